// The loaded grains of every frame, and the jams that follow from them at a threshold: the rules of libjam/events/streams.cpp, libjam/statistics/survival.cpp.
import { Arrays, fromLogCode } from '../island/sections';
import type { EventData, ReportData, SamplesData, Stay, SurvivalClassData, TrackData } from '../data';

export interface Samples {
  time: Float64Array;   // [F] s
  start: Uint32Array;   // [F + 1] first sample of each frame
  particle: Uint32Array;
  force: Float64Array;  // N
  x: Float64Array; y: Float64Array; z: Float64Array; // m
  speed: Float64Array;  // m/s, NaN where not known
  inGap: Uint8Array;
  floor: number;        // N, every grain above it is here
}

export function decodeSamples(bytes: ArrayBuffer, about: SamplesData, low: readonly number[], high: readonly number[]): Samples {
  const arrays = new Arrays(bytes);
  const n = about.samples;
  const time = arrays.float64(about.frames);
  const count = arrays.uint32(about.frames);
  const particle = arrays.uint32(n);
  const force = arrays.float64(n);
  const axis = (k: number): Float64Array => Float64Array.from(arrays.uint16(n), (code) => low[k]! + (code / 65535) * (high[k]! - low[k]!));
  const [x, y, z] = [axis(0), axis(1), axis(2)];
  const speed = Float64Array.from(arrays.uint16(n), fromLogCode);
  const inGap = arrays.bytes8(n);
  arrays.finish();
  const start = new Uint32Array(about.frames + 1);
  count.forEach((c, k) => { start[k + 1] = start[k]! + c; });
  return { time, start, particle, force, x, y, z, speed, inGap, floor: about.floor };
}

// Ids of the grains above the threshold in a frame.
export function jammedIn(samples: Samples, frame: number, threshold: number): Set<number> {
  const found = new Set<number>();
  for (let s = samples.start[frame] ?? 0; s < (samples.start[frame + 1] ?? 0); ++s)
    if (samples.force[s]! > threshold) found.add(samples.particle[s]!);
  return found;
}

export function samplingInterval(time: ArrayLike<number>): number {
  const distances = Array.from({ length: Math.max(time.length - 1, 0) }, (_, k) => time[k + 1]! - time[k]!).sort((a, b) => a - b);
  const n = distances.length;
  if (n === 0) return 0;
  return n % 2 === 1 ? distances[(n - 1) / 2]! : (distances[n / 2 - 1]! + distances[n / 2]!) / 2;
}

interface OpenStay {
  first: number; last: number; members: Set<number>;
  peak: number; peakFrame: number; peakParticle: number; inGap: boolean;
}

function begin(frame: number): OpenStay {
  return { first: frame, last: frame, members: new Set(), peak: 0, peakFrame: frame, peakParticle: 0, inGap: false };
}

function extend(stay: OpenStay, samples: Samples, frame: number, s: number, jams: boolean): void {
  stay.last = frame;
  if (jams) stay.members.add(samples.particle[s]!);
  if (samples.force[s]! > stay.peak) {
    stay.peak = samples.force[s]!;
    stay.peakFrame = frame;
    stay.peakParticle = samples.particle[s]!;
    stay.inGap = samples.inGap[s] === 1;
  }
}

export interface FrameCounts {
  interval: number; observed: number;
  events: EventData[]; tracks: TrackData[];
  classes: SurvivalClassData[]; histogram: number[];
  jammed: number[]; jammedInGap: number[]; // [F]
  jammedTime: number;
}

// The rest of the rule: an event goes on while a force is above `endForce`, over pauses up to `holdOff`, and counts from `shortest` on.
export interface Rule { endForce: number | null; holdOff: number; shortest: number }
export const plainRule: Rule = { endForce: null, holdOff: 0, shortest: 0 };

