import { describe, expect, test } from 'vitest';
import { gammaP, gammaQuantile, garwood, logGamma } from '../src/numbers/poisson';

// P(N >= n) of a Poisson count with the given mean, summed term by term.
function atLeast(n: number, mean: number): number {
  let term = Math.exp(-mean);
  let below = 0;
  for (let k = 0; k < n; ++k) {
    below += term;
    term *= mean / (k + 1);
  }
  return 1 - below;
}

describe('Garwood interval', () => {
  test('of 23 events in 2 s is 11.5 Hz within 7.29 and 17.26 Hz', () => {
    const rate = garwood(23, 2)!;
    expect(rate.rate).toBe(11.5);
    expect(rate.low).toBeCloseTo(7.29, 2);
    expect(rate.high).toBeCloseTo(17.26, 2);
  });

  test('of no event reaches from zero to -ln(0.025) / T', () => {
    const rate = garwood(0, 2)!;
    expect(rate.low).toBe(0);
    expect(rate.high).toBeCloseTo(-Math.log(0.025) / 2, 10);
  });

  test('of one event begins where one or more events are 2.5 % likely: -ln(0.975)', () => {
    expect(garwood(1, 1)!.low).toBeCloseTo(-Math.log(0.975), 10);
    expect(garwood(1, 1)!.high).toBeCloseTo(5.5716434, 6); // chi2(0.975; 4) / 2
  });

  test('ends where the count is as extreme as the confidence allows, for counts from 1 to 200', () => {
    for (const n of [1, 2, 5, 23, 60, 200])
      for (const confidence of [0.68, 0.95, 0.99]) {
        const tail = (1 - confidence) / 2;
        const { low, high } = garwood(n, 1, confidence)!;
        expect(atLeast(n, low)).toBeCloseTo(tail, 9);
        expect(1 - atLeast(n + 1, high)).toBeCloseTo(tail, 9);
      }
  });

  test('is that of the count divided by the time', () => {
    const one = garwood(7, 1)!;
    const ten = garwood(7, 10)!;
    expect(ten.low * 10).toBeCloseTo(one.low, 12);
    expect(ten.high * 10).toBeCloseTo(one.high, 12);
  });

  test('does not exist without a record', () => {
    expect(garwood(3, 0)).toBeNull();
    expect(garwood(3, NaN)).toBeNull();
  });
});

describe('gamma functions', () => {
  test('log Gamma(n + 1) is log n!', () => {
    let sum = 0;
    for (let n = 1; n < 60; ++n) {
      sum += Math.log(n);
      expect(logGamma(n + 1)).toBeCloseTo(sum, 9);
    }
    expect(logGamma(0.5)).toBeCloseTo(0.5 * Math.log(Math.PI), 12);
  });

  test('P(1, x) is 1 - exp(-x), on both branches', () => {
    for (const x of [0, 1e-6, 0.3, 1.9, 2.1, 10, 50]) expect(gammaP(1, x)).toBeCloseTo(1 - Math.exp(-x), 12);
  });

  test('the quantile inverts P', () => {
    for (const a of [0.5, 1, 7, 300]) for (const p of [0.001, 0.025, 0.5, 0.975]) expect(gammaP(a, gammaQuantile(a, p))).toBeCloseTo(p, 9);
  });
});
