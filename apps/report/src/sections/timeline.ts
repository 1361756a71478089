// All jams over time, a band of lanes for each stream. The streams are never mixed: one jam may stand in several of them.
import { emptyBox } from '../card';
import type { ReportData } from '../data';
import { el, svg } from '../dom';
import { instant, known, withUnit } from '../numbers/format';
import { decimals } from '../numbers/format';
import { roundWidth } from '../numbers/bins';
import { momentOf, type Moment } from '../scene/panel';
import type { TimeView } from '../time_view';

export interface Item {
  start: number; end: number; force: number; text: string; moment: Moment;
}
export interface Band {
  name: string; hint: string;
  lanes: Item[][];
}

// Lanes in which nothing overlaps, as few as there can be; what has no room in `most` lanes goes into the last one.
export function packed(items: readonly Item[], most: number): Item[][] {
  const lanes: Item[][] = [];
  for (const item of [...items].sort((a, b) => a.start - b.start)) {
    const free = lanes.find((lane) => lane[lane.length - 1]!.end < item.start);
    if (free) free.push(item);
    else if (lanes.length < most) lanes.push([item]);
    else lanes[lanes.length - 1]!.push(item);
  }
  return lanes;
}

const sectors = 2;

export function bands(data: ReportData): Band[] {
  const found: Band[] = [];
  const item = (jam: Parameters<typeof momentOf>[0], name: string, duration: number | null): Item | null =>
    known(jam.start) && known(jam.end)
      ? { start: jam.start, end: jam.end, force: jam.peak_force ?? 0, moment: momentOf(jam, name), text: `${name}: ${withUnit(duration, 's')}, peak ${withUnit(jam.peak_force, 'N')}` }
      : null;
  const items = <T>(list: readonly T[], make: (each: T, k: number) => Item | null): Item[] => list.map(make).filter((i): i is Item => i !== null);
  const add = (name: string, hint: string, lanes: Item[][]): void => {
    if (lanes.some((lane) => lane.length > 0)) found.push({ name, hint, lanes });
  };
  add('Global', 'Some grain is jammed, as frames see it', [items(data.events, (e) => item(e, `event ${e.number}`, e.survival_time))]);
  add('Clusters', 'Clusters by identity, as frames see them', packed(items(data.cluster_events, (e) => item(e, `cluster ${e.number}`, e.survival_time)), 10));
  add('Particles', 'Each grain by itself, as frames see it', packed(items(data.tracks, (t) => item(t, `grain ${t.particle}`, t.survival_time)), 12));
  const { global, site } = data.steps;
  if (global) add('Global, every step', 'Some grain is jammed, at every step of the run', [items(global.jams, (j, k) => item(j, `jam ${k + 1} of every step`, j.duration))]);
  if (site && site.jams.length > 0) {
    const used = [...new Set(site.jams.map((j) => j.site))].sort((a, b) => a - b);
    add('Sites, every step', 'Each sector of the blade and layer of its height by itself; from the lowest layer', used.map((s) =>
      items(site.jams.filter((j) => j.site === s), (j) => item(j, `sector ${(s % sectors) + 1}, layer ${Math.floor(s / sectors) + 1}`, j.duration))));
  }
  return found;
}

const left = 132;
const right = 14;
const lane = 11;
const gap = 12;
const bottom = 34;

export function drawTimeline(data: ReportData, view: TimeView, choose: (moment: Moment) => void): HTMLElement {
  const box = el('section', { class: 'card', id: 'timeline' }, el('h2', {}, 'Jams over time, by stream'));
  const all = bands(data);
  if (all.length === 0) {
    box.append(emptyBox('No jam in this record.'));
    return box;
  }
  const plot = el('div', { class: 'timeline', tabindex: 0, role: 'group', 'aria-label': 'Jams over time. Left and right choose the jam before and after, in the order of time.' });
  box.append(plot, el('p', { class: 'caption' }, 'Each bar is a jam; the stronger, the fuller its colour. Click one to see it in the 3D view. The streams count the same jams in different ways and are never mixed: ' +
    'a jam that one grain hands to the next is one global jam and two of particles. The stretch of time is that of the plots below.'));
  const inOrder = all.flatMap((band) => band.lanes.flat()).sort((a, b) => a.start - b.start);
  let current: Item | null = null;
  const most = Math.max(...inOrder.map((i) => i.force));
  const least = Math.min(...inOrder.map((i) => i.force));
  const strength = (force: number): number => (most > least && least > 0 ? Math.log(force / least) / Math.log(most / least) : 1);

  const draw = (): void => {
    const width = Math.max(plot.clientWidth, 300);
    const height = all.reduce((sum, band) => sum + band.lanes.length * lane + gap, 0) + bottom;
    const range = view.range();
    const x = (t: number): number => left + ((t - range.low) / (range.high - range.low)) * (width - left - right);
    const root = svg('svg', { width, height, viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${inOrder.length} jams over time` });
    const step = roundWidth((range.high - range.low) / Math.max(2, Math.floor((width - left) / 110)));
    for (let k = Math.ceil(range.low / step); k * step <= range.high; ++k)
      root.append(svg('line', { class: 'grid', x1: x(k * step), x2: x(k * step), y1: 0, y2: height - bottom }),
        svg('text', { class: 'tick', x: x(k * step), y: height - bottom + 14, 'text-anchor': 'middle' }, (k * step).toFixed(decimals(step))));
    root.append(svg('text', { class: 'tick', x: left + (width - left - right) / 2, y: height - 4, 'text-anchor': 'middle' }, 'Time (s)'));
    let top = 4;
    for (const band of all) {
      root.append(svg('text', { class: 'name', x: 0, y: top + Math.min(lane, band.lanes.length * lane / 2 + 4) }, band.name, svg('title', {}, band.hint)),
        svg('line', { class: 'axis', x1: 0, x2: width - right, y1: top + band.lanes.length * lane + gap / 2, y2: top + band.lanes.length * lane + gap / 2 }));
      for (const items of band.lanes) {
        for (const item of items) {
          if (item.end < range.low || item.start > range.high) continue;
          const from = Math.max(x(item.start), left - 2);
          const to = Math.min(x(item.end), width - right + 2);
          const bar = svg('rect', {
            class: item === current ? 'jam current' : 'jam', x: from, y: top + 1, width: Math.max(to - from, 3), height: lane - 2, 'fill-opacity': 0.35 + 0.65 * strength(item.force),
            click: () => select(item),
          }, svg('title', {}, `${item.text}, from ${instant(item.start, data.headline.sampling_interval)} s`));
          root.append(bar);
        }
        top += lane;
      }
      top += gap;
    }
    plot.replaceChildren(root as unknown as Node);
  };
  const select = (item: Item): void => {
    current = item;
    draw();
    choose(item.moment);
  };
  plot.addEventListener('keydown', (event) => {
    const by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (by === 0) return;
    event.preventDefault();
    const at = current ? inOrder.indexOf(current) + by : 0;
    select(inOrder[(at + inOrder.length) % inOrder.length]!);
  });
  const observer = new ResizeObserver(draw);
  observer.observe(plot);
  const end = view.listen(() => {
    if (plot.isConnected) draw();
    else {
      end();
      observer.disconnect();
    }
  });
  return box;
}
