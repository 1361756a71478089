#!/usr/bin/python3
"""Which of two builds of jamscope steps faster, on a machine whose speed changes from second to second.

    tests/bench/side_by_side.py before/jamscope after/jamscope data/cases/ft4_a_up.toml --set run.step=auto --set run.accuracy=0.26
    tests/bench/side_by_side.py build/jamscope build/jamscope CASE --set run.step=auto --against-uniform

In each round both run `jamscope bench` at the same time on the same core, which the system gives to one and the other every few
milliseconds: what else the machine does slows both alike. Prints the ratio of their grain steps, the second over the first: the median of
the rounds and the extremes. A program against itself gives 0.99 to 1.01. Rates are half of what a core alone does, and caches are shared:
for rates run `jamscope bench` itself. With --against-uniform the first steps with every contact at every step.
"""
import argparse
import json
import os
import statistics
import subprocess


def start(program, core, options, args):
    command = [program, "bench", args.case, *options, "--threads", "1", "--json", "--quiet", "--warm-up", str(args.warm_up), "--seconds", str(args.seconds)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=lambda: os.sched_setaffinity(0, {core}))


def rate(process):
    output, _ = process.communicate()
    if process.returncode != 0:
        raise SystemExit(f"{process.args[0]} ended with {process.returncode}")
    return json.loads(output)["particle_steps_per_second"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first")
    parser.add_argument("second")
    parser.add_argument("case", help="case file; all that follows goes to `jamscope bench` of both")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=12, help="of both together, each round")
    parser.add_argument("--warm-up", type=float, default=4)
    parser.add_argument("--against-uniform", action="store_true", help="the first with --uniform, only the second with the options")
    args, options = parser.parse_known_args()
    cores = sorted(os.sched_getaffinity(0))
    ratios = []
    for number in range(args.rounds):
        core = cores[number % len(cores)]
        first = start(args.first, core, ["--uniform"] if args.against_uniform else options, args)
        second = start(args.second, core, options, args)
        rates = rate(first), rate(second)
        ratios.append(rates[1] / rates[0])
        print(f"round {number + 1}, core {core}: {rates[0]:.3g} and {rates[1]:.3g} grain steps/s, {ratios[-1]:.3f}", flush=True)
    print(f"second over first: {statistics.median(ratios):.3f} in the median of {len(ratios)} ({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
