// How long jams last, how many grains they hold, where they sit (paper, Figs 9 and 12, Table 4).
import type { Bar, BarPlot, View } from '../charts/spec';
import { missing } from '../charts/spec';
import { edgeText, position } from '../charts/bar_plot';
import type { Column, ReportData, SurvivalClassData } from '../data';
import { histogram } from '../numbers/bins';
import { count, known, percent, plural, scaleFor, setting, significant, withUnit } from '../numbers/format';
import { garwood } from '../numbers/poisson';
import type { Figure } from './figure';

const noJam = (data: ReportData): string =>
  `No grain was above ${setting(data.criteria.jam_force, 'N')} in any frame of this record.`;

export function className(c: SurvivalClassData, unit: { factor: number }): string {
  const low = String(Number(((c.low ?? 0) / unit.factor).toPrecision(6)));
  return known(c.high) ? `${low}–${Number((c.high / unit.factor).toPrecision(6))}` : `≥ ${low}`;
}

function classScale(data: ReportData): { factor: number; unit: string } {
  const bound = data.survival_classes.map((c) => c.high).find(known);
  return bound === undefined ? { factor: 1e-3, unit: 'ms' } : scaleFor(bound, 's');
}

export const survivalFrequency: Figure = {
  id: 'survival-frequency',
  title: 'Frequency by survival time',
  paper: 'Fig. 9',
  caption: () => 'Jam events per second of record, by survival time. Whiskers: exact 95 % interval of Garwood for the count in each class, ' +
    'valid if events are independent.',
  view: (data) => {
    if (data.headline.events === 0) return missing(noJam(data));
    const scale = classScale(data);
    const time = data.headline.observed_time ?? NaN;
    const bars = data.survival_classes.map((c): Bar => {
      const rate = garwood(c.events, time);
      const name = `${className(c, scale)} ${scale.unit}`;
      return {
        label: className(c, scale),
        value: c.frequency ?? 0,
        text: count(c.events),
        hover: `${name}: ${plural(c.events, 'event')}, ${withUnit(c.frequency, 'Hz')}` +
          (rate ? `, 95 % interval ${significant(rate.low)} to ${withUnit(rate.high, 'Hz')}` : ''),
        low: rate?.low,
        high: rate?.high,
      };
    });
    return { kind: 'bars', quantity: 'Frequency', unit: 'Hz', across: `Survival time (${scale.unit}); number of events above each bar`, bars, colour: 'blue' };
  },
};

export const survivalShare: Figure = {
  id: 'survival-share',
  title: 'Share of the jam time by survival time',
  paper: 'Table 4',
  caption: () => 'Which jams make up the time that something is jammed.',
  view: (data): View => {
    if (data.headline.events === 0) return missing(noJam(data));
    const scale = classScale(data);
    const time = data.headline.observed_time ?? NaN;
    const total = data.survival_classes.reduce((sum, c) => sum + c.events, 0);
    const all = garwood(total, time);
    const range = (low: number, high: number): string => `${significant(low)} … ${significant(high)}`;
    const rows = data.survival_classes.map((c) => {
      const rate = garwood(c.events, time);
      return [className(c, scale), count(c.events), known(c.frequency) ? significant(c.frequency) : '–',
        rate ? range(rate.low, rate.high) : '–', percent(c.share_of_jam_time)];
    });
    rows.push(['all', count(total), all ? significant(all.rate) : '–', all ? range(all.low, all.high) : '–',
      percent(data.survival_classes.reduce((sum, c) => sum + (c.share_of_jam_time ?? 0), 0))]);
    return { kind: 'table', header: [`Survival time (${scale.unit})`, 'Events', 'Frequency (Hz)', '95 % interval (Hz)', 'Share of jam time'], rows };
  },
};

