// Does the checked-in dist/ equal a fresh build of the sources? Exit code 1 if not.
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';

const root = fileURLToPath(new URL('..', import.meta.url));
const fresh = mkdtempSync(join(tmpdir(), 'report-'));
try {
  await build({ root, logLevel: 'error', build: { outDir: fresh, emptyOutDir: true } });
  const names = [...new Set([...readdirSync(fresh), ...readdirSync(join(root, 'dist'))])].sort();
  const same = (name) => {
    try {
      return readFileSync(join(fresh, name)).equals(readFileSync(join(root, 'dist', name)));
    } catch {
      return false;
    }
  };
  const different = names.filter((name) => !same(name));
  if (different.length > 0) {
    console.error(`dist/ is not what the sources build: ${different.join(', ')} differ. Run "npm run build".`);
    process.exitCode = 1;
  } else {
    console.log(`dist/ equals a fresh build (${names.join(', ')})`);
  }
} finally {
  rmSync(fresh, { recursive: true, force: true });
}
