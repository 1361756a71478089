// Tables: sorted by any column, shown in portions, saved as CSV.
import { el, saveText } from './dom';
import { csv, type Cell } from './numbers/csv';
import { plural } from './numbers/format';

export interface TableColumn<Row> {
  title: string;
  hint?: string;                  // what the column means
  text(row: Row): string;
  value(row: Row): Cell;          // in SI units: for sorting and for CSV
  name: string;                   // in CSV
  left?: boolean;                 // words rather than numbers
}

export interface TableOptions<Row> {
  file: string;
  label: string;
  columns: TableColumn<Row>[];
  rows: Row[];
  open?: { column: number; hint(row: Row): string; action(row: Row): void };
}

const portion = 100;

// Unknown values last in either direction; equal ones keep their order.
export function sorted<Row>(rows: readonly Row[], value: (row: Row) => Cell, ascending: boolean): Row[] {
  const rank = (v: Cell): number => (v === null || v === undefined || v === '' ? 1 : 0);
  return rows
    .map((row, k) => ({ row, k, v: value(row) }))
    .sort((a, b) => {
      if (rank(a.v) !== rank(b.v)) return rank(a.v) - rank(b.v);
      const difference = typeof a.v === 'string' && typeof b.v === 'string'
        ? (a.v < b.v ? -1 : a.v > b.v ? 1 : 0)
        : rank(a.v) === 1 ? 0 : Number(a.v) - Number(b.v);
      return (ascending ? difference : -difference) || a.k - b.k;
    })
    .map((entry) => entry.row);
}

export interface DrawnTable<Row> {
  box: HTMLElement;
  mark(row: Row | null): void;
}

export function drawTable<Row>(options: TableOptions<Row>): DrawnTable<Row> {
  const { columns, open } = options;
  let column = 0;
  let ascending = true;
  let shown = portion;
  let marked: Row | null = null;
  const lines = new Map<Row, HTMLElement>();
  const body = el('tbody');
  const more = el('button', { type: 'button', click: () => { shown += 5 * portion; fill(); } });
  const heads = columns.map((c, k) =>
    el('th', { scope: 'col', class: c.left ? 'left' : undefined },
      el('button', {
        type: 'button', title: c.hint,
        click: () => {
          ascending = column === k ? !ascending : true;
          column = k;
          fill();
        },
      }, c.title)));
  const fill = (): void => {
    heads.forEach((head, k) => {
      if (k === column) head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    });
    lines.clear();
    const rows = sorted(options.rows, columns[column]!.value, ascending);
    body.replaceChildren(...rows.slice(0, shown).map((row) => {
      const cells = columns.map((c, k) => {
        const text = c.text(row);
        if (open && k === open.column)
          return el('td', {}, el('button', { type: 'button', class: 'open', title: open.hint(row), 'aria-label': open.hint(row) }, text));
        return el('td', { class: c.left ? 'left' : undefined }, text);
      });
      const line = el('tr', { class: [open ? 'can-open' : '', row === marked ? 'marked' : ''].join(' ').trim() || undefined }, ...cells);
      lines.set(row, line);
      if (open) line.addEventListener('click', () => open.action(row));
      return line;
    }));
    more.hidden = shown >= rows.length;
    more.textContent = `Show more (${plural(rows.length - Math.min(shown, rows.length), 'row')} left)`;
  };
  fill();
  const save = el('button', {
    type: 'button',
    click: () => saveText(options.file, csv(columns.map((c) => c.name), options.rows.map((row) => columns.map((c) => c.value(row))))),
  }, 'Save as CSV');
  const box = el('div', { class: 'table-box' },
    el('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': options.label },
      el('table', {}, el('thead', {}, el('tr', {}, ...heads)), body)),
    el('div', { class: 'under' }, more, save));
  return {
    box,
    mark(row) {
      for (const [each, line] of lines) line.classList.toggle('marked', each === row);
      marked = row;
    },
  };
}
