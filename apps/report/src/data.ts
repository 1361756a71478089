// The data island that apps/jamscope/report.cpp writes (format "jamscope-report", schema 2). SI units; null is "not known".

export type Column = (number | null)[];

export interface FramesData {
  rows: number; every: number; time: Column;
  largest_force: Column; mean_force: Column; jammed: Column; jammed_in_gap: Column; bridges: Column;
  coordination: Column; coordination_with_walls: Column;
}
export interface BladeData {
  name: string;
  force_mean: Column; force_low: Column; force_high: Column;
  torque_mean: Column; torque_low: Column; torque_high: Column;
}
export interface SeriesData {
  rows: number; every: number; window: number | null; time: Column;
  watch_force: number | null; // N, `jammed` counts grains above it
  largest_force: Column; jammed: Column; kinetic_energy: Column; largest_overlap: Column;
  blades: BladeData[];
}
export interface FlowEnergyData {
  source: string; total: number | null; rows: number; every: number; time: Column; energy: Column;
}
export interface Stay {
  start: number | null; end: number | null; samples: number;
  survival_time: number | null; shortest: number | null; longest: number | null;
  open_at_start: boolean; open_at_end: boolean;
  peak_force: number | null; peak_time: number | null; peak_in_gap: boolean;
}
export interface EventData extends Stay {
  number: number; first_frame: number; last_frame: number; peak_particle: number;
  bridged: boolean | null; // null: not known at a threshold that the page counted for itself
  members: number[]; member_count: number;
}
export interface TrackData extends Stay {
  particle: number; radius: number | null; height: number | null; path: number | null; mean_speed: number | null;
}
export interface SurvivalClassData {
  low: number | null; high: number | null; events: number; frequency: number | null; share_of_jam_time: number | null;
}
export interface Headline {
  events: number; bridged: number | null; censored: number; tracks: number; frames: number; particles: number;
  observed_time: number | null; sampling_interval: number | null;
  jammed_time: number | null; jammed_share: number | null; jam_frequency: number | null;
  largest_force: number | null; largest_force_time: number | null; largest_force_source: string;
  jammed_in_gap_share: number | null;
  // Of the run's own steps, not of frames; null where the source did not watch them.
  every_step: { events: number; grains: number; median: number | null; longest: number | null } | null;
}
export interface RunData {
  creator: string; creator_version: string; commit: string; created_utc: string;
  case_toml: string; case_sha256: string; argv: string[]; seed: string; gravity: Column; dt: number | null;
  wall_loads_known: boolean;
  materials: { name: string; density: number | null; young: number | null; poisson: number | null }[];
  interactions: {
    a: string; b: string;
    restitution: number | null; friction: number | null; rolling: number | null; work_of_adhesion: number | null;
  }[];
  walls: { name: string; kind: string; role: string; material: string; triangles: number }[];
  gap: { tip_radius: number | null; vessel_radius: number | null };
}
export interface Interval { value: number | null; low: number | null; high: number | null }
export interface StepJamData {
  start: number | null; end: number | null; duration: number | null; open_at_start: boolean; open_at_end: boolean;
  peak_force: number | null; peak_time: number | null; peak_particle: number; site: number;
  impulse: number | null; work: number | null; // null at a threshold that the page counted for itself
  members: number[]; member_count: number;
}
export interface SurvivalData { time: Column; share: Column; low: Column; high: Column }
export interface StepStreamData {
  events: number; jams: StepJamData[]; rate: Interval; median: Interval;
  jammed_time: number | null; longest: number | null; fano: number | null; survival: SurvivalData;
}
export type StepStreams = Partial<Record<'global' | 'particle' | 'site', StepStreamData>>;
export interface MetricsData {
  every: number; time: Column; curves: { name: string; unit: string; doc: string; values: Column }[];
}
export interface EnergyData {
  every: number; time: Column; put_in: number | null; unexplained: number | null; curves: { name: string; values: Column }[];
}
export interface SceneWall {
  name: string; kind: string; role: string; free: string; point: Column; axis: Column; radius: number; high_radius: number; hole_radius: number;
  low: number | null; high: number | null; left_out?: string;
  section?: number; vertices?: number; triangles?: number; spheres?: number;
}
export interface SceneFrame {
  frame: number; time: number; whole: boolean; part: boolean; grains: number; contacts: number; wall_contacts: number;
  mean_force: number; least_force: number; // N: mean of the pressing contacts; those above this one are here
  poses: number[][];                       // of each wall: x y z, quaternion w x y z
  fine: boolean;                           // between the frames of the analysis, after number `frame`
  jammed: number[]; cluster: number[];     // ids by the criterion of the analysis, and the cluster of each
  bridges: boolean[];                      // of each cluster
  loaded?: [number, number][];             // of fine frames: ids and forces, N, above the floor of the samples
  section: number;
}
// The 3D view; `why` says why there is none. Layout of the sections: apps/jamscope/scene_data.hpp.
export interface SceneData {
  why: string; low?: number[]; high?: number[]; grains?: number; grains_section?: number; walls?: SceneWall[];
  frames: SceneFrame[]; all_frames?: number; part_reach?: number;
}
// Every loaded grain of every frame, for counting at other thresholds.
export interface SamplesData {
  frames: number; samples: number; floor: number; by_force: boolean; end_force: number | null; hold_off: number; shortest: number; section: number;
}
// Every stay of a grain above the force that the run watched.
export interface StaysData {
  rows: number; watch_force: number; dt: number; stride: number; first_step: number; hold_off: number; shortest: number;
  begin: number; end: number; section: number;
}
// One run.
export interface ReportData {
  name: string; description: string;
  headline: Headline;
  criteria: {
    measure: string; jam_force: number; bridge_contact_share: number | null; gap_margin: number | null;
    survival_classes: Column;
  };
  frames: FramesData; series: SeriesData | null; flow_energy: FlowEnergyData;
  events: EventData[]; tracks: TrackData[]; cluster_events: EventData[]; steps: StepStreams;
  survival_classes: SurvivalClassData[]; jammed_histogram: number[];
  metrics: MetricsData; energy: EnergyData | null;
  scene: SceneData; samples: SamplesData | null; stays: StaysData | null;
  derived: { name: string; value: string; unit: string }[];
  run: RunData; notes: string[]; warnings: string[];
  report: {
    program: string; version: string; commit: string; created_utc: string; machine: string; command_line: string[];
    wall_seconds: number | null; particle_steps_per_second: number | null;
  };
}

