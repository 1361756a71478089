// Opens a report in a headless Chromium and checks what a reader would: see README.md.
//
//   npm run test:browser -- REPORT.html [--run RUN.h5 --program JAMSCOPE] [--several PAGE.html] [--pictures DIR]
//
// REPORT.html: of one run with jams, with its summary.json beside it. With --run and --program (the snapshots the report was made from, and jamscope) the
// threshold slider is compared with what `jamscope analyze --set jam_force=...` counts. --several: a page of several runs. Exit code 1 where something is wrong.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { chromium } from 'playwright-core';

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: { run: { type: 'string' }, program: { type: 'string' }, pictures: { type: 'string' }, several: { type: 'string' }, draws: { type: 'string', default: '10' }, chromium: { type: 'string', default: '/usr/bin/chromium' } },
});
const report = resolve(positionals[0] ?? '');
if (positionals.length !== 1 || !existsSync(report)) {
  console.error('usage: npm run test:browser -- REPORT.html [--run RUN.h5 --program JAMSCOPE] [--pictures DIR]');
  process.exit(2);
}
const summary = JSON.parse(readFileSync(join(dirname(report), 'summary.json'), 'utf8'));

let failures = 0;
function check(what, ok, found = '') {
  console.log(`${ok ? 'ok  ' : 'FAIL'}  ${what}${found === '' ? '' : `: ${found}`}`);
  if (!ok) ++failures;
}
// Milliseconds for any one thing: a page that hangs fails in the end, one on a busy machine does not.
const patience = 180_000;
const close = (a, b, relative = 1e-5) => Math.abs(a - b) <= relative * Math.max(Math.abs(a), Math.abs(b), 1e-300);

const software = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

async function open(args, file = report) {
  const browser = await chromium.launch({ executablePath: options.chromium, args, timeout: patience });
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, colorScheme: 'light' });
  page.setDefaultTimeout(patience);
  const trouble = [];
  page.on('console', (message) => { if (message.type() === 'error') trouble.push(message.text()); });
  page.on('pageerror', (error) => trouble.push(error.message));
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) trouble.push(`asked the network for ${request.url()}`); });
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => document.documentElement.dataset.state !== 'loading', null, { timeout: patience });
  return { browser, page, trouble };
}
const sceneReady = (page) => page.waitForFunction(() => document.querySelector('.stage')?.dataset.state === 'ready', null, { timeout: patience });
const picture = async (page, name) => {
  if (options.pictures) await page.screenshot({ path: join(options.pictures, `${name}.png`) });
};

// The colour of the ring of a jammed grain, as drawn around the chosen one.
async function ringPixels(page) {
  return page.evaluate(() => {
    const { place } = window.jamscope.scene();
    const canvas = document.querySelector('.stage canvas');
    const copy = document.createElement('canvas');
    copy.width = copy.height = 80;
    const scale = canvas.width / canvas.clientWidth;
    const pen = copy.getContext('2d');
    pen.drawImage(canvas, place.x * scale - 40, place.y * scale - 40, 80, 80, 0, 0, 80, 80);
    const wanted = document.createElement('canvas').getContext('2d');
    wanted.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--jam').trim();
    wanted.fillRect(0, 0, 1, 1);
    const [r, g, b] = wanted.getImageData(0, 0, 1, 1).data;
    const pixels = pen.getImageData(0, 0, 80, 80).data;
    let found = 0;
    for (let k = 0; k < pixels.length; k += 4) found += Number(Math.abs(pixels[k] - r) < 6 && Math.abs(pixels[k + 1] - g) < 6 && Math.abs(pixels[k + 2] - b) < 6);
    return found;
  });
}

