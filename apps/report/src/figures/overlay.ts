// One figure of several runs.
import type { Colour, Curve, SingleView, Stroke, TimePlot, View } from '../charts/spec';
import { missing } from '../charts/spec';
import type { ReportData } from '../data';
import type { Figure } from './figure';

export const runHues: readonly Colour[] = ['blue', 'vermillion', 'green', 'orange', 'purple', 'grey'];

// What tells the curves of one run apart where its colour tells the runs apart.
const strokes: readonly (Stroke | undefined)[] = [undefined, 'dots', 'dashes'];

const isEdge = (c: Curve): boolean => c.kind === 'low' || c.kind === 'high';
const linesOf = (view: TimePlot): Curve[] => view.curves.filter((c) => !isEdge(c));

// The curves of each run that a plot of several shows. Bands would hide each other; those of survival curves, which are what comparing is about, stay, of
// one stream: the first that all runs have.
function kept(views: readonly TimePlot[]): Curve[][] {
  if (!views.some((view) => view.across && view.curves.some(isEdge))) return views.map(linesOf);
  const label = linesOf(views[0]!).find((line) => views.every((view) => linesOf(view).some((other) => other.label === line.label)))?.label;
  return views.map((view) => {
    const line = linesOf(view).find((c) => c.label === label) ?? linesOf(view)[0];
    return view.curves.filter((c) => c.colour === line?.colour);
  });
}

// Curves of all runs in one plot: each run has its colour, each quantity its stroke; a curve that is dashed of one run is so of several.
function overlaid(names: readonly string[], view: TimePlot, curves: readonly Curve[][]): TimePlot {
  return {
    ...view,
    curves: curves.flatMap((all, r): Curve[] => {
      const free = strokes.filter((stroke) => stroke === undefined || !all.some((c) => c.stroke === stroke));
      let solid = 0;
      return all.map((c) => ({ ...c, label: `${names[r]!}: ${c.label}`, colour: runHues[r % runHues.length]!, stroke: c.stroke ?? (isEdge(c) ? undefined : free[solid++]) }));
    }),
  };
}

export function viewOf(figure: Figure, runs: readonly ReportData[]): View {
  if (runs.length === 1) return figure.view(runs[0]!);
  const all = runs.map((data) => ({ name: data.name, view: figure.view(data) }));
  const present = all.filter((run) => run.view.kind !== 'missing');
  if (present.length === 0) return missing((all[0]!.view as { why: string }).why);
  const plots = present.filter((run): run is { name: string; view: TimePlot } => run.view.kind === 'time');
  if (plots.length === present.length) {
    const curves = kept(plots.map((run) => run.view));
    if (curves.every((all) => all.filter((c) => !isEdge(c)).length <= strokes.length)) return overlaid(plots.map((run) => run.name), plots[0]!.view, curves);
  }
  return { kind: 'several', parts: all as { name: string; view: SingleView }[] };
}
