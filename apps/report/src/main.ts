import 'uplot/dist/uPlot.min.css';
import './style.css';
import { drawCard, type Card } from './card';
import { parseData, type Column, type EventData, type ReportData, type StepJamData, type TrackData } from './data';
import { el } from './dom';
import { groups } from './figures';
import { sectionsOfRun } from './island/sections';
import { instant, known as isKnown, plural, setting } from './numbers/format';
import { recounted, type Recountable } from './recount/recount';
import { decodeSamples } from './recount/samples';
import { decodeStays } from './recount/stays';
import { drawScene, momentOf, type Moment, type ScenePanel } from './scene/panel';
import { drawConventions } from './sections/conventions';
import { drawComparison, drawHeadline } from './sections/headline';
import { drawEvents, drawSteps, drawTracks, type Lists } from './sections/lists';
import { drawMetrics } from './sections/metrics';
import { drawOverview } from './sections/overview';
import { drawProvenance } from './sections/provenance';
import { drawThreshold } from './sections/threshold';
import { drawTimeline } from './sections/timeline';
import { around, makeTimeView, type Range } from './time_view';

// The span of everything that is drawn over time.
function recordOf(data: ReportData): Range {
  let low = Infinity;
  let high = -Infinity;
  const include = (time: Column): void => {
    for (const t of time)
      if (isKnown(t)) {
        low = Math.min(low, t);
        high = Math.max(high, t);
      }
  };
  [data.frames.time, data.series?.time ?? [], data.flow_energy.time].forEach(include);
  if (!(high >= low)) return { low: 0, high: 1 };
  return high > low ? { low, high } : { low: low - 0.5, high: high + 0.5 };
}

function subtitle(data: ReportData): string {
  const h = data.headline;
  return [
    h.particles > 0 ? plural(h.particles, 'grain') : '',
    h.frames > 0 ? plural(h.frames, 'frame') : 'no frames',
    isKnown(h.observed_time) ? `${setting(h.observed_time, 's')} of record` : '',
    isKnown(h.sampling_interval) ? `one frame each ${setting(h.sampling_interval, 's')}` : '',
  ].filter(Boolean).join(' · ');
}

function remarks(data: ReportData): HTMLElement | null {
  if (data.notes.length + data.warnings.length === 0) return null;
  const list = (items: string[]): HTMLElement => el('ul', {}, ...items.map((text) => el('li', {}, text)));
  return el('aside', { class: 'remarks', 'aria-label': 'Remarks on this data' },
    data.warnings.length > 0 && el('div', {}, el('h2', {}, 'Warnings'), list(data.warnings)),
    data.notes.length > 0 && el('div', {}, el('h2', {}, 'What this data cannot tell'), list(data.notes)));
}

function titleOf(runs: readonly ReportData[]): string {
  if (runs.length > 1) return `${runs.length} runs`;
  return runs[0]!.name === '' ? 'Jam analysis' : runs[0]!.name;
}

// A place on the page whose content is drawn anew when the run or the threshold changes.
function place(): { box: HTMLElement; fill(...content: (Node | null)[]): void } {
  const box = el('div');
  return { box, fill: (...content) => box.replaceChildren(...content.filter((n): n is Node => n !== null)) };
}

