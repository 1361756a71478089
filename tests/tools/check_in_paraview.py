"""Opens a run and its export in ParaView and compares what it sees there with what the file holds.

    pvpython --force-offscreen-rendering tests/tools/check_in_paraview.py INSPECT.json run.xdmf EXPORT_FOLDER

INSPECT.json: `jamscope inspect run.h5 --json`; EXPORT_FOLDER: `jamscope export run.h5 --to vtp -o EXPORT_FOLDER`.
Prints counts, times and ranges; the exit status is 1 where something differs.
"""
import json
import math
import os
import sys

from paraview.simple import OpenDataFile, XDMFReader
from vtkmodules.util.numpy_support import vtk_to_numpy

with open(sys.argv[1]) as file:
    expected = json.load(file)
xdmf, folder = sys.argv[2], sys.argv[3]
problems = []


def check(what, got, wanted):
    fine = math.isclose(got, wanted, rel_tol=1e-6, abs_tol=1e-12)
    print("%-58s %.9g%s" % (what, got, "" if fine else "   EXPECTED %.9g" % wanted))
    if not fine:
        problems.append(what)


def leaves(data):
    """The polygonal or unstructured sets of a composite one."""
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    found, it = [], data.NewIterator()
    it.InitTraversal()
    while not it.IsDoneWithTraversal():
        found.append(it.GetCurrentDataObject())
        it.GoToNextItem()
    return found


def frames(reader, path):
    """Checks the times and gives every frame's sets."""
    reader.UpdatePipelineInformation()
    times = reader.TimestepValues
    times = list(times) if hasattr(times, "__len__") else [times]
    check(path + ": frames", len(times), expected["frames"])
    check(path + ": first time", times[0], expected["first_time_s"])
    check(path + ": last time", times[-1], expected["last_time_s"])
    for time in times:
        reader.UpdatePipeline(time)
        yield leaves(reader.GetClientSideObject().GetOutputDataObject(0))


def force_range(sets, where):
    values = []
    for data in sets:
        attributes = data.GetPointData() if where == "points" else data.GetCellData()
        array = attributes.GetArray("compressive_force" if where == "points" else "normal_force")
        if array is not None and array.GetNumberOfTuples() > 0:
            numbers = vtk_to_numpy(array)
            values += [float(numbers.min()), float(numbers.max())]
    return (min(values), max(values)) if values else (math.nan, math.nan)


def summary(sets_of_frames):
    # The reader fills the same objects anew for every frame, so each is measured before the next one is asked for.
    found = {"points": [], "cells": [], "forces on points": [], "forces on cells": []}
    for sets in sets_of_frames:
        found["points"].append(sum(d.GetNumberOfPoints() for d in sets))
        found["cells"].append(sum(d.GetNumberOfCells() for d in sets))
        found["forces on points"].append(force_range(sets, "points"))
        found["forces on cells"].append(force_range(sets, "cells"))
    return found


index = summary(frames(XDMFReader(FileNames=[xdmf]), "run.xdmf"))
series = {}
for name in ("particles", "contacts", "blade", "walls"):
    path = os.path.join(folder, name + ".pvd")
    if os.path.exists(path):
        series[name] = summary(frames(OpenDataFile(path), name + ".pvd"))

particles, contacts = expected["particles"], expected["particle_contacts"]
walls = expected["wall_contacts"]
check("particles.pvd: most points in a frame", max(series["particles"]["points"]), particles["max"])
check("particles.pvd: fewest", min(series["particles"]["points"]), particles["min"])
check("contacts.pvd: mean of lines a frame", sum(series["contacts"]["cells"]) / expected["frames"], contacts["mean"] + walls["mean"])
for k in range(expected["frames"]):
    # The index draws particles as cells of one grid and the contacts of particles as those of another one.
    lines = index["cells"][k] - series["particles"]["points"][k]
    if not 0 <= lines <= series["contacts"]["cells"][k]:
        problems.append("frame %d: %d lines in run.xdmf, %d in contacts.pvd" % (k, lines, series["contacts"]["cells"][k]))
    for a, b in zip(index["forces on points"][k], series["particles"]["forces on points"][k]):
        if not (math.isnan(a) or math.isclose(a, b, rel_tol=1e-6)):
            problems.append("frame %d: compressive force %g in run.xdmf, %g in particles.pvd" % (k, a, b))
lines = [index["cells"][k] - series["particles"]["points"][k] for k in range(expected["frames"])]
check("run.xdmf: mean of lines a frame", sum(lines) / expected["frames"], contacts["mean"])
triangles = sum(w["triangles"] for w in expected["walls"] if w["role"] == "blade")
if triangles:
    check("blade.pvd: triangles", series["blade"]["cells"][-1], triangles)
for name in series:
    where = "points" if name == "particles" else "cells"
    ends = [x for pair in series[name]["forces on " + where] for x in pair if not math.isnan(x)]
    print("%-58s %.9g to %.9g N" % (name + ".pvd: " + ("compressive" if where == "points" else "normal") + " force", min(ends, default=math.nan), max(ends, default=math.nan)))
for problem in problems:
    print("DIFFERS: " + problem)
sys.exit(1 if problems else 0)
