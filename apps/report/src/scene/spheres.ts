// Grains as instanced squares on which the fragment shader finds the sphere: exact at any distance, and two triangles a grain.
import { BufferAttribute, DynamicDrawUsage, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, ShaderMaterial, Vector4, Color } from 'three';

// What a grain is besides its colour; summed in its flag.
export const flagJammed = 1;
export const flagSelected = 2;

const vertex = `
in vec3 centre;
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
  place = middle + towards * size + (right * position.x + up * position.y) * size * 1.12;
  gl_Position = projectionMatrix * vec4(place, 1.0);
}`;

const fragment = `
precision highp float;
uniform mat4 projectionMatrix;
uniform vec3 jamColour;
uniform vec3 selectColour;
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
  pixel = vec4(lit, 1.0);
  vec4 clip = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}`;

export interface Spheres {
  mesh: Mesh;
  material: ShaderMaterial;
  resize(n: number): void;
  centre(): Float32Array;
  radius(): Float32Array;
  shade(): Uint8Array;
  changed(n: number): void;
  dispose(): void;
}

export function makeSpheres(): Spheres {
  const material = new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, glslVersion: GLSL3,
    uniforms: {
      cut: { value: new Vector4(0, 0, 0, 1) }, bulk: { value: 1 }, jamColour: { value: new Color() }, selectColour: { value: new Color() },
    },
  });
  let geometry = new InstancedBufferGeometry();
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  let room = -1;
  let centre = new InstancedBufferAttribute(new Float32Array(0), 3);
  let radius = new InstancedBufferAttribute(new Float32Array(0), 1);
  let shade = new InstancedBufferAttribute(new Uint8Array(0), 4, true);
  const resize = (n: number): void => {
    if (n <= room) return;
    room = n;
    geometry.dispose();
    geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    centre = new InstancedBufferAttribute(new Float32Array(3 * n), 3);
    radius = new InstancedBufferAttribute(new Float32Array(n), 1);
    shade = new InstancedBufferAttribute(new Uint8Array(4 * n), 4, true);
    for (const [name, attribute] of [['centre', centre], ['radius', radius], ['shade', shade]] as const) {
      attribute.setUsage(DynamicDrawUsage);
      geometry.setAttribute(name, attribute);
    }
    mesh.geometry = geometry;
  };
  resize(1);
  return {
    mesh, material, resize,
    centre: () => centre.array as Float32Array,
    radius: () => radius.array as Float32Array,
    shade: () => shade.array as Uint8Array,
    changed(n) {
      geometry.instanceCount = n;
      centre.needsUpdate = radius.needsUpdate = shade.needsUpdate = true;
    },
    dispose() {
      geometry.dispose();
      material.dispose();
    },
  };
}
