import { svg } from '../dom';
import { roundWidth } from '../numbers/bins';
import { decimals, scaleFor, significant } from '../numbers/format';
import type { BarPlot } from './spec';

const width = 560;
const height = 260;
const margin = { left: 58, right: 12, top: 26, bottom: 46 };

export interface Tick {
  value: number;
  text: string;
}

// About five round ticks from zero to at least `largest`.
export function ticks(largest: number): Tick[] {
  const step = roundWidth((largest > 0 ? largest : 1) / 5);
  const found: Tick[] = [];
  for (let k = 0; (k - 1) * step < largest * (1 - 1e-9) || k < 2; ++k)
    found.push({ value: k * step, text: (k * step).toFixed(decimals(step)) });
  return found;
}

export function drawBars(spec: BarPlot, title: string): SVGElement {
  const largest = Math.max(...spec.bars.map((b) => Math.max(b.value, b.high ?? 0)), 0);
  const scale = scaleFor(largest, spec.unit);
  const axis = ticks(largest / scale.factor);
  const top = axis[axis.length - 1]!.value;
  const inner = { width: width - margin.left - margin.right, height: height - margin.top - margin.bottom };
  const y = (v: number): number => margin.top + inner.height * (1 - v / scale.factor / top);
  const slot = inner.width / Math.max(spec.bars.length, 1);
  const x = (k: number): number => margin.left + k * slot;
  const every = Math.ceil(spec.bars.length / (spec.edges ? 12 : 16));
  const named = `${title}. ${spec.bars.map((b) => b.hover).join('; ')}`;
  const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, class: 'bars', role: 'img', 'aria-label': named });

  for (const tick of axis) {
    const at = y(tick.value * scale.factor);
    root.append(
      svg('line', { class: 'grid', x1: margin.left, x2: width - margin.right, y1: at, y2: at }),
      svg('text', { class: 'tick', x: margin.left - 7, y: at + 4, 'text-anchor': 'end' }, tick.text));
  }
  spec.bars.forEach((bar, k) => {
    const gap = spec.edges ? 0.04 : 0.14;
    const left = x(k + gap);
    const wide = slot * (1 - 2 * gap);
    const middle = x(k + 0.5);
    const group = svg('g', { class: 'bar' }, svg('title', {}, bar.hover));
    // A transparent strip of full height, so that small bars can be pointed at.
    group.append(
      svg('rect', { class: 'reach', x: x(k), y: margin.top, width: slot, height: inner.height }),
      svg('rect', { class: `fill-${spec.colour}`, x: left, y: y(bar.value), width: wide, height: Math.max(0, y(0) - y(bar.value)) }));
    let label = y(bar.value);
    if (bar.low !== undefined && bar.high !== undefined) {
      const cap = Math.min(6, wide / 4);
      label = Math.min(label, y(bar.high));
      group.append(svg('path', {
        class: 'whisker',
        d: `M${middle} ${y(bar.low)}V${y(bar.high)}M${middle - cap} ${y(bar.low)}h${2 * cap}M${middle - cap} ${y(bar.high)}h${2 * cap}`,
      }));
    }
    if (slot > 20) group.append(svg('text', { class: 'value', x: middle, y: label - 5, 'text-anchor': 'middle' }, bar.text));
    root.append(group);
    if (k % every === 0) {
      const at = spec.edges ? x(k) : middle;
      root.append(svg('text', { class: 'tick', x: at, y: height - margin.bottom + 16, 'text-anchor': 'middle' }, bar.label));
      if (spec.edges) root.append(svg('line', { class: 'axis', x1: at, x2: at, y1: y(0), y2: y(0) + 4 }));
    }
  });
  root.append(
    svg('line', { class: 'axis', x1: margin.left, x2: width - margin.right, y1: y(0), y2: y(0) }),
    svg('text', { class: 'label', x: margin.left + inner.width / 2, y: height - 8, 'text-anchor': 'middle' }, spec.across),
    svg('text', {
      class: 'label', transform: `translate(14 ${margin.top + inner.height / 2}) rotate(-90)`, 'text-anchor': 'middle',
    }, scale.unit === '' ? spec.quantity : `${spec.quantity} (${scale.unit})`));
  (spec.marks ?? []).forEach((mark, k) => {
    const at = x(mark.at);
    if (at < margin.left - 1 || at > width - margin.right + 1) return;
    const right = at > margin.left + inner.width * 0.6;
    root.append(
      svg('line', { class: 'mark', x1: at, x2: at, y1: margin.top - 8, y2: y(0) }),
      svg('text', { class: 'value', x: at + (right ? -4 : 4), y: 12 + 12 * (k % 2), 'text-anchor': right ? 'end' : 'start' }, mark.label));
  });
  return root;
}

// Where a value lies on the axis of equal bins.
export function position(value: number, first: number, binWidth: number): number {
  return (value - first) / binWidth;
}

export const edgeText = (value: number, factor: number): string => significant(Number((value / factor).toPrecision(8)), 4).replace(/\.0+$|(\.\d*[1-9])0+$/, '$1');
