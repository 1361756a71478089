import uPlot from 'uplot';
import type { Column } from '../data';
import { el } from '../dom';
import { count, decimals, inScale, known, powerOfTen, scaleFor, withUnit } from '../numbers/format';
import type { TimeView } from '../time_view';
import type { Curve, TimePlot } from './spec';

export const height = 230;

function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// Curves on one x axis: instants that only one of them has leave the others undefined, which uPlot draws through.
function joined(curves: readonly Curve[], positive: boolean, positiveAcross: boolean): uPlot.AlignedData {
  const tables = new Map<Column, Curve[]>();
  for (const curve of curves) tables.set(curve.time, [...(tables.get(curve.time) ?? []), curve]);
  const parts: uPlot.AlignedData[] = [];
  const order: Curve[] = [];
  for (const [time, members] of tables) {
    const rows = time.map((t, r) => (known(t) && (!positiveAcross || t > 0) ? r : -1)).filter((r) => r >= 0);
    const clean = (v: number | null | undefined): number | null => (known(v) && (!positive || v > 0) ? v : null);
    parts.push([rows.map((r) => time[r]!), ...members.map((c) => rows.map((r) => clean(c.values[r])))]);
    order.push(...members);
  }
  const data = parts.length === 1 ? parts[0]! : uPlot.join(parts);
  return [data[0], ...curves.map((c) => data[1 + order.indexOf(c)]!)] as uPlot.AlignedData;
}

const wholeSteps = [1, 2, 5].flatMap((n) => [0, 1, 2, 3, 4, 5, 6].map((e) => n * 10 ** e)).sort((a, b) => a - b);

// Powers of ten only, where finer lines would fill the plot.
const decadesOf = (scale: 'x' | 'y') => (plot: uPlot, splits: (number | null)[]): (number | null)[] => {
  const { min, max } = plot.scales[scale]!;
  if (!known(min) || !known(max) || max / min < 1e3) return splits;
  return splits.map((v) => (known(v) && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9 ? v : null));
};
const decades = decadesOf('y');

function logLabel(value: number): string {
  const exponent = Math.round(Math.log10(value));
  if (Math.abs(Math.log10(value) - exponent) > 1e-6) return String(Number(value.toPrecision(2)));
  return exponent >= -2 && exponent <= 4 ? String(Number((10 ** exponent).toPrecision(1))) : powerOfTen(exponent);
}

function largestOf(curves: readonly Curve[]): number {
  let largest = 0;
  for (const curve of curves) for (const v of curve.values) if (known(v)) largest = Math.max(largest, Math.abs(v));
  return largest;
}

function series(curve: Curve, spec: TimePlot): uPlot.Series {
  const edge = curve.kind === 'low' || curve.kind === 'high';
  return {
    label: curve.label,
    stroke: () => colour(edge ? `${curve.colour}-band` : curve.colour),
    width: edge ? 0.75 : 1.5,
    dash: curve.stroke && { dashes: [6, 4], dots: [1.5, 3] }[curve.stroke],
    class: edge && spec.across ? 'edge' : undefined,
    paths: curve.kind === 'steps' || (edge && spec.across) ? uPlot.paths.stepped!({ align: 1 }) : undefined,
    points: edge ? { show: false } : undefined,
    value: (_plot, v) => spec.whole ? count(v) : withUnit(v, spec.unit, 4),
  };
}

function bands(curves: readonly Curve[]): uPlot.Band[] {
  const found: uPlot.Band[] = [];
  curves.forEach((high, h) => {
    if (high.kind !== 'high') return;
    const l = curves.findIndex((low) => low.kind === 'low' && low.colour === high.colour);
    if (l >= 0) found.push({ series: [h + 1, l + 1], fill: () => colour(`${high.colour}-band`) } as unknown as uPlot.Band);
  });
  return found;
}

function drawEvents(plot: uPlot, view: TimeView): void {
  const { ctx, bbox } = plot;
  const marked = view.marked();
  const paint = (start: number, end: number, fill: string): void => {
    const x0 = Math.max(plot.valToPos(start, 'x', true), bbox.left);
    const x1 = Math.min(plot.valToPos(end, 'x', true), bbox.left + bbox.width);
    if (x1 >= bbox.left && x0 <= bbox.left + bbox.width) {
      ctx.fillStyle = fill;
      ctx.fillRect(x0, bbox.top, Math.max(x1 - x0, devicePixelRatio), bbox.height);
    }
  };
  ctx.save();
  for (const event of view.events)
    if (event.start !== marked?.start) paint(event.start, event.end, colour('event'));
  if (marked) paint(marked.start, marked.end, colour('event-marked'));
  ctx.restore();
}