function draw(all: readonly ReportData[], page: HTMLElement): void {
  const several = all.length > 1;
  const records = all.map(recordOf);
  const view = makeTimeView({ low: Math.min(...records.map((r) => r.low)), high: Math.max(...records.map((r) => r.high)) }, []);
  let runs: readonly ReportData[] = all; // at the threshold of the page
  let at = 0;                            // the run whose lists and view in space are shown
  let current: EventData | null = null;
  let shownEvents: Lists | null = null;
  let scene: ScenePanel | null = null;

  const decoded = all.map((data, k): Promise<Recountable> => {
    const load = sectionsOfRun(k);
    const samples = data.samples ? load(data.samples.section).then((bytes) => decodeSamples(bytes, data.samples!, data.scene.low!, data.scene.high!)) : Promise.resolve(null);
    const stays = data.stays ? load(data.stays.section).then((bytes) => decodeStays(bytes, data.stays!)) : Promise.resolve(null);
    return Promise.all([samples, stays]).then(([s, t]) => ({ samples: s, stays: t }));
  });
  let known: readonly Recountable[] = all.map(() => ({ samples: null, stays: null }));

  const run = (): ReportData => runs[at]!;
  const interval = (): number => run().headline.sampling_interval ?? 0;
  const spans = (): { start: number; end: number; event: EventData }[] =>
    run().events.filter((e) => isKnown(e.start) && isKnown(e.end)).map((e) => ({ start: e.start!, end: e.end!, event: e }));

  const inSpace = (moment: Moment, scroll: boolean): void => {
    if (scroll) document.getElementById('scene')?.scrollIntoView();
    void scene?.show(moment);
  };
  const mark = (start: number | null, end: number | null): void => {
    if (!isKnown(start) || !isKnown(end)) return;
    const span = { start, end };
    view.show(around(span, interval()), span);
  };
  const choose = (event: EventData, scroll: boolean): void => {
    current = event;
    mark(event.start, event.end);
    inSpace(momentOf(event, `event ${event.number}`), scroll);
  };
  const chooseJam = (jam: TrackData | StepJamData, name: string): void => {
    current = null;
    mark(jam.start, jam.end);
    inSpace(momentOf(jam, name), true);
  };
  const step = (by: number): void => {
    const list = spans();
    if (list.length === 0) return;
    const from = current ? list.findIndex((s) => s.event === current) + by : by > 0 ? 0 : list.length - 1;
    choose(list[(from + list.length) % list.length]!.event, false);
  };
  view.onChoose((time, give) => {
    const near = spans().find((s) => time >= s.start - Math.max(give, interval() / 2) && time <= s.end + Math.max(give, interval() / 2));
    if (near) choose(near.event, false);
  });

  // What the plots show, and ways to change it; stays in sight.
  const shown = el('output', { 'aria-live': 'polite' });
  const button = (text: string, hint: string, click: () => void): HTMLButtonElement => el('button', { type: 'button', title: hint, click }, text);
  const whole = button('Whole record', 'Show the whole record (double click in a plot)', () => view.reset());
  const earlier = button('‹ Event', 'Show the event before', () => step(-1));
  const later = button('Event ›', 'Show the next event', () => step(1));
  const hint = el('span', { class: 'hint' });
  const bar = el('div', { class: 'bar-tools', role: 'toolbar', 'aria-label': 'Time shown in the plots' },
    shown, whole, earlier, later, el('a', { href: '#scene' }, '3D view'), el('a', { href: '#events' }, 'Event list'),
    hint);
  const tell = (): void => {
    const { low, high } = view.range();
    if (!view.marked()) current = null;
    const digits = (high - low) / 1000;
    shown.textContent = `${instant(low, digits)} s … ${instant(high, digits)} s${current ? `, event ${current.number}` : ''}`;
    whole.disabled = low <= view.full.low && high >= view.full.high;
    earlier.hidden = later.hidden = run().events.length === 0;
    hint.textContent = `Drag in a plot to zoom, double click to reset${view.events.length > 0 ? ', click a shaded jam to choose it' : ''}.`;
    shownEvents?.mark(current);
  };
  view.listen(tell);

  const parts = { headline: place(), remarks: place(), overview: place(), scene: place(), timeline: place(), events: place(), steps: place(), tracks: place(), provenance: place(), conventions: place() };
  const threshold = drawThreshold(all, (force) => {
    runs = all.map((data, k) => recounted(data, known[k]!, force));
    fillCounts();
    scene?.threshold(force);
  });

  let cards: Card[] = [];
  const sections = groups.map((group) => {
    const drawn = group.figures.map((figure) => drawCard(figure, runs, view));
    cards.push(...drawn);
    return el('section', { class: `group ${group.id}`, id: group.id },
      el('h2', {}, group.title), group.id === 'over-time' && bar, el('div', { class: 'cards' }, ...drawn.map((card) => card.box)));
  });
  const metrics = drawMetrics(all, view);

  // What follows from the threshold and the run.
  function fillCounts(): void {
    const data = run();
    view.setEvents(several ? [] : spans());
    parts.headline.fill(several ? drawComparison(runs) : drawHeadline(data));
    shownEvents = drawEvents(data, (event) => choose(event, true));
    parts.events.fill(shownEvents.box);
    parts.steps.fill(drawSteps(data, chooseJam));
    parts.tracks.fill(drawTracks(data, (track) => chooseJam(track, `stay of grain ${track.particle}`)));
    parts.timeline.fill(drawTimeline(data, view, (moment) => {
      const event = data.events.find((e) => e.peak_particle === moment.particle && e.peak_time === moment.peak);
      if (event && moment.name.startsWith('event')) choose(event, true);
      else {
        current = null;
        mark(moment.start, moment.end);
        inSpace(moment, true);
      }
    }));
    parts.conventions.fill(drawConventions(data));
    threshold.tell(runs);
    cards = cards.map((card) => {
      if (!card.figure.counts) return card;
      const fresh = drawCard(card.figure, runs, view);
      card.box.replaceWith(fresh.box);
      return fresh;
    });
    tell();
  }
  // What follows from the run alone.
  function fillRun(): void {
    const data = all[at]!;
    parts.remarks.fill(remarks(data));
    parts.overview.fill(drawOverview(data));
    scene = drawScene(data, at, decoded[at]!.then((d) => d.samples));
    parts.scene.fill(scene.box);
    parts.provenance.fill(drawProvenance(data));
    fillCounts();
    scene.threshold(run().criteria.jam_force);
  }

  const links: [string, string][] = [
    ['scene', '3D view'], ['overview', 'Overview'], ['threshold', 'Threshold'], ['timeline', 'Timeline'], ['over-time', 'Over time'], ['events', 'Events'], ['steps', 'Every step'],
    ...groups.slice(1).map((g): [string, string] => [g.id, g.title]), ['metrics', 'Network'], ['tracks', 'Tracks'], ['provenance', 'Provenance'], ['conventions', 'Conventions'],
  ];
  const chooser = el('select', { change: () => { at = Number(chooser.value); fillRun(); } }, ...all.map((data, k) => el('option', { value: k }, data.name || `run ${k + 1}`)));
  const overTime = sections.shift()!;
  page.append(
    el('header', { class: 'top' },
      el('p', { class: 'program' }, 'jamscope report'),
      el('h1', {}, titleOf(all)),
      !several && all[0]!.description !== '' && el('p', { class: 'description' }, all[0]!.description),
      el('p', { class: 'subtitle' }, several ? all.map((data) => data.name).join(' · ') : subtitle(all[0]!)),
      el('nav', { 'aria-label': 'Contents' }, ...links.map(([id, text]) => el('a', { href: `#${id}` }, text)))),
    parts.headline.box);
  if (several) page.append(el('p', { class: 'choose' }, el('label', { class: 'choice' }, 'Lists, timeline and 3D view of ', chooser), ' Plots show all runs.'));
  page.append(parts.remarks.box, parts.scene.box, parts.overview.box, threshold.box, parts.timeline.box, overTime, parts.events.box, parts.steps.box, ...sections, metrics.box, parts.tracks.box, parts.provenance.box, parts.conventions.box);
  fillRun();
  const redraw = (): void => {
    cards.forEach((card) => card.redraw());
    metrics.redraw();
    scene?.recolour();
  };
  redraw();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  matchMedia('print').addEventListener('change', redraw);
  document.title = `${titleOf(all)} · jamscope report`;
  void Promise.all(decoded).then((d) => {
    known = d;
    threshold.offer(d);
    root.dataset.counting = 'ready';
  }).catch((error: unknown) => {
    threshold.offer(known);
    console.error(error);
  });
  // For the tests that drive a browser.
  Object.assign(window, { jamscope: { scene: () => scene?.state(), measure: (draws: number) => scene?.measure(draws), runs: () => runs } });
}

const root = document.documentElement;
const page = document.getElementById('page')!;
try {
  draw(parseData(document.getElementById('data')?.textContent ?? ''), page);
  root.dataset.state = 'ready';
} catch (error) {
  const text = error instanceof Error ? error.message : String(error);
  page.replaceChildren(el('p', { class: 'trouble', role: 'alert' }, `This report cannot be shown: ${text}. Build it again with "jamscope report DIR".`));
  document.title = 'Error · jamscope report';
  root.dataset.state = 'error';
}
