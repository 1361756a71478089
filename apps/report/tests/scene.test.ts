import { Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { SceneData, SceneFrame } from '../src/data';
import { clustersOf, clustersOfAnalysis } from '../src/scene/clusters';
import { clusterColour, forceRange, rangeOf, shareOf, unknownColour, viridis } from '../src/scene/colours';
import { boundsOf, decodeFrame, decodeGrains, frameFor, rowOf, type Frame } from '../src/scene/frame';
import { momentOf } from '../src/scene/panel';
import { tubeRadius } from '../src/scene/tubes';
import { endsInBox, planeInBox } from '../src/scene/walls';
import { bands, packed, type Item } from '../src/sections/timeline';
import { jammed } from './sample';

const about = (more: Partial<SceneFrame>): SceneFrame => ({
  frame: 0, time: 0, whole: true, part: false, grains: 0, contacts: 0, wall_contacts: 0, mean_force: 0, least_force: 0, poses: [], fine: false, jammed: [], cluster: [], bridges: [], section: 0, ...more,
});
const bytesOf = (...parts: (Uint32Array | Uint16Array | Uint8Array | Float32Array)[]): ArrayBuffer => new Uint8Array(parts.flatMap((a) => [...new Uint8Array(a.buffer, a.byteOffset, a.byteLength)])).buffer;
const code = (v: number): number => 1 + Math.round(((Math.log10(v) + 12) * 65533) / 18);

const scene: SceneData = { why: '', low: [0, 0, 0], high: [1, 2, 3], frames: [] };
const grains = decodeGrains(bytesOf(Uint32Array.of(3, 8, 9), Float32Array.of(0.5, 0.25, 0.125)), 3);
const tail = [Uint8Array.of(2, 1), Uint32Array.of(0), Uint32Array.of(1), Uint16Array.of(code(30)), Uint32Array.of(1), Uint8Array.of(2), Uint16Array.of(65535), Uint16Array.of(0), Uint16Array.of(0), Uint16Array.of(code(5))];
const head = [Uint16Array.of(0, 65535), Uint16Array.of(0, 65535), Uint16Array.of(0, 65535), Uint16Array.of(0, 65535), Uint16Array.of(code(40), code(0.1))];

describe('a frame', () => {
  const frame = decodeFrame(bytesOf(Uint32Array.of(0, 2), ...head, ...tail), about({ whole: false, part: true, grains: 2, contacts: 1, wall_contacts: 1 }), scene, grains);
  test('that holds part of the grains says which', () => {
    expect([...frame.id]).toEqual([3, 9]);
    expect([...frame.radius]).toEqual([0.5, 0.125]);
    expect([frame.x[1], frame.y[1], frame.z[1]]).toEqual([1, 2, 3]);
    expect(frame.force[0]).toBeCloseTo(40, 1);
    expect(frame.speed[0]).toBe(0);
    expect(frame.speed[1]).toBeNaN();
    expect([frame.pairForce[0]! / 30, frame.wallForce[0]! / 5].every((r) => Math.abs(r - 1) < 5e-4)).toBe(true);
    expect([frame.wallX[0], frame.wall[0]]).toEqual([1, 2]);
  });
  test('finds the row of a grain', () => {
    expect([rowOf(frame, 3), rowOf(frame, 9), rowOf(frame, 8), rowOf(frame, 100)]).toEqual([0, 1, -1, -1]);
  });
  test('is refused where its section has another size', () => {
    expect(() => decodeFrame(bytesOf(...head, ...tail), about({ whole: false, grains: 2, contacts: 1, wall_contacts: 1 }), scene, grains)).toThrow(/shorter/);
    expect(() => decodeFrame(bytesOf(Uint32Array.of(0, 2), ...head, ...tail, Uint8Array.of(1)), about({ whole: false, grains: 2, contacts: 1, wall_contacts: 1 }), scene, grains)).toThrow(/longer/);
  });
});

describe('the frame to show for a jam', () => {
  const frames = [0, 1, 2, 3].map((k) => about({ frame: k, time: k, jammed: k === 2 || k === 3 ? [7] : [] }));
  const of = (id: number) => (f: SceneFrame): boolean => f.jammed.includes(id);
  test('is one in which the grain is jammed, nearest to the peak', () => {
    expect(frameFor(frames, of(7), 1.1)).toEqual({ index: 2, jammed: true });
    expect(frameFor(frames, of(7), 2.8)).toEqual({ index: 3, jammed: true });
  });
  test('is the nearest where none shows it, and says so', () => {
    expect(frameFor(frames, of(9), 0.9)).toEqual({ index: 1, jammed: false });
    expect(frameFor([], of(9), 0.9)).toEqual({ index: -1, jammed: false });
  });
  test('is asked for by the grain with the peak', () => {
    const data = jammed();
    expect(momentOf(data.events[0]!, 'event 1')).toMatchObject({ particle: 41, peak: 0.002 });
    expect(momentOf(data.tracks[1]!, 'x')).toMatchObject({ particle: 42 });
  });
});

describe('clusters of jammed grains', () => {
  const frame = {
    size: 5, a: Uint32Array.of(0, 1, 3), b: Uint32Array.of(1, 2, 4), pairForce: Float32Array.of(10, 1, 10), grain: Uint32Array.of(0, 1, 3, 4), wall: Uint8Array.of(0, 1, 0, 0),
    wallForce: Float32Array.of(9, 9, 9, 9),
  } as unknown as Frame;
  test('hang together by contacts that carry enough, and bridge where both walls press them', () => {
    const c = clustersOf(frame, Uint8Array.of(1, 1, 1, 1, 1), 2, ['blade', 'vessel']);
    expect([...c.label]).toEqual([0, 0, 2, 1, 1]);
    expect(c.size).toEqual([2, 2, 1]);
    expect(c.bridges).toEqual([true, false, false]);
  });
  test('at its own threshold are those of the analysis', () => {
    const own = { size: 3, id: Uint32Array.of(3, 8, 9), about: about({ jammed: [8, 9, 77], cluster: [0, 1, 0], bridges: [true, false] }) } as unknown as Frame;
    const c = clustersOfAnalysis(own);
    expect([...c.label]).toEqual([-1, 0, 1]);
    expect(c.size).toEqual([2, 1]); // 77 is not among the grains of this part frame, but counts
    expect(c.bridges).toEqual([true, false]);
  });
  test('leave out grains that are not jammed', () => {
    const c = clustersOf(frame, Uint8Array.of(1, 0, 1, 0, 0), 2, ['blade', 'vessel']);
    expect([...c.label]).toEqual([0, -1, 1, -1, -1]);
    expect(c.bridges).toEqual([false, false]);
  });
});

describe('colours', () => {
  test('of the map rise in lightness all the way', () => {
    const light = Array.from({ length: 41 }, (_, k) => viridis(k / 40)).map(([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b);
    light.slice(1).forEach((l, k) => expect(l).toBeGreaterThan(light[k]!));
    expect(viridis(-1)).toEqual(viridis(0));
    expect(viridis(7)).toEqual(viridis(1));
  });
  test('follow the value, on a logarithmic axis too', () => {
    expect(shareOf(5, { low: 0, high: 10, log: false })).toBe(0.5);
    expect(shareOf(1, { low: 0.01, high: 100, log: true })).toBeCloseTo(0.5, 12);
    expect(shareOf(0, { low: 0.01, high: 100, log: true })).toBe(0);
  });
  test('end at a round value that a few outliers do not set', () => {
    expect(rangeOf([...Array.from({ length: 999 }, () => 0.19), 50]).high).toBeCloseTo(0.2, 12);
    expect(rangeOf([NaN, NaN]).high).toBe(1);
  });
  test('of forces reach from the decade of the weak ones to ten times the threshold', () => {
    const range = forceRange([0, 0, ...Array.from({ length: 20 }, (_, k) => 0.003 * (k + 1)), 500], 20);
    expect(range.low).toBeCloseTo(0.001, 12);
    expect(range.high).toBe(200);
    expect(forceRange([], 20).low).toBeCloseTo(0.001, 12);
  });
  test('tell clusters apart and leave the rest grey', () => {
    expect(clusterColour(-1)).toEqual(unknownColour);
    expect(clusterColour(0)).not.toEqual(clusterColour(1));
  });
});

describe('the room of the view', () => {
  const line = (x: number[]): Frame => ({ size: x.length, x: Float32Array.from(x), y: new Float32Array(x.length), z: new Float32Array(x.length), radius: new Float32Array(x.length).fill(0.5) }) as unknown as Frame;
  test('is that of the grains of all its frames, to their surfaces', () => {
    const bounds = boundsOf([line([0, 1, 2, 3]), line([1, 2, 3, 4])]);
    expect(bounds.low.toArray()).toEqual([-0.5, -0.5, -0.5]);
    expect(bounds.high.toArray()).toEqual([4.5, 0.5, 0.5]);
  });
  test('leaves out a grain that flew far off, and none that stands out a little', () => {
    const many = Array.from({ length: 1001 }, (_, k) => k / 100);
    expect(boundsOf([line([...many, 11])]).high.x).toBeCloseTo(11.5, 6);
    expect(boundsOf([line([...many, 100])]).high.x).toBeCloseTo(10.5, 6);
  });
});

describe('a wall without ends', () => {
  const box = { low: new Vector3(0, 0, 0), high: new Vector3(2, 1, 1) };
  test('is drawn where its plane cuts the room, counter-clockwise about its normal', () => {
    const corners = planeInBox(new Vector3(5, 5, 0.5), new Vector3(0, 0, 1), box);
    expect(corners.length).toBe(4);
    expect(corners.every((c) => c.z === 0.5)).toBe(true);
    expect(new Set(corners.map((c) => `${c.x} ${c.y}`))).toEqual(new Set(['0 0', '2 0', '2 1', '0 1']));
    const turned = corners[1]!.clone().sub(corners[0]!).cross(corners[2]!.clone().sub(corners[1]!));
    expect(turned.z).toBeGreaterThan(0);
    expect(planeInBox(new Vector3(0, 0, 1), new Vector3(0, 0, -1), box).length).toBe(4); // in a face of the room
    expect(planeInBox(new Vector3(1, 0.5, 0.5), new Vector3(1, 1, 1).normalize(), box).length).toBeGreaterThan(2);
    expect(planeInBox(new Vector3(0, 0, 2), new Vector3(0, 0, 1), box)).toEqual([]);
  });
  test('goes along its axis as far as the room does, and one with ends no farther than these', () => {
    const [origin, x] = [new Vector3(0.5, 0, 0), new Vector3(1, 0, 0)];
    expect(endsInBox(null, null, origin, x, box)).toEqual([-0.5, 1.5]);
    expect(endsInBox(-0.25, 9, origin, x, box)).toEqual([-0.25, 1.5]);
    expect(endsInBox(3, 4, origin, x, box)).toEqual([3, 4]); // outside the room: as it is
  });
});

test("a tube's cross-section is proportional to its force, down to a thread", () => {
  expect(tubeRadius(100, 100, 0.3)).toBeCloseTo(0.3, 12);
  expect(tubeRadius(25, 100, 0.3)).toBeCloseTo(0.15, 12);
  expect(tubeRadius(1e-9, 100, 0.3)).toBeCloseTo(0.018, 12);
});

describe('the timeline', () => {
  const item = (start: number, end: number): Item => ({ start, end, force: 1, text: '', moment: { particle: 1, peak: start, start, end, name: '' } });
  test('packs what overlaps into as few lanes as there can be', () => {
    expect(packed([item(0, 2), item(1, 3), item(2.5, 4)], 9).map((lane) => lane.length)).toEqual([2, 1]);
    expect(packed([item(0, 2), item(1, 3), item(1, 4)], 2).map((lane) => lane.length)).toEqual([1, 2]);
  });
  test('keeps the streams apart and names them', () => {
    expect(bands(jammed()).map((b) => [b.name, b.lanes.flat().length])).toEqual([['Global', 2], ['Clusters', 1], ['Particles', 2], ['Global, every step', 3]]);
  });
});
