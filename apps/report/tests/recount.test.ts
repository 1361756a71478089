import { describe, expect, test } from 'vitest';
import { Arrays, fromBase64, fromLogCode, unpack } from '../src/island/sections';
import { recounted } from '../src/recount/recount';
import { countFrames, decodeSamples, jammedIn, plainRule, samplingInterval, type Rule, type Samples } from '../src/recount/samples';
import { decodeStays, stepJams, stepStream } from '../src/recount/stays';
import { kaplanMeier, whenLeft } from '../src/recount/survival';
import { forceAt, positionOf } from '../src/sections/threshold';
import { jammed } from './sample';

// Frames 2 ms apart, with the loaded grains of each.
function record(frames: [number, number][][], time = frames.map((_, k) => 0.002 * k)): Samples {
  const flat = frames.flat();
  const start = new Uint32Array(frames.length + 1);
  frames.forEach((f, k) => { start[k + 1] = start[k]! + f.length; });
  const n = flat.length;
  return {
    time: Float64Array.from(time), start, particle: Uint32Array.from(flat, ([id]) => id), force: Float64Array.from(flat, ([, f]) => f),
    x: Float64Array.from({ length: n }, (_, k) => 0.012 + 1e-4 * k), y: new Float64Array(n), z: new Float64Array(n).fill(0.01),
    speed: new Float64Array(n).fill(0.1), inGap: new Uint8Array(n).fill(1), floor: 1,
  };
}

describe('counting frames at a threshold', () => {
  const samples = record([[], [[7, 30]], [[7, 50], [9, 25]], [[9, 60]], [[7, 5]], [], [[9, 21]]]);
  test('finds the global events and the stays of each grain', () => {
    const c = countFrames(samples, 20, [0.005], { x: 0, y: 0 });
    expect(c.events.map((e) => [e.first_frame, e.last_frame, e.peak_force, e.peak_particle, e.members])).toEqual([[1, 3, 60, 9, [7, 9]], [6, 6, 21, 9, [9]]]);
    expect(c.tracks.map((t) => [t.particle, t.samples, t.peak_force])).toEqual([[7, 2, 50], [9, 2, 60], [9, 1, 21]]);
    expect(c.events.map((e) => [e.open_at_start, e.open_at_end, e.longest === null])).toEqual([[false, false, false], [false, true, true]]);
    expect(c.histogram).toEqual([3, 3, 1]);
    expect(c.classes.map((k) => k.events)).toEqual([1, 1]);
    expect(c.jammedTime).toBeCloseTo(0.008, 12);
  });
  test('counts fewer and shorter ones at a higher threshold', () => {
    const c = countFrames(samples, 40, [0.005], null);
    expect(c.events.map((e) => [e.first_frame, e.last_frame])).toEqual([[2, 3]]);
    expect(c.tracks.map((t) => [t.particle, t.samples, t.radius])).toEqual([[7, 1, null], [9, 1, null]]);
  });
  test('is strict: a force that equals the threshold is not above it', () => {
    expect(countFrames(samples, 60, [], null).events).toHaveLength(0);
    expect([...jammedIn(samples, 2, 25)]).toEqual([7]);
  });
  test('cuts events where frames are missing', () => {
    const time = [0, 0.002, 0.004, 0.008, 0.01, 0.012, 0.014];
    const c = countFrames(record([[], [[7, 30]], [[7, 50]], [[7, 60]], [], [], []], time), 20, [], null);
    expect(c.events.map((e) => [e.first_frame, e.last_frame, e.open_at_start, e.open_at_end])).toEqual([[1, 2, false, true], [3, 3, true, false]]);
    expect(c.tracks).toHaveLength(2);
  });
  test('a survival time on a bound belongs to the class above, whatever rounding did to it', () => {
    const times = [0, 0.1 + 0.2, 0.6, 0.9, 1.2];
    expect(countFrames(record([[], [[7, 30]], [], [], []], times), 20, [0.3], null).classes.map((c) => c.events)).toEqual([0, 1]);
  });
  test('goes on above the end force, over pauses and without short ones, as the analysis does', () => {
    const frames: [number, number][][] = [[], [[7, 15]], [[7, 30]], [[7, 12]], [], [[7, 40]], [], [], [[9, 12]], [[9, 25]]];
    const ends = (rule: Rule): number[][] => {
      const c = countFrames(record(frames), 20, [], null, rule);
      expect(c.tracks.map((t) => t.samples)).toEqual(c.events.map((e) => e.samples)); // one grain at a time
      return c.events.map((e) => [e.first_frame, e.last_frame]);
    };
    expect(ends(plainRule)).toEqual([[2, 2], [5, 5], [9, 9]]);
    expect(ends({ ...plainRule, endForce: 10 })).toEqual([[1, 3], [5, 5], [8, 9]]);
    expect(ends({ ...plainRule, endForce: 10, holdOff: 0.002 })).toEqual([[1, 5], [8, 9]]);
    expect(ends({ ...plainRule, endForce: 10, shortest: 0.004 })).toEqual([[1, 3], [8, 9]]);
    expect(ends({ ...plainRule, endForce: 50 })).toEqual(ends(plainRule)); // never above the threshold
  });
  test('the sampling interval is the median distance', () => {
    expect(samplingInterval([0, 1, 2, 10])).toBe(1);
    expect(samplingInterval([0, 1, 4])).toBe(2);
    expect(samplingInterval([5])).toBe(0);
  });
});

