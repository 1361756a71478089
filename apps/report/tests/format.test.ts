import { describe, expect, test } from 'vitest';
import {
  bracket, columnScale, count, decimals, duration, inScale, instant, percent, plural, powerOfTen, scaleFor, scientific, setting, significant, unknown,
  withUnit,
} from '../src/numbers/format';

describe('numbers with units', () => {
  test('take the SI prefix that leaves 1 to 999', () => {
    expect(withUnit(1234.5, 'N')).toBe('1.23 kN');
    expect(withUnit(0.0123, 's')).toBe('12.3 ms');
    expect(withUnit(5e-8, 's')).toBe('50.0 ns');
    expect(withUnit(63e9, 'Pa')).toBe('63.0 GPa');
    expect(withUnit(1, 'N')).toBe('1.00 N');
    expect(withUnit(2.5e-6, 'm')).toBe('2.50 µm');
  });

  test('choose the prefix after rounding, never "1000 N" for "1.00 kN"', () => {
    expect(withUnit(999.4, 'N')).toBe('999 N');
    expect(withUnit(999.6, 'N')).toBe('1.00 kN');
  });

  test('keep their sign and say zero plainly', () => {
    expect(withUnit(-40.25, 'N')).toBe('−40.3 N');
    expect(withUnit(0, 'J')).toBe('0 J');
  });

  test('that are not known are a dash, not a zero', () => {
    for (const value of [null, undefined, NaN, Infinity]) expect(withUnit(value, 'N')).toBe(unknown);
    expect(percent(null)).toBe(unknown);
    expect(count(null)).toBe(unknown);
  });

  test('that somebody chose show no digits they did not write', () => {
    expect(setting(20, 'N')).toBe('20 N');
    expect(setting(0.002, 's')).toBe('2 ms');
    expect(setting(0.01175, 'm')).toBe('11.75 mm');
    expect(setting(-9.81, '')).toBe('−9.81');
    expect(setting(0.1 * 20, 'N')).toBe('2 N');
  });
});

describe('plain numbers', () => {
  test('have the digits asked for', () => {
    expect(significant(17.256)).toBe('17.3');
    expect(significant(0.030449, 4)).toBe('0.03045');
    expect(significant(123456)).toBe('123456');
    expect(significant(1.5e9)).toBe('1.50·10⁹');
    expect(significant(1.5e-7)).toBe('1.50·10⁻⁷');
  });
  test('group long counts', () => {
    expect(count(9999)).toBe('9999');
    expect(count(35000)).toBe('35\u202f000');
    expect(plural(1, 'event')).toBe('1 event');
    expect(plural(0, 'event')).toBe('0 events');
  });
  test('as powers of ten', () => {
    expect(powerOfTen(-12)).toBe('10⁻¹²');
    expect(scientific(4.2e6)).toBe('4.20·10⁶');
  });
  test('of percent', () => {
    expect(percent(0.209)).toBe('20.9 %');
    expect(percent(1)).toBe('100 %');
  });
});

describe('steps and instants', () => {
  test('write a step exactly', () => {
    expect([1, 0.5, 0.25, 0.1, 0.05, 2e-5, 50].map(decimals)).toEqual([0, 1, 2, 1, 2, 5, 0]);
  });
  test('tell neighbouring samples apart', () => {
    expect(instant(1.314, 0.002)).toBe('1.314');
    expect(instant(1.31416, 1e-4)).toBe('1.3142');
    expect(instant(null, 0.002)).toBe(unknown);
    expect(instant(2, null)).toBe('2.0000');
  });
  test('spell long durations', () => {
    expect(duration(5321)).toBe('1 h 28 min 41 s');
    expect(duration(3600)).toBe('1 h');
    expect(duration(3605)).toBe('1 h 0 min 5 s');
    expect(duration(90)).toBe('1 min 30 s');
    expect(duration(0.5)).toBe('500 ms');
  });
});

describe('columns', () => {
  test('have one scale, that of the median', () => {
    const scale = columnScale([0.002, 0.054, 0.016, null], 's');
    expect(scale).toEqual({ factor: 1e-3, unit: 'ms' });
    expect(inScale(0.054, scale)).toBe('54.0');
    expect(columnScale([], 's').unit).toBe('s');
    expect(scaleFor(12, '').unit).toBe('');
  });
  test('bracket a survival time, open where the record cuts the event', () => {
    const ms = { factor: 1e-3, unit: 'ms' };
    expect(bracket(0.004, 0.008, false, ms)).toBe('4.00 … 8.00');
    expect(bracket(0.004, 0.008, true, ms)).toBe('> 4.00');
    expect(bracket(0.004, null, false, ms)).toBe('> 4.00');
  });
});
