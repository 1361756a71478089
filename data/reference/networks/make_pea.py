#!/usr/bin/python3
"""What h5py, numpy and networkx find in the three frames of pea.h5 of what networks.csv does not hold: friction, ages, what becomes of contacts, jams.

    data/reference/networks/make_pea.py
    (apt-get install python3-networkx python3-h5py)

pea.h5 is run.h5 of `jamscope simulate` of the case in tests/app/simulate_test.cpp with frame_interval = "1 ms" and
series_interval = "0.5 ms", made smaller by `h5repack -f GZIP=9 -S FSM_AGGR`. Writes pea.csv beside itself:
frame, metric, value; of a change: for the change from the frame before.
"""
import csv
import math
from pathlib import Path

import h5py
import networkx
import numpy

HERE = Path(__file__).resolve().parent
JAM_FORCE, LOAD_PATH = 0.5, 0.05  # N; a jam's contacts carry more than a tenth of the jam force


def frame(file, k):
    rows = file["frames"]
    part = lambda kind: slice(int(rows[f"{kind}_start"][k]), int(rows[f"{kind}_start"][k]) + int(rows[f"{kind}_count"][k]))
    columns = lambda group, which: {name: data[which] for name, data in file[group].items()}
    roles = {int(w.attrs["id"]): w.attrs["role"].decode().rstrip("\0") for w in file["walls"].values()}
    return {"particles": columns("particles", part("particle")), "pp": columns("contacts/pp", part("pp")), "pw": columns("contacts/pw", part("pw")),
            "roles": roles, "step": int(rows["step"][k]), "dt": float(file.attrs["dt"])}


def largest_cluster(pairs, particles):
    graph = networkx.Graph()
    graph.add_edges_from(pairs)
    return max((len(c) for c in networkx.connected_components(graph)), default=0) / particles


def of_frame(f, file):
    pp, pw, particles = f["pp"], f["pw"], f["particles"]
    n = len(particles["id"])
    sliding = (pp["flags"] & 1) == 1
    yield "sliding_share", sliding.mean()
    yield "largest_sliding_cluster_share", largest_cluster(map(tuple, pp["row"][sliding]), n)
    # Thornton 1991, Eq. 15, with the work of adhesion W of the pair: F_c = 3/2 pi W R*.
    radius = particles["radius"].astype(float)
    first, second = radius[pp["row"][:, 0]], radius[pp["row"][:, 1]]
    kind = particles["material"]
    work, friction = (file[f"interactions/{name}"][:][kind[pp["row"][:, 0]], kind[pp["row"][:, 1]]] for name in ("work_of_adhesion", "friction"))
    pull_off = 1.5 * math.pi * work / (1 / first + 1 / second)
    force = pp["normal_force"].astype(float)
    limit = friction * (force + 2 * pull_off + numpy.sqrt(4 * pull_off * numpy.maximum(force + pull_off, 0)))
    used = numpy.linalg.norm(pp["tangential_force"].astype(float), axis=1)[limit > 0] / limit[limit > 0]
    yield "mean_mobilisation", used.mean()
    yield "mean_contact_age", f["dt"] * (f["step"] - pp["birth_step"].astype(float)).mean()
    # Jams.
    whole = lambda c: numpy.maximum(c["normal_force"].astype(float) + c["damping_force"], 0)
    load = numpy.zeros(n)
    numpy.add.at(load, pp["row"][:, 0], whole(pp))
    numpy.add.at(load, pp["row"][:, 1], whole(pp))
    numpy.add.at(load, pw["row"], whole(pw))
    jammed = load > JAM_FORCE
    yield "jammed_particles", jammed.sum()
    graph = networkx.Graph()
    graph.add_nodes_from(numpy.flatnonzero(jammed))
    graph.add_edges_from(tuple(r) for r, w in zip(pp["row"], whole(pp)) if jammed[r[0]] and jammed[r[1]] and w > LOAD_PATH)
    pressed = {role: {int(r) for r, wall, w in zip(pw["row"], pw["wall"], whole(pw)) if f["roles"][int(wall)] == role and w > LOAD_PATH} for role in ("blade", "vessel")}
    yield "bridging_clusters", sum(1 for c in networkx.connected_components(graph) if c & pressed["blade"] and c & pressed["vessel"])


def names(f):
    ids = f["particles"]["id"]
    return {(int(ids[a]), int(ids[b]), int(birth)): k for k, ((a, b), birth) in enumerate(zip(f["pp"]["row"], f["pp"]["birth_step"]))}


def of_change(before, now):
    old, new = names(before), names(now)
    lost = [k for name, k in old.items() if name not in new]
    yield "contact_survival", 1 - len(lost) / len(old)
    yield "contact_renewal", sum(1 for name in new if name not in old) / len(new)
    yield "lost_contact_age", before["dt"] * numpy.mean([before["step"] - float(before["pp"]["birth_step"][k]) for k in lost])
    yield "broken_cluster_share", largest_cluster((tuple(before["pp"]["row"][k]) for k in lost), len(before["particles"]["id"]))


with h5py.File(HERE / "pea.h5", "r", swmr=True) as file, open(HERE / "pea.csv", "w", newline="") as out:
    write = csv.writer(out, lineterminator="\n").writerow
    write(["frame", "metric", "value"])
    frames = [frame(file, k) for k in range(len(file["frames/time"]))]
    for k, f in enumerate(frames):
        for metric, value in of_frame(f, file):
            write([k, metric, repr(float(value))])
        if k > 0:
            for metric, value in of_change(frames[k - 1], f):
                write([k, metric, repr(float(value))])
