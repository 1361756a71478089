// What a figure hands to the charts.
import type { Column } from '../data';

export type Colour = 'blue' | 'vermillion' | 'green' | 'orange' | 'purple' | 'grey';

export type Stroke = 'dashes' | 'dots';

// One curve, over time unless the plot says otherwise. `low` and `high` are the edges of a band; a band belongs to the curves of its own colour.
export interface Curve {
  label: string;
  time: Column;    // or what the plot is over
  values: Column;
  colour: Colour;
  kind?: 'line' | 'steps' | 'low' | 'high';
  stroke?: Stroke; // solid unless it says otherwise
}

export interface TimePlot {
  kind: 'time';
  quantity: string; // name of the y axis, without its unit
  unit: string;
  curves: Curve[];
  log?: 'offer' | 'first' | 'always'; // log axis: as an option, as the first choice, without choice
  threshold?: { value: number; label: string };
  fromZero?: boolean;
  whole?: boolean;   // counts: no ticks between whole numbers
  // Over something else than time: its name and unit, and whether its axis may be or is first logarithmic.
  across?: { quantity: string; unit: string; log?: 'offer' | 'first' };
}

export interface Bar {
  label: string;
  value: number;
  text: string;      // written above the bar
  hover: string;
  low?: number;      // ends of the error bar
  high?: number;
}

export interface BarPlot {
  kind: 'bars';
  quantity: string;
  unit: string;
  across: string;    // name and unit of the x axis
  bars: Bar[];
  colour: Colour;
  edges?: boolean;   // labels name the left edge of a bin instead of the bar
  marks?: { at: number; label: string }[];  // vertical lines; 1.5 is the middle of the second bar
}

export interface TableView {
  kind: 'table';
  header: string[];
  rows: string[][];
}

// Why there is nothing to show: data that is absent is explained, never drawn as zero.
export interface Missing {
  kind: 'missing';
  why: string;
}

// The same of several runs, one below the other, where they cannot share axes.
export interface SeveralViews {
  kind: 'several';
  parts: { name: string; view: TimePlot | BarPlot | TableView | Missing }[];
}

export type SingleView = TimePlot | BarPlot | TableView | Missing;
export type View = SingleView | SeveralViews;

export const missing = (why: string): Missing => ({ kind: 'missing', why });
