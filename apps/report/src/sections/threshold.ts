// The slider that counts jams anew at another force.
import type { ReportData } from '../data';
import { el } from '../dom';
import { count, plural, setting } from '../numbers/format';
import type { Recountable } from '../recount/recount';

const positions = 1000;

// Forces of the slider's positions: even on a logarithmic axis, with three digits.
export function forceAt(position: number, low: number, high: number): number {
  return Number((low * (high / low) ** (position / positions)).toPrecision(3));
}
export function positionOf(force: number, low: number, high: number): number {
  return Math.round((positions * Math.log(force / low)) / Math.log(high / low));
}

export interface ThresholdBar {
  box: HTMLElement;
  offer(known: readonly Recountable[]): void; // once the sections are unpacked
  tell(runs: readonly ReportData[]): void;
}

export function drawThreshold(runs: readonly ReportData[], set: (force: number) => void): ThresholdBar {
  const recorded = runs[0]!.criteria.jam_force;
  const slider = el('input', { type: 'range', min: 0, max: positions, step: 1, value: 0, disabled: true, 'aria-label': 'Jam threshold', id: 'threshold-slider' });
  const number = el('input', { type: 'number', min: 0, step: 'any', value: recorded, disabled: true, id: 'threshold-number', 'aria-label': 'Jam threshold in newtons' });
  const back = el('button', { type: 'button', disabled: true, click: () => choose(recorded) }, `As analysed (${setting(recorded, 'N')})`);
  const found = el('output', { 'aria-live': 'polite', id: 'threshold-found' });
  const why = el('p', { class: 'caption' });
  let low = recorded / 100;
  let high = recorded;
  let waiting = 0;
  const choose = (force: number): void => {
    if (!(force >= low)) force = low;
    number.value = String(force);
    slider.value = String(positionOf(Math.min(force, high), low, high));
    clearTimeout(waiting);
    waiting = window.setTimeout(() => set(force), 60);
  };
  slider.addEventListener('input', () => choose(forceAt(Number(slider.value), low, high)));
  number.addEventListener('change', () => choose(Number(number.value)));
  const box = el('section', { class: 'card', id: 'threshold' }, el('h2', {}, 'Jam threshold'),
    el('div', { class: 'threshold' }, slider, el('label', {}, number, ' N'), back), found, why);
  return {
    box,
    offer(known) {
      const all = known.map((k) => k.samples);
      if (runs.some((r) => r.samples && !r.samples.by_force)) {
        why.textContent = 'These jams were found by a criterion other than a force, so there is no force to choose here.';
        return;
      }
      if (all.some((s) => s === null)) {
        why.textContent = 'The loaded grains of the frames are not in this page, so it cannot count at another threshold: jamscope analyze --set jam_force=... does.';
        return;
      }
      low = Math.max(...all.map((s) => s!.floor));
      high = Math.max(recorded, ...all.map((s) => s!.force.reduce((a, f) => Math.max(a, f), 0)));
      for (const control of [slider, number, back]) control.disabled = false;
      slider.value = String(positionOf(recorded, low, high));
      number.min = String(low);
      why.textContent = `Counts as jamscope analyze --set jam_force=... would, from ${setting(Number(low.toPrecision(3)), 'N')} up: figures, lists and the 3D view follow. ` +
        'What needs all contacts of every frame (bridges, clusters) does not.';
    },
    tell(now) {
      found.textContent = now.map((run) => {
        const steps = run.headline.every_step;
        return `${now.length > 1 ? `${run.name}: ` : ''}${plural(run.headline.events, 'jam')} of frames, ${plural(run.headline.tracks, 'stay')} of single grains` +
          (steps ? `; at every step ${plural(steps.events, 'jam')}, ${count(steps.grains)} of single grains` : '');
      }).join(' · ');
    },
  };
}
