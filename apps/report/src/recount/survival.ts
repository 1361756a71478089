// Kaplan and Meier's estimate with its band, as libjam/statistics/lifetimes.cpp has it.
import type { Interval, SurvivalData } from '../data';

export interface Lifetime {
  time: number;   // s
  ended: boolean; // false: cut off by the end of the record
}

const z = 1.959963984540054; // 95 %

export function kaplanMeier(lifetimes: readonly Lifetime[]): SurvivalData {
  const times = [...new Set(lifetimes.filter((l) => l.ended).map((l) => l.time))].sort((a, b) => a - b);
  const leaves = lifetimes.map((l) => l.time).sort((a, b) => a - b);
  const ended = new Map<number, number>();
  for (const l of lifetimes) if (l.ended) ended.set(l.time, (ended.get(l.time) ?? 0) + 1);
  const curve: SurvivalData = { time: times, share: [], low: [], high: [] };
  let share = 1;
  let variance = 0;
  let gone = 0;
  for (const t of times) {
    while (leaves[gone]! < t) ++gone;
    const n = leaves.length - gone;
    const d = ended.get(t)!;
    share *= 1 - d / n;
    variance += d / (n * (n - d));
    const known = share > 0 && share < 1;
    const spread = (z * Math.sqrt(variance)) / Math.log(share);
    curve.share.push(share);
    curve.low.push(known ? share ** Math.exp(-spread) : null);
    curve.high.push(known ? share ** Math.exp(spread) : null);
  }
  return curve;
}

// The first time at which half or less is left, and the same of the band.
export function whenLeft(curve: SurvivalData, share = 0.5): Interval {
  const first = (values: readonly (number | null)[]): number | null => {
    const k = values.findIndex((v) => v !== null && v <= share);
    return k < 0 ? null : curve.time[k]!;
  };
  return { value: first(curve.share), low: first(curve.low), high: first(curve.high) };
}
