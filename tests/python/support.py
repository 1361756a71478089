"""What the tests of the Python module share: where things are, a small case, and how to run the program."""
import atexit
import csv
import os
import shutil
import subprocess
import tempfile
import warnings
from pathlib import Path

import jamscope

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "data"
PROGRAM = os.environ["JAMSCOPE_PROGRAM"]
PEA = DATA / "reference" / "networks" / "pea.h5"  # three frames of a run of about 160 grains
JAM_FORCE = 0.5  # N, at which some of its grains are jammed

# The small case's blade comes close to the floor, and its file says so.
warnings.filterwarnings("ignore", message=".*will be crushed there")

# The bed of the small case settles once for all tests of a process.
SCRATCH = Path(tempfile.mkdtemp(prefix="jamscope_"))
atexit.register(shutil.rmtree, SCRATCH, ignore_errors=True)
BEDS = SCRATCH / "beds"
SHORT = {"run.duration": "0.5 ms", "output.frame_interval": "0.1 ms", "output.series_interval": "0.02 ms", "output.checkpoint_interval": "0.2 ms",
         "analysis.jam_force": "0.5 N"}


def small_case():
    """The case that pea.h5 was made from, as a file."""
    path = SCRATCH / "pea.toml"
    if not path.exists():
        path.write_text(jamscope.open(PEA).info.case_toml)
    return path


def program(*arguments):
    """Runs the built program and returns what it prints."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"jamscope {' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def simulate_by_program(output, *arguments, set=SHORT):
    overrides = [f"--set={key}={value}" for key, value in set.items()]
    program("simulate", small_case(), "-o", output, "-q", "--bed-cache", BEDS, *overrides, *arguments)


def simulate(output, callback=None, set=SHORT, **options):
    return jamscope.simulate(small_case(), output, callback, set=set, bed_cache=BEDS, **options)


def rows(text):
    """The rows of a CSV text as dictionaries."""
    return list(csv.DictReader(text.splitlines()))


def reference(name):
    """A table of data/reference/statistics."""
    return rows((DATA / "reference" / "statistics" / name).read_text())
