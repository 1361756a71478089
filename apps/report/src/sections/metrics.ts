// Network metrics of every frame: one plot, the reader chooses which.
import { emptyBox, drawCard, type Card } from '../card';
import type { ReportData } from '../data';
import { el } from '../dom';
import type { Figure } from '../figures/figure';
import { missing } from '../charts/spec';
import type { TimeView } from '../time_view';

export function metricFigure(name: string): Figure {
  return {
    id: 'metric', title: name.replace(/_/g, ' '), paper: '',
    caption: (data) => {
      const curve = data.metrics.curves.find((c) => c.name === name);
      const bins = data.metrics.every > 1 ? ` Means over ${data.metrics.every} frames.` : '';
      return `${curve ? curve.doc.charAt(0).toUpperCase() + curve.doc.slice(1) : ''}. Named ${name} in jamscope metrics.${bins}`;
    },
    view: (data) => {
      const curve = data.metrics.curves.find((c) => c.name === name);
      if (!curve) return missing(`The metric ${name} is not defined in any frame of this record.`);
      return {
        kind: 'time', quantity: name.replace(/_/g, ' '), unit: curve.unit === '1' ? '' : curve.unit, log: 'offer',
        curves: [{ label: name.replace(/_/g, ' '), time: data.metrics.time, values: curve.values, colour: 'blue' }],
      };
    },
  };
}

export interface MetricsSection {
  box: HTMLElement;
  redraw(): void;
}

export function drawMetrics(runs: readonly ReportData[], view: TimeView): MetricsSection {
  const box = el('section', { class: 'group', id: 'metrics' }, el('h2', {}, 'Contact network over time'));
  const names = [...new Set(runs.flatMap((run) => run.metrics.curves.map((c) => c.name)))];
  if (names.length === 0) {
    box.append(emptyBox('No network metrics were recorded with this analysis ([analysis] metrics in the case).'));
    return { box, redraw: () => {} };
  }
  const first = names.includes('bridge_strength') ? 'bridge_strength' : names[0]!;
  const list = el('select', { 'aria-label': 'Network metric', change: () => show(list.value) }, ...names.map((name) => el('option', { value: name, selected: name === first }, name)));
  const place = el('div');
  let card: Card | null = null;
  const show = (name: string): void => {
    card = drawCard(metricFigure(name), runs, view);
    place.replaceChildren(card.box);
  };
  show(first);
  box.append(el('p', { class: 'choose' }, el('label', { class: 'choice' }, 'Metric ', list), ` ${names.length} were recorded; jamscope metrics computes more.`), place);
  return { box, redraw: () => card?.redraw() };
}
