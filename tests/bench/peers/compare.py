#!/usr/bin/python3
"""Runs jamscope, LAMMPS and LIGGGHTS in turn on the same settled bed with the same step and prints grain steps per second.

    tests/bench/peers/compare.py build/jamscope [--beads 35000] [--rounds 3] [--json FILE]

Needs: apt-get install lammps liggghts openmpi-bin python3-h5py. The bed is that of data/cases/ft4_c_down.toml (E = 63 MPa, the
step of 1e-6 s that all codes bear) around a blade half way down; jamscope settles it once and keeps it. Every round runs each
code on one core, then on two. The peers' blade is two leaning plates of its size (LAMMPS has no meshes), and they leave out the
grains that would stand in them; how else they differ is said in in.lammps and in.liggghts. Medians, and jamscope's over theirs
from the same round.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

HERE = Path(__file__).resolve().parent
CASE = HERE.parents[2] / "data/cases/ft4_c_down.toml"
STEP = 1e-6  # s
START = 25e-3  # m, lower edge of the blade
MODULUS, SURFACE_ENERGY = 63e6, 0.01728823 / 2  # Pa, J/m^2
SKIN = 1e-4  # m
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}


def case_options(beads):
    sets = {"run.step": f"{STEP} s", "run.duration": "0.2 s", "blade.start_height": f"{START} m"}
    if beads is not None:
        sets["bed.depth"] = f"{52e-3 * beads / 35000} m"
        sets["blade.start_height"] = f"{min(START, 26e-3 * beads / 35000)} m"
    return [part for key, value in sets.items() for part in ("--set", f'{key}="{value}"')]


def write_bed(path, grains, comment):
    with open(path, "w") as out:
        out.write(f"{comment}\n\n{len(grains)} atoms\n2 atom types\n\n-0.014 0.014 xlo xhi\n-0.014 0.014 ylo yhi\n"
                  "-0.002 0.125 zlo zhi\n\nAtoms\n\n")
        for number, (x, y, z, radius) in enumerate(grains, 1):
            out.write(f"{number} 1 {2 * radius:.9e} 2500 {x:.9e} {y:.9e} {z:.9e}\n")


def in_plates(grain, blade):
    """Does the grain reach into one of the two leaning plates of in.lammps, or within a tenth of its radius of them?"""
    x, y, z, radius = grain[0], grain[1], grain[2] - blade, 1.1 * grain[3]
    if abs(z) > 3e-3 + radius or abs(x) > 0.01115 + radius:
        return False
    # The first plate leans towards +y above the middle, for x > 0; the second mirrors it in y and x.
    near = [side for side in (1, -1) if side * x > -radius]
    return any(abs(y - side * z) / 2 ** 0.5 < 0.7e-3 / 2 ** 0.5 + radius for side in near)


def write_plates(path, stations=12):
    """The two plates of in.lammps as a mesh for LIGGGHTS, which takes no mesh with triangles as slender as jamscope's blade has."""
    triangles = []
    for side in (1, -1):
        corners = [(side * y, z) for y, z in ((-3.7e-3, -3e-3), (-2.3e-3, -3e-3), (3.7e-3, 3e-3), (2.3e-3, 3e-3))]
        rings = [[(side * 0.01115 * k / stations, y, z) for y, z in corners] for k in range(stations + 1)]
        for near, far in zip(rings, rings[1:]):
            for k in range(4):
                a, b, c, d = near[k], near[(k + 1) % 4], far[(k + 1) % 4], far[k]
                triangles += [(a, b, c), (a, c, d)]
        for a, b, c, d in (rings[0][::-1], rings[-1]):
            triangles += [(a, b, c), (a, c, d)]
    with open(path, "w") as out:
        out.write("solid plates\n")
        for a, b, c in triangles:
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            size = sum(n * n for n in normal) ** 0.5
            out.write("facet normal " + " ".join(f"{n / size:.6e}" for n in normal) + "\nouter loop\n")
            for point in (a, b, c):
                out.write("vertex " + " ".join(f"{p:.9e}" for p in point) + "\n")
            out.write("endloop\nendfacet\n")
        out.write("endsolid plates\n")


