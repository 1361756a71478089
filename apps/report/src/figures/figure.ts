import type { SingleView } from '../charts/spec';
import type { ReportData } from '../data';

export interface Figure {
  id: string;
  title: string;
  paper: string; // the figure of the paper that it answers, or empty
  caption(data: ReportData): string;
  counts?: boolean; // changes with the threshold
  view(data: ReportData): SingleView;
}
