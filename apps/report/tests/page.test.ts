import { describe, expect, test } from 'vitest';
import { parseData } from '../src/data';
import { csv } from '../src/numbers/csv';
import { sorted } from '../src/tables';
import { around, clamped, makeTimeView } from '../src/time_view';
import { bare, jammed } from './sample';

describe('the data island', () => {
  const island = (...runs: unknown[]): string => JSON.stringify({ format: 'jamscope-report', schema: 2, runs });
  test('is read back as written', () => {
    expect(parseData(island(jammed()))).toEqual([jammed()]);
    expect(parseData(island(jammed(), bare()))).toHaveLength(2);
  });
  test('is refused with a reason when it is broken', () => {
    expect(() => parseData('')).toThrow(/not valid JSON/);
    expect(() => parseData('@JAMSCOPE_REPORT_DATA@')).toThrow(/not valid JSON/);
    expect(() => parseData('[]')).toThrow(/not a jamscope report/);
    expect(() => parseData('null')).toThrow(/not an object/);
    expect(() => parseData(JSON.stringify({ format: 'jamscope-report', schema: 1, runs: [jammed()] }))).toThrow(/schema 2 .* found 1/);
    expect(() => parseData(island())).toThrow(/no runs/);
    expect(() => parseData(island({ ...jammed(), events: undefined }))).toThrow(/"events"/);
    expect(() => parseData(island(jammed(), { ...jammed(), frames: null }))).toThrow(/"frames"/);
  });
});

describe('sorting', () => {
  const rows = [{ v: 3 }, { v: null }, { v: 1 }, { v: 2 }];
  test('goes both ways and keeps unknown values last', () => {
    expect(sorted(rows, (r) => r.v, true).map((r) => r.v)).toEqual([1, 2, 3, null]);
    expect(sorted(rows, (r) => r.v, false).map((r) => r.v)).toEqual([3, 2, 1, null]);
  });
  test('keeps the order of equal rows', () => {
    const equal = ['b', 'a', 'c'].map((name) => ({ name, v: 1 }));
    for (const up of [true, false]) expect(sorted(equal, (r) => r.v, up).map((r) => r.name)).toEqual(['b', 'a', 'c']);
  });
});

test('CSV quotes what needs it and leaves unknown numbers empty', () => {
  expect(csv(['a', 'b,c'], [[1.5, 'say "x"'], [null, 'two\nlines']])).toBe('a,"b,c"\r\n1.5,"say ""x"""\r\n,"two\nlines"\r\n');
});

describe('the time shown', () => {
  const full = { low: 0, high: 2 };
  test('stays inside the record', () => {
    expect(clamped({ low: -1, high: 1 }, full)).toEqual({ low: 0, high: 2 });
    expect(clamped({ low: 1.9, high: 2.1 }, full).high).toBeCloseTo(2, 12);
    expect(clamped({ low: 1.9, high: 2.1 }, full).low).toBeCloseTo(1.8, 12);
    expect(clamped({ low: -5, high: 9 }, full)).toEqual(full);
    expect(clamped({ low: 1, high: 1 }, full).high).toBeGreaterThan(1);
  });
  test('holds an event with room around it, also one of a single sample', () => {
    expect(around({ start: 1, end: 1.1 }, 0.002)).toEqual({ low: expect.closeTo(0.9, 12), high: expect.closeTo(1.2, 12) });
    expect(around({ start: 1, end: 1 }, 0.002)).toEqual({ low: 0.99, high: 1.01 });
  });
  test('is told to everyone who listens, and forgets the event on reset', () => {
    const view = makeTimeView(full, []);
    let told = 0;
    view.listen(() => ++told);
    view.show({ low: 0.5, high: 0.6 }, { start: 0.52, end: 0.55 });
    expect(view.marked()).toEqual({ start: 0.52, end: 0.55 });
    view.show({ low: 0.4, high: 0.7 });
    expect(view.marked()).not.toBeNull();
    view.reset();
    expect([told, view.range(), view.marked()]).toEqual([3, full, null]);
  });
});
