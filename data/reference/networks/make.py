#!/usr/bin/python3
"""Contact networks of real frames and random ones, and what networkx, igraph, GUDHI, voro++, scipy and numpy find in them.

    data/reference/networks/make.py RUN.h5
    (apt-get install python3-networkx python3-igraph python3-gudhi python3-pot python3-scipy python3-h5py voro++)

RUN.h5: of `jamscope simulate data/cases/ft4_quick.toml --until "1 ms"`, last frame. Writes beside itself
  networks.csv   network, kind, ...: `grain` (a: id; x in `value`, y, z, radius: m), `touch` (a, b: ids; value: normal force, N), `blade` and
                 `vessel` (a: id; value: normal force on it, N); floats with nine digits, which give back the same float32
  metrics.csv    network, metric, value; of a change: network, metric, value for the change from the network before it
  cells.csv      network, id, volume of the radical Voronoi cell in the box around all spheres of the network, m^3: as voro++ prints it
The dumps of LAMMPS and LIGGGHTS are those in data/formats: last frame. LIGGGHTS lists no contacts with its vessel.
"""
import csv
import lzma
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import gudhi
import gudhi.wasserstein
import h5py
import igraph
import networkx
import numpy
import scipy.sparse.csgraph
import scipy.spatial

HERE = Path(__file__).resolve().parent
FORMATS = HERE.parents[1] / "formats"


class Contacts:
    def __init__(self):
        self.place, self.radius, self.touch, self.blade, self.vessel = {}, {}, {}, [], []


def single(value):
    return float(numpy.float32(value))


def quick(path):
    c = Contacts()
    with h5py.File(path, "r", swmr=True) as file:
        frames, particles = file["frames"], file["particles"]
        of = lambda kind: slice(int(frames[f"{kind}_start"][-1]), int(frames[f"{kind}_start"][-1]) + int(frames[f"{kind}_count"][-1]))
        rows, pp, pw = of("particle"), of("pp"), of("pw")
        ids = particles["id"][rows]
        for name, x, radius in zip(ids, particles["position"][rows], particles["radius"][rows]):
            c.place[int(name)] = tuple(map(float, x))
            c.radius[int(name)] = float(radius)
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
        c.radius[int(row["id"])] = single(row["radius"])


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
        c.radius[7 * name + 1] = single(reach / 2)
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


def diagrams(c):
    """Persistence by force of the flag complex of the repulsive contacts, dimensions 0 and 1: (birth, death), death 0 for what stays."""
    tree = gudhi.SimplexTree()
    # GUDHI's filtrations ascend.
    for (a, b), f in c.touch.items():
        if f > 0:
            for v in (a, b):
                if not tree.find([v]) or tree.filtration([v]) > -f:
                    tree.insert([v], filtration=-f)
    for (a, b), f in c.touch.items():
        if f > 0:
            tree.insert([a, b], filtration=-f)
    tree.expansion(2)
    tree.compute_persistence(persistence_dim_max=True)
    for dimension in (0, 1):
        pairs = tree.persistence_intervals_in_dimension(dimension)
        yield numpy.array([(-birth, 0 if numpy.isinf(death) else -death) for birth, death in pairs]).reshape(-1, 2)


def rigidity(c):
    """Rows and rank of the rigidity matrix, all contacts sticking, without walls."""
    index = {name: k for k, name in enumerate(c.place)}
    matrix = numpy.zeros((3 * len(c.touch), 6 * len(index)))
    for k, (a, b) in enumerate(c.touch):
        branch = numpy.subtract(c.place[b], c.place[a])
        arm = {a: c.radius[a] / (c.radius[a] + c.radius[b]) * branch, b: -c.radius[b] / (c.radius[a] + c.radius[b]) * branch}
        for name, sign in ((a, 1), (b, -1)):
            x, y, z = arm[name] / c.radius[name]
            matrix[3 * k:3 * k + 3, 6 * index[name]:6 * index[name] + 6] = sign * numpy.array(
                [[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]])
    return matrix.shape[0], numpy.linalg.matrix_rank(matrix, tol=1e-7)


