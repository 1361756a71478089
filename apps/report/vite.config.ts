import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

// One file for everything: script, style and licences go into the page, and a policy forbids it to load anything else.
function onePage(): Plugin {
  return {
    name: 'one-page',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['index.html'];
      if (!page || page.type !== 'asset') throw new Error('no page in the bundle');
      let script = '';
      let style = '';
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === 'chunk') script += file.code;
        else if (name.endsWith('.css')) style += String(file.source);
        else if (file !== page) throw new Error(`unexpected file in the bundle: ${name}`);
        if (file !== page) delete bundle[name];
      }
      if (/<\/script|<!--/i.test(script)) throw new Error('the script would end its own element');
      const licences = ['uplot', 'three'].map((name) => {
        const text = (file: string): string => readFileSync(new URL(`node_modules/${name}/${file}`, import.meta.url), 'utf8');
        return `report.html contains ${name} ${(JSON.parse(text('package.json')) as { version: string }).version}:\n\n${text('LICENSE').trim()}\n`;
      }).join('\n');
      const policy = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";
      const html = String(page.source)
        .replace(/\s*<script\b[^>]*src=[^>]*><\/script>/, '')
        .replace(/\s*<link\b[^>]*rel="stylesheet"[^>]*>/, '')
        .replace('<meta charset="utf-8" />', (m) => `${m}\n<meta http-equiv="Content-Security-Policy" content="${policy}" />`)
        .replace('</head>', () => `<style>${style.trim()}</style>\n<!--\n${licences}-->\n</head>`)
        .replace('</body>', () => `<script>${script.trim()}</script>\n</body>`);
      page.source = html;
      page.fileName = 'report.html';
      this.emitFile({ type: 'asset', fileName: 'LICENSES.txt', source: licences });
    },
  };
}

export default defineConfig({
  plugins: [onePage()],
  build: {
    target: 'es2022',
    outDir: 'dist',
    emptyOutDir: true,
    modulePreload: false,
    cssCodeSplit: false, // otherwise the script would carry the style
    rolldownOptions: { output: { format: 'iife' } },
  },
  test: { include: ['tests/**/*.test.ts'] },
});
