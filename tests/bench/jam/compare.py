#!/usr/bin/python3
"""libjam's metrics and the same by networkx, igraph, scipy, GUDHI and numpy, in turn on one network and one core.

    tests/bench/jam/compare.py build/tests/network_bench [RUN.h5] [--exact] [--only REGEX] [--repeat N]
    (apt-get install python3-networkx python3-igraph python3-gudhi python3-scipy)

Without RUN.h5 on the proxy network of network_bench; with it on the last frame of that run. Each time is the median of N (default 3), without
reading and without building the graph, which are lines of their own. --exact also takes exact betweenness (minutes).
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import tempfile
import time

import gudhi
import igraph
import networkx
import numpy
import scipy.sparse
import scipy.sparse.csgraph

BLADE, VESSEL = -1, -2


def measured(repeat, f):
    times = []
    for _ in range(repeat):
        begin = time.perf_counter()
        f()
        times.append(1000 * (time.perf_counter() - begin))
    return statistics.median(times)


def peers(path, exact):
    """(our name, program, function) for each comparison."""
    rows = numpy.loadtxt(path)
    ends = rows[:, 1] < 0
    touch, force = rows[~ends][:, :2].astype(int), rows[~ends][:, 2]
    n = int(rows[:, 0].max() if ends.all() else max(rows[:, 0].max(), touch.max())) + 1
    plain = networkx.Graph()
    plain.add_nodes_from(range(n))
    plain.add_edges_from(map(tuple, touch))
    compact = igraph.Graph(n, touch.tolist())
    sparse = scipy.sparse.csr_matrix((numpy.ones(len(touch)), touch.T), shape=(n, n))
    pushing = force > 0

    # Two nodes for the ends, only for flows.
    wall = rows[ends]
    wall = wall[wall[:, 2] > 0]
    edges = touch[pushing].tolist() + [[int(a), n if role == BLADE else n + 1] for a, role, _ in wall]
    flow_graph = igraph.Graph(n + 2, edges)
    capacity = force[pushing].tolist() + wall[:, 2].tolist()

    def persistence(dimension):
        tree = gudhi.SimplexTree()
        largest = numpy.zeros(n)
        numpy.maximum.at(largest, touch[pushing][:, 0], force[pushing])
        numpy.maximum.at(largest, touch[pushing][:, 1], force[pushing])
        inside = numpy.flatnonzero(largest)
        tree.insert_batch(inside.reshape(1, -1), -largest[inside])
        tree.insert_batch(touch[pushing].T, -force[pushing])
        if dimension == 1:
            tree.expansion(2)
        tree.compute_persistence(persistence_dim_max=True)

    def strongest_bridge():
        tree = flow_graph.spanning_tree(weights=[-c for c in capacity])
        tree.get_shortest_paths(n, n + 1)

    def principal():
        # Eigenvalues of as many symmetric matrices as there are particles.
        numpy.linalg.eigh(numpy.tile(numpy.diag([1.0, 2.0, 3.0]), (n, 1, 1)))

    yield "build_graph", "igraph", lambda: igraph.Graph(n, touch.tolist())
    yield "build_graph", "scipy", lambda: scipy.sparse.csr_matrix((numpy.ones(len(touch)), touch.T), shape=(n, n))
    yield "components", "networkx", lambda: list(networkx.connected_components(plain))
    yield "components", "igraph", lambda: compact.connected_components()
    yield "components", "scipy", lambda: scipy.sparse.csgraph.connected_components(sparse, directed=False)
    yield "cut_edges", "networkx", lambda: (list(networkx.bridges(plain)), list(networkx.articulation_points(plain)))
    yield "cut_edges", "igraph", lambda: (compact.bridges(), compact.articulation_points())
    yield "principal_loads", "numpy", principal
    yield "cores", "networkx", lambda: networkx.core_number(plain)
    yield "cores", "igraph", lambda: compact.coreness()
    yield "triangle_counts", "networkx", lambda: networkx.triangles(plain)
    yield "triangle_counts", "igraph", lambda: compact.transitivity_local_undirected()
    yield "strongest_bridge", "igraph", strongest_bridge
    yield "persistence_0", "gudhi", lambda: persistence(0)
    yield "persistence_1", "gudhi", lambda: persistence(1)
    yield "flow", "igraph", lambda: flow_graph.maxflow(n, n + 1, capacity=capacity)
    yield "community_search", "igraph", lambda: compact.community_leiden(
        objective_function="CPM", weights=(numpy.maximum(force, 0) - force[pushing].mean()).tolist(), resolution_parameter=0.0,
        n_iterations=-1)
    if exact:
        yield "exact_betweenness", "igraph", lambda: compact.betweenness(directed=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("run", nargs="?")
    parser.add_argument("--exact", action="store_true")
    parser.add_argument("--only", default=".", help="names of our benchmarks, a regular expression")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    one_core = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    if options.run:
        one_core["JAMSCOPE_BENCH_RUN"] = os.path.abspath(options.run)
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})

    with tempfile.TemporaryDirectory() as folder:
        edges = os.path.join(folder, "edges")
        subprocess.run([options.bench, "--edges", edges], check=True, env=one_core)
        theirs = {}
        for name, program, f in peers(edges, options.exact):
            if not re.search(options.only, name):
                continue
            theirs.setdefault(name, []).append((program, measured(1 if name == "exact_betweenness" else options.repeat, f)))
    slow = "rank_of_rigidity" if options.exact else "rank_of_rigidity|exact_betweenness"
    wanted = f"-{slow}" if options.only == "." else options.only
    command = [options.bench, "--benchmark_format=json", f"--benchmark_repetitions={options.repeat}",
               f"--benchmark_report_aggregates_only={str(options.repeat > 1).lower()}", f"--benchmark_filter={wanted}"]
    found = json.loads(subprocess.run(command, check=True, env=one_core, capture_output=True, text=True).stdout)
    print(f"{'':30}{'libjam':>12}  others, ms (times as long)")
    for entry in found["benchmarks"]:
        if options.repeat > 1 and not entry["name"].endswith("_median"):
            continue
        name, ours = entry["run_name"], entry["real_time"]
        others = "  ".join(f"{program} {took:.4g} ({took / ours:.3g})" for program, took in theirs.get(name, []))
        print(f"{name:30}{ours:9.4g} ms  {others}")
        if name == "build_graph":
            print(f"{'':30}{entry['particles']:.0f} particles, {entry['contacts']:.0f} contacts")


if __name__ == "__main__":
    main()
