// Axial force and torque of the blade (paper, Figs 3 and 11).
import { withUnit } from '../numbers/format';
import { runningMedian } from '../numbers/bins';
import type { BladeData, Column, ReportData, SeriesData } from '../data';
import type { Curve, SingleView } from '../charts/spec';
import { missing } from '../charts/spec';
import type { Figure } from './figure';

const hues = ['blue', 'vermillion', 'green'] as const;

const absent = 'This data holds no record of the loads on a blade between its frames. A run of "jamscope simulate" writes one; ' +
  'dumps of other programs usually have none.';

type Load = 'force' | 'torque';

function load(blade: BladeData, which: Load): { mean: Column; low: Column; high: Column } {
  return which === 'force'
    ? { mean: blade.force_mean, low: blade.force_low, high: blade.force_high }
    : { mean: blade.torque_mean, low: blade.torque_low, high: blade.torque_high };
}

function loadedBlades(series: SeriesData | null, which: Load): BladeData[] {
  return (series?.blades ?? []).filter((blade) => load(blade, which).mean.length > 0).slice(0, hues.length);
}

function prefix(blades: readonly BladeData[], blade: BladeData): string {
  return blades.length > 1 ? `${blade.name}: ` : '';
}

function loadView(data: ReportData, which: Load, quantity: string, unit: string): SingleView {
  const series = data.series;
  const blades = loadedBlades(series, which);
  if (!series || blades.length === 0) return missing(absent);
  const curves: Curve[] = blades.flatMap((blade, k) => {
    const { mean, low, high } = load(blade, which);
    const common = { time: series.time, colour: hues[k]! };
    const edges: Curve[] = low.length > 0 && high.length > 0
      ? [
          { ...common, label: `${prefix(blades, blade)}highest in the window`, values: high, kind: 'high' },
          { ...common, label: `${prefix(blades, blade)}lowest in the window`, values: low, kind: 'low' },
        ]
      : [];
    return [...edges, { ...common, label: `${prefix(blades, blade)}mean of the window`, values: mean }];
  });
  return { kind: 'time', quantity, unit, curves };
}

function windowText(data: ReportData): string {
  const series = data.series;
  if (!series) return '';
  const window = series.window === null ? '' : ` of ${withUnit(series.window * series.every, 's')}`;
  const thinned = series.every > 1 ? ` ${series.every} recorded windows are joined into one here; their extremes are kept.` : '';
  return `Line: mean over a window${window}; band: lowest and highest value of any step in it.${thinned}`;
}

export const bladeForce: Figure = {
  id: 'blade-force',
  title: 'Axial force on the blade',
  paper: 'Fig. 3',
  caption: (data) => `z component of the force on the blade, upward positive. ${windowText(data)}`,
  view: (data) => loadView(data, 'force', 'Axial force', 'N'),
};

export const bladeTorque: Figure = {
  id: 'blade-torque',
  title: 'Torque on the blade',
  paper: 'Fig. 3',
  caption: (data) => `z component of the torque on the blade about its origin, counter-clockwise from above positive. ${windowText(data)}`,
  view: (data) => loadView(data, 'torque', 'Torque', 'N m'),
};

// The width of one reading of an instrument that exports at 25 Hz, or a tenth of a short record.
export function medianWidth(time: Column): number {
  const length = (time[time.length - 1] ?? 0) - (time[0] ?? 0);
  return Math.min(0.04, length / 10);
}

export const logForce: Figure = {
  id: 'log-force',
  title: 'Axial force on the blade, logarithmic',
  paper: 'Fig. 11',
  caption: (data) => {
    const width = data.series ? withUnit(medianWidth(data.series.time), 's', 2) : '';
    return `Magnitude of the window mean. The running median over ${width} is what remains when peaks shorter than half of it are set aside: ` +
      'jams stand out as the distance between the two.';
  },
  view: (data) => {
    const series = data.series;
    const blades = loadedBlades(series, 'force');
    if (!series || blades.length === 0) return missing(absent);
    const time = series.time.map((t) => t ?? NaN);
    const curves: Curve[] = blades.flatMap((blade, k): Curve[] => {
      const size = blade.force_mean.map((v) => (v === null ? null : Math.abs(v)));
      const median = runningMedian(time, size, medianWidth(series.time));
      return [
        { label: `${prefix(blades, blade)}|mean of the window|`, time: series.time, values: size, colour: hues[k]! },
        { label: `${prefix(blades, blade)}running median`, time: series.time, values: median, colour: k === 0 ? 'vermillion' : 'purple' },
      ];
    });
    return { kind: 'time', quantity: '|Axial force|', unit: 'N', curves, log: 'always' };
  },
};