// Throws an Error that says what is wrong; a page that shows half of a broken record would mislead.
export function parseData(text: string): ReportData[] {
  let data: unknown;
  try {
    data = JSON.parse(text);
  } catch (error) {
    throw new Error(`the data of this page is not valid JSON: ${(error as Error).message}`);
  }
  if (typeof data !== 'object' || data === null) throw new Error('the data of this page is not an object');
  const record = data as Record<string, unknown>;
  if (record.format !== 'jamscope-report') throw new Error('the data of this page is not a jamscope report');
  if (record.schema !== 2) throw new Error(`this page reads schema 2 of its data, found ${String(record.schema)}`);
  if (!Array.isArray(record.runs) || record.runs.length === 0) throw new Error('the data of this page has no runs');
  for (const run of record.runs as Record<string, unknown>[]) {
    for (const part of ['headline', 'criteria', 'frames', 'flow_energy', 'steps', 'metrics', 'scene', 'run', 'report'])
      if (typeof run[part] !== 'object' || run[part] === null) throw new Error(`the data of this page has no "${part}"`);
    for (const part of ['events', 'tracks', 'cluster_events', 'survival_classes', 'jammed_histogram', 'derived', 'notes', 'warnings'])
      if (!Array.isArray(run[part])) throw new Error(`the data of this page has no list "${part}"`);
  }
  return record.runs as ReportData[];
}
