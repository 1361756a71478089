// The card of the 3D view: canvas, controls, the record of the chosen grain.
import { emptyBox } from '../card';
import type { EventData, ReportData, SceneFrame, StepJamData, TrackData } from '../data';
import { el } from '../dom';
import { sectionsOfRun } from '../island/sections';
import { count, instant, plural, significant, withUnit } from '../numbers/format';
import { jammedIn, type Samples } from '../recount/samples';
import { clustersOf, clustersOfAnalysis, type Clusters } from './clusters';
import { forceRange, rangeOf, viridis, type Range } from './colours';
import { boundsOf, decodeFrame, decodeGrains, frameFor, rowOf, type Frame, type Grains } from './frame';
import { hasShape } from './walls';
import { makeViewer, type Blade, type Chains, type ColourBy, type Look, type Viewer } from './viewer';

// What can be shown: a jam of a grain.
export interface Moment {
  particle: number; peak: number; start: number; end: number; name: string;
}
export function momentOf(jam: EventData | TrackData | StepJamData, name: string): Moment {
  return { particle: 'particle' in jam ? jam.particle : jam.peak_particle, peak: jam.peak_time ?? 0, start: jam.start ?? 0, end: jam.end ?? 0, name };
}

export interface ScenePanel {
  box: HTMLElement;
  show(moment: Moment): Promise<void>;
  threshold(value: number): void;
  recolour(): void;
  ready: Promise<void>;
  // For tests: what is drawn.
  state(): { frame: number; time: number; selected: number; drawnJammed: boolean; place: { x: number; y: number } | null; jammed: number; frames: number; message: string };
  measure(draws: number): number; // s for each
}

const kept = 60; // unpacked frames

function webglWorks(): boolean {
  try {
    return document.createElement('canvas').getContext('webgl2') !== null;
  } catch {
    return false;
  }
}

function select<T extends string>(label: string, options: readonly [T, string][], chosen: T, change: (value: T) => void): HTMLElement {
  const list = el('select', { change: () => change(list.value as T) }, ...options.map(([value, text]) => el('option', { value, selected: value === chosen }, text)));
  return el('label', { class: 'choice' }, label, ' ', list);
}

function tick(label: string, on: boolean, change: (on: boolean) => void): HTMLElement {
  const box = el('input', { type: 'checkbox', checked: on, change: () => change(box.checked) });
  return el('label', { class: 'choice' }, box, ' ', label);
}

function nothing(box: HTMLElement, why: string): ScenePanel {
  box.append(emptyBox(why));
  return {
    box, show: async () => {}, threshold: () => {}, recolour: () => {}, ready: Promise.resolve(),
    state: () => ({ frame: -1, time: NaN, selected: -1, drawnJammed: false, place: null, jammed: 0, frames: 0, message: why }), measure: () => NaN,
  };
}

