// The figures of the report, in order. To add one: write a Figure (figure.ts) in a file of this folder, and add a row here;
// its card, its data download and its empty state come with it, and tests/figures.test.ts checks it.
import { bladeForce, bladeTorque, energyLedger, flowEnergy, kineticEnergy, logForce, overlap } from './blade';
import type { Figure } from './figure';
import { compressiveForce, coordination, jammedCount } from './grains';
import { jammedHistogram, jammedSpeed, jamsAbove, radialPosition, survivalCurve, survivalFrequency, survivalShare } from './jams';

export interface Group {
  id: string;
  title: string;
  figures: Figure[];
}

export const groups: Group[] = [
  { id: 'over-time', title: 'Over time', figures: [compressiveForce, jammedCount, bladeForce, bladeTorque, logForce, flowEnergy] },
  {
    id: 'jams', title: 'Jams',
    figures: [survivalFrequency, survivalShare, survivalCurve, jamsAbove, jammedHistogram, radialPosition, jammedSpeed],
  },
  { id: 'checks', title: 'State of the bed', figures: [coordination, kineticEnergy, overlap, energyLedger] },
];