const { browser, page, trouble } = await open(software);
try {
  check('the page is ready', (await page.evaluate(() => document.documentElement.dataset.state)) === 'ready');
  await sceneReady(page);
  await page.waitForFunction(() => document.documentElement.dataset.counting === 'ready', null, { timeout: patience });

  // Numbers of summary.json in figures and tiles.
  const { analysis } = summary;
  const tile = (name) => page.locator('.tiles > div', { hasText: name }).locator('.value').innerText();
  check('the tile of events holds the number of summary.json', Number((await tile('Jam events above')).replace(/\D/g, '')) === analysis.jams.events, await tile('Jam events above'));
  const data = await page.evaluate(() => window.jamscope.runs()[0]);
  check('the flow energy ends at that of summary.json', close(data.flow_energy.energy.at(-1), analysis.flow_energy.total_J) || analysis.flow_energy.total_J === null, String(data.flow_energy.energy.at(-1)));
  check('the largest force of a frame is that of summary.json', close(Math.max(...data.frames.largest_force), analysis.largest_compressive_force.force_N), String(Math.max(...data.frames.largest_force)));
  const bars = await page.locator('#survival-frequency g.bar text.value').allTextContents();
  check('the bars of Fig. 9 are the survival classes of summary.json', analysis.jams.events === 0 || bars.map((t) => Number(t.replace(/\D/g, ''))).join() === analysis.survival_classes.map((c) => c.events).join(), bars.join());
  const shares = await page.locator('#survival-share tbody tr td:last-child').allInnerTexts();
  check('the shares of Table 4 are those of summary.json', analysis.jams.events === 0 || analysis.survival_classes.every((c, k) => /* three digits */ Math.abs(parseFloat(shares[k]) / 100 - c.share_of_jam_time) < 5e-3 * Math.max(c.share_of_jam_time, 0.01)), shares.join(' '));
  const histogram = await page.locator('#jammed-histogram g.bar text.value').allTextContents();
  const jammedFrames = analysis.frames_by_jammed_particles.slice(1);
  check('the bars of Fig. 12 are the frames of summary.json', histogram.length > 20 || histogram.every((t, k) => Number(t.replace(/\D/g, '')) === jammedFrames[k]), histogram.join());
  for (const stream of Object.keys(analysis.jams_at_every_step ?? {})) {
    const theirs = analysis.jams_at_every_step[stream].survival;
    const mine = data.steps[stream].survival;
    const same = (a, b) => a.length === b.length && a.every((v, k) => (v === null || b[k] === null ? v === b[k] : close(v, b[k])));
    check(`the survival curve of the stream ${stream} is that of summary.json, with its band`, same(mine.time, theirs.time_s) && ['share', 'low', 'high'].every((part) => same(mine[part], theirs[part])), `${mine.time.length} steps`);
  }
  await picture(page, 'overview');

  // A click on an event, in the table, in the timeline, in a plot.
  const state = () => page.evaluate(() => window.jamscope.scene());
  const waitFor = (particle) => page.waitForFunction((id) => window.jamscope.scene().selected === id && document.querySelector('.stage').dataset.selected === String(id), particle, { timeout: patience });
  if (analysis.jams.events > 0) {
    for (const [k, event] of data.events.slice(0, 3).entries()) {
      await page.locator('#events button.open').nth(k).click();
      await waitFor(event.peak_particle);
      await page.waitForFunction(() => window.jamscope.scene().drawnJammed, null, { timeout: patience }).catch(() => {});
      const s = await state();
      check(`clicking event ${event.number} in the table shows grain ${event.peak_particle} as jammed`, s.selected === event.peak_particle && s.drawnJammed && s.time >= event.start - 1e-9 && s.time <= event.end + 1e-9, `frame ${s.frame}, ${s.time} s, jammed ${s.jammed}`);
      let ring = 0;
      for (const began = Date.now(); ring <= 20 && Date.now() < began + patience;) { // until it is drawn
        await page.waitForTimeout(200);
        ring = await ringPixels(page);
      }
      check('and the ring of a jammed grain is drawn there', ring > 20, `${ring} pixels`);
    }
    await picture(page, 'event');
    // Jams of every step may fall between all frames; then the page says so and shows the nearest.
    const jams = data.steps.particle?.jams ?? [];
    if (jams.length > 0) await page.locator('#steps select').selectOption('particle');
    const order = [...jams].sort((a, b) => a.peak_particle - b.peak_particle); // as the table is sorted at first
    for (const [k, jam] of order.slice(0, 6).entries()) {
      const near = `jam of every step, grain ${jam.peak_particle}`;
      await page.locator('#steps button.open').nth(k).click();
      await page.waitForFunction(([id, name]) => window.jamscope.scene().selected === id && window.jamscope.scene().message.startsWith(name), [jam.peak_particle, near], { timeout: patience });
      const inside = data.scene.frames.some((f) => f.time >= jam.start - 1e-9 && f.time <= jam.end + 1e-9 && f.jammed.includes(jam.peak_particle));
      if (inside) await page.waitForFunction(() => window.jamscope.scene().drawnJammed, null, { timeout: patience }).catch(() => {});
      const s = await state();
      check(`clicking a jam of every step shows grain ${jam.peak_particle} ${inside ? 'as jammed' : 'in the nearest frame, and says so'}`,
        inside ? s.drawnJammed && s.time >= jam.start - 1e-9 && s.time <= jam.end + 1e-9 : /no frame of this page shows it/.test(s.message), `${s.time} s`);
    }
    const bar = page.locator('.timeline rect.jam').last();
    await bar.scrollIntoViewIfNeeded();
    await page.evaluate(() => { document.querySelector('.timeline').scrollIntoView({ block: 'center' }); });
    const was = (await state()).message;
    await bar.click({ force: true });
    await page.waitForFunction((message) => window.jamscope.scene().message !== message, was, { timeout: patience });
    const fromTimeline = await state();
    check('clicking a bar of the timeline chooses a grain', fromTimeline.selected >= 0 && fromTimeline.message !== '', `grain ${fromTimeline.selected}, frame ${fromTimeline.frame}, ${fromTimeline.message}`);
    const wholeRecord = page.locator('.bar-tools button', { hasText: 'Whole record' });
    if (await wholeRecord.isEnabled()) await wholeRecord.click(); // a jam as long as the record shows all of it
    const event = data.events[0];
    const spot = await page.evaluate(([start, end]) => {
      const over = document.querySelector('#grain-force .u-over');
      over.scrollIntoView({ block: 'center' });
      const box = over.getBoundingClientRect();
      const times = window.jamscope.runs()[0].frames.time;
      const low = Math.min(times[0], window.jamscope.runs()[0].series?.time[0] ?? Infinity);
      const high = Math.max(times.at(-1), window.jamscope.runs()[0].series?.time.at(-1) ?? -Infinity);
      return { x: box.left + ((start + end) / 2 - low) / (high - low) * box.width, y: box.top + box.height / 2 };
    }, [event.start, event.end]);
    await page.mouse.click(spot.x, spot.y);
    await waitFor(event.peak_particle);
    await page.waitForFunction(() => window.jamscope.scene().drawnJammed, null, { timeout: patience }).catch(() => {});
    check('clicking a shaded jam in a plot shows it', (await state()).drawnJammed);

    // A grain is picked where it is drawn, and keys work.
    await page.locator('#scene').scrollIntoViewIfNeeded();
    await page.evaluate(() => document.querySelector('#scene').scrollIntoView());
    const chosen = await state();
    const box = await page.locator('.stage').boundingBox();
    await page.locator('#scene button', { hasText: 'Let go' }).click();
    check('a chosen grain can be let go', (await state()).selected === -1);
    await page.mouse.click(box.x + chosen.place.x, box.y + chosen.place.y);
    check('a click on a grain picks it', (await state()).selected >= 0, `grain ${(await state()).selected}`);
    await page.locator('.stage').focus();
    const before = (await state()).frame;
    await page.keyboard.press(before > 0 ? ',' : '.');
    await page.waitForFunction((frame) => window.jamscope.scene().frame !== frame, before, { timeout: patience });
    check('the keyboard changes the frame', true);
  }

  // The threshold.
  if (options.run && options.program) {
    const most = analysis.largest_compressive_force.force_N;
    const recorded = analysis.criteria.jam_force_N;
    for (const force of [recorded / 4, recorded / 2, recorded * 1.5, most / 2].map((f) => Number(f.toPrecision(3)))) {
      const out = mkdtempSync(join(tmpdir(), 'jamscope-'));
      try {
        execFileSync(options.program, ['analyze', options.run, '-o', out, '--overwrite', '-q', '--set', `jam_force=${force} N`]);
        const theirs = JSON.parse(readFileSync(join(out, 'summary.json'), 'utf8')).analysis;
        await page.evaluate((f) => {
          const number = document.querySelector('#threshold-number');
          number.value = String(f);
          number.dispatchEvent(new Event('change'));
        }, force);
        await page.waitForFunction((f) => window.jamscope.runs()[0].criteria.jam_force === f, force, { timeout: patience });
        const mine = await page.evaluate(() => window.jamscope.runs()[0]);
        const steps = theirs.jams_at_every_step ?? {};
        const pairs = [
          [mine.headline.events, theirs.jams.events], [mine.headline.tracks, theirs.jams.particle_tracks], [mine.headline.censored, theirs.jams.cut_off_by_the_record],
          [mine.headline.jammed_time, theirs.jams.jammed_time_s], [mine.headline.jam_frequency, theirs.jams.frequency_per_s],
          [mine.headline.jammed_in_gap_share, theirs.jams.jammed_in_gap_share],
          ...mine.survival_classes.map((c, k) => [c.events, theirs.survival_classes[k].events]),
          ...theirs.frames_by_jammed_particles.map((n, k) => [mine.jammed_histogram[k] ?? 0, n]),
          ...theirs.first_events.flatMap((e, k) => [[mine.events[k]?.peak_force, e.peak_force_N], [mine.events[k]?.peak_particle, e.peak_particle], [mine.events[k]?.samples, e.samples], [mine.events[k]?.start, e.start_s]]),
          ...Object.keys(steps).flatMap((stream) => [[mine.steps[stream]?.events, steps[stream].events], [mine.steps[stream]?.jammed_time, steps[stream].jammed_time_s],
            [mine.steps[stream]?.median.value ?? null, steps[stream].median_duration_s.value], [mine.steps[stream]?.rate.high, steps[stream].frequency_per_s.high],
            ...steps[stream].survival.share.map((v, k) => [mine.steps[stream]?.survival.share[k], v])]),
        ];
        const wrong = pairs.filter(([a, b]) => !(a === b || (typeof a === 'number' && typeof b === 'number' && close(a, b, 1e-7))));
        check(`at ${force} N the page counts as jamscope analyze --set jam_force="${force} N"`, wrong.length === 0,
          wrong.length === 0 ? `${theirs.jams.events} events, ${theirs.jams.particle_tracks} stays, ${pairs.length} numbers` : `differ (page, program): ${JSON.stringify(wrong.slice(0, 5))}`);
        const said = await page.locator('#threshold-found').innerText();
        check('and says so', said.startsWith(`${String(theirs.jams.events)} jam`), said);
      } finally {
        rmSync(out, { recursive: true, force: true });
      }
    }
    const slider = page.locator('#threshold-slider');
    await slider.focus();
    const was = await page.evaluate(() => window.jamscope.runs()[0].criteria.jam_force);
    await page.keyboard.press('ArrowLeft');
    await page.waitForFunction((f) => window.jamscope.runs()[0].criteria.jam_force !== f, was, { timeout: patience });
    check('the slider moves by keyboard', true);
    await page.evaluate(() => document.querySelector('#threshold').scrollIntoView());
    await page.waitForTimeout(300);
    await picture(page, 'threshold');
    await page.locator('#threshold button').click();
    await page.waitForFunction((f) => window.jamscope.runs()[0].criteria.jam_force === f, recorded, { timeout: patience });
    check('the way back leads to the threshold of the analysis', true);
  }

  const seconds = await page.evaluate((n) => window.jamscope.measure(n), Number(options.draws));
  const grains = await page.evaluate(() => window.jamscope.runs()[0].headline.particles);
  const size = await page.evaluate(() => { const c = document.querySelector('.stage canvas'); return `${c.width} x ${c.height}`; });
  check('a frame is drawn in finite time', seconds > 0 && seconds < 60, `${(1 / seconds).toFixed(1)} frames a second of ${grains} grains at ${size} pixels, software renderer`);
  check('nothing was said on the console, nothing asked of a network', trouble.length === 0, trouble.join('; '));
} catch (error) {
  check('the page does what is asked of it', false, `${error.message}${trouble.length > 0 ? `; console: ${trouble.join('; ')}` : ''}`);
} finally {
  await browser.close();
}