export const jammedHistogram: Figure = {
  id: 'jammed-histogram',
  title: 'Number of grains jammed at once',
  paper: 'Fig. 12',
  caption: (data) => {
    const none = data.jammed_histogram[0] ?? 0;
    const all = data.jammed_histogram.reduce((a, b) => a + b, 0);
    return `Frames by the number of grains above ${setting(data.criteria.jam_force, 'N')}` +
      (all > 0 ? `; ${count(none)} of ${count(all)} frames (${percent(none / all)}) have none and are left out.` : '.');
  },
  view: (data) => {
    const all = data.jammed_histogram;
    const counts = all.slice(0, all.findLastIndex((n) => n > 0) + 1);
    const jammed = counts.slice(1).reduce((a, b) => a + b, 0);
    if (jammed === 0) return missing(all.length === 0 ? 'The record holds no frames.' : noJam(data));
    // A long tail ends in one bar for "k or more".
    const shown = Math.min(counts.length - 1, 20);
    const bars: Bar[] = [];
    for (let n = 1; n <= shown; ++n) {
      const rest = n === shown && counts.length - 1 > shown;
      const frames = rest ? counts.slice(n).reduce((a, b) => a + b, 0) : counts[n]!;
      bars.push({
        label: rest ? `≥${n}` : String(n), value: frames, text: count(frames),
        hover: `${rest ? `${n} or more grains` : plural(n, 'grain')}: ${plural(frames, 'frame')}, ${percent(frames / jammed)} of the jammed frames`,
      });
    }
    return { kind: 'bars', quantity: 'Frames', unit: '', across: 'Grains jammed at once', bars, colour: 'vermillion' };
  },
};

function binned(values: Column, unit: string, quantity: string, what: string, marks: { value: number | null; label: string }[]): BarPlot | null {
  const bins = histogram([...values, ...(values.some(known) ? marks.map((m) => m.value) : [])]);
  const first = bins[0];
  if (!first || !values.some(known)) return null;
  const width = first.high - first.low;
  for (const bin of bins) bin.count = 0;
  for (const v of values)
    if (known(v)) bins[Math.min(Math.max(Math.floor((v - first.low) / width + 1e-9), 0), bins.length - 1)]!.count += 1;
  const scale = scaleFor(bins[bins.length - 1]!.high, unit);
  return {
    kind: 'bars', quantity: 'Tracks', unit: '', across: `${quantity} (${scale.unit})`, colour: 'green', edges: true,
    bars: bins.map((b) => ({
      label: edgeText(b.low, scale.factor), value: b.count, text: b.count > 0 ? count(b.count) : '',
      hover: `${edgeText(b.low, scale.factor)} to ${edgeText(b.high, scale.factor)} ${scale.unit}: ${plural(b.count, what)}`,
    })),
    marks: marks.filter((m) => known(m.value)).map((m) => ({ at: position(m.value!, first.low, width), label: m.label })),
  };
}

export const radialPosition: Figure = {
  id: 'radial-position',
  title: 'Where grains jammed',
  paper: '',
  caption: () => 'Distance of the centre of each jammed grain from the axis of the vessel when its force was largest. ' +
    'A grain in the gap has its centre near or beyond the blade tip.',
  view: (data) => {
    if (data.tracks.length === 0) return missing(noJam(data));
    const { tip_radius, vessel_radius } = data.run.gap;
    return binned(data.tracks.map((t) => t.radius), 'm', 'Distance from the axis', 'track',
      [{ value: tip_radius, label: 'blade tip' }, { value: vessel_radius, label: 'vessel wall' }])
      ?? missing('The vessel of this data is not a cylinder, so distances from its axis are not defined.');
  },
};

export const jammedSpeed: Figure = {
  id: 'jammed-speed',
  title: 'Speed of jammed grains',
  paper: '',
  caption: () => 'Mean speed of each grain while it was jammed: grains held by the wall stay near zero, grains pushed by the blade move with it.',
  view: (data) => {
    if (data.tracks.length === 0) return missing(noJam(data));
    return binned(data.tracks.map((t) => t.mean_speed), 'm/s', 'Mean speed', 'track', []) ?? missing('Velocities are not known from this data.');
  },
};
