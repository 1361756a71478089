// The 3D view itself: a canvas, a camera, what is in the frame. Draws when something changed, never otherwise. Lengths in mm.
import {
  AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { SceneData } from '../data';
import type { LoadSection } from '../island/sections';
import type { Clusters } from './clusters';
import { clusterColour, shareOf, unknownColour, viridis, type Range, type Rgb } from './colours';
import type { Bounds, Frame } from './frame';
import { flagJammed, flagSelected, makeSpheres } from './spheres';
import { makeTubes, tubeRadius, type Tube } from './tubes';
import { makeWalls, type Walls } from './walls';

const mm = 1000;

export type ColourBy = 'speed' | 'force' | 'contacts' | 'cluster';
export type Blade = 'solid' | 'faint' | 'hidden';
export type Chains = 'none' | 'bridges' | 'strong' | 'mean';

export interface Look {
  by: ColourBy; range: Range;
  bulk: number;      // size of grains that are not jammed, 1: as they are
  cut: boolean;      // leave out the half towards the camera
  chains: Chains;
  vessel: boolean; blade: Blade;
}

export interface Shown {
  frame: Frame; jammed: Uint8Array; clusters: Clusters; selected: number; // id, -1: none
}

export interface Viewer {
  canvas: HTMLCanvasElement;
  show(shown: Shown, look: Look): void;
  resize(): void;
  recolour(): void;
  reset(): void;
  face(row: number): void;   // the whole, with this grain on the near side unless the whole is a strip
  lookAt(row: number): void; // close up
  turn(right: number, up: number): void;
  zoom(by: number): void;
  pick(x: number, y: number): number;  // row of the grain at a point of the canvas, -1
  place(row: number): { x: number; y: number }; // where it is on the canvas, px
  drawNow(): void;
  thickest(): number;                  // N, of the tubes shown
  isDrawnJammed(row: number): boolean;
}

// Which contacts are tubes, as multiples of the mean force.
const strong = 5;

// `bounds`: what the view is laid out for.
export async function makeViewer(scene: SceneData, load: LoadSection, bounds: Bounds, box: HTMLElement, rendered: () => void): Promise<Viewer> {
  const renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  const canvas = renderer.domElement;
  box.append(canvas);
  const low = bounds.low.clone().multiplyScalar(mm);
  const high = bounds.high.clone().multiplyScalar(mm);
  const centre = low.clone().add(high).multiplyScalar(0.5);
  const size = low.distanceTo(high);
  // What is about as long as wide is looked at from where the grain in question is near; a strip from its long side.
  const [long, wide] = [high.x - low.x, high.y - low.y].sort((a, b) => b - a) as [number, number];
  const strip = long > 1.5 * wide;
  const standard = new Vector3(-0.55, -1, 0.62).normalize();
  const world = new Scene();
  const camera = new PerspectiveCamera(32, 2, size / 200, size * 20);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, canvas);
  const ambient = new AmbientLight(0xffffff, 1.5);
  const sun = new DirectionalLight(0xffffff, 2.2);
  world.add(ambient, camera);
  camera.add(sun);
  sun.position.set(-0.5, 0.8, 1);
  const spheres = makeSpheres();
  world.add(spheres.mesh);
  const tubes = makeTubes((before, after) => {
    world.remove(before);
    world.add(after);
  });
  world.add(tubes.mesh());
  const walls: Walls = await makeWalls(scene, load, bounds);
  world.add(walls.group);

  let shown: Shown | null = null;
  let look: Look | null = null;
  let thickest = 0;
  let wanted = false;
  const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  const drawNow = (): void => {
    const away = camera.position.clone().sub(controls.target).normalize();
    const flat = new Vector3(away.x, away.y, 0);
    if (flat.lengthSq() < 1e-4) flat.copy(away);
    flat.normalize();
    spheres.material.uniforms.cut!.value.set(flat.x, flat.y, flat.z, look?.cut ? flat.dot(centre) : 1e9);
    renderer.render(world, camera);
    rendered();
  };
  const draw = (): void => {
    if (wanted) return;
    wanted = true;
    requestAnimationFrame(() => {
      wanted = false;
      drawNow();
    });
  };
  controls.addEventListener('change', draw);

  const reset = (): void => {
    controls.target.copy(centre);
    const distance = (0.5 * size) / Math.tan((camera.fov * Math.PI) / 360) / Math.min(1, camera.aspect * 0.8);
    camera.position.copy(centre).addScaledVector(standard, distance);
    controls.update();
    draw();
  };

  const colourOf = (s: Shown, l: Look, row: number): Rgb => {
    if (l.by === 'cluster') return clusterColour(s.clusters.label[row]!);
    const value = l.by === 'speed' ? s.frame.speed[row]! : l.by === 'force' ? s.frame.force[row]! : s.frame.contacts[row]!;
    return Number.isFinite(value) ? viridis(shareOf(value, l.range)) : unknownColour;
  };

  const fillTubes = (s: Shown, l: Look): void => {
    const { frame, clusters } = s;
    const list: Tube[] = [];
    const least = l.chains === 'mean' ? frame.about.mean_force : l.chains === 'strong' ? strong * frame.about.mean_force : Infinity;
    const bridging = (row: number): boolean => {
      const label = clusters.label[row]!;
      return label >= 0 && clusters.bridges[label]!;
    };
    thickest = 0;
    let mean = 0;
    for (let v = 0; v < frame.size; ++v) mean += (mm * frame.radius[v]!) / frame.size;
    const consider = (draw: (force: number, bridge: boolean) => void): void => {
      for (let c = 0; c < frame.a.length; ++c) {
        const bridge = bridging(frame.a[c]!) && bridging(frame.b[c]!);
        if (frame.pairForce[c]! > least || (bridge && l.chains !== 'none')) draw(frame.pairForce[c]!, bridge);
      }
      for (let c = 0; c < frame.grain.length; ++c) {
        const bridge = bridging(frame.grain[c]!);
        if (frame.wallForce[c]! > least || (bridge && l.chains !== 'none')) draw(frame.wallForce[c]!, bridge);
      }
    };
    consider((force) => { thickest = Math.max(thickest, force); });
    const radius = (force: number): number => tubeRadius(force, thickest, 0.28 * mean);
    const at = (row: number): [number, number, number] => [mm * frame.x[row]!, mm * frame.y[row]!, mm * frame.z[row]!];
    for (let c = 0; c < frame.a.length; ++c) {
      const bridge = bridging(frame.a[c]!) && bridging(frame.b[c]!);
      if (frame.pairForce[c]! > least || (bridge && l.chains !== 'none'))
        list.push({ from: at(frame.a[c]!), to: at(frame.b[c]!), radius: radius(frame.pairForce[c]!), bridging: bridge });
    }
    for (let c = 0; c < frame.grain.length; ++c) {
      const bridge = bridging(frame.grain[c]!);
      if (frame.wallForce[c]! > least || (bridge && l.chains !== 'none'))
        list.push({ from: at(frame.grain[c]!), to: [mm * frame.wallX[c]!, mm * frame.wallY[c]!, mm * frame.wallZ[c]!], radius: radius(frame.wallForce[c]!), bridging: bridge });
    }
    tubes.set(list, 0.8 * mean, new Color(css('chain')), new Color(css('jam')));
  };

  const fill = (): void => {
    if (!shown || !look) return;
    const { frame, jammed, selected } = shown;
    const n = frame.size;
    spheres.resize(n);
    for (let v = 0; v < n; ++v)
      spheres.set(v, mm * frame.x[v]!, mm * frame.y[v]!, mm * frame.z[v]!, mm * frame.radius[v]!, colourOf(shown, look, v),
        (jammed[v] ? flagJammed : 0) + (frame.id[v] === selected ? flagSelected : 0));
    spheres.changed(n);
    spheres.material.uniforms.bulk!.value = look.bulk;
    fillTubes(shown, look);
    walls.place(frame.about.poses);
    walls.show(look.vessel, look.blade !== 'hidden', look.blade === 'faint');
    draw();
  };

  const recolour = (): void => {
    const colour = (name: string): Color => new Color().setStyle(css(name));
    world.background = colour('scene');
    walls.colour(colour('blade').getHex(), colour('vessel').getHex());
    // The shader writes its colours as they are, without the renderer's conversion.
    const plain = (name: string): Color => colour(name).convertLinearToSRGB();
    spheres.material.uniforms.jamColour!.value = plain('jam');
    spheres.material.uniforms.selectColour!.value = plain('select');
    fill();
    draw();
  };

  const resize = (): void => {
    const width = box.clientWidth;
    const height = box.clientHeight;
    if (width < 20 || height < 20) return;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  };
  resize();
  recolour();
  reset();

  const turn = (right: number, up: number): void => {
    const arm = camera.position.clone().sub(controls.target);
    arm.applyAxisAngle(new Vector3(0, 0, 1), right);
    const side = new Vector3().crossVectors(new Vector3(0, 0, 1), arm).normalize();
    const turned = arm.clone().applyAxisAngle(side, -up);
    if (Math.abs(turned.clone().normalize().z) < 0.995) arm.copy(turned);
    camera.position.copy(controls.target).add(arm);
    controls.update();
    draw();
  };

  return {
    canvas, resize, recolour, reset, turn, drawNow,
    show(s, l) {
      shown = s;
      look = l;
      fill();
    },
    face(row) {
      if (!shown || strip) return;
      const arm = camera.position.clone().sub(controls.target);
      const out = new Vector3(mm * shown.frame.x[row]! - centre.x, mm * shown.frame.y[row]! - centre.y, 0);
      if (out.lengthSq() > 1e-6) camera.position.copy(controls.target).add(arm.applyAxisAngle(new Vector3(0, 0, 1), Math.atan2(out.y, out.x) + 0.5 - Math.atan2(arm.y, arm.x)));
      controls.update();
      draw();
    },
    lookAt(row) {
      if (!shown) return;
      const f = shown.frame;
      const grain = new Vector3(mm * f.x[row]!, mm * f.y[row]!, mm * f.z[row]!);
      const out = new Vector3(grain.x - centre.x, grain.y - centre.y, 0);
      // From outside and above, a little to the side: blade, grain and wall are then beside each other.
      const from = !strip && out.lengthSq() > 1e-6 ? out.normalize().applyAxisAngle(new Vector3(0, 0, 1), 0.5).add(new Vector3(0, 0, 0.75)).normalize() : standard;
      controls.target.copy(grain);
      camera.position.copy(grain).addScaledVector(from, Math.min(34 * mm * f.radius[row]!, size));
      controls.update();
      draw();
    },
    zoom(by) {
      const arm = camera.position.clone().sub(controls.target).multiplyScalar(by);
      camera.position.copy(controls.target).add(arm);
      controls.update();
      draw();
    },
    pick(px, py) {
      if (!shown || !look) return -1;
      const f = shown.frame;
      const ray = new Vector3((px / canvas.clientWidth) * 2 - 1, 1 - (py / canvas.clientHeight) * 2, 0.5).unproject(camera).sub(camera.position).normalize();
      const eye = camera.position;
      const cut = spheres.material.uniforms.cut!.value as { x: number; y: number; z: number; w: number };
      let best = -1;
      let nearest = Infinity;
      for (let v = 0; v < f.size; ++v) {
        const kept = shown.jammed[v] || f.id[v] === shown.selected;
        const radius = mm * f.radius[v]! * (kept ? 1 : look.bulk);
        const [x, y, z] = [mm * f.x[v]!, mm * f.y[v]!, mm * f.z[v]!];
        if (radius <= 0 || (!kept && cut.x * x + cut.y * y + cut.z * z > cut.w)) continue;
        const [dx, dy, dz] = [x - eye.x, y - eye.y, z - eye.z];
        const along = dx * ray.x + dy * ray.y + dz * ray.z;
        const inside = along * along - (dx * dx + dy * dy + dz * dz) + radius * radius;
        if (inside < 0) continue;
        const distance = along - Math.sqrt(inside);
        if (distance > 0 && distance < nearest) {
          nearest = distance;
          best = v;
        }
      }
      return best;
    },
    place(row) {
      const f = shown!.frame;
      camera.updateMatrixWorld();
      const p = new Vector3(mm * f.x[row]!, mm * f.y[row]!, mm * f.z[row]!).project(camera);
      return { x: ((p.x + 1) / 2) * canvas.clientWidth, y: ((1 - p.y) / 2) * canvas.clientHeight };
    },
    thickest: () => thickest,
    isDrawnJammed: (row) => row >= 0 && (spheres.flag(row) & flagJammed) !== 0,
  };
}