export function drawScene(data: ReportData, run: number, samples: Promise<Samples | null>): ScenePanel {
  const box = el('section', { class: 'card', id: 'scene' }, el('h2', {}, '3D view'));
  const scene = data.scene;
  if (scene.why !== '') return nothing(box, `No 3D view. ${scene.why}`);
  if (scene.frames.length === 0) return nothing(box, 'No 3D view. No frame fits into this page.');
  if (!webglWorks()) return nothing(box, 'No 3D view. This browser has no WebGL 2, or it is switched off. Everything else on this page works without it.');

  const load = sectionsOfRun(run);
  const frames = scene.frames;
  const walls = scene.walls ?? [];
  const roles = walls.map((w) => w.role);
  const shapeless = walls.filter((w) => !hasShape(w) && !w.left_out).map((w) => w.name);
  const hasBlade = walls.some((w) => w.role === 'blade' && hasShape(w));
  const hasVessel = walls.some((w) => w.role !== 'blade' && hasShape(w));
  const decimalsOf = data.headline.sampling_interval ?? 1e-4;
  let threshold = data.criteria.jam_force;
  let loaded: Samples | null = null;
  let grains: Grains | null = null;
  let viewer: Viewer | null = null;
  let index = 0;
  let selected = -1;
  let message = '';
  let current: { frame: Frame; jammed: Uint8Array; clusters: Clusters } | null = null;
  let playing = 0;
  let asked = 0;
  const look: Look = { by: 'force', range: { low: 0, high: 1, log: false }, bulk: 1, cut: true, chains: 'strong', vessel: true, blade: 'solid' };
  let fastest: Range | null = null; // scales widen, and never change back: frames stay comparable
  let weakest = Infinity;
  const cache = new Map<number, Frame>();

  const stage = el('div', { class: 'stage', tabindex: 0, role: 'application', 'aria-label': 'Grains in space. Arrow keys turn, plus and minus zoom, comma and full stop change the frame, space plays, R resets the view.' });
  const legend = el('div', { class: 'legend' });
  const record = el('div', { class: 'record', 'aria-live': 'polite' });
  const note = el('output', { class: 'when', 'aria-live': 'polite' });
  const slider = el('input', { type: 'range', min: 0, max: frames.length - 1, value: 0, step: 1, 'aria-label': 'Frame', input: () => void go(Number(slider.value)) });
  const play = el('button', { type: 'button', click: () => (playing ? stop() : start()) }, 'Play');
  const fraction = (t: number): string => `${instant(t, decimalsOf)} s`;

  // At its own threshold the analysis says who is jammed, by whatever criterion; at another the page counts.
  const jammedNow = (frame: SceneFrame): Set<number> => {
    if (!loaded || threshold === data.criteria.jam_force) return new Set(frame.jammed);
    return frame.fine ? new Set((frame.loaded ?? []).filter(([, force]) => force > threshold).map(([id]) => id)) : jammedIn(loaded, frame.frame, threshold);
  };

  const frameAt = async (k: number): Promise<Frame> => {
    const known = cache.get(k);
    if (known) return known;
    grains ??= decodeGrains(await load(scene.grains_section!), scene.grains!);
    const frame = decodeFrame(await load(frames[k]!.section), frames[k]!, scene, grains);
    cache.set(k, frame);
    if (cache.size > kept) cache.delete(cache.keys().next().value!);
    return frame;
  };

  const rangeNow = (frame: Frame): Range => {
    if (look.by === 'force') {
      const here = forceRange(frame.force, threshold);
      weakest = Math.min(weakest, here.low);
      return { ...here, low: weakest };
    }
    if (look.by === 'contacts') return { low: 0, high: 10, log: false };
    const here = rangeOf(frame.speed);
    if (!fastest || here.high > fastest.high) fastest = here;
    return fastest;
  };

  const drawLegend = (): void => {
    const r = look.range;
    const bar = el('div', { class: 'bar', style: `background: linear-gradient(90deg, ${[0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1].map((s) => `rgb(${viridis(s).join(' ')})`).join(', ')})` });
    const unit = look.by === 'force' ? 'N' : look.by === 'speed' ? 'm/s' : '';
    const title = { force: 'Compressive force', speed: 'Speed', contacts: 'Contacts of the grain', cluster: 'Clusters of jammed grains' }[look.by];
    const ends = el('div', { class: 'ends' }, el('span', {}, withUnit(r.low, unit)), r.log && el('span', {}, withUnit(Math.sqrt(r.low * r.high), unit)), el('span', {}, `${withUnit(r.high, unit)}${look.by === 'contacts' ? '' : ' and more'}`));
    const key = (cls: string, text: string): HTMLElement => el('div', { class: 'key' }, el('span', { class: `mark ${cls}` }), text);
    legend.replaceChildren(...[
      el('h3', {}, title),
      ...(look.by === 'cluster' ? [el('p', { class: 'caption' }, 'One colour for each cluster; grains that are not jammed are grey.')]
        : look.by === 'speed' && !current?.frame.speed.some(Number.isFinite) ? [el('p', { class: 'caption' }, 'Speeds are not known from this data; all grains are grey.')] : [bar, ends]),
      key('ring', data.samples?.by_force === false ? 'jammed, by the criterion of the analysis' : `jammed: above ${withUnit(threshold, 'N')}`),
      key('ring chosen', 'chosen grain'),
      ...(look.chains === 'none' || !viewer || viewer.thickest() === 0 ? [] : [
        key('tube bridge', 'contact of a cluster that bridges blade and vessel'), key('tube', look.chains === 'strong' ? 'contact above 5 times the mean' : 'contact above the mean'),
        el('p', { class: 'caption' }, `Cross-section of tubes proportional to the force; the thickest carries ${withUnit(viewer.thickest(), 'N')}, the mean of this frame is ${withUnit(frames[index]!.mean_force, 'N')}.`)]),
    ].filter((n): n is HTMLElement => n !== null));
  };

  const drawRecord = (): void => {
    if (!current) return;
    const row = selected < 0 ? -1 : rowOf(current.frame, selected);
    if (selected < 0) {
      record.replaceChildren(el('h3', {}, 'Grain'), el('p', { class: 'caption' }, 'Click a grain, or an event in any table or plot.'));
      return;
    }
    const f = current.frame;
    const pairs: [string, string][] = [];
    if (row >= 0) {
      const label = current.clusters.label[row]!;
      const partners = f.a.reduce((n, a, c) => n + Number(a === row || f.b[c] === row), 0) + f.grain.reduce((n, g) => n + Number(g === row), 0);
      pairs.push(
        ['Compressive force', withUnit(f.force[row]!, 'N')],
        ['Jammed', current.jammed[row] ? 'yes' : 'no'],
        ['Cluster', label < 0 ? '–' : `${plural(current.clusters.size[label]!, 'grain')}${current.clusters.bridges[label] ? ', bridges' : ''}`],
        ['Speed', withUnit(f.speed[row]!, 'm/s')],
        ['Contacts', `${f.contacts[row]!}, ${partners} of them strong`],
        ['Diameter', withUnit(2 * f.radius[row]!, 'm')],
        ['Place', `(${[f.x[row]!, f.y[row]!, f.z[row]!].map((v) => significant(1000 * v, 4)).join(', ')}) mm`],
      );
    } else {
      pairs.push(['', f.about.part ? 'not among the grains of this part frame' : 'not in this frame']);
    }
    const stays = data.tracks.filter((t) => t.particle === selected);
    record.replaceChildren(el('h3', {}, `Grain ${selected}`),
      el('dl', { class: 'pairs narrow' }, ...pairs.map(([name, text]) => el('div', {}, el('dt', {}, name), el('dd', {}, text)))),
      el('p', { class: 'caption' }, stays.length === 0 ? 'Not jammed in any frame of the record.' : `Jammed in frames: ${plural(stays.length, 'time')}, first at ${fraction(stays[0]!.start ?? 0)}.`),
      el('button', { type: 'button', click: () => { selected = -1; message = ''; refresh(); } }, 'Let go'));
  };

  const refresh = (): void => {
    if (!current || !viewer) return;
    const f = current.frame;
    look.range = rangeNow(f);
    viewer.show({ ...current, selected }, look);
    drawLegend();
    drawRecord();
    const about = f.about;
    const jammed = current.jammed.reduce((a, b) => a + b, 0);
    slider.value = String(index);
    slider.setAttribute('aria-valuetext', fraction(about.time));
    note.textContent = `${fraction(about.time)} · ${about.fine ? `after frame ${count(about.frame + 1)}` : `frame ${count(about.frame + 1)}`} of ${count(scene.all_frames)} · ${plural(jammed, 'grain')} jammed` +
      (about.part ? ` · part: only grains within ${scene.part_reach} diameters of a jammed one` : '') + (message === '' ? '' : ` · ${message}`);
    stage.dataset.frame = String(about.frame);
    stage.dataset.selected = String(selected);
  };

  // Unpacks a frame and shows it; of several that are asked for, the last.
  async function go(k: number): Promise<void> {
    const mine = ++asked;
    index = Math.min(Math.max(k, 0), frames.length - 1);
    const frame = await frameAt(index);
    if (mine !== asked) return;
    const ids = jammedNow(frame.about);
    const jammed = Uint8Array.from(frame.id, (id) => (ids.has(id) ? 1 : 0));
    const clusters = threshold === data.criteria.jam_force ? clustersOfAnalysis(frame)
      : clustersOf(frame, jammed, (data.criteria.bridge_contact_share ?? 0.1) * threshold, roles);
    current = { frame, jammed, clusters };
    refresh();
  }
  function stop(): void {
    clearTimeout(playing);
    playing = 0;
    play.textContent = 'Play';
  }
  function start(): void {
    play.textContent = 'Pause';
    const next = async (): Promise<void> => {
      const began = performance.now();
      message = '';
      await go(index + 1 >= frames.length ? 0 : index + 1);
      if (playing) playing = window.setTimeout(() => void next(), Math.max(0, 110 - (performance.now() - began)));
    };
    playing = window.setTimeout(() => void next(), 0);
  }
  const step = (by: number): void => {
    stop();
    message = '';
    void go(index + by);
  };

  const bladeList = el('select', { change: () => { look.blade = bladeList.value as Blade; refresh(); } },
    el('option', { value: 'solid' }, 'solid'), el('option', { value: 'faint' }, 'see-through'), el('option', { value: 'hidden' }, 'hidden'));
  const bladeChoice = el('label', { class: 'choice' }, 'Blade ', bladeList);
  const controls = el('div', { class: 'scene-tools' },
    select<ColourBy>('Colour', [['force', 'compressive force'], ['speed', 'speed'], ['contacts', 'coordination'], ['cluster', 'cluster']], look.by, (v) => { look.by = v; refresh(); }),
    select<'1' | '0.4' | '0'>('Grains', [['1', 'full size'], ['0.4', 'small'], ['0', 'jammed only']], '1', (v) => { look.bulk = Number(v); refresh(); }),
    select<Chains>('Force chains', [['mean', 'above the mean'], ['strong', 'above 5 × the mean'], ['bridges', 'bridging clusters'], ['none', 'none']], look.chains, (v) => { look.chains = v; refresh(); }),
    tick('Cut away', look.cut, (v) => { look.cut = v; refresh(); }),
    hasVessel && tick('Vessel', look.vessel, (v) => { look.vessel = v; refresh(); }),
    hasBlade && bladeChoice);
  const fine = frames.filter((f) => f.fine).length;
  const whole = (frames.length - fine === scene.all_frames ? 'All frames of the record are here'
    : `${count(frames.length - fine)} of ${count(scene.all_frames)} frames are here: those of jams, strongest first, then some spread evenly`) +
    (fine > 0 ? `, and ${count(fine)} of capture.h5, of jams between them` : '');
  box.append(
    controls,
    el('div', { class: 'scene-body' }, stage, el('aside', {}, legend, record)),
    el('div', { class: 'transport' }, play,
      el('button', { type: 'button', 'aria-label': 'Frame before', click: () => step(-1) }, '‹'), slider,
      el('button', { type: 'button', 'aria-label': 'Next frame', click: () => step(1) }, '›'),
      el('button', { type: 'button', click: () => viewer?.reset() }, 'Reset view')), note,
    ...walls.filter((w) => w.left_out).map((w) => el('p', { class: 'caption' }, `The wall ${w.name} is not drawn: ${w.left_out}.`)),
    ...(shapeless.length > 0 ? [el('p', { class: 'caption' }, `The data do not hold the shape of ${shapeless.join(', ')}: not drawn.`)] : []),
    el('p', { class: 'caption' }, `${whole}. Drag to turn, wheel to zoom, right button to move, click a grain for its record. With the view in focus: arrow keys turn, + and − zoom, ` +
      'comma and full stop change the frame, space plays, R resets. ' +
      (hasVessel ? 'The near side of the vessel is cut away; so is the near half of the bed, except for jammed grains.' : 'The near half of the bed is cut away, except for jammed grains.')));

  stage.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !viewer) return;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => viewer!.turn(-0.12, 0), ArrowRight: () => viewer!.turn(0.12, 0), ArrowUp: () => viewer!.turn(0, 0.1), ArrowDown: () => viewer!.turn(0, -0.1),
      '+': () => viewer!.zoom(0.85), '=': () => viewer!.zoom(0.85), '-': () => viewer!.zoom(1.18), ',': () => step(-1), '.': () => step(1),
      ' ': () => (playing ? stop() : start()), r: () => viewer!.reset(), R: () => viewer!.reset(),
    };
    const action = actions[event.key];
    if (!action) return;
    action();
    event.preventDefault();
  });
  let down: { x: number; y: number } | null = null;
  stage.addEventListener('pointerdown', (event) => { down = { x: event.clientX, y: event.clientY }; });
  stage.addEventListener('pointerup', (event) => {
    if (!down || !viewer || !current || event.button !== 0 || Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4) return;
    const at = viewer.canvas.getBoundingClientRect();
    const row = viewer.pick(event.clientX - at.left, event.clientY - at.top);
    selected = row < 0 ? -1 : current.frame.id[row]!;
    message = '';
    refresh();
  });

  // Draws are counted; the number is there for the tests.
  const ready = (async (): Promise<void> => {
    try {
      // Begin with the strongest jam, on the near side.
      const strongest = data.events.reduce<EventData | null>((a, e) => (a && (a.peak_force ?? 0) >= (e.peak_force ?? 0) ? a : e), null);
      const first = Math.max(0, strongest ? frameFor(frames, (f) => f.jammed.includes(strongest.peak_particle), strongest.peak_time ?? 0).index : 0);
      // Room for the first and the last frame that hold all grains; where none does, for the one that is shown.
      const whole = frames.flatMap((f, k) => (f.part ? [] : [k]));
      const bounds = boundsOf(await Promise.all([...new Set(whole.length > 0 ? [whole[0]!, whole.at(-1)!] : [first])].map(frameAt)));
      viewer = await makeViewer(scene, load, bounds, stage, () => {});
      new ResizeObserver(() => viewer?.resize()).observe(stage);
      loaded = await samples;
      await go(first);
      const row = strongest && current ? rowOf((current as { frame: Frame }).frame, strongest.peak_particle) : -1;
      if (row >= 0) viewer.face(row);
      stage.dataset.state = 'ready';
    } catch (error) {
      stage.dataset.state = 'error';
      box.replaceChildren(el('h2', {}, '3D view'), emptyBox(`No 3D view. ${error instanceof Error ? error.message : String(error)}. Everything else on this page works without it.`));
    }
  })();

  return {
    box, ready,
    async show(moment) {
      await ready;
      if (!viewer) return;
      stop();
      const found = frameFor(frames, (f) => f.time >= moment.start - 1e-12 && f.time <= moment.end + 1e-12 && jammedNow(f).has(moment.particle), moment.peak);
      selected = moment.particle;
      // Close up, the blade would hide what it presses on.
      if (look.blade === 'solid') bladeList.value = look.blade = 'faint';
      message = found.jammed ? moment.name : `${moment.name}: no frame of this page shows it; this one is the nearest in time`;
      await go(found.index);
      const row = current ? rowOf(current.frame, selected) : -1;
      if (row >= 0) viewer.lookAt(row);
    },
    threshold(value) {
      threshold = value;
      if (viewer) void go(index);
    },
    recolour: () => viewer?.recolour(),
    state() {
      const row = current && selected >= 0 ? rowOf(current.frame, selected) : -1;
      return {
        frame: current?.frame.about.frame ?? -1, time: current?.frame.about.time ?? NaN, selected, drawnJammed: row >= 0 && (viewer?.isDrawnJammed(row) ?? false),
        place: row >= 0 && viewer ? viewer.place(row) : null, jammed: current?.jammed.reduce((a, b) => a + b, 0) ?? 0, frames: frames.length, message,
      };
    },
    measure(draws) {
      if (!viewer) return NaN;
      const gl = viewer.canvas.getContext('webgl2')!;
      const pixel = new Uint8Array(4);
      const finish = (): void => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for the drawing
      viewer.drawNow();
      finish();
      const began = performance.now();
      for (let k = 0; k < draws; ++k) {
        viewer.turn(0.02, 0);
        viewer.drawNow();
        finish();
      }
      return (performance.now() - began) / 1000 / draws;
    },
  };
}
