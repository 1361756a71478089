// Forces and numbers of grains over time (paper, Fig. 5).
import type { Curve } from '../charts/spec';
import { missing } from '../charts/spec';
import { known, setting, withUnit } from '../numbers/format';
import type { ReportData } from '../data';
import type { Figure } from './figure';

export const compressiveForce: Figure = {
  id: 'grain-force',
  title: 'Compressive force on the grains',
  paper: 'Fig. 5',
  counts: true,
  caption: (data, several) => {
    const thinned = data.frames.every > 1 ? ` ${data.frames.every} frames are joined into one point: largest of the largest, mean of the means.` : '';
    const series = data.series?.largest_force.length
      ? ' Dashed: largest force in any step between the frames.'
      : ' Peaks between two frames are not seen in this data.';
    return `Largest and mean over all grains in each frame.${series} A grain above ${setting(data.criteria.jam_force, 'N')} counts as jammed.` +
      `${data.headline.events > 0 && !several ? ' Shaded: jam events.' : ''}${thinned}`;
  },
  view: (data) => {
    const { frames, series, criteria } = data;
    const curves: Curve[] = [];
    if (series && series.largest_force.some(known))
      curves.push({ label: 'largest in any step', time: series.time, values: series.largest_force, colour: 'orange', stroke: 'dashes' });
    if (frames.largest_force.some(known))
      curves.push({ label: 'largest in the frame', time: frames.time, values: frames.largest_force, colour: 'vermillion' });
    if (frames.mean_force.some(known))
      curves.push({ label: 'mean of the frame', time: frames.time, values: frames.mean_force, colour: 'blue' });
    if (curves.length === 0)
      return missing(frames.rows === 0 ? 'The record holds no frames.' : 'The compressive forces of the grains are not known from this data.');
    return {
      kind: 'time', quantity: 'Compressive force', unit: 'N', curves, log: 'first',
      threshold: { value: criteria.jam_force, label: `jam threshold ${setting(criteria.jam_force, 'N')}` },
    };
  },
};

// A run counts its grains above the force that it watched, whatever the threshold of the analysis.
const watchedForce = (data: ReportData): string => (known(data.series?.watch_force) ? setting(data.series.watch_force, 'N') : 'what the run watched');

export const jammedCount: Figure = {
  id: 'jammed-count',
  title: 'Jammed grains and bridges',
  paper: '',
  counts: true,
  caption: (data) => {
    const window = data.series?.jammed.length && known(data.series.window)
      ? ` Dashed: most grains above ${watchedForce(data)} in any step of a ${withUnit(data.series.window * data.series.every, 's')} window.`
      : '';
    return `Grains above ${setting(data.criteria.jam_force, 'N')} in each frame, and clusters that carry force from a blade to the vessel.${window}`;
  },
  view: (data) => {
    const { frames, series } = data;
    if (frames.rows === 0) return missing('The record holds no frames.');
    const curves: Curve[] = [];
    if (series && series.jammed.length > 0)
      curves.push({ label: `above ${watchedForce(data)} in any step`, time: series.time, values: series.jammed, colour: 'orange', stroke: 'dashes' });
    curves.push(
      { label: 'jammed grains', time: frames.time, values: frames.jammed, colour: 'vermillion', kind: 'steps' });
    if (frames.bridges.some(known)) curves.push({ label: 'bridges', time: frames.time, values: frames.bridges, colour: 'blue', kind: 'steps' });
    return { kind: 'time', quantity: 'Number', unit: '', curves, fromZero: true, whole: true };
  },
};

export const coordination: Figure = {
  id: 'coordination',
  title: 'Coordination number',
  paper: '',
  caption: () => 'Mean number of contacts per grain; with walls, a contact with a wall counts once for its grain.',
  view: (data) => {
    const { frames } = data;
    if (frames.rows === 0) return missing('The record holds no frames.');
    return {
      kind: 'time', quantity: 'Contacts per grain', unit: '',
      curves: [
        { label: 'with walls', time: frames.time, values: frames.coordination_with_walls, colour: 'green' },
        { label: 'grains only', time: frames.time, values: frames.coordination, colour: 'blue' },
      ],
    };
  },
};