describe('a run at another threshold', () => {
  const samples = record([[[1, 1]], [[1, 30]], [[1, 40], [2, 30]], [[1, 1]], [[1, 120]], []]);
  test('keeps what does not depend on it and leaves out what needs contacts', () => {
    const data = jammed();
    const again = recounted(data, { samples, stays: null }, 35);
    expect(again.headline).toMatchObject({ events: 2, tracks: 2, bridged: null, largest_force: 130, every_step: null });
    expect(again.criteria.jam_force).toBe(35);
    expect(again.frames.jammed).toEqual([0, 0, 1, 0, 1, 0]);
    expect(again.frames.bridges.every((b) => b === null)).toBe(true);
    expect(again.cluster_events).toEqual([]);
    expect(again.flow_energy).toBe(data.flow_energy);
  });
  test('is the run itself at its own threshold, or without samples', () => {
    const data = jammed();
    expect(recounted(data, { samples, stays: null }, 20)).toBe(data);
    expect(recounted(data, { samples: null, stays: null }, 35)).toBe(data);
  });
});

describe('jams of every step', () => {
  const about = { rows: 4, watch_force: 20, dt: 1e-3, stride: 1, first_step: 0, hold_off: 0, shortest: 0, begin: 0, end: 1, section: 0 };
  const stays = {
    particle: Uint32Array.from([5, 6, 5, 6]), first: Float64Array.from([10, 14, 30, 31]), last: Float64Array.from([15, 20, 30, 40]),
    peakStep: Float64Array.from([12, 16, 30, 35]), force: Float32Array.from([100, 50, 25, 30]), site: Uint8Array.from([0, 3, 0, 0]), open: Uint8Array.from([0, 0, 0, 1]),
  };
  test('joins stays that overlap or follow each other in the global stream', () => {
    const jams = stepJams(stays, about, 'global', 20);
    expect(jams.map((j) => [j.start, j.end, j.peak_force, j.peak_particle, j.open_at_end])).toEqual([[0.01, 0.02, 100, 5, false], [0.03, 0.04, 30, 6, true]]);
    expect(jams[0]!.duration).toBeCloseTo(0.011, 12);
    expect(jams[0]!.members).toEqual([5, 6]);
  });
  test('keeps grains and sites apart in theirs', () => {
    expect(stepJams(stays, about, 'particle', 20)).toHaveLength(4);
    expect(stepJams(stays, about, 'site', 20).map((j) => j.site)).toEqual([0, 3, 0]);
  });
  test('counts those that passed the threshold, with the time above the force that was watched', () => {
    const jams = stepJams(stays, about, 'global', 60);
    expect(jams).toHaveLength(1);
    expect(jams[0]!.duration).toBeCloseTo(0.011, 12);
  });
  test('bridges pauses up to the hold-off, and drops what is too short', () => {
    expect(stepJams(stays, { ...about, hold_off: 0.009 }, 'global', 20)).toHaveLength(1);
    expect(stepJams(stays, { ...about, hold_off: 0.008 }, 'global', 20)).toHaveLength(2);
    expect(stepJams(stays, { ...about, shortest: 0.005 }, 'particle', 20).map((j) => j.peak_particle)).toEqual([5, 6, 6]);
  });
  test('have their statistics', () => {
    const s = stepStream(stays, about, 'particle', 20);
    expect(s.events).toBe(4);
    expect(s.survival.time).toEqual([0.001, 0.006, 0.007]);
    expect(s.survival.share).toEqual([0.75, expect.closeTo(0.5, 12), expect.closeTo(0.25, 12)]);
    expect(s.median.value).toBeCloseTo(0.006, 12);
  });
  test('are read as they are written', () => {
    const bytes = new Uint8Array([...[stays.particle, stays.first, stays.last, stays.peakStep, stays.force, stays.site, stays.open].flatMap((a) => [...new Uint8Array(a.buffer)])]);
    expect(decodeStays(bytes.buffer, about)).toEqual(stays);
    expect(() => decodeStays(bytes.slice(0, -1).buffer, about)).toThrow(/shorter/);
  });
});

