// How long jams last, how many grains they hold, where they sit (paper, Figs 9 and 12, Table 4).
import type { Bar, BarPlot, Colour, Curve, SingleView } from '../charts/spec';
import { missing } from '../charts/spec';
import { edgeText, position } from '../charts/bar_plot';
import type { Column, ReportData, StepStreams, SurvivalClassData, SurvivalData } from '../data';
import { histogram } from '../numbers/bins';
import { count, known, percent, plural, scaleFor, setting, significant, withUnit } from '../numbers/format';
import { garwood } from '../numbers/poisson';
import { kaplanMeier } from '../recount/survival';
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
  counts: true,
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
  counts: true,
  caption: () => 'Which jams make up the time that something is jammed.',
  view: (data): SingleView => {
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
  counts: true,
  caption: (data, several) => {
    const none = data.jammed_histogram[0] ?? 0;
    const all = data.jammed_histogram.reduce((a, b) => a + b, 0);
    return `Frames by the number of grains above ${setting(data.criteria.jam_force, 'N')}` +
      (all > 0 && !several ? `; ${count(none)} of ${count(all)} frames (${percent(none / all)}) have none and are left out.` : '.');
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

const hue: Record<keyof StepStreams, Colour> = { global: 'blue', particle: 'vermillion', site: 'green' };

// Durations as frames see them, n D; those that the record cuts off as such.
function ofFrames(data: ReportData): SurvivalData {
  return kaplanMeier(data.events.filter((e) => !e.open_at_start && known(e.survival_time)).map((e) => ({ time: e.survival_time!, ended: !e.open_at_end })));
}

export const survivalCurve: Figure = {
  id: 'survival-curve',
  title: 'Survival of jams',
  paper: '',
  counts: true,
  caption: (data) => (Object.keys(data.steps).length > 0 ? 'Of every step of the run, by stream: global, some grain is jammed; particle, each grain by itself; site, each sector and layer of the blade. '
    : 'As frames see them: the run did not watch every step. ') +
    'Kaplan and Meier\'s estimate; bands: pointwise 95 %. Jams that the end of the record cuts off count as censored.',
  view: (data) => {
    const curves: Curve[] = [];
    const add = (label: string, s: SurvivalData, colour: Colour): void => {
      if (s.time.length === 0) return;
      const time = [s.time[0]! * 0.5, ...s.time]; // begins at 1, before the first end
      const common = { time, colour };
      curves.push(
        { ...common, label: `${label}, band to`, values: [null, ...s.high], kind: 'high' }, { ...common, label: `${label}, band from`, values: [null, ...s.low], kind: 'low' },
        { ...common, label, values: [1, ...s.share], kind: 'steps' });
    };
    for (const name of ['global', 'particle', 'site'] as const) {
      const stream = data.steps[name];
      if (stream) add(name, stream.survival, hue[name]);
    }
    if (Object.keys(data.steps).length === 0) add('events of frames', ofFrames(data), 'blue');
    if (curves.length === 0) return missing('No jam ended in this record, so nothing is known of how long they last.');
    return { kind: 'time', quantity: 'Share that lasts longer', unit: '', curves, fromZero: true, log: 'offer', across: { quantity: 'Duration', unit: 's', log: 'first' } };
  },
};

// Separate stretches of a series above a threshold.
export function stretchesAbove(values: Column, threshold: number): number {
  let found = 0;
  let above = false;
  for (const v of values) {
    const now = known(v) && v > threshold;
    if (now && !above) ++found;
    above = now;
  }
  return found;
}

export const jamsAbove: Figure = {
  id: 'jams-above',
  title: 'Jams above every threshold',
  paper: '',
  caption: () => 'Separate stretches of the largest force above each threshold. Where the curve is flat, the number of jams does not depend on the choice of the threshold.',
  view: (data) => {
    const sources: [string, Column, Colour][] = [['frames', data.frames.largest_force, 'blue']];
    if (data.series?.largest_force.some(known)) sources.push(['windows of steps', data.series.largest_force, 'vermillion']);
    const curves = sources.flatMap(([label, values, colour]): Curve[] => {
      const most = values.reduce<number>((a, v) => (known(v) ? Math.max(a, v) : a), 0);
      if (!(most > 0)) return [];
      const time = Array.from({ length: 81 }, (_, k) => most * 10 ** ((k - 80) / 20));
      return [{ label, time, values: time.map((t) => stretchesAbove(values, t)), colour, kind: 'steps' }];
    });
    if (curves.length === 0) return missing('The compressive forces of the grains are not known from this data.');
    return { kind: 'time', quantity: 'Jams', unit: '', curves, fromZero: true, whole: true, log: 'offer', across: { quantity: 'Threshold', unit: 'N', log: 'first' } };
  },
};

export const radialPosition: Figure = {
  id: 'radial-position',
  title: 'Where grains jammed',
  paper: '',
  counts: true,
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
  counts: true,
  caption: () => 'Mean speed of each grain while it was jammed: grains held by the wall stay near zero, grains pushed by the blade move with it.',
  view: (data) => {
    if (data.tracks.length === 0) return missing(noJam(data));
    return binned(data.tracks.map((t) => t.mean_speed), 'm/s', 'Mean speed', 'track', []) ?? missing('Velocities are not known from this data.');
  },
};
