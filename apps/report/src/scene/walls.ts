// Blade and vessel. Analytic walls that rest are drawn as far as the grains reach; of vessels only the far side is drawn, so that they are cut away
// wherever one looks from. Glued grains are drawn like grains.
import {
  BackSide, BufferAttribute, BufferGeometry, CylinderGeometry, DoubleSide, FrontSide, Group, Matrix4, Mesh, MeshLambertMaterial, PlaneGeometry, Quaternion, RingGeometry, Vector3,
  type Side,
} from 'three';
import type { SceneData, SceneWall } from '../data';
import { Arrays, type LoadSection } from '../island/sections';
import { unknownColour } from './colours';
import type { Bounds } from './frame';
import { makeSpheres, type Spheres } from './spheres';

const mm = 1000;
const vector = (v: readonly (number | null)[]): Vector3 => new Vector3(v[0] ?? 0, v[1] ?? 0, v[2] ?? 0);

// Turns the y axis of three's cylinders, or the z axis of its planes, into the wall's axis.
function along(geometry: BufferGeometry, from: Vector3, axis: Vector3, at: Vector3): BufferGeometry {
  const turn = new Quaternion().setFromUnitVectors(from, axis.clone().normalize());
  return geometry.applyMatrix4(new Matrix4().compose(at.clone().multiplyScalar(mm), turn, new Vector3(1, 1, 1)));
}

// The corners of what is left of a plane in a box, in order about `normal`. Fewer than three: the plane misses it.
export function planeInBox(point: Vector3, normal: Vector3, box: Bounds): Vector3[] {
  const corner = (k: number): Vector3 => new Vector3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z);
  const found: Vector3[] = [];
  for (let k = 0; k < 8; ++k)
    for (const bit of [1, 2, 4]) {
      if (k & bit) continue;
      const [a, b] = [corner(k), corner(k | bit)];
      const [at, to] = [a.clone().sub(point).dot(normal), b.clone().sub(point).dot(normal)];
      if (at * to > 0 || at === to) continue;
      const crossing = a.lerp(b, at / (at - to));
      if (!found.some((other) => other.distanceTo(crossing) < 1e-9 * box.low.distanceTo(box.high))) found.push(crossing);
    }
  if (found.length === 0) return found;
  const middle = found.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(found.length);
  const right = found[0]!.clone().sub(middle);
  const up = new Vector3().crossVectors(normal, right);
  const angle = (corner: Vector3): number => Math.atan2(corner.clone().sub(middle).dot(up), corner.clone().sub(middle).dot(right));
  return found.sort((a, b) => angle(a) - angle(b));
}

// The stretch of the axis on which a cylinder or cone is drawn: as far as it goes itself, and in a box no farther than the box.
export function endsInBox(low: number | null, high: number | null, point: Vector3, axis: Vector3, box: Bounds): [number, number] {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new Vector3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z).sub(point).dot(axis));
  const ends: [number, number] = [Math.max(low ?? -Infinity, Math.min(...corners)), Math.min(high ?? Infinity, Math.max(...corners))];
  return ends[0] < ends[1] ? ends : [low ?? Math.min(...corners), high ?? Math.max(...corners)];
}

const facing = new Vector3(0, 0, 1); // of three's planes, rings and discs
const upright = new Vector3(0, 1, 0); // of its cylinders

async function meshOf(wall: SceneWall, load: LoadSection): Promise<BufferGeometry> {
  const arrays = new Arrays(await load(wall.section!));
  const vertices = arrays.float32(3 * (wall.vertices ?? 0)).map((v) => mm * v);
  const shared = new BufferGeometry();
  shared.setAttribute('position', new BufferAttribute(vertices, 3));
  shared.setIndex(new BufferAttribute(arrays.uint32(3 * wall.triangles!), 1));
  const flat = shared.toNonIndexed(); // each triangle its own normal: edges stay sharp
  flat.computeVertexNormals();
  return flat;
}

// Of an analytic wall. `rests`: where its body frame is that of the laboratory in all frames, so that it can be cut off at `box`.
function shapeOf(wall: SceneWall, box: Bounds, rests: boolean): BufferGeometry | null {
  const point = vector(wall.point);
  const axis = vector(wall.axis).normalize();
  const size = box.low.distanceTo(box.high);
  switch (wall.kind) {
    case 'cylinder':
    case 'cone': {
      const [low, high] = rests ? endsInBox(wall.low, wall.high, point, axis, box) : [wall.low ?? -size / 2, wall.high ?? size / 2];
      const radius = (at: number): number => wall.kind === 'cylinder' ? wall.radius : wall.radius + ((wall.high_radius - wall.radius) * (at - wall.low!)) / (wall.high! - wall.low!);
      return along(new CylinderGeometry(mm * radius(high), mm * radius(low), mm * (high - low), 96, 1, true), upright, axis, point.clone().addScaledVector(axis, (low + high) / 2));
    }
    case 'disc':
      return along(new RingGeometry(mm * wall.hole_radius, mm * wall.radius, 96), facing, axis, point);
    case 'plane': {
      if (!rests) return along(new PlaneGeometry(mm * size, mm * size), facing, axis, point);
      const corners = planeInBox(point, axis, box);
      const geometry = new BufferGeometry().setFromPoints(corners.map((corner) => corner.multiplyScalar(mm)));
      geometry.setIndex(corners.slice(2).flatMap((_, k) => [0, k + 1, k + 2]));
      geometry.computeVertexNormals();
      return geometry;
    }
    default:
      return null;
  }
}

