// Colour maps. Viridis (van der Walt and Smith) is read alike with and without colour vision; clusters have the colours of Okabe and Ito.
import { roundWidth } from '../numbers/bins';

export type Rgb = readonly [number, number, number]; // 0 to 255

const viridisStops: readonly Rgb[] = [
  [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140], [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37],
];

export function viridis(share: number): Rgb {
  const at = Math.min(Math.max(share, 0), 1) * (viridisStops.length - 1);
  const k = Math.min(Math.floor(at), viridisStops.length - 2);
  const [a, b] = [viridisStops[k]!, viridisStops[k + 1]!];
  return [0, 1, 2].map((c) => Math.round(a[c]! + (at - k) * (b[c]! - a[c]!))) as unknown as Rgb;
}

const hues: readonly Rgb[] = [[230, 159, 0], [86, 180, 233], [0, 158, 115], [204, 121, 167], [240, 228, 66], [0, 114, 178]];
export const unknownColour: Rgb = [150, 155, 160];

export function clusterColour(label: number): Rgb {
  return label < 0 ? unknownColour : hues[label % hues.length]!;
}

export interface Range { low: number; high: number; log: boolean }

export function shareOf(value: number, range: Range): number {
  if (range.log) return value <= range.low ? 0 : Math.log(value / range.low) / Math.log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

// Zero to a round value that all but one in two hundred values lie below.
export function rangeOf(values: ArrayLike<number>): Range {
  const known = Array.from(values).filter(Number.isFinite).sort((a, b) => a - b);
  const top = known[Math.floor(0.995 * (known.length - 1))] ?? 1;
  return { low: 0, high: roundWidth(top > 0 ? top : 1), log: false };
}

// From the decade that nine in ten loaded grains lie above to ten times the threshold, so that what is jammed is always at the bright end.
export function forceRange(values: ArrayLike<number>, threshold: number): Range {
  const loaded = Array.from(values).filter((v) => v > 0).sort((a, b) => a - b);
  const tenth = loaded[Math.floor(0.1 * (loaded.length - 1))] ?? threshold / 1e4;
  return { low: 10 ** Math.floor(Math.log10(Math.min(tenth, threshold / 10))), high: 10 * threshold, log: true };
}
