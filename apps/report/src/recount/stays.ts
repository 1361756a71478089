// Jams of every step at a threshold, from the stays of single grains: the rules of libjam/events/every_step.cpp.
import { Arrays } from '../island/sections';
import type { StaysData, StepJamData, StepStreamData, StepStreams } from '../data';
import { garwood } from '../numbers/poisson';
import { kaplanMeier, whenLeft } from './survival';

export interface Stays {
  particle: Uint32Array; first: Float64Array; last: Float64Array; peakStep: Float64Array; force: Float32Array; site: Uint8Array; open: Uint8Array;
}

export function decodeStays(bytes: ArrayBuffer, about: StaysData): Stays {
  const arrays = new Arrays(bytes);
  const n = about.rows;
  const stays = {
    particle: arrays.uint32(n), first: arrays.float64(n), last: arrays.float64(n), peakStep: arrays.float64(n), force: arrays.float32(n),
    site: arrays.bytes8(n), open: arrays.bytes8(n),
  };
  arrays.finish();
  return stays;
}

export type Stream = 'global' | 'particle' | 'site';

interface Open {
  first: number; last: number; openAtStart: boolean; openAtEnd: boolean; peak: number; peakStep: number; peakParticle: number; site: number; members: Set<number>;
}

export function stepJams(stays: Stays, about: StaysData, stream: Stream, threshold: number): StepJamData[] {
  const { dt, stride } = about;
  const pause = about.hold_off * (1 + 1e-9);
  const jams: { jam: StepJamData; least: number }[] = [];
  const close = (o: Open): void => {
    const duration = (o.last - o.first + stride) * dt;
    if (!(o.peak > threshold) || duration < about.shortest * (1 - 1e-9)) return;
    const members = [...o.members].sort((a, b) => a - b);
    jams.push({
      least: members[0]!,
      jam: {
        start: o.first * dt, end: o.last * dt, duration, open_at_start: o.openAtStart, open_at_end: o.openAtEnd,
        peak_force: o.peak, peak_time: o.peakStep * dt, peak_particle: o.peakParticle, site: o.site, impulse: null, work: null,
        members: members.slice(0, 20), member_count: members.length,
      },
    });
  };
  const all = new Map<number, Open>();
  for (let k = 0; k < stays.particle.length; ++k) {
    const key = stream === 'global' ? 0 : stream === 'particle' ? stays.particle[k]! : stays.site[k]!;
    const first = stays.first[k]!;
    const last = stays.last[k]!;
    const isOpen = stays.open[k] !== 0;
    let now = all.get(key);
    const goesOn = now !== undefined && (first <= now.last + stride || (first - now.last - stride) * dt <= pause);
    if (!now || !goesOn) {
      if (now) close(now);
      now = { first, last, openAtStart: first <= about.first_step, openAtEnd: isOpen, peak: 0, peakStep: 0, peakParticle: 0, site: 0, members: new Set() };
      all.set(key, now);
    } else if (last > now.last) {
      now.openAtEnd = isOpen;
    } else if (last === now.last) {
      now.openAtEnd = now.openAtEnd || isOpen;
    }
    now.last = Math.max(now.last, last);
    now.members.add(stays.particle[k]!);
    if (stays.force[k]! > now.peak) {
      now.peak = stays.force[k]!;
      now.peakStep = stays.peakStep[k]!;
      now.peakParticle = stays.particle[k]!;
      now.site = stays.site[k]!;
    }
  }
  for (const open of all.values()) close(open);
  return jams.sort((a, b) => a.jam.start! - b.jam.start! || a.least - b.least).map((j) => j.jam);
}

export function stepStream(stays: Stays, about: StaysData, stream: Stream, threshold: number): StepStreamData {
  const jams = stepJams(stays, about, stream, threshold);
  const began = jams.filter((j) => !j.open_at_start);
  const survival = kaplanMeier(began.map((j) => ({ time: j.duration!, ended: !j.open_at_end })));
  const rate = garwood(began.length, about.end - about.begin);
  return {
    events: jams.length, jams, survival, rate: { value: rate?.rate ?? null, low: rate?.low ?? null, high: rate?.high ?? null },
    median: whenLeft(survival), jammed_time: jams.reduce((sum, j) => sum + j.duration!, 0), longest: jams.reduce((most, j) => Math.max(most, j.duration!), 0), fano: null,
  };
}

export function stepStreams(stays: Stays, about: StaysData, threshold: number): StepStreams {
  const of = (stream: Stream): StepStreamData => stepStream(stays, about, stream, threshold);
  return { global: of('global'), particle: of('particle'), site: of('site') };
}
