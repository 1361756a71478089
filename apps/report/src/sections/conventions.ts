// What the words and numbers of this page mean.
import type { ReportData } from '../data';
import { el } from '../dom';
import { known, setting } from '../numbers/format';

export function drawConventions(data: ReportData): HTMLElement {
  const d = data.headline.sampling_interval;
  const force = setting(data.criteria.jam_force, 'N');
  const entries: [string, string][] = [
    ['Compressive force', `Of a grain: ${data.criteria.measure} over its contacts, walls included. Repulsion counts as positive.`],
    ['Jammed', `A grain is jammed in a frame when its compressive force is larger than ${force}.`],
    ['Jam event', 'A run of consecutive frames in each of which at least one grain is jammed, whichever grain that is. ' +
      'Tracks follow each grain by itself, so one event may hold several tracks.'],
    ['Survival time', `Of n samples that are D apart${known(d) ? ` (here D = ${setting(d, 's')})` : ''}: n D. The true duration lies in the ` +
      'bracket ((n − 1) D, (n + 1) D); n D is right on average. An event cut by an end of the record, or by missing frames, has no upper limit: only "more than" is known.'],
    ['Jammed share of time', 'Sum of the survival times over the length of the record, which is frames times D.'],
    ['Interval of a rate', 'Garwood: the exact 95 % interval of a Poisson count, divided by the length of the record. ' +
      'Jams that trigger each other make the true uncertainty larger; repeat runs with other seeds to see it.'],
    ['In the gap', 'The centre of the grain is farther from the axis than the blade tip less ' +
      `${known(data.criteria.gap_margin) ? setting(data.criteria.gap_margin, '') : ''} of its diameter, and within the height of the blade give or take one diameter.`],
    ['Bridge', 'A connected cluster of loaded grains that touches a blade and a vessel wall and carries force from one to the other.'],
    ['Flow energy', 'Work of the blade on the grains: ∫ (T/(R tan α) + F) dh for a helical path, written for any motion as −∫ (F·v + T·ω) dt with force F and torque T on the blade.'],
    ['Signs', 'Loads of a blade are those on the blade. z points up; a torque is positive when it turns counter-clockwise seen from above.'],
    ['Thinned curves', 'A curve too long for the page is joined in bins that keep the lowest, mean and highest value, so no peak is lost. The data files have every value.'],
  ];
  return el('section', { class: 'card', id: 'conventions' }, el('h2', {}, 'Conventions'),
    el('dl', { class: 'entries' }, ...entries.flatMap(([name, text]) => [el('dt', {}, name), el('dd', {}, text)])));
}
