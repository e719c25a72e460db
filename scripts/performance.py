#!/usr/bin/env python3
"""Measures what doc/performance.md states and prints its tables in markdown.

scripts/performance.py [--plate DIR] [--large] [--repeat N]

Needs `scripts/build.sh release`; builds the benchmarks, plain loops to compare
with among them. All figures are processor time but for those of two ranks.
Each round runs every program once, so that all see the same machine; medians
of the rounds count, of ratios, too.

--plate  a run of the plate (its result.json) for the shares of the phases;
         none: spacing-1.0mm.prm is run to 30 us
--large  also 10^6 particles (3 GB)
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build/release")
# OpenMPI refuses root unless told twice.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

BLOCK = """
include %(root)s/prm/materials/al6061-t6.prm
set Title = block
set End time = %(end)s
set Energy residual limit = 1000
set List of bodies = block
subsection Bodies
  subsection block
    set Discretization = %(kind)s
    set Material = al6061-t6
    set Size = %(size)s mm, %(size)s mm, %(size)s mm
    set %(entry)s = 1 mm
    %(more)s
  end
end
"""


def output_of(command):
    done = subprocess.run(command, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, universal_newlines=True,
                          env=ENVIRONMENT)
    if done.returncode != 0:
        raise SystemExit("failed: " + " ".join(command))
    return done.stdout


def benchmark(program, pattern):
    """ns per item of each benchmark that fits."""
    path = os.path.join(BUILD, "benchmark_" + program)
    data = json.loads(output_of([path, "--benchmark_format=json",
                                 "--benchmark_filter=" + pattern]))
    return {b["name"]: b["cpu_time"] / b["items"] for b in data["benchmarks"]}


def run(scene, folder, *settings, ranks=1):
    command = [os.path.join(BUILD, "sabot"), "run", scene, "-o", folder,
               "--quiet", "--overwrite"]
    for setting in settings:
        command += ["--set", setting]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-np", str(ranks)] + command
    output_of(command)
    return read(folder)


def read(folder):
    with open(os.path.join(folder, "result.json")) as file:
        return json.load(file)


def block(folder, kind, size, end, ranks=1):
    scene = os.path.join(folder, "block.prm")
    with open(scene, "w") as file:
        file.write(BLOCK % {
            "root": ROOT, "kind": kind, "size": size, "end": end,
            "entry": "Nodal spacing" if kind == "SPG" else "Cell size",
            "more": "set Initial velocity = 100 m/s, 0 m/s, 0 m/s"
                    if kind == "SPG" else
                    "set Driven faces = -x\n    set Prescribed velocity = "
                    "20 m/s, 0 m/s, 0 m/s"})
    return run(scene, os.path.join(folder, "block"), ranks=ranks)


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def steps(arguments):
    spg = "johnson_cook_(un|bond).*/22|johnson_cook_bond_residual/47"
    if arguments.large:
        spg += "|johnson_cook_bond_residual/100"
    rounds = []
    for _ in range(arguments.repeat):
        measured = {"plain " + name: ns for name, ns in benchmark(
            "plain_loops", "(stabilized|cells)/(22|47%s)"
            % ("|100" if arguments.large else "")).items()}
        measured.update(benchmark("spg_step", spg))
        measured.update(benchmark("fem_step", "johnson_cook"))
        rounds.append(measured)
    median = {key: statistics.median(r[key] for r in rounds)
              for key in rounds[0]}

    def against(name, base):
        if base not in median:
            return "–"
        return "%.2f" % statistics.median(r[name] / r[base] for r in rounds)

    print("## Step, ns per item (medians of %d rounds)\n" % arguments.repeat)
    names = (("SPG, Johnson-Cook, bond residual, 10^4", "plain particles_stabilized/22",
              "johnson_cook_bond_residual/22"),
             ("SPG, Johnson-Cook, bond residual, 10^5", 
              "plain particles_stabilized/47",
              "johnson_cook_bond_residual/47"),
             ("SPG, Johnson-Cook, bond residual, 10^6",
              "plain particles_stabilized/100",
              "johnson_cook_bond_residual/100"),
             ("SPG, Johnson-Cook, no stabilization, 10^4", "-",
              "johnson_cook_unstabilized/22"),
             ("FEM, Johnson-Cook, one point, viscous, 10^4", "plain cells/22",
              "johnson_cook_viscous/22"),
             ("FEM, Johnson-Cook, one point, viscous, 10^5",
              "plain cells/47", "johnson_cook_viscous/47"),
             ("FEM, Johnson-Cook, one point, stiffness, 10^4", "plain cells/22",
              "johnson_cook_stiffness/22"),
             ("FEM, Johnson-Cook, B-bar, 10^4", "-", "johnson_cook_b_bar/22"))
    table(("loop", "ns per item", "plain loop", "ratio"),
          [(name, "%.0f" % median[key],
            "%.0f" % median[base] if base in median else "–",
            against(key, base)) for name, base, key in names if key in median])
    for edge, power in ((47, 5), (100, 6)):
        name = "johnson_cook_bond_residual/%d" % edge
        if name in median:
            print("Growth of the SPG step from 10^4 to 10^%d particles: %.2f.\n"
                  % (power, statistics.median(
                      r[name] / r["johnson_cook_bond_residual/22"]
                      for r in rounds)))


def memory(folder):
    print("## Memory\n")
    rows = []
    for kind, items in (("SPG", "particles"), ("FEM", "cells")):
        sizes = []
        for size in (20, 46):
            r = block(folder, kind, size, "0.5 us")
            sizes.append((r["bodies"]["block"][items], r["peak_memory_bytes"]))
        (n1, b1), (n2, b2) = sizes
        rows.append((kind, items, "%d to %d" % (n1, n2),
                     "%.0f" % ((b2 - b1) / (n2 - n1))))
    table(("body", "items", "from", "bytes per further item, peak"), rows)


def shares(arguments, folder):
    if arguments.plate:
        r = read(arguments.plate)
    else:
        r = run(os.path.join(ROOT, "prm/perforation/spacing-1.0mm.prm"),
                os.path.join(folder, "plate"), "End time=30 us")
    total = sum(t["cpu_seconds"] for t in r["timers"].values())
    print("## Phases of the plate: %d steps to %.3g ms, %.0f s of the "
          "processor\n" % (r["steps"], 1e3 * r["time"], r["cpu_seconds"]))
    rows = [(name, "%.1f" % t["cpu_seconds"],
             "%.1f" % (100 * t["cpu_seconds"] / total),
             "%.0f" % t["ns_per_item"] if t["ns_per_item"] else "–")
            for name, t in sorted(r["timers"].items(),
                                  key=lambda pair: -pair[1]["cpu_seconds"])
            if t["cpu_seconds"] > 0.001 * total]
    table(("phase", "s", "%", "ns per item"), rows)
    contact = sum(t["cpu_seconds"] for name, t in r["timers"].items()
                  if "contact" in name)
    update = r["timers"]["kernel update"]["cpu_seconds"]
    print("Contact with its searches %.1f %%, kernel update %.1f %% of the "
          "run.\n" % (100 * contact / total, 100 * update / total))
    limits = r["step_limits"]
    print("Steps: %.2f times as many as %s at rest need; limited by\n"
          % (limits["steps_over_own"], limits["own_step_of"]))
    table(("what", "kind", "% of the steps"),
          [(row["name"], row["kind"], "%.1f" % (100 * row["share"]))
           for row in limits["limited_by"]])


def ranks(folder):
    print("## Two ranks, 10^5 particles (wall time of the steps)\n")
    seconds = []
    for n in (1, 2):
        r = block(folder, "SPG", 46, "8 us", ranks=n)
        # The time of the set-up is spent once.
        seconds.append((r["wall_seconds"] - r["timers"]["set-up"]["seconds"])
                       / r["steps"])
    table(("ranks", "ms per step", "speed-up"),
          [("1", "%.1f" % (1e3 * seconds[0]), "1"),
           ("2", "%.1f" % (1e3 * seconds[1]),
            "%.2f" % (seconds[0] / seconds[1]))])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--plate")
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--only", help="steps, memory, shares or ranks")
    arguments = parser.parse_args()
    build = subprocess.run(["ninja", "-C", BUILD, "benchmarks"],
                           stdout=subprocess.DEVNULL)
    if build.returncode != 0:
        raise SystemExit("set it up first: scripts/build.sh release")
    with open("/proc/loadavg") as file:
        print("Load of the machine at the start: %s\n" % file.read().split()[0])
    with tempfile.TemporaryDirectory() as folder:
        for name, action in (("steps", lambda: steps(arguments)),
                             ("memory", lambda: memory(folder)),
                             ("shares", lambda: shares(arguments, folder)),
                             ("ranks", lambda: ranks(folder))):
            if arguments.only in (None, name):
                action()


if __name__ == "__main__":
    main()