def gap_factor(c, graph, communities):
    largest, factors = max(map(len, communities)), []
    for members in communities:
        hops = dict(networkx.all_pairs_shortest_path_length(graph.subgraph(members)))
        pairs = [(a, b) for a in members for b in members if a < b]
        x = [hops[a][b] for a, b in pairs]
        if len(members) < 3 or min(x) == max(x):
            continue
        y = [numpy.linalg.norm(numpy.subtract(c.place[a], c.place[b])) for a, b in pairs]
        factors.append(1 - numpy.corrcoef(x, y)[0, 1] * len(members) / largest)
    return numpy.mean(factors)


def hull_ratio(c, communities):
    ratios = []
    for members in communities:
        if len(members) >= 4:
            hull = scipy.spatial.ConvexHull([c.place[v] for v in members]).volume
            ratios.append(hull / sum(4 / 3 * numpy.pi * c.radius[v] ** 3 for v in members))
    return numpy.mean(ratios) if ratios else numpy.nan


def metrics_of_paths(c, graph):
    names = list(graph)
    matrix = networkx.to_scipy_sparse_array(graph, nodelist=names, weight=None)
    distance = scipy.sparse.csgraph.shortest_path(matrix, directed=False, unweighted=True)
    apart = distance[~numpy.eye(len(names), dtype=bool)]
    joined = apart[numpy.isfinite(apart)]
    yield "path_efficiency", (1 / joined).sum() / len(apart)
    yield "mean_path_length", joined.mean()
    yield "longest_path_length", joined.max()
    index = {name: k for k, name in enumerate(names)}
    plain = igraph.Graph(len(names), [(index[a], index[b]) for a, b in c.touch])
    cycles = [len(cycle) for cycle in plain.minimum_cycle_basis()]
    for length in (3, 4, 5, 6):
        yield f"basis_cycles_of_{length}", cycles.count(length)
    yield "largest_betweenness", max(plain.betweenness(directed=False))
    yield "largest_contact_betweenness", max(plain.edge_betweenness(directed=False))
    # Lengths 1/f; contacts that do not push are not walked.
    pushing = [((a, b), f) for (a, b), f in c.touch.items() if f > 0]
    loads = igraph.Graph(len(names), [(index[a], index[b]) for (a, b), _ in pushing])
    lengths = [1 / f for _, f in pushing]
    yield "largest_force_betweenness", max(loads.betweenness(directed=False, weights=lengths))
    yield "largest_contact_force_betweenness", max(loads.edge_betweenness(directed=False, weights=lengths))
    weighted = scipy.sparse.csr_matrix((lengths, ([index[a] for (a, b), _ in pushing], [index[b] for (a, b), _ in pushing])),
                                       shape=(len(names), len(names)))
    distance = scipy.sparse.csgraph.dijkstra(weighted, directed=False)
    apart = distance[~numpy.eye(len(names), dtype=bool)]
    yield "force_efficiency", (1 / apart[numpy.isfinite(apart)]).sum() / len(apart)


def stresses(c):
    """Love-Weber stress of each sphere from the normal forces between particles; walls have no direction here."""
    stress = {v: numpy.zeros((3, 3)) for v in c.place}
    for (a, b), f in c.touch.items():
        branch = numpy.subtract(c.place[b], c.place[a])
        on_a = -f * branch / numpy.linalg.norm(branch)
        share = c.radius[a] / (c.radius[a] + c.radius[b])
        stress[a] += numpy.outer(share * branch, on_a)
        stress[b] += numpy.outer((share - 1) * branch, -on_a)
    return {v: s / (4 / 3 * numpy.pi * c.radius[v] ** 3) for v, s in stress.items()}