// `bounds`: upper ones of the survival classes, s; `axis`: a point and a direction of the vessel's axis, where it is round.
export function countFrames(
  samples: Samples, threshold: number, bounds: readonly number[], vessel: { x: number; y: number } | null, rule: Rule = plainRule,
): FrameCounts {
  const { time, start, force, particle } = samples;
  const endForce = Math.min(rule.endForce ?? threshold, threshold);
  const frames = time.length;
  const interval = samplingInterval(time);
  const gapBefore = (k: number): boolean => time[k]! - time[k - 1]! > 1.5 * interval;
  const goesOn = (last: number, k: number): boolean => {
    if ((k - last - 1) * interval > rule.holdOff * (1 + 1e-9)) return false;
    for (let next = last + 1; next <= k; ++next) if (gapBefore(next)) return false;
    return true;
  };
  const counts = (stay: OpenStay): boolean => stay.members.size > 0 && (stay.last - stay.first + 1) * interval >= rule.shortest * (1 - 1e-9);
  const closed = (stay: OpenStay): Stay => {
    const openAtStart = stay.first === 0 || gapBefore(stay.first);
    const openAtEnd = stay.last + 1 === frames || gapBefore(stay.last + 1);
    const n = stay.last - stay.first + 1;
    return {
      start: time[stay.first]!, end: time[stay.last]!, samples: n, survival_time: n * interval, shortest: (n - 1) * interval,
      longest: openAtStart || openAtEnd ? null : (n + 1) * interval, open_at_start: openAtStart, open_at_end: openAtEnd,
      peak_force: stay.peak, peak_time: time[stay.peakFrame]!, peak_in_gap: stay.inGap,
    };
  };
  const globals: OpenStay[] = [];
  const tracks: { stay: OpenStay; rows: number[] }[] = [];
  const jammed: number[] = [];
  const jammedInGap: number[] = [];
  const histogram: number[] = [0];
  let open: OpenStay | null = null;
  const latest = new Map<number, { stay: OpenStay; rows: number[] }>(); // of each grain its last track
  for (let k = 0; k < frames; ++k) {
    let count = 0;
    let inGap = 0;
    for (let s = start[k]!; s < start[k + 1]!; ++s) {
      if (!(force[s]! > endForce)) continue;
      const jams = force[s]! > threshold;
      if (jams) {
        ++count;
        inGap += samples.inGap[s]!;
      }
      if (!open || !goesOn(open.last, k)) {
        open = begin(k);
        globals.push(open);
      }
      extend(open, samples, k, s, jams);
      let track = latest.get(particle[s]!);
      if (!track || !goesOn(track.stay.last, k)) {
        track = { stay: begin(k), rows: [] };
        tracks.push(track);
        latest.set(particle[s]!, track);
      }
      extend(track.stay, samples, k, s, jams);
      track.rows.push(s);
    }
    jammed.push(count);
    jammedInGap.push(inGap);
    while (histogram.length <= count) histogram.push(0);
    histogram[count]! += 1;
  }
  const events = globals.filter(counts).map((stay, k): EventData => ({
    ...closed(stay), number: k + 1, first_frame: stay.first, last_frame: stay.last, peak_particle: stay.peakParticle, bridged: null,
    members: [...stay.members].sort((a, b) => a - b).slice(0, 20), member_count: stay.members.size,
  }));
  const observed = frames * interval;
  const jammedTime = events.reduce((sum, e) => sum + e.survival_time!, 0);
  const classes = [...bounds, Infinity].map((high, k): SurvivalClassData => {
    const low = k > 0 ? bounds[k - 1]! : 0;
    const held = events.filter((e) => {
      const t = e.survival_time! + 1e-3 * interval;
      return t >= low && t < high;
    });
    return {
      low, high: Number.isFinite(high) ? high : null, events: held.length, frequency: observed > 0 ? held.length / observed : 0,
      share_of_jam_time: jammedTime > 0 ? held.reduce((sum, e) => sum + e.survival_time!, 0) / jammedTime : 0,
    };
  });
  return {
    interval, observed, events, classes, histogram, jammed, jammedInGap, jammedTime,
    tracks: tracks.filter((track) => counts(track.stay)).map(({ stay, rows }): TrackData => {
      let path = 0;
      for (let r = 1; r < rows.length; ++r) {
        const [a, b] = [rows[r - 1]!, rows[r]!];
        path += Math.hypot(samples.x[b]! - samples.x[a]!, samples.y[b]! - samples.y[a]!, samples.z[b]! - samples.z[a]!);
      }
      const speeds = rows.map((s) => samples.speed[s]!).filter(Number.isFinite);
      const peak = rows.find((s) => samples.force[s] === stay.peak)!;
      return {
        ...closed(stay), particle: stay.peakParticle, path,
        radius: vessel ? Math.hypot(samples.x[peak]! - vessel.x, samples.y[peak]! - vessel.y) : null, height: samples.z[peak]!,
        mean_speed: speeds.length > 0 ? speeds.reduce((a, b) => a + b, 0) / speeds.length : null,
      };
    }),
  };
}

// The vessel from whose axis radii are measured, where it is an upright cylinder.
export function roundVessel(data: ReportData): { x: number; y: number } | null {
  const wall = (data.scene.walls ?? []).find((w) => w.role === 'vessel' && w.kind === 'cylinder');
  if (!wall || Math.abs(wall.axis[2] ?? 0) < 0.999) return null;
  return { x: wall.point[0] ?? 0, y: wall.point[1] ?? 0 };
}
