import { describe, expect, test } from 'vitest';
import { ticks } from '../src/charts/bar_plot';
import { histogram, roundWidth, runningMedian } from '../src/numbers/bins';

describe('histogram', () => {
  test('counts every finite value once, in bins of one round width', () => {
    const values = Array.from({ length: 500 }, (_, k) => Math.sin(k) * 3.7 + 1);
    const bins = histogram([...values, null, NaN]);
    expect(bins.reduce((sum, b) => sum + b.count, 0)).toBe(500);
    const width = bins[0]!.high - bins[0]!.low;
    expect(roundWidth(width * (1 - 1e-12))).toBeCloseTo(width, 12);
    bins.forEach((bin, k) => {
      if (k > 0) expect(bin.low).toBeCloseTo(bins[k - 1]!.high, 12);
      expect(bin.count).toBe(values.filter((v) => v >= bin.low && v < bin.high).length);
    });
  });

  test('puts a value on an edge into the bin that begins there', () => {
    const bins = histogram([0, 1, 2, 3, 4], 4);
    expect(bins.map((b) => [b.low, b.count])).toEqual([[0, 1], [1, 1], [2, 1], [3, 1], [4, 1]]);
  });

  test('copes with one value, with equal values and with none', () => {
    expect(histogram([5]).reduce((sum, b) => sum + b.count, 0)).toBe(1);
    expect(histogram([0, 0, 0]).reduce((sum, b) => sum + b.count, 0)).toBe(3);
    expect(histogram([null, NaN])).toEqual([]);
  });
});

test('a width is rounded up to 1, 2 or 5 times a power of ten', () => {
  expect([0.9, 1, 1.1, 3, 7, 20, 0.03].map(roundWidth)).toEqual([1, 1, 2, 5, 10, 20, 0.05]);
});

test('ticks start at zero and reach the largest value', () => {
  for (const largest of [0.3, 1, 9.2, 149, 150, 1e-4]) {
    const axis = ticks(largest);
    expect(axis[0]!.value).toBe(0);
    expect(axis[axis.length - 1]!.value).toBeGreaterThanOrEqual(largest * (1 - 1e-9));
    expect(axis.length).toBeLessThanOrEqual(7);
  }
  expect(ticks(0).length).toBeGreaterThan(1);
});

describe('running median', () => {
  test('equals the median of the points within half a width, computed afresh', () => {
    const x = Array.from({ length: 200 }, (_, k) => k * 0.1);
    const y = x.map((t, k) => (k % 17 === 0 ? null : Math.sin(7 * t) + (k % 13 === 0 ? 100 : 0)));
    const fast = runningMedian(x, y, 1.05);
    x.forEach((centre, k) => {
      const near = y.filter((v, j) => v !== null && Math.abs(x[j]! - centre) <= 0.525).map(Number).sort((a, b) => a - b);
      const n = near.length;
      expect(fast[k]).toBeCloseTo(n % 2 ? near[(n - 1) / 2]! : (near[n / 2 - 1]! + near[n / 2]!) / 2, 12);
    });
  });
  test('sets short peaks aside', () => {
    const x = Array.from({ length: 100 }, (_, k) => k);
    expect(runningMedian(x, x.map((k) => (k % 20 < 4 ? 500 : 1)), 20).every((v) => v === 1)).toBe(true);
  });
  test('is unknown where nothing is known', () => {
    expect(runningMedian([0, 1], [null, null], 5)).toEqual([null, null]);
  });
});
