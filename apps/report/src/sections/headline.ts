// The numbers that come first.
import type { ReportData } from '../data';
import { el } from '../dom';
import { count, instant, known, percent, plural, setting, significant, withUnit } from '../numbers/format';
import { garwood } from '../numbers/poisson';

export interface Tile {
  name: string;
  value: string;
  note: string;
}

export function tiles(data: ReportData): Tile[] {
  const h = data.headline;
  const threshold = setting(data.criteria.jam_force, 'N');
  const rate = known(h.observed_time) ? garwood(h.events, h.observed_time) : null;
  const interval = rate ? `95 % interval ${significant(rate.low)} … ${significant(rate.high)}\u00a0Hz` : '';
  const jams: Tile[] = [
    {
      name: `Jam events above ${threshold}`,
      value: count(h.events),
      note: h.frames === 0 ? 'the record holds no frames' : h.events === 0 ? `no jam in ${plural(h.frames, 'frame')}`
        : h.censored > 0 ? `${count(h.censored)} cut by a record end or missing frames` : 'all begin and end within the record',
    },
    {
      name: 'Jam frequency',
      value: withUnit(known(h.jam_frequency) ? h.jam_frequency : rate?.rate, 'Hz'),
      note: !rate ? 'the length of the record is not known' : h.events === 0 ? `below ${withUnit(rate.high, 'Hz')} (95 %)` : interval,
    },
    {
      name: 'Jammed share of time',
      value: percent(h.jammed_share),
      note: known(h.observed_time) ? `${withUnit(h.jammed_time, 's')} of ${withUnit(h.observed_time, 's')}` : '',
    },
  ];
  const steps = h.every_step;
  const everyStep: Tile[] = steps ? [{
    name: 'Jams at every step',
    value: count(steps.events),
    note: steps.events === 0 ? 'none, also between the frames'
      : `${count(steps.grains)} of single grains; ${known(steps.median) ? `half end within ${withUnit(steps.median, 's')}` : `the longest lasts ${withUnit(steps.longest, 's')}`}`,
  }] : [];
  const seen = h.largest_force_source === 'series' ? 'over every step' : 'over the frames only';
  return [
    ...jams,
    ...everyStep,
    {
      name: 'Largest compressive force',
      value: withUnit(h.largest_force, 'N'),
      note: known(h.largest_force) ? `${seen}, at ${instant(h.largest_force_time, h.sampling_interval)} s` : 'not known from this data',
    },
    {
      name: 'Jammed grains in the gap',
      value: h.events === 0 ? '–' : percent(h.jammed_in_gap_share),
      note: h.events === 0 ? 'no grain was jammed' : known(h.jammed_in_gap_share) ? 'of all grains jammed in any frame' : 'the gap is not known from this data',
    },
    {
      name: 'Events that bridge the gap',
      value: h.events === 0 || h.bridged === null ? '–' : `${count(h.bridged)} of ${count(h.events)}`,
      note: h.events === 0 ? 'no event' : h.bridged === null ? 'not counted on this page: it needs all contacts' : 'force carried from blade to vessel',
    },
    {
      name: 'Flow energy',
      value: withUnit(data.flow_energy.total, 'J'),
      note: !known(data.flow_energy.total) ? 'blade loads are not known'
        : data.flow_energy.source === 'series' ? 'from loads of every step' : 'from loads in the frames: an estimate',
    },
  ];
}

export function drawHeadline(data: ReportData): HTMLElement {
  return el('dl', { class: 'tiles' }, ...tiles(data).map((tile) =>
    el('div', {}, el('dt', {}, tile.name), el('dd', { class: 'value' }, tile.value), el('dd', { class: 'note' }, tile.note))));
}

// The same of several runs, a column for each.
export function drawComparison(runs: readonly ReportData[]): HTMLElement {
  const columns = runs.map(tiles);
  const names = [...new Set(columns.flatMap((column) => column.map((tile) => tile.name)))];
  return el('section', { class: 'card', id: 'comparison' }, el('div', { class: 'scroll' }, el('table', { class: 'plain' },
    el('thead', {}, el('tr', {}, el('th', { scope: 'col' }), ...runs.map((run) => el('th', { scope: 'col' }, run.name)))),
    el('tbody', {}, ...names.map((name) => el('tr', {}, el('td', {}, name), ...columns.map((column) => {
      const tile = column.find((t) => t.name === name);
      return el('td', { title: tile?.note }, tile?.value ?? '–');
    })))))), el('p', { class: 'caption' }, 'jamscope compare says with tests whether such runs differ.'));
}
