// One frame of the 3D view, unpacked. SI units.
import { Vector3 } from 'three';
import type { SceneData, SceneFrame } from '../data';
import { Arrays, fromLogCode } from '../island/sections';

export interface Grains {
  id: Uint32Array;      // ascending
  radius: Float32Array; // m
}

export interface Frame {
  about: SceneFrame;
  size: number;
  id: Uint32Array; radius: Float32Array;
  x: Float32Array; y: Float32Array; z: Float32Array;
  speed: Float32Array;         // NaN where not known
  force: Float32Array;         // compressive, N
  contacts: Uint8Array;        // number, walls included
  // Contacts of two grains (rows of the frame), and of a grain with a wall: those above `least_force`, and those of jammed grains.
  a: Uint32Array; b: Uint32Array; pairForce: Float32Array;
  grain: Uint32Array; wall: Uint8Array; wallX: Float32Array; wallY: Float32Array; wallZ: Float32Array; wallForce: Float32Array;
}

export function decodeGrains(bytes: ArrayBuffer, n: number): Grains {
  const arrays = new Arrays(bytes);
  const grains = { id: arrays.uint32(n), radius: arrays.float32(n) };
  arrays.finish();
  return grains;
}

export function decodeFrame(bytes: ArrayBuffer, about: SceneFrame, scene: SceneData, grains: Grains): Frame {
  const arrays = new Arrays(bytes);
  const n = about.grains;
  const low = scene.low ?? [0, 0, 0];
  const high = scene.high ?? [1, 1, 1];
  const axis = (k: number, count: number): Float32Array => Float32Array.from(arrays.uint16(count), (code) => low[k]! + (code / 65535) * (high[k]! - low[k]!));
  const codes = (count: number): Float32Array => Float32Array.from(arrays.uint16(count), fromLogCode);
  const row = about.whole ? null : arrays.uint32(n);
  const [x, y, z] = [axis(0, n), axis(1, n), axis(2, n)];
  const speed = codes(n);
  const force = codes(n);
  const contacts = arrays.bytes8(n);
  const a = arrays.uint32(about.contacts);
  const b = arrays.uint32(about.contacts);
  const pairForce = codes(about.contacts);
  const grain = arrays.uint32(about.wall_contacts);
  const wall = arrays.bytes8(about.wall_contacts);
  const [wallX, wallY, wallZ] = [axis(0, about.wall_contacts), axis(1, about.wall_contacts), axis(2, about.wall_contacts)];
  const wallForce = codes(about.wall_contacts);
  arrays.finish();
  return {
    about, size: n, id: row ? row.map((r) => grains.id[r]!) : grains.id, radius: row ? Float32Array.from(row, (r) => grains.radius[r]!) : grains.radius,
    x, y, z, speed, force, contacts, a, b, pairForce, grain, wall, wallX, wallY, wallZ, wallForce,
  };
}

// Row of a grain in the frame, -1 where it has none. Ids ascend.
export function rowOf(frame: Frame, id: number): number {
  let low = 0;
  let high = frame.size;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (frame.id[middle]! < id) low = middle + 1;
    else high = middle;
  }
  return low < frame.size && frame.id[low] === id ? low : -1;
}

// The frame to show for a grain that is jammed from `start` to `end`, with its peak at `peak`: of the frames in which `jammed` says it is, the one
// nearest to the peak; without one, the nearest at all. -1 where there are no frames.
export function frameFor(frames: readonly SceneFrame[], jammed: (frame: SceneFrame) => boolean, peak: number): { index: number; jammed: boolean } {
  let best = -1;
  let found = false;
  frames.forEach((frame, k) => {
    const is = jammed(frame);
    const nearer = best < 0 || Math.abs(frame.time - peak) < Math.abs(frames[best]!.time - peak);
    if ((is && !found) || (is === found && nearer)) {
      best = k;
      found = is;
    }
  });
  return { index: best, jammed: found };
}

export interface Bounds { low: Vector3; high: Vector3 } // m

// The box of the grains of some frames, without those that flew far off: a few grains must not make all others small. Far is more than a quarter of the
// length on which all but one in a hundred are.
export function boundsOf(frames: readonly Frame[]): Bounds {
  const bounds = { low: new Vector3(Infinity, Infinity, Infinity), high: new Vector3(-Infinity, -Infinity, -Infinity) };
  for (const frame of frames)
    for (const axis of ['x', 'y', 'z'] as const) {
      const sorted = Float32Array.from(frame[axis]).sort();
      const at = (share: number): number => sorted[Math.round(share * (sorted.length - 1))]!;
      const reach = 0.25 * (at(0.995) - at(0.005));
      for (let v = 0; v < frame.size; ++v) {
        const value = frame[axis][v]!;
        if (value < at(0.005) - reach || value > at(0.995) + reach) continue;
        bounds.low[axis] = Math.min(bounds.low[axis], value - frame.radius[v]!);
        bounds.high[axis] = Math.max(bounds.high[axis], value + frame.radius[v]!);
      }
    }
  return bounds;
}