describe("Kaplan and Meier's estimate", () => {
  // The leukaemia patients of Freireich et al. (1963) under 6-MP, the textbook's example; R's survfit, conf.type "log-log".
  const weeks: [number, boolean][] = [[6, true], [6, true], [6, true], [6, false], [7, true], [9, false], [10, true], [10, false], [11, false], [13, true], [16, true], [17, false],
    [19, false], [20, false], [22, true], [23, true], [25, false], [32, false], [32, false], [34, false], [35, false]];
  const curve = kaplanMeier(weeks.map(([time, ended]) => ({ time, ended })));
  test('is that of the textbook, with its band', () => {
    expect(curve.time).toEqual([6, 7, 10, 13, 16, 22, 23]);
    expect(curve.share.map((v) => Number(v!.toFixed(4)))).toEqual([0.8571, 0.8067, 0.7529, 0.6902, 0.6275, 0.5378, 0.4482]);
    expect(curve.low[0]).toBeCloseTo(0.6197, 4);
    expect(curve.high[0]).toBeCloseTo(0.9516, 4);
    expect(curve.low[6]).toBeCloseTo(0.1881, 4);
    expect(curve.high[6]).toBeCloseTo(0.6801, 4);
    expect(whenLeft(curve).value).toBe(23);
  });
});

describe('the slider', () => {
  test('goes from its lowest to its highest force in even steps of their logarithm', () => {
    expect(forceAt(0, 0.2, 200)).toBe(0.2);
    expect(forceAt(1000, 0.2, 200)).toBe(200);
    expect(positionOf(forceAt(400, 0.2, 200), 0.2, 200)).toBe(400);
  });
});

describe('sections', () => {
  test('are deflate in base64', async () => {
    const packed = new Uint8Array(await new Response(new Blob([new Uint8Array([1, 2, 3])]).stream().pipeThrough(new CompressionStream('deflate'))).arrayBuffer());
    const text = btoa(String.fromCharCode(...packed));
    expect([...new Uint8Array(await unpack(text))]).toEqual([1, 2, 3]);
    expect([...fromBase64('AQID')]).toEqual([1, 2, 3]);
  });
  test('hold arrays one after the other', () => {
    const arrays = new Arrays(new Uint8Array([7, 1, 0, 2, 0, 0, 0]).buffer);
    expect([...arrays.bytes8(1), ...arrays.uint16(1), ...arrays.uint32(1)]).toEqual([7, 1, 2]);
    expect(() => arrays.bytes8(1)).toThrow(/shorter/);
    expect(() => new Arrays(new ArrayBuffer(3)).finish()).toThrow(/longer/);
  });
  test('have codes that keep three digits from 1e-12 to 1e6', () => {
    expect(fromLogCode(0)).toBe(0);
    expect(fromLogCode(65535)).toBeNaN();
    expect(fromLogCode(1)).toBeCloseTo(1e-12, 20);
    expect(fromLogCode(65534)).toBeCloseTo(1e6, 3);
    expect(fromLogCode(1 + Math.round(((Math.log10(20) + 12) * 65533) / 18)) / 20).toBeCloseTo(1, 3);
  });
  test('samples come back with places and frames', () => {
    const parts = [Float64Array.of(0, 1), Uint32Array.of(0, 1), Uint32Array.of(9), Float64Array.of(33), Uint16Array.of(65535), Uint16Array.of(0), Uint16Array.of(32768), Uint16Array.of(65535), Uint8Array.of(1)];
    const bytes = new Uint8Array(parts.flatMap((a) => [...new Uint8Array(a.buffer)]));
    const s = decodeSamples(bytes.buffer, { frames: 2, samples: 1, floor: 0.2, by_force: true, end_force: null, hold_off: 0, shortest: 0, section: 0 }, [0, 0, 0], [2, 2, 2]);
    expect([s.x[0], s.y[0], s.force[0], s.start[1], s.start[2], s.inGap[0]]).toEqual([2, 0, 33, 0, 1, 1]);
    expect(s.z[0]).toBeCloseTo(1, 3);
    expect(s.speed[0]).toBeNaN();
  });
});
