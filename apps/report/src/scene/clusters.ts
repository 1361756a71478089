// Clusters of jammed grains in a frame, and which of them carry force from blade to vessel: the rule of libjam/jamming/jam_clusters.cpp.
import { rowOf, type Frame } from './frame';

export interface Clusters {
  label: Int32Array;  // [grains] number of the cluster, -1: not jammed
  size: number[];     // grains of each, largest first
  bridges: boolean[];
}

export function clustersOf(frame: Frame, jammed: Uint8Array, least: number, roles: readonly string[]): Clusters {
  const parent = Int32Array.from({ length: frame.size }, (_, k) => k);
  const root = (v: number): number => {
    while (parent[v] !== v) v = parent[v] = parent[parent[v]!]!;
    return v;
  };
  for (let c = 0; c < frame.a.length; ++c) {
    const [a, b] = [frame.a[c]!, frame.b[c]!];
    if (jammed[a] && jammed[b] && frame.pairForce[c]! > least) parent[root(a)] = root(b);
  }
  const members = new Map<number, number[]>();
  for (let v = 0; v < frame.size; ++v) {
    if (!jammed[v]) continue;
    const list = members.get(root(v));
    if (list) list.push(v);
    else members.set(root(v), [v]);
  }
  const sorted = [...members.values()].sort((a, b) => b.length - a.length || a[0]! - b[0]!);
  const label = new Int32Array(frame.size).fill(-1);
  sorted.forEach((list, k) => list.forEach((v) => { label[v] = k; }));
  const blade = new Set<number>();
  const vessel = new Set<number>();
  for (let c = 0; c < frame.grain.length; ++c) {
    const k = label[frame.grain[c]!]!;
    if (k < 0 || !(frame.wallForce[c]! > least)) continue;
    if (roles[frame.wall[c]!] === 'blade') blade.add(k);
    if (roles[frame.wall[c]!] === 'vessel') vessel.add(k);
  }
  return { label, size: sorted.map((list) => list.length), bridges: sorted.map((_, k) => blade.has(k) && vessel.has(k)) };
}

// Those of the analysis itself.
export function clustersOfAnalysis(frame: Frame): Clusters {
  const { jammed, cluster, bridges } = frame.about;
  const label = new Int32Array(frame.size).fill(-1);
  const size = bridges.map(() => 0);
  jammed.forEach((id, k) => {
    size[cluster[k]!]! += 1;
    const row = rowOf(frame, id);
    if (row >= 0) label[row] = cluster[k]!;
  });
  return { label, size, bridges };
}
