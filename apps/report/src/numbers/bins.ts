// Binning and smoothing.

export interface Bin {
  low: number;
  high: number;
  count: number;
}

// 1, 2 or 5 times a power of ten, not smaller than `width`.
export function roundWidth(width: number): number {
  const power = 10 ** Math.floor(Math.log10(width));
  for (const step of [1, 2, 5, 10]) if (step * power >= width * (1 - 1e-9)) return step * power;
  return 10 * power;
}

// About `wanted` bins of a round width that cover every finite value: [low, high) each, edges at multiples of the width.
export function histogram(values: readonly (number | null)[], wanted = 16): Bin[] {
  const finite = values.filter((v): v is number => v !== null && Number.isFinite(v));
  if (finite.length === 0) return [];
  const smallest = finite.reduce((a, b) => Math.min(a, b));
  const largest = finite.reduce((a, b) => Math.max(a, b));
  const spread = largest - smallest || Math.abs(largest) * 0.1 || 1;
  const width = roundWidth(spread / wanted);
  const first = Math.floor(smallest / width + 1e-9);
  const last = Math.floor(largest / width + 1e-9);
  const bins: Bin[] = [];
  for (let k = first; k <= last; ++k) bins.push({ low: k * width, high: (k + 1) * width, count: 0 });
  for (const v of finite) {
    const k = Math.floor(v / width + 1e-9) - first;
    bins[Math.min(Math.max(k, 0), bins.length - 1)]!.count += 1;
  }
  return bins;
}

function firstNotBelow(sorted: readonly number[], value: number): number {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle]! < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Median over the points within width/2 of each point; x ascending; unknown values are left out.
export function runningMedian(x: readonly number[], y: readonly (number | null)[], width: number): (number | null)[] {
  const sorted: number[] = [];
  const result: (number | null)[] = [];
  let enter = 0;
  let leave = 0;
  for (const centre of x) {
    for (; enter < x.length && x[enter]! <= centre + width / 2; ++enter) {
      const v = y[enter];
      if (typeof v === 'number') sorted.splice(firstNotBelow(sorted, v), 0, v);
    }
    for (; leave < enter && x[leave]! < centre - width / 2; ++leave) {
      const v = y[leave];
      if (typeof v === 'number') sorted.splice(firstNotBelow(sorted, v), 1);
    }
    const n = sorted.length;
    if (n === 0) result.push(null);
    else result.push(n % 2 === 1 ? sorted[(n - 1) / 2]! : 0.5 * (sorted[n / 2 - 1]! + sorted[n / 2]!));
  }
  return result;
}
