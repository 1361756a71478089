// Contacts as tubes whose cross-section is proportional to the force.
import { Color, CylinderGeometry, DynamicDrawUsage, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion, Vector3 } from 'three';

export interface Tube {
  from: [number, number, number]; // mm
  to: [number, number, number];
  radius: number;                 // mm
  bridging: boolean;
}

// mm, of a tube that carries `force`, where `largest` is as thick as `most`.
export function tubeRadius(force: number, largest: number, most: number): number {
  return most * Math.max(Math.sqrt(Math.min(force / largest, 1)), 0.06);
}

export interface Tubes {
  mesh: () => InstancedMesh;
  set(tubes: readonly Tube[], nearer: number, chain: Color, bridge: Color): void; // nearer: mm
}

export function makeTubes(replace: (before: InstancedMesh, after: InstancedMesh) => void): Tubes {
  const geometry = new CylinderGeometry(1, 1, 1, 8, 1, true);
  const material = new MeshLambertMaterial();
  // Contacts lie inside the two grains: their depth is drawn `pull` nearer than they are, so that grains of their own do not hide them.
  const pull = { value: 0 };
  material.onBeforeCompile = (shader) => {
    shader.uniforms.pull = pull;
    shader.vertexShader = shader.vertexShader.replace('void main() {', 'uniform float pull;\nvoid main() {').replace('#include <project_vertex>', `#include <project_vertex>
      vec4 nearer = projectionMatrix * (mvPosition + vec4(0.0, 0.0, pull, 0.0));
      gl_Position.z = nearer.z / nearer.w * gl_Position.w;`);
  };
  let mesh = new InstancedMesh(geometry, material, 1);
  mesh.count = 0;
  mesh.frustumCulled = false;
  return {
    mesh: () => mesh,
    set(tubes, nearer, chain, bridge) {
      pull.value = nearer;
      if (tubes.length > mesh.instanceMatrix.count) {
        const larger = new InstancedMesh(geometry, material, Math.ceil(1.5 * tubes.length));
        larger.frustumCulled = false;
        replace(mesh, larger);
        mesh.dispose();
        mesh = larger;
      }
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      const y = new Vector3(0, 1, 0);
      const matrix = new Matrix4();
      tubes.forEach((tube, k) => {
        const from = new Vector3(...tube.from);
        const to = new Vector3(...tube.to);
        const length = from.distanceTo(to);
        const turn = new Quaternion().setFromUnitVectors(y, to.clone().sub(from).normalize());
        matrix.compose(from.add(to).multiplyScalar(0.5), turn, new Vector3(tube.radius, length, tube.radius));
        mesh.setMatrixAt(k, matrix);
        mesh.setColorAt(k, tube.bridging ? bridge : chain);
      });
      mesh.count = tubes.length;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    },
  };
}
