import { describe, expect, test } from 'vitest';
import { viewCsv } from '../src/card';
import type { TimePlot } from '../src/charts/spec';
import { groups } from '../src/figures';
import { energyLedger } from '../src/figures/blade';
import { survivalCurve, stretchesAbove } from '../src/figures/jams';
import { viewOf } from '../src/figures/overlay';
import { metricFigure } from '../src/sections/metrics';
import { health } from '../src/sections/overview';
import { bare, jammed, quiet } from './sample';

const figures = groups.flatMap((g) => g.figures);
const two = [{ ...jammed(), name: 'A' }, { ...jammed(), name: 'B' }];

describe.each(figures.map((f) => [f.id, f] as const))('figure %s of several runs', (_id, figure) => {
  test('names every run', () => {
    const view = viewOf(figure, two);
    if (view.kind === 'time') expect(new Set(view.curves.map((c) => c.label.split(':')[0]))).toEqual(new Set(['A', 'B']));
    else if (view.kind === 'several') expect(view.parts.map((p) => p.name)).toEqual(['A', 'B']);
    else expect.unreachable(view.kind);
    expect(viewCsv(view)).toContain('B');
  });
  test('of one run is its own', () => {
    expect(viewOf(figure, [two[0]!])).toEqual(figure.view(two[0]!));
  });
  test('shows the run that has data and explains where none has', () => {
    expect(viewOf(figure, [two[0]!, { ...bare(), name: 'B' }]).kind).not.toBe('missing');
    if (figure.view(bare()).kind === 'missing') expect(viewOf(figure, [bare(), bare()]).kind).toBe('missing');
  });
});

test('each run has a colour of its own', () => {
  const view = viewOf(figures.find((f) => f.id === 'flow-energy')!, two) as TimePlot;
  expect(view.curves.map((c) => [c.label, c.colour])).toEqual([['A: Flow energy', 'blue'], ['B: Flow energy', 'vermillion']]);
});

test('curves of one run have strokes of their own; what is dashed of one run stays so', () => {
  const view = viewOf(figures.find((f) => f.id === 'grain-force')!, two) as TimePlot;
  expect(view.curves.filter((c) => c.colour === 'blue').map((c) => [c.label, c.stroke])).toEqual([
    ['A: largest in any step', 'dashes'], ['A: largest in the frame', undefined], ['A: mean of the frame', 'dots']]);
});

test('survival curves of several runs are of the same stream, with their bands', () => {
  const { global: _none, ...without } = jammed().steps;
  const view = viewOf(survivalCurve, [two[0]!, { ...two[1]!, steps: without }]) as TimePlot;
  expect(view.curves.map((c) => [c.label.split(/[ ,]+/)[1], c.kind])).toEqual([['particle', 'high'], ['particle', 'low'], ['particle', 'steps'], ['particle', 'high'], ['particle', 'low'], ['particle', 'steps']]);
});

test('plots of more curves than there are strokes stand one below the other', () => {
  const ledger = { ...jammed().energy!, curves: ['a', 'b', 'c', 'd'].map((name) => ({ name, values: [1, 2, 3] })) };
  const view = viewOf(energyLedger, two.map((run) => ({ ...run, energy: ledger })));
  expect(view.kind).toBe('several');
});

test('a run is said to count above the force that it watched, whatever the threshold', () => {
  const figure = figures.find((f) => f.id === 'jammed-count')!;
  const data = { ...jammed(), criteria: { ...jammed().criteria, jam_force: 50 } };
  expect((figure.view(data) as TimePlot).curves[0]!.label).toBe('above 20 N in any step');
  expect(figure.caption(data, false)).toMatch(/above 50 N in each frame.*above 20 N in any step/);
});

test('survival curves begin at one and have their band', () => {
  const view = survivalCurve.view(jammed()) as TimePlot;
  expect(view.across?.quantity).toBe('Duration');
  const line = view.curves.find((c) => c.label === 'global')!;
  expect(line.values[0]).toBe(1);
  expect(view.curves.filter((c) => c.colour === line.colour).map((c) => c.kind)).toEqual(['high', 'low', 'steps']);
  expect(survivalCurve.view(quiet()).kind).toBe('missing');
});

test('jams above a threshold are separate stretches', () => {
  expect(stretchesAbove([1, 5, 5, 1, 5, null, 5], 3)).toBe(3);
  expect(stretchesAbove([1, 5, 5, 1, 5], 5)).toBe(0);
});

test('the ledger leaves out what is negligible but never what is unexplained', () => {
  expect((energyLedger.view(jammed()) as TimePlot).curves.map((c) => c.label)).toEqual(['work of blade', 'sliding', 'unexplained']);
});

test('a metric is drawn with its own words', () => {
  const figure = metricFigure('coordination');
  expect(figure.caption(jammed(), false)).toMatch(/^Contacts per grain\. Named coordination/);
  expect(figure.view(bare()).kind).toBe('missing');
});

test('the health of a run says what is unexplained, or that nothing was kept', () => {
  const rows = new Map(health(jammed()));
  expect(rows.get('Energy unexplained')).toBe('1.00 nJ, 3.3·10⁻⁹ of what was put in');
  expect(rows.get('Largest overlap')).toBe('2.00 % of a radius');
  expect(new Map(health(bare())).get('Energy put in by walls')).toBe('no ledger was kept');
});
