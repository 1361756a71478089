// Small records with the shape of those of apps/jamscope/report.cpp.
import type { EventData, ReportData, StepJamData, StepStreamData, TrackData } from '../src/data';
import { kaplanMeier } from '../src/recount/survival';

const stay = (start: number, samples: number, force: number): Omit<EventData, 'number' | 'first_frame' | 'last_frame' | 'peak_particle' | 'bridged' | 'members' | 'member_count'> => ({
  start, end: start + (samples - 1) * 0.002, samples,
  survival_time: samples * 0.002, shortest: (samples - 1) * 0.002, longest: (samples + 1) * 0.002,
  open_at_start: false, open_at_end: false, peak_force: force, peak_time: start, peak_in_gap: true,
});

function stepJam(particle: number, start: number, duration: number, force: number): StepJamData {
  return {
    start, end: start + duration, duration, open_at_start: false, open_at_end: false, peak_force: force, peak_time: start, peak_particle: particle, site: 0,
    impulse: force * duration, work: 1e-4, members: [particle], member_count: 1,
  };
}
function stream(jams: StepJamData[]): StepStreamData {
  return {
    events: jams.length, jams, rate: { value: 250, low: 50, high: 700 }, median: { value: 0.001, low: null, high: null }, jammed_time: 0.005, longest: 0.004, fano: 1,
    survival: kaplanMeier(jams.map((j) => ({ time: j.duration!, ended: true }))),
  };
}

export function jammed(): ReportData {
  const time = [0, 0.002, 0.004, 0.006, 0.008, 0.01];
  const event = (number: number, start: number, samples: number, force: number): EventData => ({
    ...stay(start, samples, force), number, first_frame: 0, last_frame: 0, peak_particle: 40 + number, bridged: true, members: [40 + number], member_count: 1,
  });
  const track = (particle: number, start: number, samples: number, force: number): TrackData => ({
    ...stay(start, samples, force), particle, radius: 0.0121, height: 0.02, path: 1e-4, mean_speed: 0.1,
  });
  return {
    name: 'two jams', description: '',
    headline: {
      events: 2, bridged: 2, censored: 0, tracks: 2, frames: 6, particles: 50, observed_time: 0.012, sampling_interval: 0.002,
      jammed_time: 0.006, jammed_share: 0.5, jam_frequency: 2 / 0.012, largest_force: 130, largest_force_time: 0.0075,
      largest_force_source: 'series', jammed_in_gap_share: 1,
      every_step: { events: 3, grains: 5, median: 0.0021, longest: 0.004 },
    },
    criteria: { measure: 'sum of the repulsive normal forces', jam_force: 20, bridge_contact_share: 0.1, gap_margin: 0.5, survival_classes: [0.01, 0.02] },
    frames: {
      rows: 6, every: 1, time, largest_force: [1, 30, 40, 1, 120, 1], mean_force: [0.1, 0.2, 0.2, 0.1, 0.2, 0.1],
      jammed: [0, 1, 2, 0, 1, 0], jammed_in_gap: [0, 1, 2, 0, 1, 0], bridges: [0, 1, 1, 0, 1, 0],
      coordination: [4, 4, 4, 4, 4, 4], coordination_with_walls: [4.2, 4.2, 4.2, 4.2, 4.2, 4.2],
    },
    series: {
      rows: 3, every: 1, window: 0.004, watch_force: 20, time: [0.004, 0.008, 0.012], largest_force: [45, 130, 2], jammed: [2, 2, 0],
      kinetic_energy: [1e-5, 1e-5, 1e-5], largest_overlap: [0.01, 0.02, 0.001],
      blades: [{ name: 'blade', force_mean: [1, 5, 2], force_low: [0, 1, 1], force_high: [3, 40, 3], torque_mean: [0.1, 0.2, 0.1], torque_low: [0, 0, 0], torque_high: [0.2, 2, 0.2] }],
    },
    flow_energy: { source: 'series', total: 0.3, rows: 3, every: 1, time: [0.004, 0.008, 0.012], energy: [0.1, 0.2, 0.3] },
    events: [event(1, 0.002, 2, 40), event(2, 0.008, 1, 120)],
    tracks: [track(41, 0.002, 2, 40), track(42, 0.008, 1, 120)],
    survival_classes: [
      { low: 0, high: 0.01, events: 2, frequency: 2 / 0.012, share_of_jam_time: 1 },
      { low: 0.01, high: 0.02, events: 0, frequency: 0, share_of_jam_time: 0 },
      { low: 0.02, high: null, events: 0, frequency: 0, share_of_jam_time: 0 },
    ],
    cluster_events: [event(1, 0.002, 2, 40)],
    steps: {
      global: stream([stepJam(41, 0.0021, 0.004, 45), stepJam(42, 0.0075, 0.001, 130), stepJam(42, 0.0112, 0.0002, 25)]),
      particle: stream([stepJam(41, 0.0021, 0.004, 45)]), site: stream([]),
    },
    metrics: { every: 1, time, curves: [{ name: 'coordination', unit: '1', doc: 'contacts per grain', values: [4, 4, 4, 4, 4, 4] }] },
    energy: {
      every: 1, time: [0.004, 0.008, 0.012], put_in: 0.3, unexplained: 1e-9,
      curves: [{ name: 'work of blade', values: [0.1, 0.2, 0.3] }, { name: 'sliding', values: [0.08, 0.1, 0.2] }, { name: 'rolling springs', values: [1e-9, 1e-9, 1e-9] }, { name: 'unexplained', values: [0, 0, 1e-9] }],
    },
    scene: { why: 'The snapshots were not at hand.', frames: [] }, samples: null, stays: null,
    jammed_histogram: [3, 2, 1, 0], derived: [],
    run: {
      creator: 'jamscope', creator_version: '0.1.0', commit: '', created_utc: '', case_toml: '', case_sha256: '', argv: [], seed: '1',
      gravity: [0, 0, -9.81], dt: 5e-8, wall_loads_known: true, materials: [], interactions: [], walls: [],
      gap: { tip_radius: 0.01175, vessel_radius: 0.0125 },
    },
    notes: [], warnings: [],
    report: { program: 'jamscope', version: '0.1.0', commit: '', created_utc: '', machine: '', command_line: [], wall_seconds: null, particle_steps_per_second: null },
  };
}

// No grain above the threshold.
export function quiet(): ReportData {
  const d = jammed();
  const none = { low: 0, high: 0.01, events: 0, frequency: 0, share_of_jam_time: 0 };
  return {
    ...d, events: [], tracks: [], cluster_events: [], steps: { global: stream([]), particle: stream([]), site: stream([]) }, jammed_histogram: [6], survival_classes: [none, { ...none, low: 0.01, high: null }],
    headline: { ...d.headline, events: 0, bridged: 0, tracks: 0, jammed_time: 0, jammed_share: 0, jam_frequency: 0, jammed_in_gap_share: null, observed_time: 2 },
  };
}

// Frames without forces, no series, no loads: what a poor dump of another program comes down to.
export function bare(): ReportData {
  const d = quiet();
  const nothing = d.frames.time.map(() => null);
  return {
    ...d, series: null, energy: null, steps: {}, metrics: { every: 1, time: [], curves: [] }, flow_energy: { source: 'none', total: null, rows: 0, every: 1, time: [], energy: [] },
    frames: { ...d.frames, largest_force: nothing, mean_force: nothing },
    headline: { ...d.headline, largest_force: null, largest_force_time: null, largest_force_source: 'frames', every_step: null },
  };
}