function drawThreshold(plot: uPlot, threshold: { value: number; label: string }): void {
  const { ctx, bbox } = plot;
  const y = plot.valToPos(threshold.value, 'y', true);
  if (!(y >= bbox.top && y <= bbox.top + bbox.height)) return;
  ctx.save();
  ctx.strokeStyle = colour('text');
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  const width = ctx.measureText(threshold.label).width;
  const above = y - bbox.top > 18 * devicePixelRatio;
  ctx.fillStyle = colour('card');
  ctx.globalAlpha = 0.75;
  const top = above ? y - 15 * devicePixelRatio : y + 3 * devicePixelRatio;
  ctx.fillRect(bbox.left + bbox.width - width - 8 * devicePixelRatio, top, width + 6 * devicePixelRatio, 13 * devicePixelRatio);
  ctx.globalAlpha = 1;
  ctx.fillStyle = colour('text');
  ctx.textBaseline = 'top';
  ctx.fillText(threshold.label, bbox.left + bbox.width - width - 5 * devicePixelRatio, top + devicePixelRatio);
  ctx.restore();
}

// A click, not a drag, on a shaded event or within a few pixels of it chooses it.
function chooseByClick(plot: uPlot, view: TimeView): void {
  let down = NaN;
  plot.over.addEventListener('mousedown', (event) => { down = event.clientX; });
  plot.over.addEventListener('mouseup', (event) => {
    if (event.button !== 0 || !(Math.abs(event.clientX - down) < 3)) return;
    const x = event.clientX - plot.over.getBoundingClientRect().left;
    const time = plot.posToVal(x, 'x');
    view.choose(time, Math.abs(plot.posToVal(x + 5, 'x') - time));
  });
}

function options(spec: TimePlot, log: boolean, logAcross: boolean, width: number, view: TimeView): uPlot.Options {
  const scale = scaleFor(Math.max(largestOf(spec.curves), spec.threshold?.value ?? 0), spec.unit);
  const unit = log ? spec.unit : scale.unit;
  const axis: uPlot.Axis = {
    stroke: () => colour('muted'),
    grid: { stroke: () => colour('grid'), width: 1 },
    ticks: { stroke: () => colour('grid'), width: 1, size: 5 },
    font: '12px system-ui, sans-serif',
    labelFont: '12px system-ui, sans-serif',
  };
  const range: uPlot.Range.Function = (_plot, low, high) => {
    let [a, b] = [low, high];
    if (spec.threshold) {
      a = Math.min(a ?? spec.threshold.value, spec.threshold.value);
      b = Math.max(b ?? spec.threshold.value, spec.threshold.value);
    }
    if (!known(a) || !known(b)) return log ? [1, 10] : [0, 1];
    if (log) return uPlot.rangeLog(a, b * 1.2, 10, false);
    if (spec.fromZero) a = Math.min(0, a);
    if (a === b) return [Math.min(0, a * 1.2), Math.max(a * 1.2, a === 0 ? 1 : 0)];
    const [lo, hi] = uPlot.rangeNum(a, b, 0.08, true);
    return [spec.fromZero && a >= 0 ? 0 : lo ?? a, hi ?? b];
  };
  const across = spec.across;
  const largestAcross = across ? Math.max(0, ...spec.curves.flatMap((c) => c.time).filter(known)) : 0;
  const acrossScale = across && !logAcross ? scaleFor(largestAcross, across.unit) : { factor: 1, unit: across?.unit ?? 's' };
  const acrossAxis: uPlot.Axis = across
    ? {
        ...axis, space: 60, label: acrossScale.unit === '' ? across.quantity : `${across.quantity} (${acrossScale.unit})`, labelSize: 18, size: 34,
        ...(logAcross ? { grid: { ...axis.grid, filter: decadesOf('x') }, ticks: { ...axis.ticks, filter: decadesOf('x') } } : {}),
        values: (_p, at, _a, _s, step) => (at as (number | null)[]).map((v) => (!known(v) ? '' : logAcross ? logLabel(v) : (v / acrossScale.factor).toFixed(decimals(step / acrossScale.factor)))),
      }
    // Room for the labels of a run of a millisecond, which have five decimals.
    : { ...axis, space: 80, label: 'Time (s)', labelSize: 18, size: 34, values: (_p, at, _a, _s, step) => at.map((v) => v.toFixed(decimals(step)).replace('-', '−')) };
  return {
    width,
    height,
    padding: [10, 22, null, null],  // right: half of the last time label
    scales: { x: { time: false, distr: logAcross ? 3 : 1, log: 10 }, y: { distr: log ? 3 : 1, log: 10, range } },
    axes: [
      acrossAxis,
      {
        ...axis,
        ...(log ? { grid: { ...axis.grid, filter: decades }, ticks: { ...axis.ticks, filter: decades } } : {}),
        ...(spec.whole ? { incrs: wholeSteps } : {}),
        label: unit === '' ? spec.quantity : `${spec.quantity} (${unit})`,
        labelSize: 20,
        size: 56,
        values: (_p, at, _a, _s, step) =>
          (at as (number | null)[]).map((v) =>
            !known(v) ? '' : log ? logLabel(v) : (v / scale.factor).toFixed(decimals(step / scale.factor)).replace('-', '−')),
      },
    ],
    series: [
      across ? { label: across.quantity, value: (_plot, v) => withUnit(v, across.unit, 4) }
        : { label: 'Time', value: (_plot, t) => (known(t) ? `${inScale(t, { factor: 1, unit: 's' }, 6)} s` : '–') },
      ...spec.curves.map((curve) => series(curve, spec)),
    ],
    bands: bands(spec.curves),
    legend: { live: true, markers: { width: 2, dash: (_plot, k) => ({ dashes: 'dashed', dots: 'dotted', solid: 'solid' })[spec.curves[k - 1]?.stroke ?? 'solid'] } },
    cursor: {
      y: false,
      ...(across ? {} : { sync: { key: 'time', scales: ['x', null] as [string, null], setSeries: false, filters: { pub: (type: string) => type === 'mousemove' || type === 'mouseleave' } } }),
      drag: { x: true, y: false, setScale: across !== undefined },
      // Hover reads the nearest value of each curve, also where only another curve has this instant.
      dataIdx: (plot, s, index) => {
        const values = plot.data[s]!;
        for (let away = 0; away < 500; ++away) {
          if (known(values[index - away])) return index - away;
          if (known(values[index + away])) return index + away;
        }
        return index;
      },
      // A double click on another axis than time is uPlot's own: it shows everything.
      ...(across ? {} : {
        bind: {
          dblclick: () => () => {
            view.reset();
            return null;
          },
        },
      }),
    },
    hooks: {
      drawClear: across ? [] : [(plot) => drawEvents(plot, view)],
      ready: across ? [] : [(plot) => chooseByClick(plot, view)],
      draw: [(plot) => { if (spec.threshold) drawThreshold(plot, spec.threshold); }],
      setSelect: across ? [] : [
        (plot) => {
          const { left, width: across } = plot.select;
          if (across < 4) return;
          view.show({ low: plot.posToVal(left, 'x'), high: plot.posToVal(left + across, 'x') });
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        },
      ],
    },
  };
}

