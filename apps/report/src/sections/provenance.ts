// Where the numbers come from: program, run, case, materials, criteria.
import type { ReportData } from '../data';
import { el } from '../dom';
import { duration, known, scientific, setting, unknown } from '../numbers/format';

type Pair = [string, string];

function pairs(rows: readonly Pair[]): HTMLElement {
  return el('dl', { class: 'pairs' }, ...rows.filter(([, text]) => text !== '' && text !== unknown)
    .map(([name, text]) => el('div', {}, el('dt', {}, name), el('dd', {}, text))));
}

function table(header: readonly string[], rows: readonly (readonly string[])[]): HTMLElement {
  return el('div', { class: 'scroll' }, el('table', { class: 'plain words' },
    el('thead', {}, el('tr', {}, ...header.map((h) => el('th', { scope: 'col' }, h)))),
    el('tbody', {}, ...rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, cell)))))));
}

function words(argv: readonly string[]): string {
  return argv.map((a) => (/^[\w@%+=:,./-]+$/.test(a) ? a : `'${a.replace(/'/g, "'\\''")}'`)).join(' ');
}

export function drawProvenance(data: ReportData): HTMLElement {
  const { run, report, criteria } = data;
  const commit = (version: string, hash: string): string => [version, hash === '' ? '' : `(commit ${hash})`].filter(Boolean).join(' ');
  const number = (v: number | null): string => (known(v) ? setting(v, '') : unknown);
  const section = el('section', { class: 'card', id: 'provenance' }, el('h2', {}, 'Provenance'));
  const add = (title: string, ...nodes: (Node | null)[]): void => section.append(el('h3', {}, title), ...nodes.filter((n): n is Node => n !== null));

  add('Data', pairs([
    ['Written by', `${run.creator} ${commit(run.creator_version, run.commit)}`.trim()],
    ['Written (UTC)', run.created_utc],
    ['Command', words(run.argv)],
    ['Seed', run.case_toml === '' && run.seed === '0' ? '' : run.seed],
    ['Time step', setting(run.dt, 's')],
    ['Gravity', run.gravity.every(known) ? `(${run.gravity.map((g) => setting(g, '')).join(', ')}) m/s²` : ''],
    ['Sampling interval', setting(data.headline.sampling_interval, 's')],
    ['Length of the record', setting(data.headline.observed_time, 's')],
    ['Window of the series', data.series ? setting(data.series.window, 's') : 'no series in this data'],
    ['Blade tip radius', setting(run.gap.tip_radius, 'm')],
    ['Vessel radius', setting(run.gap.vessel_radius, 'm')],
    ['Case file, SHA-256', run.case_sha256],
  ]));
  add('Criteria of the analysis', pairs([
    ['Compressive force of a grain', criteria.measure],
    ['Jammed above', setting(criteria.jam_force, 'N')],
    ['Load path: contacts above', known(criteria.bridge_contact_share)
      ? `${setting(criteria.bridge_contact_share * 100, '%')} of it (${setting(criteria.bridge_contact_share * criteria.jam_force, 'N')})` : ''],
    ['Margin of the gap', known(criteria.gap_margin) ? `${setting(criteria.gap_margin, '')} grain diameters` : ''],
    ['Survival classes end at', criteria.survival_classes.filter(known).map((b) => setting(b, 's')).join(', ')],
  ]));
  if (run.materials.length > 0)
    add('Materials', table(['Material', 'Density', "Young's modulus", "Poisson's ratio"],
      run.materials.map((m) => [m.name, known(m.density) ? `${number(m.density)} kg/m³` : unknown, known(m.young) ? setting(m.young, 'Pa') : unknown, number(m.poisson)])));
  if (run.interactions.length > 0)
    add('Interactions', table(['Pair', 'Restitution', 'Friction', 'Rolling friction', 'Work of adhesion'],
      run.interactions.map((i) => [`${i.a} – ${i.b}`, number(i.restitution), number(i.friction), number(i.rolling), known(i.work_of_adhesion) ? setting(i.work_of_adhesion, 'J/m²') : unknown])));
  if (run.walls.length > 0)
    add('Walls', table(['Wall', 'Kind', 'Role', 'Material', 'Triangles'],
      run.walls.map((w) => [w.name, w.kind, w.role, w.material || unknown, w.triangles > 0 ? String(w.triangles) : unknown])));
  add('This report', pairs([
    ['Written by', `${report.program} ${commit(report.version, report.commit)}`],
    ['Written (UTC)', report.created_utc],
    ['Command', words(report.command_line)],
    ['Machine', report.machine],
    ['Computing time', duration(report.wall_seconds)],
    ['Speed', known(report.particle_steps_per_second) ? `${scientific(report.particle_steps_per_second)} particle steps per second` : ''],
  ]));
  section.append(run.case_toml === ''
    ? el('p', { class: 'caption' }, 'This data came without a case file.')
    : el('details', {}, el('summary', {}, 'Case file'), el('pre', { tabindex: 0 }, run.case_toml)));
  return section;
}
