// The case in its derived numbers, and whether the run can be trusted.
import type { ReportData } from '../data';
import { el } from '../dom';
import { duration, known, percent, scientific, setting, significant, unknown, withUnit } from '../numbers/format';

type Pair = [string, string];

// What a reader checks before believing a run.
export function health(data: ReportData): Pair[] {
  const { energy, series, report, run } = data;
  const overlap = series ? series.largest_overlap.reduce<number | null>((a, v) => (known(v) ? Math.max(a ?? 0, v) : a), null) : null;
  const steps = known(run.dt) && known(data.headline.observed_time) ? data.headline.observed_time / run.dt : null;
  return [
    ['Energy put in by walls', energy ? withUnit(energy.put_in, 'J') : 'no ledger was kept'],
    ['Energy unexplained', energy && known(energy.unexplained) && known(energy.put_in) && energy.put_in > 0
      ? `${withUnit(energy.unexplained, 'J')}, ${significant(Math.abs(energy.unexplained / energy.put_in), 2)} of what was put in` : unknown],
    ['Largest overlap', known(overlap) ? `${percent(overlap)} of a radius` : unknown],
    ['Time step', setting(run.dt, 's')],
    ['Steps in the record', known(steps) ? scientific(steps) : unknown],
    ['Speed', known(report.particle_steps_per_second) ? `${scientific(report.particle_steps_per_second)} grain steps a second` : unknown],
    // Without a speed the program only analysed: its time says nothing of the run.
    ['Computing time', known(report.particle_steps_per_second) ? duration(report.wall_seconds) : unknown],
  ];
}

function pairs(rows: readonly Pair[]): HTMLElement {
  return el('dl', { class: 'pairs narrow' }, ...rows.filter(([, text]) => text !== unknown && text !== '')
    .map(([name, text]) => el('div', {}, el('dt', {}, name), el('dd', {}, text))));
}

export function drawOverview(data: ReportData): HTMLElement {
  const derived = data.derived.map((d): Pair => [d.name, `${d.value} ${d.unit}`.trim()]);
  return el('div', { class: 'cards', id: 'overview' },
    el('section', { class: 'card' }, el('h2', {}, 'Health of the run'), pairs(health(data))),
    el('section', { class: 'card' }, el('h2', {}, 'What follows from the case'),
      derived.length > 0 ? el('div', { class: 'scroll short', tabindex: 0, role: 'region', 'aria-label': 'Derived numbers' }, pairs(derived))
        : el('p', { class: 'caption' }, 'This data came without a case file.')));
}