function legendByKeyboard(box: HTMLElement): void {
  box.querySelectorAll<HTMLElement>('.u-legend .u-series').forEach((row, k) => {
    const name = row.querySelector('th');
    if (!name || k === 0) return;
    name.tabIndex = 0;
    name.setAttribute('role', 'button');
    name.title = 'Show or hide this curve';
    name.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      name.click();
    });
  });
}

// Arrow keys move, + and - zoom, 0 or Home shows the whole record.
function zoomByKeyboard(box: HTMLElement, view: TimeView): void {
  box.addEventListener('keydown', (event) => {
    if (event.target !== box || event.ctrlKey || event.metaKey || event.altKey) return;
    const { low, high } = view.range();
    const length = high - low;
    const move = (a: number, b: number): void => view.show({ low: low + a * length, high: high + b * length });
    if (event.key === 'ArrowLeft') move(-0.2, -0.2);
    else if (event.key === 'ArrowRight') move(0.2, 0.2);
    else if (event.key === '+' || event.key === '=') move(0.25, -0.25);
    else if (event.key === '-') move(-0.5, 0.5);
    else if (event.key === '0' || event.key === 'Home') view.reset();
    else return;
    event.preventDefault();
  });
}

export interface DrawnPlot {
  box: HTMLElement;
  setLog(log: boolean): void;
  setLogAcross(log: boolean): void;
  redraw(): void;
}

export function drawTimePlot(spec: TimePlot, view: TimeView, title: string): DrawnPlot {
  const box = el('div', {
    class: 'plot', tabindex: 0, role: 'group',
    'aria-label': spec.across ? `${title}, plot over ${spec.across.quantity.toLowerCase()}.` : `${title}, plot over time. Arrow keys move, plus and minus zoom, zero shows the whole record.`,
  });
  let log = spec.log === 'first' || spec.log === 'always';
  let logAcross = spec.across?.log === 'first';
  let plot: uPlot | null = null;
  const make = (): void => {
    const width = box.clientWidth;
    if (width < 50) return;
    plot?.destroy();
    plot = new uPlot(options(spec, log, logAcross, width, view), joined(spec.curves, log, logAcross), box);
    const { low, high } = view.range();
    if (!spec.across) plot.setScale('x', { min: low, max: high });
    legendByKeyboard(box);
  };
  new ResizeObserver(() => {
    if (!plot) make();
    else if (Math.abs(plot.width - box.clientWidth) > 1) plot.setSize({ width: box.clientWidth, height });
  }).observe(box);
  const unlisten = spec.across ? null : view.listen(() => {
    // A figure that was drawn anew leaves its old plot behind.
    if (!box.isConnected) {
      unlisten?.();
      return;
    }
    const { low, high } = view.range();
    plot?.setScale('x', { min: low, max: high });
  });
  if (!spec.across) zoomByKeyboard(box, view);
  return {
    box,
    setLog(wanted) {
      log = wanted;
      make();
    },
    setLogAcross(wanted) {
      logAcross = wanted;
      make();
    },
    redraw: make,
  };
}
