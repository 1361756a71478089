// Tables of the jam events and of the stays of single grains.
import { emptyBox } from '../card';
import type { EventData, ReportData, Stay, StepJamData, TrackData } from '../data';
import { el } from '../dom';
import { bracket, columnScale, count, inScale, instant, known, plural, setting, unknown, withUnit } from '../numbers/format';
import { drawTable, type DrawnTable, type TableColumn } from '../tables';

const open = (stay: Stay): boolean => stay.open_at_start || stay.open_at_end;

function record(stay: Stay): string {
  if (stay.open_at_start && stay.open_at_end) return 'cut at both ends';
  return stay.open_at_start ? 'cut at its start' : stay.open_at_end ? 'cut at its end' : 'complete';
}

function stayColumns<Row extends Stay>(rows: readonly Row[], data: ReportData): TableColumn<Row>[] {
  const step = data.headline.sampling_interval;
  const time = columnScale(rows.map((r) => r.survival_time), 's');
  const force = columnScale(rows.map((r) => r.peak_force), 'N');
  return [
    { title: 'Start (s)', name: 'start_s', hint: 'First frame above the threshold', text: (r) => instant(r.start, step), value: (r) => r.start },
    { title: 'End (s)', name: 'end_s', hint: 'Last frame above the threshold', text: (r) => instant(r.end, step), value: (r) => r.end },
    {
      title: `Survival time (${time.unit})`, name: 'survival_time_s', hint: 'Samples times sampling interval, n D',
      text: (r) => inScale(r.survival_time, time), value: (r) => r.survival_time,
    },
    {
      title: `Bracket (${time.unit})`, name: 'shortest_s', hint: 'The true duration lies between (n − 1) D and (n + 1) D',
      text: (r) => bracket(r.shortest, r.longest, open(r), time), value: (r) => r.shortest,
    },
    { title: 'Samples', name: 'samples', hint: 'Frames above the threshold, n', text: (r) => count(r.samples), value: (r) => r.samples },
    { title: `Peak force (${force.unit})`, name: 'peak_force_N', text: (r) => inScale(r.peak_force, force), value: (r) => r.peak_force },
    { title: 'Peak at (s)', name: 'peak_time_s', text: (r) => instant(r.peak_time, step), value: (r) => r.peak_time },
  ];
}

const yes = (value: boolean): string => (value ? 'yes' : 'no');

// Without a gap nothing is in it, but nothing is outside either.
const inGap = (stay: Stay, data: ReportData): boolean | null => (known(data.run.gap.tip_radius) ? stay.peak_in_gap : null);
const yesOrUnknown = (value: boolean | null): string => (value === null ? unknown : yes(value));

function members(event: EventData): string {
  const named = event.members.join(', ');
  return event.member_count > event.members.length ? `${named}, … (${count(event.member_count)})` : named;
}

export interface Lists {
  box: HTMLElement;
  mark(event: EventData | null): void;
}