def force_chains(c):
    """Linear chains of Peters et al. by sets: who is loaded, which contacts lie along both loads, which of them is the best of a side."""
    pressure, direction = {}, {}
    for v, s in stresses(c).items():
        values, vectors = numpy.linalg.eigh((s + s.T) / 2)
        if values[0] < 0 and values[1] - values[0] > 1e-9 * -values[0]:
            direction[v] = vectors[:, 0]
        pressure[v] = max(-values[0], 0) if -values[0] > 1e-12 * values[2] else 0  # two of a particle only pulled are rounded zeros
    mean = numpy.mean([p for p in pressure.values() if p > 0])
    loaded = {v for v in direction if pressure[v] > mean}

    def cosine(v, w):
        branch = numpy.subtract(c.place[w], c.place[v])
        return branch @ direction[v] / numpy.linalg.norm(branch)

    least = numpy.cos(numpy.pi / 4)
    along = [(a, b) for a, b in c.touch if {a, b} <= loaded and abs(cosine(a, b)) >= least and abs(cosine(b, a)) >= least]
    sides = {}
    for a, b in along:
        for v, w in ((a, b), (b, a)):
            sides.setdefault((v, cosine(v, w) > 0), []).append((-abs(cosine(v, w)), w))
    best = {(v, min(found)[1]) for (v, _), found in sides.items()}
    links = networkx.Graph([(a, b) for a, b in along if (a, b) in best and (b, a) in best])
    return pressure, [links.subgraph(part) for part in networkx.connected_components(links) if len(part) >= 3]


def chain_metrics(c):
    pressure, chains = force_chains(c)
    yield "mean_largest_compression", numpy.mean(list(pressure.values()))
    yield "force_chain_count", len(chains)
    yield "force_chain_share", sum(map(len, chains)) / len(c.place)
    if chains:
        yield "mean_force_chain_length", numpy.mean(list(map(len, chains)))
    straight, bends = [], []
    for chain in chains:
        ends = [v for v in chain if chain.degree(v) == 1]
        if not ends:
            continue
        x = numpy.array([c.place[v] for v in networkx.shortest_path(chain, *ends)])
        steps = numpy.diff(x, axis=0)
        straight.append(numpy.linalg.norm(x[-1] - x[0]) / numpy.linalg.norm(steps, axis=1).sum())
        unit = steps / numpy.linalg.norm(steps, axis=1)[:, None]
        bends += list(numpy.arccos(numpy.clip((unit[1:] * unit[:-1]).sum(axis=1), -1, 1)))
    if straight:
        yield "chain_straightness", numpy.mean(straight)
        yield "chain_bend", numpy.mean(bends)


def holds(c, graph):
    """Of particles by their contacts, walls counted."""
    walls = {v: 0 for v in c.place}
    force = {v: 0.0 for v in c.place}
    for a, f in c.blade + c.vessel:
        walls[a] += 1
        force[a] += max(f, 0)
    for (a, b), f in c.touch.items():
        force[a] += max(f, 0)
        force[b] += max(f, 0)
    n, e = len(c.place), len(c.touch)
    yield "coordination_with_walls", (2 * e + sum(walls.values())) / n
    degrees = [d for _, d in graph.degree()]
    ones, nones = degrees.count(1), degrees.count(0)
    if n > ones + nones:
        yield "mechanical_coordination", (2 * e - ones) / (n - nones - ones)
    left = set(c.place)
    while True:
        loose = {v for v in left if walls[v] + sum(w in left for w in graph[v]) < 2}
        if not loose:
            break
        left -= loose
    yield "rattler_share", 1 - len(left) / n
    yield "mean_compressive_force", sum(force.values()) / n
    yield "largest_compressive_force", max(force.values())


def modularity(c, mean):
    """Best of ten of igraph's Leiden with the geographical null model."""
    index = {name: k for k, name in enumerate(c.place)}
    graph = igraph.Graph(len(index), [(index[a], index[b]) for a, b in c.touch])
    weights = [max(f, 0) - mean for f in c.touch.values()]
    random.seed(1)
    best = 0
    for _ in range(10):
        found = graph.community_leiden(objective_function="CPM", weights=weights, resolution_parameter=0.0, n_iterations=-1).membership
        best = max(best, sum(w for (a, b), w in zip(c.touch, weights) if found[index[a]] == found[index[b]]))
    return best / sum(max(f, 0) for f in c.touch.values())