export const flowEnergy: Figure = {
  id: 'flow-energy',
  title: 'Flow energy',
  paper: 'Fig. 4',
  caption: (data) =>
    data.flow_energy.source === 'frames'
      ? 'Work done by the blade, from its loads in the frames. A peak between two frames is not seen: read it as an estimate.'
      : 'Work done by the blade: the integral of −(F·v + T·ω) over time, from loads averaged over every step.',
  view: (data) => {
    const flow = data.flow_energy;
    if (flow.time.length === 0)
      return missing('The flow energy needs the force and the torque on the blade together with its motion; this data does not hold them.');
    return {
      kind: 'time', quantity: 'Flow energy', unit: 'J', fromZero: true,
      curves: [{ label: 'Flow energy', time: flow.time, values: flow.energy, colour: 'blue' }],
    };
  },
};

export const kineticEnergy: Figure = {
  id: 'kinetic-energy',
  title: 'Kinetic energy',
  paper: '',
  caption: () => 'Of all grains. It should follow the blade; growth without a cause is a fault of the simulation.',
  view: (data) => {
    const series = data.series;
    const curves: Curve[] = [];
    if (series && series.kinetic_energy.length > 0)
      curves.push({ label: 'Kinetic energy', time: series.time, values: series.kinetic_energy, colour: 'blue' });
    if (curves.length === 0) return missing('This data holds no record of the kinetic energy.');
    return { kind: 'time', quantity: 'Kinetic energy', unit: 'J', curves, log: 'offer', fromZero: true };
  },
};

export const overlap: Figure = {
  id: 'overlap',
  title: 'Largest overlap',
  paper: '',
  caption: () => 'Largest overlap of any contact in the window, as a share of the particle radius. Contact laws of spheres are meant for a few per cent.',
  view: (data) => {
    const series = data.series;
    if (!series || series.largest_overlap.length === 0) return missing('This data holds no record of the largest overlap.');
    const percent = series.largest_overlap.map((v) => (v === null ? null : v * 100));
    return {
      kind: 'time', quantity: 'Overlap / radius', unit: '%', log: 'offer', fromZero: true,
      curves: [{ label: 'Largest overlap', time: series.time, values: percent, colour: 'orange' }],
    };
  },
};

const ledgerHues = ['blue', 'vermillion', 'green', 'orange', 'purple', 'grey'] as const;

export const energyLedger: Figure = {
  id: 'energy-ledger',
  title: 'Energy ledger',
  paper: '',
  caption: () => 'What the walls put in, where it is, and where it went since the start of the run. What is left unexplained is rounding, or a fault of the program.',
  view: (data) => {
    const energy = data.energy;
    if (!energy) return missing('This run kept no energy ledger ([output] energy_ledger = true in the case).');
    // The places that matter: those above a thousandth of the largest, and always what is unexplained.
    const size = (values: Column): number => values.reduce<number>((a, v) => (v === null ? a : Math.max(a, Math.abs(v))), 0);
    const most = Math.max(...energy.curves.map((c) => size(c.values)));
    const shown = energy.curves.filter((c) => size(c.values) > 1e-3 * most || c.name === 'unexplained');
    return {
      kind: 'time', quantity: 'Energy', unit: 'J',
      curves: shown.map((c, k): Curve => ({
        label: c.name, time: energy.time, values: c.values, colour: ledgerHues[k % ledgerHues.length]!, stroke: k < ledgerHues.length ? undefined : 'dashes',
      })),
    };
  },
};
