"""Reads exported contact networks with networkx and compares them with the CSV export of the same frames.

    python3 tests/tools/check_in_networkx.py GRAPHML_FOLDER CSV_FOLDER

`jamscope export run.h5 --to graphml -o GRAPHML_FOLDER` and `... --to csv -o CSV_FOLDER`. Prints nodes, edges and forces of every
frame; the exit status is 1 where something differs.
"""
import collections
import csv
import glob
import math
import os
import sys

import networkx

graphs, tables = sys.argv[1], sys.argv[2]
problems = 0


def rows(name):
    path = os.path.join(tables, name + ".csv")
    frames = collections.defaultdict(list)
    if os.path.exists(path):
        with open(path) as file:
            for row in csv.DictReader(file):
                frames[int(row["frame"])].append(row)
    return frames


particles, contacts, wall_contacts = rows("particles"), rows("contacts"), rows("wall_contacts")
paths = sorted(glob.glob(os.path.join(graphs, "frame_*.graphml")))
if not paths:
    sys.exit(graphs + ": no networks")
for path in paths:
    graph = networkx.read_graphml(path, force_multigraph=True)
    frame = int(os.path.basename(path)[len("frame_"):-len(".graphml")])
    kinds = collections.Counter(data["kind"] for _, data in graph.nodes(data=True))
    between = [d for u, v, d in graph.edges(data=True) if graph.nodes[u]["kind"] == graph.nodes[v]["kind"] == "particle"]
    force = math.fsum(d["normal_force"] for _, _, d in graph.edges(data=True))
    wanted = math.fsum(float(r["normal_force [N]"]) for r in contacts[frame] + wall_contacts[frame])
    walls = {r["wall"] for r in wall_contacts[frame]}
    # The compressive force of a particle is the sum of the weights of its edges.
    worst = max((abs(sum(d["weight"] for _, _, d in graph.edges(n, data=True)) - data["compressive_force"])
                 for n, data in graph.nodes(data=True) if data["kind"] == "particle"), default=0)
    fine = (kinds["particle"] == len(particles[frame]) and kinds["wall"] == len(walls) and len(between) == len(contacts[frame])
            and graph.number_of_edges() == len(contacts[frame]) + len(wall_contacts[frame])
            and math.isclose(force, wanted, rel_tol=1e-5, abs_tol=1e-9) and worst <= 1e-4 * max(1e-6, abs(force)))
    problems += not fine
    print("frame %d: %d particles, %d walls, %d edges (%d between particles), %d components, sum of normal forces %.7g N, compressive forces "
          "within %.2g N%s" % (frame, kinds["particle"], kinds["wall"], graph.number_of_edges(), len(between),
                              networkx.number_connected_components(graph), force, worst, "" if fine else "   DIFFERS"))
sys.exit(1 if problems else 0)
