// Blade and vessel. Analytic walls are drawn as far as the grains reach; of vessels only the far side is drawn, so that they are cut away
// wherever one looks from.
import {
  BackSide, BufferAttribute, BufferGeometry, CylinderGeometry, DoubleSide, Group, Matrix4, Mesh, MeshLambertMaterial, PlaneGeometry, Quaternion, RingGeometry, SphereGeometry, Vector3,
  type Material,
} from 'three';
import type { SceneData, SceneWall } from '../data';
import { Arrays, type LoadSection } from '../island/sections';

const mm = 1000;
const vector = (v: readonly (number | null)[]): Vector3 => new Vector3(v[0] ?? 0, v[1] ?? 0, v[2] ?? 0);

// Turns the y axis of three's cylinders, or the z axis of its planes, into the wall's axis.
function along(geometry: BufferGeometry, from: Vector3, axis: Vector3, at: Vector3): BufferGeometry {
  const turn = new Quaternion().setFromUnitVectors(from, axis.clone().normalize());
  return geometry.applyMatrix4(new Matrix4().compose(at.clone().multiplyScalar(mm), turn, new Vector3(1, 1, 1)));
}

async function geometryOf(wall: SceneWall, scene: SceneData, load: LoadSection): Promise<BufferGeometry[]> {
  const point = vector(wall.point);
  const axis = vector(wall.axis);
  const low = vector(scene.low ?? []);
  const high = vector(scene.high ?? []);
  const size = low.distanceTo(high);
  // The ends along the axis: its own, or those of the box of all grains.
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new Vector3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z).sub(point).dot(axis));
  const ends = [wall.low ?? Math.min(...corners), wall.high ?? Math.max(...corners)] as const;
  const middle = point.clone().addScaledVector(axis, (ends[0] + ends[1]) / 2);
  const y = new Vector3(0, 1, 0);
  const z = new Vector3(0, 0, 1);
  if (wall.section !== undefined && wall.triangles !== undefined) {
    const arrays = new Arrays(await load(wall.section));
    const vertices = arrays.float32(3 * (wall.vertices ?? 0)).map((v) => mm * v);
    const triangles = arrays.uint32(3 * wall.triangles);
    const shared = new BufferGeometry();
    shared.setAttribute('position', new BufferAttribute(vertices, 3));
    shared.setIndex(new BufferAttribute(triangles, 1));
    const flat = shared.toNonIndexed(); // each triangle its own normal: edges stay sharp
    flat.computeVertexNormals();
    return [flat];
  }
  if (wall.section !== undefined && wall.spheres !== undefined) {
    const all = new Arrays(await load(wall.section)).float32(4 * wall.spheres);
    return Array.from({ length: Math.min(wall.spheres, 3000) }, (_, k) =>
      new SphereGeometry(mm * all[4 * k + 3]!, 12, 8).translate(mm * all[4 * k]!, mm * all[4 * k + 1]!, mm * all[4 * k + 2]!));
  }
  switch (wall.kind) {
    case 'cylinder':
      return [along(new CylinderGeometry(mm * wall.radius, mm * wall.radius, mm * (ends[1] - ends[0]), 96, 1, true), y, axis, middle)];
    case 'cone':
      return [along(new CylinderGeometry(mm * wall.high_radius, mm * wall.radius, mm * (ends[1] - ends[0]), 96, 1, true), y, axis, middle)];
    case 'disc':
      return [along(new RingGeometry(mm * wall.hole_radius, mm * wall.radius, 96), z, axis, point)];
    case 'plane': {
      const centre = low.clone().add(high).multiplyScalar(0.5);
      const foot = centre.addScaledVector(axis, -centre.clone().sub(point).dot(axis));
      return [along(new PlaneGeometry(mm * size, mm * size), z, axis, foot)];
    }
    default:
      return [];
  }
}

export interface Walls {
  group: Group;
  place(poses: readonly number[][]): void;
  show(vessel: boolean, blade: boolean, faint: boolean): void; // faint: one sees through the blade
  colour(blade: number, vessel: number): void;
}

export async function makeWalls(scene: SceneData, load: LoadSection): Promise<Walls> {
  const group = new Group();
  const bodies: Group[] = [];
  const walls = scene.walls ?? [];
  const round = walls.find((w) => w.role === 'vessel' && w.kind === 'cylinder');
  for (const wall of walls) {
    const body = new Group();
    const blade = wall.role === 'blade';
    const material: Material = blade
      ? new MeshLambertMaterial({ side: DoubleSide })
      : new MeshLambertMaterial({ side: wall.kind === 'cylinder' || wall.kind === 'cone' ? BackSide : DoubleSide, transparent: true, opacity: 0.35, depthWrite: false });
    let geometries = await geometryOf(wall, scene, load);
    // The floor of a round vessel is as large as the vessel.
    if (wall.kind === 'plane' && round && Math.abs(vector(wall.axis).dot(vector(round.axis))) > 0.999)
      geometries = [along(new RingGeometry(0, mm * round.radius, 96), new Vector3(0, 0, 1), vector(wall.axis), vector(wall.point))];
    for (const geometry of geometries) body.add(new Mesh(geometry, material));
    body.userData = { role: wall.role, material };
    group.add(body);
    bodies.push(body);
  }
  return {
    group,
    place(poses) {
      bodies.forEach((body, k) => {
        const p = poses[k];
        if (!p) return;
        body.position.set(mm * p[0]!, mm * p[1]!, mm * p[2]!);
        body.quaternion.set(p[4]!, p[5]!, p[6]!, p[3]!);
      });
    },
    show(vessel, blade, faint) {
      for (const body of bodies) {
        body.visible = body.userData.role === 'blade' ? blade : vessel;
        if (body.userData.role !== 'blade') continue;
        const material = body.userData.material as MeshLambertMaterial;
        if (material.transparent !== faint) material.needsUpdate = true;
        material.transparent = faint;
        material.opacity = faint ? 0.3 : 1;
        material.depthWrite = !faint;
      }
    },
    colour(blade, vessel) {
      for (const body of bodies) (body.userData.material as MeshLambertMaterial).color.setHex(body.userData.role === 'blade' ? blade : vessel);
    },
  };
}