def cells(c):
    """Box around all spheres, and the volume that voro++ prints for each, in units of 1e-9 of its own input."""
    low = [min(c.place[v][k] - c.radius[v] for v in c.place) for k in range(3)]
    high = [max(c.place[v][k] + c.radius[v] for v in c.place) for k in range(3)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "spheres"
        path.write_text("".join(f"{v} {' '.join(repr(x) for x in c.place[v])} {c.radius[v]!r}\n" for v in c.place))
        box = [repr(x) for pair in zip(low, high) for x in pair]
        subprocess.run(["voro++", "-r", "-o", "-c", "%i %v", *box, path], check=True, capture_output=True)
        return [line.split() for line in path.with_suffix(".vol").read_text().splitlines()]


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
    yield from metrics_of_paths(c, graph)
    yield from holds(c, graph)
    yield from chain_metrics(c)
    largest = graph.subgraph(max(parts, key=len))
    yield "algebraic_connectivity", numpy.linalg.eigvalsh(networkx.laplacian_matrix(largest).toarray().astype(float))[1]
    yield "modularity", modularity(c, mean)
    yield "gap_factor_of_components", gap_factor(c, graph, parts)
    yield "hull_ratio_of_components", hull_ratio(c, parts)
    clustering = igraph.Graph.TupleList([(str(a), str(b), max(f, 0)) for (a, b), f in c.touch.items()], weights=True)
    barrat = numpy.array(clustering.transitivity_local_undirected(weights="weight", mode="nan"))
    yield "mean_force_clustering", barrat[numpy.isfinite(barrat)].mean()
    for (name, of), pairs in zip((("parts", "parts"), ("loops", "loops")), diagrams(c)):
        yield f"{name}_at_mean_force", numpy.sum((pairs[:, 0] >= mean) & (pairs[:, 1] < mean))
        yield f"persistence_of_{of}", (pairs[:, 0] - pairs[:, 1]).sum() / mean
    if n <= 300:
        rows, rank = rigidity(c)
        yield "zero_modes_without_walls", 6 * n - rank
        yield "self_stresses_without_walls", rows - rank
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
    with open(HERE / "networks.csv", "w", newline="") as out, open(HERE / "metrics.csv", "w", newline="") as found, \
         open(HERE / "cells.csv", "w", newline="") as volumes:
        rows, results = csv.writer(out, lineterminator="\n"), csv.writer(found, lineterminator="\n")
        cell_rows = csv.writer(volumes, lineterminator="\n")
        rows.writerow(["network", "kind", "a", "b", "value", "y", "z", "radius"])
        results.writerow(["network", "metric", "value"])
        cell_rows.writerow(["network", "id", "volume"])
        before = None
        for name, c in networks.items():
            for a, x in sorted(c.place.items()):
                rows.writerow([name, "grain", a, "", *(f"{v:.9g}" for v in x), f"{c.radius[a]:.9g}"])
            for (a, b), f in sorted(c.touch.items()):
                rows.writerow([name, "touch", a, b, f"{f:.9g}", "", "", ""])
            for role in ("blade", "vessel"):
                for a, f in sorted(getattr(c, role)):
                    rows.writerow([name, role, a, "", f"{f:.9g}", "", "", ""])
            for metric, value in metrics(c):
                results.writerow([name, metric, repr(float(value))])
            # Changes from one random network to the next: real diagrams are too large for POT.
            if name.startswith("geometric"):
                now = list(diagrams(c))
                if before is not None:
                    for k, of in enumerate(("parts", "loops")):
                        # Births before deaths, as GUDHI has them.
                        results.writerow([name, f"bottleneck_of_{of}", repr(gudhi.bottleneck_distance(before[k][:, ::-1], now[k][:, ::-1]))])
                        cost = gudhi.wasserstein.wasserstein_distance(before[k][:, ::-1], now[k][:, ::-1], order=1, internal_p=numpy.inf)
                        results.writerow([name, f"wasserstein_of_{of}", repr(float(cost))])
                before = now
            else:
                for row in cells(c):
                    cell_rows.writerow([name, *row])


if __name__ == "__main__":
    main()
