// A figure on the page: title, caption, tools, and the plot or the reason why there is none.
import { drawBars } from './charts/bar_plot';
import type { TimePlot, View } from './charts/spec';
import { drawTimePlot, type DrawnPlot } from './charts/time_plot';
import type { ReportData } from './data';
import { el, saveText } from './dom';
import type { Figure } from './figures/figure';
import { csv, type Cell } from './numbers/csv';
import type { TimeView } from './time_view';

// The numbers behind a view. Curves with different instants follow one another, so the first column names the curve.
export function viewCsv(view: View): string {
  switch (view.kind) {
    case 'time': {
      const rows: Cell[][] = view.curves.flatMap((curve) => curve.time.map((t, r): Cell[] => [curve.label, t, curve.values[r]]));
      return csv(['curve', 'time_s', view.unit === '' ? view.quantity : `${view.quantity} (${view.unit})`], rows);
    }
    case 'bars':
      return csv([view.across, view.unit === '' ? view.quantity : `${view.quantity} (${view.unit})`, 'low', 'high'],
        view.bars.map((b) => [b.label, b.value, b.low, b.high]));
    case 'table':
      return csv(view.header, view.rows);
    case 'missing':
      return '';
  }
}

export function emptyBox(why: string): HTMLElement {
  return el('p', { class: 'empty' }, why);
}

function logSwitch(spec: TimePlot, plot: DrawnPlot): HTMLElement | null {
  if (spec.log !== 'offer' && spec.log !== 'first') return null;
  const button = (text: string, log: boolean): HTMLButtonElement =>
    el('button', { type: 'button', 'aria-pressed': String(log === (spec.log === 'first')), click: () => choose(log) }, text);
  const linear = button('Linear', false);
  const logarithmic = button('Logarithmic', true);
  const choose = (log: boolean): void => {
    plot.setLog(log);
    linear.setAttribute('aria-pressed', String(!log));
    logarithmic.setAttribute('aria-pressed', String(log));
  };
  return el('span', { class: 'switch', role: 'group', 'aria-label': 'Vertical axis' }, linear, logarithmic);
}

export interface Card {
  box: HTMLElement;
  redraw(): void;
}

export function drawCard(figure: Figure, data: ReportData, view: TimeView): Card {
  const spec = figure.view(data);
  const tools = el('span', { class: 'tools' });
  const paper = figure.paper === '' ? null : el('span', { class: 'paper', title: 'Figure or table of Xuan and Nan (2024) that this one answers' }, figure.paper);
  const head = el('header', {}, el('h3', {}, figure.title, paper && ' ', paper), tools);
  const box = el('section', { class: `card shows-${spec.kind}`, id: figure.id }, head);
  let redraw = (): void => {};
  if (spec.kind === 'missing') {
    box.append(emptyBox(spec.why));
    return { box, redraw };
  }
  if (spec.kind === 'time') {
    const plot = drawTimePlot(spec, view, figure.title);
    redraw = plot.redraw;
    const choice = logSwitch(spec, plot);
    if (choice) tools.append(choice);
    box.append(plot.box);
  } else if (spec.kind === 'bars') {
    box.append(drawBars(spec, figure.title) as unknown as HTMLElement);
  } else {
    box.append(el('div', { class: 'scroll' }, el('table', { class: 'plain' },
      el('thead', {}, el('tr', {}, ...spec.header.map((h) => el('th', { scope: 'col' }, h)))),
      el('tbody', {}, ...spec.rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, cell))))))));
  }
  tools.append(el('button', { type: 'button', title: 'Save the numbers of this figure', click: () => saveText(`${figure.id}.csv`, viewCsv(spec)) }, 'CSV'));
  box.append(el('p', { class: 'caption' }, figure.caption(data)));
  return { box, redraw };
}
