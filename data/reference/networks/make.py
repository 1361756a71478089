#!/usr/bin/python3
"""Contact networks of real frames and random ones, and what networkx and numpy find in them.

    data/reference/networks/make.py RUN.h5      (apt-get install python3-networkx python3-h5py)

RUN.h5: of `jamscope simulate data/cases/ft4_quick.toml --until "1 ms"`, last frame. Writes beside itself
  networks.csv   network, kind, ...: `grain` (a: id; x in `value`, y, z: m), `touch` (a, b: ids; value: normal force, N), `blade` and
                 `vessel` (a: id; value: normal force on it, N); floats with nine digits, which give back the same float32
  metrics.csv    network, metric, value
The dumps of LAMMPS and LIGGGHTS are those in data/formats: last frame. LIGGGHTS lists no contacts with its vessel.
"""
import csv
import lzma
import random
import sys
from pathlib import Path

import h5py
import networkx
import numpy

HERE = Path(__file__).resolve().parent
FORMATS = HERE.parents[1] / "formats"


class Contacts:
    def __init__(self):
        self.place, self.touch, self.blade, self.vessel = {}, {}, [], []


def single(value):
    return float(numpy.float32(value))


def quick(path):
    c = Contacts()
    with h5py.File(path, "r", swmr=True) as file:
        frames, particles = file["frames"], file["particles"]
        of = lambda kind: slice(int(frames[f"{kind}_start"][-1]), int(frames[f"{kind}_start"][-1]) + int(frames[f"{kind}_count"][-1]))
        rows, pp, pw = of("particle"), of("pp"), of("pw")
        ids = particles["id"][rows]
        for name, x in zip(ids, particles["position"][rows]):
            c.place[int(name)] = tuple(map(float, x))
        # The whole of the normal force, in double as the sum of two floats.
        force = lambda group, part: file[f"contacts/{group}/normal_force"][part].astype(float) + file[f"contacts/{group}/damping_force"][part]
        for (a, b), f in zip(file["contacts/pp/row"][pp], force("pp", pp)):
            c.touch[int(ids[a]), int(ids[b])] = single(f)
        roles = {int(w.attrs["id"]): w.attrs["role"].decode().rstrip("\0") for w in file["walls"].values()}
        for a, wall, f in zip(file["contacts/pw/row"][pw], file["contacts/pw/wall"][pw], force("pw", pw)):
            if roles[int(wall)] in ("blade", "vessel"):
                getattr(c, roles[int(wall)]).append((int(ids[a]), single(f)))
    return c


def last_table(name):
    """Rows of the last frame of a dump, by the names in its header."""
    rows, header = [], []
    with lzma.open(FORMATS / name, "rt") as file:
        for line in file:
            if line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
                header, rows = line.split()[2:], []
            elif line.startswith("ITEM"):
                header = []
            elif header:
                rows.append(dict(zip(header, map(float, line.split()))))
    return rows


def places(c, name):
    for row in last_table(name):
        c.place[int(row["id"])] = tuple(single(row[k]) for k in "xyz")


def lammps():
    c = Contacts()
    places(c, "lammps.particles.dump.xz")
    for row in last_table("lammps.pair.local.xz"):
        c.touch[tuple(sorted((int(row["id1"]), int(row["id2"]))))] = single(row["Fn"])
    for row in last_table("lammps.wall.dump.xz"):
        x = numpy.array(c.place[int(row["id"])])
        for array, role in (("f_wc", "vessel"), ("f_b1", "blade"), ("f_b2", "blade")):
            if row[f"{array}[1]"] == 0:
                continue
            force = numpy.array([row[f"{array}[{k}]"] for k in (2, 3, 4)])
            point = numpy.array([row[f"{array}[{k}]"] for k in (5, 6, 7)])
            away = (x - point) / numpy.linalg.norm(x - point)
            getattr(c, role).append((int(row["id"]), single(force @ away)))
    return c


def liggghts():
    c = Contacts()
    places(c, "liggghts.particles.dump.xz")
    for row in last_table("liggghts.pair.local.xz"):
        a, b = int(row["c_pc[1]"]), int(row["c_pc[2]"])
        away = numpy.array(c.place[a]) - numpy.array(c.place[b])
        force = numpy.array([row[f"c_pc[{k}]"] for k in (4, 5, 6)])
        c.touch[tuple(sorted((a, b)))] = single(force @ away / numpy.linalg.norm(away))
    for row in last_table("liggghts.wall.local.xz"):
        force = numpy.array([row[f"c_wc[{k}]"] for k in (10, 11, 12)])
        c.blade.append((int(row["c_wc[9]"]), single(numpy.linalg.norm(force))))
    return c


def geometric(seed):
    """Grains in a cube that touch where they are near, exponential forces of which a fifth pull, walls left and right."""
    chance = random.Random(seed)
    c = Contacts()
    count, reach = 30, 0.25 + 0.004 * seed
    for name in range(count):
        c.place[7 * name + 1] = tuple(single(chance.random()) for _ in range(3))
    names = list(c.place)
    for k, a in enumerate(names):
        for b in names[k + 1:]:
            if numpy.linalg.norm(numpy.subtract(c.place[a], c.place[b])) < reach:
                force = chance.expovariate(1)
                c.touch[a, b] = single(-force if chance.random() < 0.2 else force)
        if c.place[a][0] < 0.25:
            c.blade.append((a, single(chance.expovariate(0.5))))
        if c.place[a][0] > 0.75:
            c.vessel.append((a, single(chance.expovariate(0.5))))
    return c