def settle(jamscope, beads, folder):
    """Writes the bed and the plates for the peers; returns the height of the plates' middle, m, the grains and those written."""
    run = folder / "run"
    subprocess.run([jamscope, "simulate", CASE, "-o", run, "--until", f"{10 * STEP} s", "--quiet", *case_options(beads)], check=True)
    with h5py.File(run / "run.h5", "r", swmr=True) as file:
        count = int(file["/frames/particle_count"][0])
        places, radii = file["/particles/position"][:count], file["/particles/radius"][:count]
        blade = next(wall for wall in file["/walls"].values() if wall.attrs["role"].decode().rstrip("\0") == "blade")
        middle = float(blade["pose_position"][0][2])
    grains = [(*map(float, place), float(radius)) for place, radius in zip(places, radii)]
    kept = [grain for grain in grains if not in_plates(grain, middle)]
    write_bed(folder / "bed.data", kept, "settled by jamscope, less what stands in the plates")
    write_plates(folder / "plates.stl")
    return middle, len(grains), len(kept)


def peer(program, script, cores, folder, grains, steps, **values):
    variables = {"px": cores, "modulus": MODULUS, "skin": SKIN, "step": STEP, "warm": 100, "steps": steps, **values}
    command = [program, "-in", HERE / script, "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    command = (["taskset", "-c", "0"] if cores == 1 else ["mpirun", "-np", str(cores), "--bind-to", "core"]) + command
    done = subprocess.run(command, cwd=folder, env={**os.environ, **MPI}, capture_output=True, text=True)
    loops = re.findall(r"Loop time of ([0-9.e+-]+) on", done.stdout)
    if done.returncode != 0 or len(loops) != 2:
        sys.exit(f"{program} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    left = int(re.findall(r"with (\d+) atoms", done.stdout)[-1])
    if left < 0.99 * grains:
        sys.exit(f"{program} lost {grains - left} of {grains} grains")
    return left * steps / float(loops[-1])


def ours(jamscope, cores, beads, seconds, mode):
    command = [jamscope, "bench", CASE, "--json", "--quiet", "--threads", str(cores), "--seconds", str(seconds), "--warm-up", "5",
               *mode, *case_options(beads)]
    if cores == 1:
        command = ["taskset", "-c", "0"] + command
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["particle_steps_per_second"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("jamscope", type=Path)
    parser.add_argument("--beads", type=int, help="a bed as deep as so many grains make it; default: the paper's 52 mm")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=10, help="s, that each run takes about")
    parser.add_argument("--json", type=Path, help="the numbers, for programs")
    options = parser.parse_args()
    jamscope = options.jamscope.resolve()
    for program in ("lmp", "liggghts", "mpirun"):
        if shutil.which(program) is None:
            sys.exit(f"{program} is not installed: apt-get install lammps liggghts openmpi-bin")
    numbers = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        middle, grains, kept = settle(jamscope, options.beads, folder)
        print(f"{grains} grains, {kept} of them outside the peers' plates; step {STEP} s", file=sys.stderr)
        for turn in range(options.rounds):
            for cores in (1, 2):
                steps = lambda speed: max(50, int(options.seconds * speed * cores / grains))
                rates = {
                    "jamscope": ours(jamscope, cores, options.beads, options.seconds, ["--uniform"]),
                    "lammps": peer("lmp", "in.lammps", cores, folder, kept, steps(2.5e6), blade=middle,
                                   surface_energy=SURFACE_ENERGY),
                    "liggghts": peer("liggghts", "in.liggghts", cores, folder, kept, steps(5e6), blade=middle),
                }
                for code, rate in rates.items():
                    numbers.setdefault(code, {}).setdefault(cores, []).append(rate)
                print(f"round {turn + 1}, {cores} core(s): " + ", ".join(f"{c} {r:.3g}" for c, r in rates.items()), file=sys.stderr)
    print(f"{'code':<10}{'cores':>6}{'grain steps/s':>15}{'jamscope over it':>18}")
    table = []
    for code, by_cores in numbers.items():
        for cores, rates in by_cores.items():
            ratio = statistics.median(o / r for o, r in zip(numbers["jamscope"][cores], rates))
            print(f"{code:<10}{cores:>6}{statistics.median(rates):>15.3g}{ratio:>18.2f}")
            table.append({"code": code, "cores": cores, "grain_steps_per_second": rates, "jamscope_over_it": ratio})
    if options.json:
        options.json.write_text(json.dumps({"grains": grains, "step_s": STEP, "rates": table}, indent=2) + "\n")


if __name__ == "__main__":
    main()
