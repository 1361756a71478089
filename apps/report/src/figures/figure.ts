import type { SingleView } from '../charts/spec';
import type { ReportData } from '../data';

export interface Figure {
  id: string;
  title: string;
  paper: string; // the figure of the paper that it answers, or empty
  caption(data: ReportData, several: boolean): string; // several: of several runs in one plot, which shades no jams
  counts?: boolean; // changes with the threshold
  view(data: ReportData): SingleView;
}
