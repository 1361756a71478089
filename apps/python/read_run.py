"""Reads the snapshot files of jamscope (run.h5) with h5py and NumPy alone: copy this file to where you need it, nothing is to be built.

    import read_run
    with read_run.open_run("out/run.h5") as file:
        for k in range(read_run.frame_count(file)):
            frame = read_run.read_frame(file, k)
            frame["time"], frame["particles"]["position"], frame["contacts"]["normal_force"]

What is in a frame, with units and signs, is in libjam/snapshot/SCHEMA.md; a quantity that the source does not know is not in the dictionaries. A file
that is still being written, or whose writer was killed, gives its complete frames. Checksums are not compared: `jamscope inspect` does that.
"""
import h5py
import numpy


def open_run(path):
    """The file, for reading beside a writer (SWMR). To see frames that were written since, open it again. Raises OSError, ValueError."""
    try:
        file = h5py.File(path, "r", swmr=True, locking=False)
    except OSError:  # no SWMR in files that other tools have repacked
        file = h5py.File(path, "r", locking=False)
    if _text(file.attrs.get("format", "")) != "jamscope-snapshots" or int(file.attrs["schema_version"][0]) != 1:
        file.close()
        raise ValueError(f"{path}: not a jamscope snapshot file of schema 1.x")
    return file


def frame_count(file):
    """Complete frames: the commit of a frame is written last."""
    return len(file["frames/commit"])


def read_frame(file, k):
    """Frame k, negative from the end: time (s), step, and dictionaries of arrays: particles, contacts, wall_contacts, and walls by name."""
    count = frame_count(file)
    if not -count <= k < count:
        raise IndexError(f"there is no frame {k}: the file has {count}")
    k %= count
    frame = {"time": float(file["frames/time"][k]), "step": int(file["frames/step"][k])}
    for name, group, kind in (("particles", "particles", "particle"), ("contacts", "contacts/pp", "pp"), ("wall_contacts", "contacts/pw", "pw")):
        first = int(file[f"frames/{kind}_start"][k])
        frame[name] = _rows(file.get(group, {}), first, first + int(file[f"frames/{kind}_count"][k]))
    frame["walls"] = {wall: {c: data[k] for c, data in group.items() if len(data.shape) == 2 and c not in _STATIC} for wall, group in file["walls"].items()}
    return frame


def read_series(file):
    """The windows of steps up to the last complete frame: arrays by name, `energy` and `walls` (by name) as dictionaries."""
    rows = int(file["frames/series_count"][frame_count(file) - 1]) if frame_count(file) else 0
    series = _rows(file.get("series", {}), 0, rows)
    if "series/energy" in file:
        series["energy"] = _rows(file["series/energy"], 0, rows)
    series["walls"] = {wall: _rows(group, 0, rows) for wall, group in file.get("series/walls", {}).items()}
    return series


def read_excursions(file):
    """Stays of particles above the watched force, those of the windows up to the last complete frame."""
    counts = read_series(file).get("excursion_count", numpy.zeros(0, "u4"))
    return _rows(file.get("excursions", {}), 0, int(counts.sum()))


def wall_info(file):
    """What does not change about each wall, by name: its attributes (id, kind, role, ...) and the arrays of meshes and glued spheres."""
    return {wall: {**{a: _text(v) for a, v in group.attrs.items()}, **{c: group[c][()] for c in _STATIC if c in group}} for wall, group in file["walls"].items()}


_STATIC = ("vertices", "triangles", "triangle_label", "sphere_centre", "sphere_radius")


def _rows(group, first, last):
    return {name: data[first:last] for name, data in group.items() if isinstance(data, h5py.Dataset)}


def _text(value):
    return value.decode().rstrip("\0") if isinstance(value, bytes) else value