// The side from which a wall of the vessel is seen: the one that grains are on. Sheets and meshes have two.
function farSide(wall: SceneWall): Side {
  if (wall.kind === 'plane') return FrontSide;
  if (wall.kind !== 'cylinder' && wall.kind !== 'cone') return DoubleSide;
  return wall.free === 'outside' ? FrontSide : BackSide;
}

// Whether a pose is that of the laboratory.
const atHome = (pose: readonly number[] | undefined): boolean => pose === undefined || pose.every((v, k) => v === (k === 3 ? 1 : 0));

interface Body {
  group: Group; blade: boolean;
  material: MeshLambertMaterial | null; // of a surface
  spheres: Spheres | null; count: number; // of glued grains
}

// Whether there is something to draw of a wall: foreign data may know no more than its name.
export const hasShape = (wall: SceneWall): boolean => wall.section !== undefined || ['plane', 'cylinder', 'cone', 'disc'].includes(wall.kind);

export interface Walls {
  group: Group;
  place(poses: readonly number[][]): void;
  show(vessel: boolean, blade: boolean, faint: boolean): void; // faint: one sees through the blade
  colour(blade: number, vessel: number): void;
}

export async function makeWalls(scene: SceneData, load: LoadSection, box: Bounds): Promise<Walls> {
  const group = new Group();
  const bodies: Body[] = [];
  const walls = scene.walls ?? [];
  const round = walls.find((w) => w.role === 'vessel' && w.kind === 'cylinder');
  for (const [k, wall] of walls.entries()) {
    const rests = scene.frames.every((frame) => atHome(frame.poses[k]));
    const body: Body = { group: new Group(), blade: wall.role === 'blade', material: null, spheres: null, count: 0 };
    if (wall.section !== undefined && wall.spheres !== undefined) {
      const all = new Arrays(await load(wall.section)).float32(4 * wall.spheres).map((v) => mm * v);
      body.count = wall.spheres;
      body.spheres = makeSpheres();
      body.spheres.resize(body.count);
      for (let at = 0; at < body.count; ++at) body.spheres.set(at, all[4 * at]!, all[4 * at + 1]!, all[4 * at + 2]!, all[4 * at + 3]!, unknownColour, 0);
      body.group.add(body.spheres.mesh);
    } else {
      // The floor of a round vessel is as large as the vessel.
      const floor = wall.kind === 'plane' && rests && round && Math.abs(vector(wall.axis).dot(vector(round.axis))) > 0.999;
      const geometry = wall.section !== undefined ? await meshOf(wall, load)
        : floor ? along(new RingGeometry(0, mm * round.radius, 96), facing, vector(wall.axis), vector(wall.point)) : shapeOf(wall, box, rests);
      body.material = body.blade ? new MeshLambertMaterial({ side: DoubleSide }) : new MeshLambertMaterial({ side: farSide(wall), transparent: true, opacity: 0.35, depthWrite: false });
      if (geometry) body.group.add(new Mesh(geometry, body.material));
    }
    group.add(body.group);
    bodies.push(body);
  }
  return {
    group,
    place(poses) {
      bodies.forEach((body, k) => {
        const p = poses[k];
        if (!p) return;
        body.group.position.set(mm * p[0]!, mm * p[1]!, mm * p[2]!);
        body.group.quaternion.set(p[4]!, p[5]!, p[6]!, p[3]!);
      });
    },
    show(vessel, blade, faint) {
      for (const body of bodies) {
        body.group.visible = body.blade ? blade : vessel;
        if (!body.blade) continue;
        const material = body.material ?? body.spheres!.material;
        if (material.transparent !== faint) material.needsUpdate = true;
        material.transparent = faint;
        material.depthWrite = !faint;
        if (body.material) body.material.opacity = faint ? 0.3 : 1;
        else body.spheres!.material.uniforms.opacity!.value = faint ? 0.3 : 1;
      }
    },
    colour(blade, vessel) {
      for (const body of bodies) {
        const hex = body.blade ? blade : vessel;
        body.material?.color.setHex(hex);
        if (!body.spheres) continue;
        for (let at = 0; at < body.count; ++at) body.spheres.tint(at, [hex >> 16, (hex >> 8) & 255, hex & 255]);
        body.spheres.changed(body.count);
      }
    },
  };
}