def conductance(loads):
    """Between the ends of a network of conductances: inverse of the effective resistance, from the pseudoinverse of the Laplacian."""
    if not networkx.has_path(loads, "blade", "vessel"):
        return 0
    nodes = sorted(networkx.node_connected_component(loads, "blade"), key=str)
    inverse = numpy.linalg.pinv(networkx.laplacian_matrix(loads, nodes, weight="capacity").toarray(), rcond=1e-14, hermitian=True)
    b, v = nodes.index("blade"), nodes.index("vessel")
    return 1 / (inverse[b, b] + inverse[v, v] - 2 * inverse[b, v])


def metrics(c):
    graph = networkx.Graph()
    graph.add_nodes_from(c.place)
    graph.add_edges_from(c.touch)
    n, e = graph.number_of_nodes(), graph.number_of_edges()
    parts = list(networkx.connected_components(graph))
    with_pairs = [v for v in graph if graph.degree(v) >= 2]
    clustering = networkx.clustering(graph, with_pairs)
    repulsive = {pair: f for pair, f in c.touch.items() if f > 0}
    mean = sum(repulsive.values()) / len(repulsive)
    yield "coordination", 2 * e / n
    yield "component_count", len(parts)
    yield "largest_component_share", max(map(len, parts)) / n
    yield "largest_core_number", max(networkx.core_number(graph).values())
    yield "triangle_count", sum(networkx.triangles(graph).values()) / 3
    yield "transitivity", networkx.transitivity(graph)
    yield "mean_clustering", sum(clustering.values()) / len(clustering)
    yield "independent_cycles", e - n + len(parts)
    yield "cut_edge_count", sum(1 for _ in networkx.bridges(graph))
    yield "articulation_point_count", sum(1 for _ in networkx.articulation_points(graph))
    # networkx halves the sum over the pairs of undirected graphs.
    through = networkx.betweenness_centrality_subset(graph, sorted({a for a, _ in c.blade}), sorted({a for a, _ in c.vessel}))
    yield "largest_bridge_betweenness", 2 * max(through.values())
    yield "mean_repulsive_force", mean
    yield "strong_contact_share", sum(f > mean for f in repulsive.values()) / len(repulsive)
    for name, weight in (("fabric_anisotropy", lambda f: 1.0), ("force_fabric_anisotropy", lambda f: max(f, 0)),
                         ("strong_fabric_anisotropy", lambda f: float(f > mean)),
                         ("weak_fabric_anisotropy", lambda f: float(0 < f <= mean))):
        branches = numpy.array([numpy.subtract(c.place[b], c.place[a]) for a, b in c.touch])
        unit = branches / numpy.linalg.norm(branches, axis=1)[:, None]
        w = numpy.array([weight(f) for f in c.touch.values()])
        fabric = numpy.einsum("c,ci,cj->ij", w, unit, unit) / w.sum()
        deviator = 7.5 * (fabric - numpy.eye(3) / 3)
        yield name, numpy.sqrt(1.5 * numpy.einsum("ij,ij", deviator, deviator))

    # Ends joined to the loads, as nodes of their own only here: for flows and for the tree.
    def with_ends(capacity):
        ends = networkx.Graph()
        ends.add_nodes_from(["blade", "vessel"])
        for (a, b), f in repulsive.items():
            ends.add_edge(a, b, capacity=capacity(f))
        for role in ("blade", "vessel"):
            for a, f in getattr(c, role):
                if f > 0:
                    before = ends.get_edge_data(role, a, {"capacity": 0, "strongest": 0})
                    ends.add_edge(role, a, capacity=before["capacity"] + capacity(f), strongest=max(before["strongest"], f))
        return ends

    loads = with_ends(lambda f: f)
    yield "bridge_flow", networkx.maximum_flow_value(loads, "blade", "vessel")
    yield "bridge_conductance", conductance(loads)
    # One edge a contact: several of one grain with a wall are as many.
    yield "contact_disjoint_load_paths", networkx.maximum_flow_value(with_ends(lambda f: 1), "blade", "vessel")
    ones = with_ends(lambda f: 1)
    yield "particle_disjoint_load_paths", networkx.node_connectivity(ones, "blade", "vessel")
    for (a, b), f in repulsive.items():
        loads[a][b]["strongest"] = f
    tree = networkx.maximum_spanning_tree(loads, weight="strongest")
    if networkx.has_path(tree, "blade", "vessel"):
        path = networkx.shortest_path(tree, "blade", "vessel")
        yield "bridge_strength", min(tree[a][b]["strongest"] for a, b in zip(path, path[1:]))
    else:
        yield "bridge_strength", 0


def main():
    networks = {"quick": quick(sys.argv[1]), "lammps": lammps(), "liggghts": liggghts()}
    networks.update({f"geometric_{seed}": geometric(seed) for seed in range(50)})
    with open(HERE / "networks.csv", "w", newline="") as out, open(HERE / "metrics.csv", "w", newline="") as found:
        rows, results = csv.writer(out, lineterminator="\n"), csv.writer(found, lineterminator="\n")
        rows.writerow(["network", "kind", "a", "b", "value", "y", "z"])
        results.writerow(["network", "metric", "value"])
        for name, c in networks.items():
            for a, x in sorted(c.place.items()):
                rows.writerow([name, "grain", a, "", *(f"{v:.9g}" for v in x)])
            for (a, b), f in sorted(c.touch.items()):
                rows.writerow([name, "touch", a, b, f"{f:.9g}", "", ""])
            for role in ("blade", "vessel"):
                for a, f in sorted(getattr(c, role)):
                    rows.writerow([name, role, a, "", f"{f:.9g}", "", ""])
            for metric, value in metrics(c):
                results.writerow([name, metric, repr(float(value))])


if __name__ == "__main__":
    main()
