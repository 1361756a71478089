"""Granular flow past a moving blade: simulation, and the jams in it.

    run = jamscope.open("out/run.h5")             # a sequence of frames
    frame = run[-1]
    frame.particles.position                      # [N,3] m, a view of the frame's own numbers
    frame.metric("coordination")                  # any metric of the contact network by name
    jams = jamscope.analyze(run, jam_force=20.0)  # events, tracks, streams, statistics

All quantities are in SI units. Arrays are read-only views that keep what they belong to alive. Signs: overlap > 0 in contact; normal forces > 0
push apart; a tangential force is the one on the first particle; forces of walls are those on the wall.
"""
from __future__ import annotations

import os as _os
import sys as _sys
from typing import Any, Callable, Mapping, Optional, Sequence, Tuple, Union


def _load() -> None:
    # GNU's OpenMP reads once, when it is loaded, how long a waiting thread spins; its default burns a processor that others want (as in
    # apps/jamscope/main.cpp). Programs that this one starts do not inherit the change.
    ours = "GOMP_SPINCOUNT" not in _os.environ and "OMP_WAIT_POLICY" not in _os.environ
    if ours:
        _os.environ["GOMP_SPINCOUNT"] = "2000"
    try:
        from . import _core  # noqa: F401
    finally:
        if ours:
            del _os.environ["GOMP_SPINCOUNT"]


_load()

from . import metrics, statistics  # noqa: E402
from ._core import (  # noqa: E402
    Analysis, CaseError, Components, ContactGraph, Contacts, Criteria, CriteriaError, DataError, Error, Excursions, FlowEnergy, Frame, Gap, GeometryError,
    JamStatistics, Material, MetricInfo, Particles, PhysicsError, Run, RunInfo, Series, Simulated, UsageError, Wall, WallContacts, WallSeries, WallState,
    __version__, analyze_run as _analyze_run, check_case as _check_case, commit, open_run as _open_run, read_results as _read_results,
    simulate_case as _simulate_case,
)

__all__ = [
    "Analysis", "CaseError", "Components", "ContactGraph", "Contacts", "Criteria", "CriteriaError", "DataError", "Error", "Excursions", "FlowEnergy", "Frame",
    "Gap", "GeometryError", "JamStatistics", "Material", "MetricInfo", "Particles", "PhysicsError", "Run", "RunInfo", "Series", "Simulated", "UsageError",
    "Wall", "WallContacts", "WallSeries", "WallState", "__version__", "analyze", "check", "commit", "metrics", "open", "read_results", "simulate", "statistics",
]

Path = Union[str, "_os.PathLike[str]"]
Paths = Union[Path, Sequence[Path]]

# SI units of the criteria that are no pure numbers, for those given as numbers.
_UNITS = {"jam_force": "N", "end_force": "N", "hold_off": "s", "shortest_jam": "s", "survival_classes": "s"}


def _text(value: Any, unit: str = "") -> str:
    """The value as TOML; repr() of a float gives back the same float."""
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) == 1:  # arrays too
        return "[" + ", ".join(_text(v, unit) for v in value) + "]"
    if isinstance(value, int) or hasattr(value, "__index__"):
        return f'"{int(value)} {unit}"' if unit else str(int(value))
    return f'"{float(value)!r} {unit}"' if unit else repr(float(value))


def _overrides(values: Mapping[str, Any], units: Mapping[str, str] = {}) -> list[str]:
    return [f"{key}={_text(value, units.get(key, ''))}" for key, value in values.items() if value is not None]


def open(paths: Paths, *, map: Optional[Path] = None, blade: Optional[str] = None, vessel: Optional[str] = None) -> Run:
    """Opens a stored run: a jamscope file (also while it is being written), or the dumps of another program.

    paths: one file, or those of one run in any order; the kind of each is found from its content.
    map: TOML file that names the columns, units and walls of dumps (data/maps).
    blade, vessel: names of the walls that take these roles, instead of those that have them.
    Raises DataError, CaseError (map file) and UsageError (no wall of that name).
    """
    several = [paths] if isinstance(paths, (str, _os.PathLike)) else paths
    return _open_run([_os.fspath(p) for p in several], _os.fspath(map) if map is not None else "", blade or "", vessel or "")


def analyze(run: Union[Run, Paths], *, criteria: Optional[Path] = None, frames: Optional[Tuple[int, int]] = None, threads: int = 0,
            **options: Any) -> Analysis:
    """Finds the jams of a stored run, as `jamscope analyze` does.

    run: what open() gives, or its paths.
    criteria: TOML file with an [analysis] table; default: that of the run's own case.
    frames: (first, last), from the first to before the last; default: all.
    threads: frames examined at a time, 0: as many as there are processors. The results do not depend on it.
    options: keys of the [analysis] table, which count above all: jam_force, end_force (N), hold_off, shortest_jam, survival_classes (s), criterion,
        threshold, measure, bridge_contact_share, gap_margin, metrics. A number is in SI units, a text has a unit ("20 N").
    Raises DataError, CaseError (an unknown or wrong option, with the nearest known name), CriteriaError.
    """
    return _analyze_run(run if isinstance(run, Run) else open(run), _overrides(options, _UNITS), _os.fspath(criteria) if criteria is not None else "", frames,
                        threads)


def read_results(path: Path) -> Analysis:
    """Reads the results of an analysis: jam.h5, or the folder that holds it. Raises DataError."""
    path = _os.fspath(path)
    return _read_results(_os.path.join(path, "jam.h5") if _os.path.isdir(path) else path)


def check(case: Path, *, set: Mapping[str, Any] = {}) -> list[str]:
    """Reads a case file and returns its warnings; simulates nothing. Raises CaseError with all problems, each with file, line and column.

    set: keys that replace those of the file: {"motion.tip_speed": "100 mm/s"}.
    """
    return _check_case(_os.fspath(case), _overrides(set))


def simulate(case: Path, output: Path, callback: Optional[Callable[[Frame], Any]] = None, *, until: Union[None, float, str] = None, threads: int = 0,
             resume: bool = False, overwrite: bool = False, set: Mapping[str, Any] = {}, bed_cache: Optional[Path] = None, quiet: bool = True) -> Simulated:
    """Simulates a case, analyses it in place and writes run.h5 and all results into a folder: the same bytes as `jamscope simulate`.

    callback: called with each frame as soon as it is in the file, the first one too; its arrays stay valid. Where it returns False the run stops:
        its checkpoint and the results so far are written. So too where it raises, or on Ctrl-C, and then the exception goes on to the caller.
        Other Python threads run while the simulation steps. It may open the run's files, but not hold them open with h5py: HDF5 does not let one
        process write what it reads.
    until: s, or a text with its unit ("0.5 s"); stops there instead of at the case's end.
    threads: 0: as many as there are processors. The results do not depend on it.
    resume: go on from the last checkpoint in `output`.
    overwrite: `output` may hold an earlier run, which is replaced.
    set: keys that replace those of the case: {"motion.tip_speed": "100 mm/s"}.
    bed_cache: folder in which settled beds are kept for later runs, "" keeps none; default ~/.cache/jamscope/beds.
    quiet: False shows the progress on standard error.
    Raises CaseError, CriteriaError, PhysicsError, DataError, UsageError.
    """
    limit = until if until is None or isinstance(until, str) else f"{float(until)!r} s"
    return _simulate_case(_os.fspath(case), _os.fspath(output), callback, limit, threads, resume, overwrite, _overrides(set),
                          None if bed_cache is None else _os.fspath(bed_cache), quiet, list(_sys.argv))
