// Grains as squares on which the fragment shader finds the sphere: exact at any distance, and two triangles a grain. Each grain's numbers stand at its
// four corners instead of once for an instance: software renderers draw instances one by one, ten times as slowly as this.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, GLSL3, Mesh, ShaderMaterial, Vector4, Color } from 'three';
import type { Rgb } from './colours';

// What a grain is besides its colour; summed in its flag.
export const flagJammed = 1;
export const flagSelected = 2;

const vertex = `
in float radius;
in vec4 shade; // colour, flag / 255
uniform vec4 cut;      // grains on its positive side are left out, unless they are jammed
uniform float bulk;    // size of grains that are not jammed
out vec3 place;
flat out vec3 middle;
flat out float size;
flat out vec3 colour;
flat out float flag;
void main() {
  vec3 centre = position;
  int corner = gl_VertexID & 3;
  vec2 side = vec2(corner == 0 || corner == 3 ? -1.0 : 1.0, corner < 2 ? -1.0 : 1.0);
  flag = floor(shade.a * 255.0 + 0.5);
  bool kept = flag > 0.5;
  size = radius * (kept ? 1.0 : bulk);
  colour = shade.rgb;
  vec4 view = modelViewMatrix * vec4(centre, 1.0);
  middle = view.xyz;
  if (size <= 0.0 || (!kept && dot(cut.xyz, centre) > cut.w)) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  // A square across the line of sight, a little larger than the sphere looks.
  vec3 towards = normalize(-middle);
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), towards));
  vec3 up = cross(towards, right);
  place = middle + towards * size + (right * side.x + up * side.y) * size * 1.12;
  gl_Position = projectionMatrix * vec4(place, 1.0);
}`;

const fragment = `
precision highp float;
uniform mat4 projectionMatrix;
uniform vec3 jamColour;
uniform vec3 selectColour;
uniform float opacity;
in vec3 place;
flat in vec3 middle;
flat in float size;
flat in vec3 colour;
flat in float flag;
out vec4 pixel;
void main() {
  vec3 ray = normalize(place);
  float along = dot(ray, middle);
  float inside = along * along - dot(middle, middle) + size * size;
  if (inside < 0.0) discard;
  vec3 hit = ray * (along - sqrt(inside));
  vec3 normal = (hit - middle) / size;
  float facing = -dot(normal, ray);
  float light = 0.42 + 0.58 * max(dot(normal, normalize(vec3(-0.35, 0.55, 0.76))), 0.0);
  vec3 lit = colour * light * (0.55 + 0.45 * smoothstep(0.0, 0.5, facing));
  bool selected = flag > 1.5;
  if (flag > 0.5 && mod(flag, 2.0) > 0.5 && facing < 0.62) lit = jamColour;
  if (selected && facing < 0.36) lit = selectColour;
  pixel = vec4(lit, opacity);
  vec4 clip = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}`;

export interface Spheres {
  mesh: Mesh;
  material: ShaderMaterial;
  resize(n: number): void; // room for so many
  set(k: number, x: number, y: number, z: number, radius: number, colour: Rgb, flag: number): void;
  tint(k: number, colour: Rgb): void;
  flag(k: number): number;
  changed(n: number): void; // so many are to be drawn
}

export function makeSpheres(): Spheres {
  const material = new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, glslVersion: GLSL3,
    uniforms: {
      cut: { value: new Vector4(0, 0, 0, 1) }, bulk: { value: 1 }, opacity: { value: 1 }, jamColour: { value: new Color() }, selectColour: { value: new Color() },
    },
  });
  let geometry = new BufferGeometry();
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  let room = 0;
  let centre = new BufferAttribute(new Float32Array(0), 3);
  let size = new BufferAttribute(new Float32Array(0), 1);
  let shade = new BufferAttribute(new Uint8Array(0), 4, true);
  const resize = (n: number): void => {
    if (n <= room) return;
    room = n;
    geometry.dispose();
    geometry = new BufferGeometry();
    centre = new BufferAttribute(new Float32Array(12 * n), 3);
    size = new BufferAttribute(new Float32Array(4 * n), 1);
    shade = new BufferAttribute(new Uint8Array(16 * n), 4, true);
    for (const [name, attribute] of [['position', centre], ['radius', size], ['shade', shade]] as const) {
      attribute.setUsage(DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
    }
    const index = new Uint32Array(6 * n);
    for (let k = 0; k < n; ++k) index.set([4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3], 6 * k);
    geometry.setIndex(new BufferAttribute(index, 1));
    mesh.geometry = geometry;
  };
  resize(1);
  const tint = (k: number, [r, g, b]: Rgb): void => {
    const bytes = shade.array;
    for (let corner = 4 * k; corner < 4 * k + 4; ++corner) {
      bytes[4 * corner] = r;
      bytes[4 * corner + 1] = g;
      bytes[4 * corner + 2] = b;
    }
  };
  return {
    mesh, material, resize, tint,
    set(k, x, y, z, radius, colour, flag) {
      for (let corner = 4 * k; corner < 4 * k + 4; ++corner) {
        centre.setXYZ(corner, x, y, z);
        size.setX(corner, radius);
        shade.array[4 * corner + 3] = flag;
      }
      tint(k, colour);
    },
    flag: (k) => shade.array[16 * k + 3]!,
    changed(n) {
      geometry.setDrawRange(0, 6 * n);
      centre.needsUpdate = size.needsUpdate = shade.needsUpdate = true;
    },
  };
}