export function drawEvents(data: ReportData, show: (event: EventData) => void): Lists {
  const rows = data.events;
  const section = el('section', { class: 'card', id: 'events' }, el('h2', {}, 'Jam events'));
  if (rows.length === 0) {
    section.append(emptyBox(`No jam above ${setting(data.criteria.jam_force, 'N')} in this record.`));
    return { box: section, mark: () => {} };
  }
  const columns: TableColumn<EventData>[] = [
    { title: 'Event', name: 'event', text: (r) => String(r.number), value: (r) => r.number },
    ...stayColumns(rows, data),
    { title: 'Grain', name: 'peak_particle', hint: 'Id of the grain with the peak force', text: (r) => String(r.peak_particle), value: (r) => r.peak_particle },
    { title: 'In gap', name: 'peak_in_gap', hint: 'That grain sits in the gap', text: (r) => yesOrUnknown(inGap(r, data)), value: (r) => inGap(r, data), left: true },
    { title: 'Bridged', name: 'bridged', hint: 'A cluster carried force from blade to vessel', text: (r) => yesOrUnknown(r.bridged), value: (r) => r.bridged, left: true },
    { title: 'Members', name: 'members', hint: 'Grains jammed at some time during the event', text: (r) => count(r.member_count), value: (r) => r.member_count },
    { title: 'Ids of members', name: 'member_ids', text: members, value: members, left: true },
    { title: 'Record', name: 'record', hint: 'Whether the record holds the whole event', text: record, value: record, left: true },
  ];
  const table: DrawnTable<EventData> = drawTable({
    file: 'jam-events.csv', label: 'Jam events', columns, rows,
    open: { column: 0, hint: (r) => `Show event ${r.number} in the 3D view and in the plots`, action: show },
  });
  const all = data.headline.events;
  section.append(
    el('p', { class: 'caption' },
      'An event lasts while any grain is above the threshold. Choose one to see it in the 3D view and in the plots; choose a heading to sort.' +
      (all > rows.length ? ` The ${count(rows.length)} with the largest peak force of ${count(all)} are listed; events.csv has all.` : '')),
    table.box);
  return { box: section, mark: (event) => table.mark(event) };
}

export function drawTracks(data: ReportData, show: (track: TrackData) => void): HTMLElement {
  const rows = data.tracks;
  const section = el('section', { class: 'card', id: 'tracks' }, el('h2', {}, 'Tracks of single grains'));
  if (rows.length === 0) {
    section.append(emptyBox(`No grain was above ${setting(data.criteria.jam_force, 'N')} in this record.`));
    return section;
  }
  const path = columnScale(rows.map((r) => r.path), 'm');
  const place = columnScale(rows.flatMap((r) => [r.radius, r.height]), 'm');
  const speed = columnScale(rows.map((r) => r.mean_speed), 'm/s');
  const columns: TableColumn<TrackData>[] = [
    ...stayColumns(rows, data),
    { title: `Radius (${place.unit})`, name: 'radius_m', hint: 'Distance from the axis of the vessel at the peak', text: (r) => inScale(r.radius, place, 4), value: (r) => r.radius },
    { title: `Height (${place.unit})`, name: 'height_m', hint: 'z at the peak', text: (r) => inScale(r.height, place, 4), value: (r) => r.height },
    { title: `Path (${path.unit})`, name: 'path_m', hint: 'Distance travelled while jammed', text: (r) => inScale(r.path, path), value: (r) => r.path },
    { title: `Mean speed (${speed.unit})`, name: 'mean_speed_m_per_s', text: (r) => inScale(r.mean_speed, speed), value: (r) => r.mean_speed },
    { title: 'In gap', name: 'peak_in_gap', text: (r) => yesOrUnknown(inGap(r, data)), value: (r) => inGap(r, data), left: true },
    { title: 'Record', name: 'record', text: record, value: record, left: true },
  ];
  columns.unshift({ title: 'Grain', name: 'particle', text: (r) => String(r.particle), value: (r) => r.particle });
  const all = data.headline.tracks;
  section.append(
    el('p', { class: 'caption' },
      `A track is one grain's uninterrupted stay above the threshold: ${plural(all, 'track')}.` +
      (all > rows.length ? ` The ${count(rows.length)} with the largest peak force are listed; jam.h5 has all.` : '')),
    drawTable({
      file: 'jam-tracks.csv', label: 'Tracks of single grains', columns, rows,
      open: { column: 0, hint: (r) => `Show grain ${r.particle} at its peak in the 3D view`, action: show },
    }).box);
  return section;
}

type Stream = 'global' | 'particle' | 'site';
const streams: readonly [Stream, string][] = [['global', 'global: some grain'], ['particle', 'particle: each grain'], ['site', 'site: each sector and layer of the blade']];

