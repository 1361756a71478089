// Numbers as text: SI prefixes, significant digits, brackets.

const prefixes: [number, string][] = [
  [1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n'], [1e-12, 'p'],
];

export const unknown = '–';

export interface Scale {
  factor: number; // divide by it
  unit: string;   // unit with its prefix
}

export function known(value: number | null | undefined): value is number {
  return typeof value === 'number' && Number.isFinite(value);
}

// The prefix that brings `value` into [1, 1000) after rounding to `digits`. Units without a name take no prefix.
export function scaleFor(value: number, unit: string, digits = 3): Scale {
  const size = Math.abs(Number(value.toPrecision(digits)));
  if (unit === '' || unit === '%' || size === 0 || !Number.isFinite(size)) return { factor: 1, unit };
  const [factor, prefix] = prefixes.find(([f]) => size >= f * (1 - 1e-12)) ?? prefixes[prefixes.length - 1]!;
  return { factor, unit: prefix + unit };
}

const superscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

export function powerOfTen(exponent: number): string {
  const digits = String(Math.abs(exponent)).replace(/\d/g, (d) => superscripts[Number(d)]!);
  return `10${exponent < 0 ? '⁻' : ''}${digits}`;
}

// Fixed notation where it is short, otherwise a power of ten; true minus sign.
export function significant(value: number, digits = 3): string {
  if (value === 0) return '0';
  const exponent = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(digits)))));
  let text: string;
  if (exponent >= -4 && exponent < Math.max(6, digits)) {
    text = exponent >= digits ? Math.round(value).toString() : value.toFixed(Math.max(0, digits - 1 - exponent));
  } else {
    text = `${(value / 10 ** exponent).toFixed(digits - 1)}·${powerOfTen(exponent)}`;
  }
  return text.replace('-', '−');
}

// 1234.5 N -> "1.23 kN".
export function withUnit(value: number | null | undefined, unit: string, digits = 3): string {
  if (!known(value)) return unknown;
  const scale = scaleFor(value, unit, digits);
  const text = significant(value / scale.factor, digits);
  return scale.unit === '' ? text : `${text} ${scale.unit}`;
}

// A setting somebody chose, without digits they did not write: 20 N, not 20.0 N.
export function setting(value: number | null | undefined, unit: string): string {
  if (!known(value)) return unknown;
  const scale = scaleFor(value, unit, 8);
  const text = String(Number((value / scale.factor).toPrecision(8))).replace('-', '−');
  return scale.unit === '' ? text : `${text} ${scale.unit}`;
}

export function percent(share: number | null | undefined, digits = 3): string {
  return known(share) ? `${significant(share * 100, digits)} %` : unknown;
}

// Whole numbers with thin spaces between groups of three, from five digits up.
export function count(value: number | null | undefined): string {
  if (!known(value)) return unknown;
  const text = String(Math.round(value));
  return text.length < 5 ? text : text.replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f');
}

// One scale for a whole column or axis, so that its numbers can be compared: the one of the median size.
export function columnScale(values: readonly (number | null | undefined)[], unit: string): Scale {
  const sizes = values.filter(known).map(Math.abs).filter((v) => v > 0).sort((a, b) => a - b);
  return sizes.length === 0 ? { factor: 1, unit } : scaleFor(sizes[Math.floor(sizes.length / 2)]!, unit);
}

export function inScale(value: number | null | undefined, scale: Scale, digits = 3): string {
  return known(value) ? significant(value / scale.factor, digits) : unknown;
}

// Decimals that write every multiple of `step` exactly: 0.25 needs two.
export function decimals(step: number): number {
  for (let d = 0; d < 12; ++d) {
    const scaled = step * 10 ** d;
    if (scaled > 0.5 && Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return d;
  }
  return 12;
}

// 5321 s -> "1 h 28 min 41 s".
export function duration(seconds: number | null | undefined): string {
  if (!known(seconds)) return unknown;
  if (seconds < 60) return withUnit(seconds, 's');
  const whole = Math.round(seconds);
  const parts: [number, string][] = [[Math.floor(whole / 3600), 'h'], [Math.floor(whole / 60) % 60, 'min'], [whole % 60, 's']];
  return parts.filter(([n], k) => n > 0 || (k === 1 && whole >= 3600 && whole % 3600 !== 0)).map(([n, unit]) => `${n} ${unit}`).join(' ');
}

// 4.2e6 -> "4.20·10⁶", for units that take no prefix.
export function scientific(value: number | null | undefined, digits = 3): string {
  if (!known(value) || value === 0) return known(value) ? '0' : unknown;
  const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
  return `${mantissa}·${powerOfTen(Number(exponent))}`.replace('-', '−');
}

// An instant with enough decimals to tell neighbouring samples apart.
export function instant(time: number | null | undefined, resolution: number | null | undefined): string {
  if (!known(time)) return unknown;
  const decimals = known(resolution) && resolution > 0 ? Math.ceil(-Math.log10(resolution) - 1e-9) : 4;
  return time.toFixed(Math.min(9, Math.max(1, decimals))).replace('-', '−');
}

// n samples above the threshold, D apart, bracket the true duration; a record that cuts the event leaves one end open.
export function bracket(shortest: number | null, longest: number | null, open: boolean, scale: Scale): string {
  if (!known(shortest)) return '';
  if (open || !known(longest)) return `> ${inScale(shortest, scale)}`;
  return `${inScale(shortest, scale)} … ${inScale(longest, scale)}`;
}

export function plural(n: number, one: string, many = `${one}s`): string {
  return `${count(n)} ${n === 1 ? one : many}`;
}
