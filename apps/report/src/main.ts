import 'uplot/dist/uPlot.min.css';
import './style.css';
import { drawCard, type Card } from './card';
import { parseData, type Column, type EventData, type ReportData } from './data';
import { el } from './dom';
import { groups } from './figures';
import { instant, known, plural, setting } from './numbers/format';
import { drawConventions } from './sections/conventions';
import { drawHeadline } from './sections/headline';
import { drawEvents, drawTracks } from './sections/lists';
import { drawProvenance } from './sections/provenance';
import { around, makeTimeView, type Range } from './time_view';

// The span of everything that is drawn over time.
function recordOf(data: ReportData): Range {
  let low = Infinity;
  let high = -Infinity;
  const include = (time: Column): void => {
    for (const t of time)
      if (known(t)) {
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
    known(h.observed_time) ? `${setting(h.observed_time, 's')} of record` : '',
    known(h.sampling_interval) ? `one frame each ${setting(h.sampling_interval, 's')}` : '',
  ].filter(Boolean).join(' · ');
}

function remarks(data: ReportData): HTMLElement | null {
  if (data.notes.length + data.warnings.length === 0) return null;
  const list = (items: string[]): HTMLElement => el('ul', {}, ...items.map((text) => el('li', {}, text)));
  return el('aside', { class: 'remarks', 'aria-label': 'Remarks on this data' },
    data.warnings.length > 0 && el('div', {}, el('h2', {}, 'Warnings'), list(data.warnings)),
    data.notes.length > 0 && el('div', {}, el('h2', {}, 'What this data cannot tell'), list(data.notes)));
}

function draw(data: ReportData, page: HTMLElement): void {
  const name = data.name === '' ? 'Jam analysis' : data.name;
  const spans = data.events.filter((e) => known(e.start) && known(e.end)).map((e) => ({ start: e.start!, end: e.end!, event: e }));
  const view = makeTimeView(recordOf(data), spans);
  const interval = data.headline.sampling_interval ?? 0;
  let current: EventData | null = null;

  const choose = (event: EventData, scroll: boolean): void => {
    if (!known(event.start) || !known(event.end)) return;
    current = event;
    const span = { start: event.start, end: event.end };
    view.show(around(span, interval), span);
    if (scroll) document.getElementById('over-time')?.scrollIntoView();
  };
  const step = (by: number): void => {
    if (spans.length === 0) return;
    const at = current ? spans.findIndex((s) => s.event === current) + by : by > 0 ? 0 : spans.length - 1;
    choose(spans[(at + spans.length) % spans.length]!.event, false);
  };
  const events = drawEvents(data, (event) => choose(event, true));

  // What the plots show, and ways to change it; stays in sight.
  const shown = el('output', { 'aria-live': 'polite' });
  const button = (text: string, hint: string, click: () => void): HTMLButtonElement => el('button', { type: 'button', title: hint, click }, text);
  const whole = button('Whole record', 'Show the whole record (double click in a plot)', () => view.reset());
  const bar = el('div', { class: 'bar-tools', role: 'toolbar', 'aria-label': 'Time shown in the plots' },
    shown, whole,
    spans.length > 0 && button('‹ Event', 'Show the event before', () => step(-1)),
    spans.length > 0 && button('Event ›', 'Show the next event', () => step(1)),
    el('a', { href: '#events' }, 'Event list'),
    el('span', { class: 'hint' }, 'Drag in a plot to zoom, double click to reset.'));
  const tell = (): void => {
    const { low, high } = view.range();
    if (!view.marked()) current = null;
    const digits = (high - low) / 1000;
    shown.textContent = `${instant(low, digits)} s … ${instant(high, digits)} s${current ? `, event ${current.number}` : ''}`;
    whole.disabled = low <= view.full.low && high >= view.full.high;
    events.mark(current);
  };
  view.listen(tell);

  const cards: Card[] = [];
  const sections = groups.map((group) => {
    const drawn = group.figures.map((figure) => drawCard(figure, data, view));
    cards.push(...drawn);
    return el('section', { class: `group ${group.id}`, id: group.id },
      el('h2', {}, group.title), group.id === 'over-time' && bar, el('div', { class: 'cards' }, ...drawn.map((card) => card.box)));
  });
  const links: [string, string][] = [
    ['over-time', 'Over time'], ['events', 'Events'],
    ...groups.slice(1).map((g): [string, string] => [g.id, g.title]), ['tracks', 'Tracks'], ['provenance', 'Provenance'], ['conventions', 'Conventions'],
  ];
  const overTime = sections.shift()!;
  page.append(
    el('header', { class: 'top' },
      el('p', { class: 'program' }, 'jamscope report'),
      el('h1', {}, name),
      data.description !== '' && el('p', { class: 'description' }, data.description),
      el('p', { class: 'subtitle' }, subtitle(data)),
      el('nav', { 'aria-label': 'Contents' }, ...links.map(([id, text]) => el('a', { href: `#${id}` }, text)))),
    drawHeadline(data), ...[remarks(data)].filter((n): n is HTMLElement => n !== null),
    overTime, events.box, ...sections, drawTracks(data), drawProvenance(data), drawConventions(data));
  tell();
  cards.forEach((card) => card.redraw());
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => cards.forEach((card) => card.redraw()));
  matchMedia('print').addEventListener('change', () => cards.forEach((card) => card.redraw()));
  document.title = `${name} · jamscope report`;
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
