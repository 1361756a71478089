// One figure of several runs.
import type { Colour, Curve, SingleView, TimePlot, View } from '../charts/spec';
import { missing } from '../charts/spec';
import type { ReportData } from '../data';
import type { Figure } from './figure';

export const runHues: readonly Colour[] = ['blue', 'vermillion', 'green', 'orange', 'purple', 'grey'];

// Curves of all runs in one plot: each run has its colour, each quantity its line. Bands would hide each other; those of a survival curve, which are
// what comparing is about, stay.
function overlaid(runs: readonly { name: string; view: TimePlot }[]): TimePlot {
  const first = runs[0]!.view;
  const curves = runs.flatMap(({ name, view }, r): Curve[] => {
    const colour = runHues[r % runHues.length]!;
    const lines = view.curves.filter((c) => c.kind !== 'low' && c.kind !== 'high');
    // Streams of a survival plot are told apart by colour alone: of several runs the first stream is shown.
    const kept = view.across && lines.length > 1 ? view.curves.filter((c) => c.colour === lines[0]!.colour) : lines;
    return kept.map((c, k) => ({ ...c, label: `${name}: ${c.label}`, colour, kind: c.kind === 'low' || c.kind === 'high' || c.kind === 'steps' ? c.kind : k === 0 ? 'line' : 'dashes' }));
  });
  return { ...first, curves };
}

export function viewOf(figure: Figure, runs: readonly ReportData[]): View {
  if (runs.length === 1) return figure.view(runs[0]!);
  const all = runs.map((data) => ({ name: data.name, view: figure.view(data) }));
  const present = all.filter((run) => run.view.kind !== 'missing');
  if (present.length === 0) return missing((all[0]!.view as { why: string }).why);
  const plots = present.filter((run): run is { name: string; view: TimePlot } => run.view.kind === 'time');
  if (plots.length === present.length) return overlaid(plots);
  return { kind: 'several', parts: all as { name: string; view: SingleView }[] };
}