// Jams as every step of the run saw them.
export function drawSteps(data: ReportData, show: (jam: StepJamData, name: string) => void): HTMLElement {
  const section = el('section', { class: 'card', id: 'steps' }, el('h2', {}, 'Jams of every step'));
  if (Object.keys(data.steps).length === 0) {
    section.append(emptyBox('Only a running simulation of jamscope watches its grains at every step; this data holds frames only.'));
    return section;
  }
  const place = el('div');
  const about = el('p', { class: 'caption' });
  const fill = (stream: Stream): void => {
    const of = data.steps[stream];
    const rows = of?.jams ?? [];
    about.textContent = `${plural(of?.events ?? 0, 'jam')}${of && known(of.rate.value) ? `, ${withUnit(of.rate.value, 'Hz')} (95 %: ${withUnit(of.rate.low, 'Hz')} to ${withUnit(of.rate.high, 'Hz')})` : ''}` +
      `${of && known(of.median.value) ? `; half end within ${withUnit(of.median.value, 's')}` : ''}. No sampling: durations are true to a step.` +
      ((of?.events ?? 0) > rows.length ? ` The ${count(rows.length)} with the largest peak force are listed; jams.csv has all.` : '');
    if (rows.length === 0) {
      place.replaceChildren(emptyBox(`No jam above ${setting(data.criteria.jam_force, 'N')} at any step.`));
      return;
    }
    const time = columnScale(rows.map((r) => r.duration), 's');
    const force = columnScale(rows.map((r) => r.peak_force), 'N');
    const impulse = columnScale(rows.map((r) => r.impulse), 'N s');
    const work = columnScale(rows.map((r) => r.work), 'J');
    const columns: TableColumn<StepJamData>[] = [
      { title: 'Grain', name: 'peak_particle', hint: 'Id of the grain with the peak force', text: (r) => String(r.peak_particle), value: (r) => r.peak_particle },
      { title: 'Start (s)', name: 'start_s', text: (r) => instant(r.start, 1e-6), value: (r) => r.start },
      { title: `Duration (${time.unit})`, name: 'duration_s', text: (r) => `${r.open_at_start || r.open_at_end ? '> ' : ''}${inScale(r.duration, time)}`, value: (r) => r.duration },
      { title: `Peak force (${force.unit})`, name: 'peak_force_N', text: (r) => inScale(r.peak_force, force), value: (r) => r.peak_force },
      { title: 'Peak at (s)', name: 'peak_time_s', text: (r) => instant(r.peak_time, 1e-6), value: (r) => r.peak_time },
      { title: `Impulse (${impulse.unit})`, name: 'impulse_Ns', text: (r) => inScale(r.impulse, impulse), value: (r) => r.impulse },
      { title: `Work (${work.unit})`, name: 'work_J', hint: 'Of walls on the jammed grains', text: (r) => inScale(r.work, work), value: (r) => r.work },
      { title: 'Sector', name: 'sector', hint: 'Of the blade, around its axis', text: (r) => String((r.site % 2) + 1), value: (r) => (r.site % 2) + 1 },
      { title: 'Layer', name: 'layer', hint: 'Of the height of the blade, from below', text: (r) => String(Math.floor(r.site / 2) + 1), value: (r) => Math.floor(r.site / 2) + 1 },
      { title: 'Members', name: 'members', text: (r) => count(r.member_count), value: (r) => r.member_count },
    ];
    place.replaceChildren(drawTable({
      file: `jams-${stream}.csv`, label: 'Jams of every step', columns, rows,
      open: { column: 0, hint: (r) => `Show grain ${r.peak_particle} at this jam in the 3D view`, action: (r) => show(r, `jam of every step, grain ${r.peak_particle}`) },
    }).box);
  };
  const list = el('select', { change: () => fill(list.value as Stream) }, ...streams.map(([value, text]) => el('option', { value }, text)));
  section.append(el('label', { class: 'choice' }, 'Stream ', list), about, place);
  fill('global');
  return section;
}
