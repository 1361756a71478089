import { describe, expect, test } from 'vitest';
import { viewCsv } from '../src/card';
import type { BarPlot, TimePlot } from '../src/charts/spec';
import { groups } from '../src/figures';
import { medianWidth } from '../src/figures/blade';
import { survivalFrequency } from '../src/figures/jams';
import { tiles } from '../src/sections/headline';
import { bare, jammed, quiet } from './sample';

const figures = groups.flatMap((group) => group.figures);

describe.each(figures.map((f) => [f.id, f] as const))('figure %s', (_id, figure) => {
  test('has a title, a caption and a name of its own', () => {
    expect(figure.title).not.toBe('');
    expect(figure.caption(jammed(), false)).not.toBe('');
    expect(figure.caption(jammed(), false)).not.toMatch(/NaN|undefined|null|–\s*window/);
    expect(figures.filter((f) => f.id === figure.id)).toHaveLength(1);
  });
  test('shows a record with jams', () => {
    const view = figure.view(jammed());
    expect(view.kind).not.toBe('missing');
    expect(viewCsv(view).split('\r\n').length).toBeGreaterThan(2);
  });
  test('gives each curve as many values as instants', () => {
    const view = figure.view(jammed());
    if (view.kind === 'time') for (const curve of view.curves) expect(curve.values.length).toBe(curve.time.length);
  });
  test('shows or explains a quiet, a bare and an empty record', () => {
    const empty = { ...bare(), jammed_histogram: [], survival_classes: [], frames: { ...bare().frames, rows: 0, time: [], largest_force: [], mean_force: [], jammed: [], bridges: [] } };
    for (const data of [quiet(), bare(), empty]) {
      const view = figure.view(data);
      figure.caption(data, true);
      if (view.kind === 'missing') expect(view.why).toMatch(/\.$/);
      if (view.kind === 'time') expect(view.curves.some((c) => c.values.some((v) => v !== null))).toBe(true);
      if (view.kind === 'bars') expect(view.bars.some((b) => b.value > 0)).toBe(true);
    }
  });
});

test('absent data is explained, not drawn as zero', () => {
  const missing = figures.filter((f) => f.view(bare()).kind === 'missing').map((f) => f.id);
  expect(missing).toEqual(expect.arrayContaining(['grain-force', 'blade-force', 'blade-torque', 'log-force', 'flow-energy', 'kinetic-energy', 'overlap']));
});

test('the force figure shows the threshold and the largest force of every step', () => {
  const view = figures.find((f) => f.id === 'grain-force')!.view(jammed()) as TimePlot;
  expect(view.threshold?.value).toBe(20);
  expect(view.curves.map((c) => c.label)).toEqual(['largest in any step', 'largest in the frame', 'mean of the frame']);
});

test('the histogram of jammed grains leaves out frames without any and empty bars at its end', () => {
  const view = figures.find((f) => f.id === 'jammed-histogram')!.view(jammed()) as BarPlot;
  expect(view.bars.map((b) => [b.label, b.value])).toEqual([['1', 2], ['2', 1]]);
});

test('survival classes carry the exact interval of their count', () => {
  const bar = (survivalFrequency.view(jammed()) as BarPlot).bars[1]!;
  expect(bar.label).toBe('10–20');
  expect(bar.low).toBe(0);
  expect(bar.high).toBeCloseTo(-Math.log(0.025) / 0.012, 6);
});

test('the running median spans one reading at 25 Hz, or a tenth of a short record', () => {
  expect(medianWidth([0, 1, 2])).toBe(0.04);
  expect(medianWidth([0, 0.1])).toBeCloseTo(0.01, 12);
});

describe('headline', () => {
  const value = (data: ReturnType<typeof jammed>, name: RegExp): string => tiles(data).find((t) => name.test(t.name))!.value;
  const note = (data: ReturnType<typeof jammed>, name: RegExp): string => tiles(data).find((t) => name.test(t.name))!.note;
  test('says what every step of the run saw, where it watched', () => {
    const data = jammed();
    expect(value(data, /every step/)).toBe('3');
    expect(note(data, /every step/)).toMatch(/^5 of single grains; half end within 2\.10\sms$/);
    data.headline.every_step = { events: 2, grains: 2, median: null, longest: 0.004 };
    expect(note(data, /every step/)).toMatch(/^2 of single grains; the longest lasts 4\.00\sms$/);
    data.headline.every_step = { events: 0, grains: 0, median: null, longest: 0 };
    expect(note(data, /every step/)).toBe('none, also between the frames');
    data.headline.every_step = null;
    expect(tiles(data).some((t) => /every step/.test(t.name))).toBe(false);
  });
  test('names the threshold and gives the rate with its interval', () => {
    const data = jammed();
    data.headline = { ...data.headline, events: 23, observed_time: 2, jam_frequency: 11.5 };
    expect(tiles(data)[0]).toMatchObject({ name: 'Jam events above 20 N', value: '23' });
    expect(value(data, /frequency/)).toBe('11.5 Hz');
    expect(note(data, /frequency/)).toBe('95 % interval 7.29 … 17.3\u00a0Hz');
  });
  test('bounds the rate where nothing jammed', () => {
    expect(value(quiet(), /frequency/)).toBe('0 Hz');
    expect(note(quiet(), /frequency/)).toBe('below 1.84 Hz (95 %)');
  });
  test('says what is not known', () => {
    expect(value(bare(), /Largest/)).toBe('–');
    expect(note(bare(), /Largest/)).toBe('not known from this data');
    expect(value(bare(), /Flow energy/)).toBe('–');
  });
});
