// A run at another threshold, as `jamscope analyze --set jam_force=...` would count it.
import type { Column, ReportData } from '../data';
import { countFrames, plainRule, roundVessel, type Samples } from './samples';
import { stepStreams, type Stays } from './stays';

export interface Recountable {
  samples: Samples | null;
  stays: Stays | null;
}

// Counts of frames in the bins of the curves: the most of each bin.
function binned(values: readonly number[], every: number): Column {
  const bins: Column = [];
  for (let k = 0; k < values.length; k += every) bins.push(Math.max(...values.slice(k, k + every)));
  return bins;
}

// What needs the contacts of every frame is left out: which events bridge the gap, and the clusters.
export function recounted(data: ReportData, known: Recountable, threshold: number): ReportData {
  if (!known.samples || threshold === data.criteria.jam_force) return data;
  const bounds = data.criteria.survival_classes.filter((b): b is number => b !== null);
  const about = data.samples;
  const rule = about ? { endForce: about.end_force, holdOff: about.hold_off, shortest: about.shortest } : plainRule;
  const c = countFrames(known.samples, threshold, bounds, roundVessel(data), rule);
  const steps = known.stays && data.stays ? stepStreams(known.stays, data.stays, threshold) : {};
  const jammed = c.jammed.reduce((a, b) => a + b, 0);
  const { every } = data.frames;
  return {
    ...data,
    criteria: { ...data.criteria, jam_force: threshold },
    headline: {
      ...data.headline, events: c.events.length, bridged: null, censored: c.events.filter((e) => e.open_at_start || e.open_at_end).length,
      tracks: c.tracks.length, jammed_time: c.jammedTime, jammed_share: c.observed > 0 ? c.jammedTime / c.observed : null,
      jam_frequency: c.observed > 0 ? c.events.length / c.observed : null,
      jammed_in_gap_share: data.headline.jammed_in_gap_share === null && data.run.gap.tip_radius === null ? null
        : jammed > 0 ? c.jammedInGap.reduce((a, b) => a + b, 0) / jammed : null,
      every_step: steps.global && steps.particle
        ? { events: steps.global.events, grains: steps.particle.events, median: steps.global.median.value, longest: steps.global.longest } : null,
    },
    frames: { ...data.frames, jammed: binned(c.jammed, every), jammed_in_gap: binned(c.jammedInGap, every), bridges: data.frames.bridges.map(() => null) },
    events: c.events, tracks: c.tracks, cluster_events: [], steps, survival_classes: c.classes, jammed_histogram: c.histogram,
  };
}