// Without WebGL everything else works, and the page says so.
{
  const { browser: bare, page: flat, trouble: noise } = await open(['--no-sandbox', '--disable-gpu', '--disable-3d-apis']);
  try {
    const said = await flat.locator('#scene').innerText();
    check('without WebGL the page says so', /no WebGL/.test(said), said.split('\n').at(-1));
    check('and draws everything else', (await flat.locator('canvas').count()) >= 8 && (await flat.evaluate(() => document.documentElement.dataset.state)) === 'ready', `${await flat.locator('canvas').count()} plots`);
    check('without an error', noise.length === 0, noise.join('; '));
  } finally {
    await bare.close();
  }
}
// Several runs on one page.
if (options.several) {
  const { browser: many, page: all, trouble: noise } = await open(software, resolve(options.several));
  try {
    await sceneReady(all);
    const names = await all.evaluate(() => window.jamscope.runs().map((run) => run.name));
    check('a page of several runs has a column for each', (await all.locator('#comparison thead th').allTextContents()).slice(1).join() === names.join(), names.join());
    const legend = await all.locator('#flow-energy .u-legend th').allTextContents();
    check('and draws their curves over each other', names.every((name) => legend.some((text) => text.startsWith(`${name}:`))), legend.join(', '));
    const frames = await all.evaluate(() => window.jamscope.runs().map((run) => run.events.map((e) => e.number).join()));
    await all.locator('.choose select').first().selectOption({ index: names.length - 1 });
    await sceneReady(all);
    check('the chooser shows the lists of the last run', (await all.locator('#events tbody button.open').allTextContents()).join() === frames.at(-1));
    if (frames.at(-1) !== '') {
      await all.locator('#events button.open').first().click();
      await all.waitForFunction(() => window.jamscope.scene().drawnJammed, null, { timeout: patience });
      check('and its jams in its own 3D view', true);
    }
    if (options.pictures) await all.screenshot({ path: join(options.pictures, 'several.png') });
    check('without an error', noise.length === 0, noise.join('; '));
  } catch (error) {
    check('the page of several runs does what is asked of it', false, error.message);
  } finally {
    await many.close();
  }
}
console.log(failures === 0 ? 'all fine' : `${failures} failed`);
process.exit(failures === 0 ? 0 : 1);
