// A figure on the page: title, caption, tools, and the plot or the reason why there is none.
import { drawBars } from './charts/bar_plot';
import type { View } from './charts/spec';
import { drawTimePlot } from './charts/time_plot';
import type { ReportData } from './data';
import { el, saveText } from './dom';
import type { Figure } from './figures/figure';
import { viewOf } from './figures/overlay';
import { csv, type Cell } from './numbers/csv';
import type { TimeView } from './time_view';

// The numbers behind a view. Curves with different instants follow one another, so the first column names the curve.
export function viewCsv(view: View): string {
  const titled = (quantity: string, unit: string): string => (unit === '' ? quantity : `${quantity} (${unit})`);
  switch (view.kind) {
    case 'time': {
      const rows: Cell[][] = view.curves.flatMap((curve) => curve.time.map((t, r): Cell[] => [curve.label, t, curve.values[r]]));
      return csv(['curve', view.across ? titled(view.across.quantity, view.across.unit) : 'time_s', titled(view.quantity, view.unit)], rows);
    }
    case 'bars':
      return csv([view.across, titled(view.quantity, view.unit), 'low', 'high'], view.bars.map((b) => [b.label, b.value, b.low, b.high]));
    case 'table':
      return csv(view.header, view.rows);
    case 'several':
      return view.parts.map((part) => csv([part.name], []) + viewCsv(part.view)).join('');
    case 'missing':
      return '';
  }
}

export function emptyBox(why: string): HTMLElement {
  return el('p', { class: 'empty' }, why);
}

// What the reader chose, by figure, so that a figure that is drawn anew keeps it.
const chosen = new Map<string, boolean>();

function logSwitch(key: string, label: string, offer: 'offer' | 'first' | 'always' | undefined, set: (log: boolean) => void): HTMLElement | null {
  if (offer !== 'offer' && offer !== 'first') return null;
  const first = chosen.get(key) ?? offer === 'first';
  const button = (text: string, log: boolean): HTMLButtonElement =>
    el('button', { type: 'button', 'aria-pressed': String(log === first), click: () => choose(log) }, text);
  const linear = button('Linear', false);
  const logarithmic = button('Logarithmic', true);
  const choose = (log: boolean): void => {
    chosen.set(key, log);
    set(log);
    linear.setAttribute('aria-pressed', String(!log));
    logarithmic.setAttribute('aria-pressed', String(log));
  };
  if (first !== (offer === 'first')) set(first);
  return el('span', { class: 'switch', role: 'group', 'aria-label': label }, linear, logarithmic);
}

export interface Card {
  figure: Figure;
  box: HTMLElement;
  redraw(): void;
}

export function drawCard(figure: Figure, runs: readonly ReportData[], view: TimeView): Card {
  const spec = viewOf(figure, runs);
  const tools = el('span', { class: 'tools' });
  const paper = figure.paper === '' ? null : el('span', { class: 'paper', title: 'Figure or table of Xuan and Nan (2024) that this one answers' }, figure.paper);
  const head = el('header', {}, el('h3', {}, figure.title, paper && ' ', paper), tools);
  const box = el('section', { class: `card shows-${spec.kind}`, id: figure.id }, head);
  const redraws: (() => void)[] = [];
  const fill = (part: View, title: string): void => {
    if (part.kind === 'missing') {
      box.append(emptyBox(part.why));
    } else if (part.kind === 'time') {
      const plot = drawTimePlot(part, view, title);
      redraws.push(plot.redraw);
      const up = logSwitch(`${figure.id}-y`, 'Vertical axis', part.log, plot.setLog);
      const along = logSwitch(`${figure.id}-x`, 'Horizontal axis', part.across?.log, plot.setLogAcross);
      if (along) tools.append(el('span', { class: 'axis-name' }, 'x'), along);
      if (up) tools.append(...(along ? [el('span', { class: 'axis-name' }, 'y')] : []), up);
      box.append(plot.box);
    } else if (part.kind === 'bars') {
      box.append(drawBars(part, title) as unknown as HTMLElement);
    } else if (part.kind === 'table') {
      box.append(el('div', { class: 'scroll' }, el('table', { class: 'plain' },
        el('thead', {}, el('tr', {}, ...part.header.map((h) => el('th', { scope: 'col' }, h)))),
        el('tbody', {}, ...part.rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, cell))))))));
    } else {
      for (const each of part.parts) {
        box.append(el('h4', {}, each.name));
        fill(each.view, `${title}, ${each.name}`);
      }
    }
  };
  fill(spec, figure.title);
  if (spec.kind !== 'missing') {
    tools.append(el('button', { type: 'button', title: 'Save the numbers of this figure', click: () => saveText(`${figure.id}.csv`, viewCsv(spec)) }, 'CSV'));
    box.append(el('p', { class: 'caption' }, figure.caption(runs[0]!, runs.length > 1)));
  }
  return { figure, box, redraw: () => redraws.forEach((redraw) => redraw()) };
}
