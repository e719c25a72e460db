#!/usr/bin/env python3
"""Other programs' explicit steps beside Sabot's, in one sitting.

scripts/peers.py [--size N] [--repeat N]

A block of N^3 particles or cells (22) whose metal yields, on one core, user
time: LAMMPS with state-based elastic-plastic peridynamics (pair style peri/eps)
and a horizon of 26 neighbors, what an SPG particle has; CalculiX, explicit, with
eight-point and one-point hexahedra (C3D8, C3D8R) and hardening plasticity.
Debian: apt install lammps calculix-ccx. What is not installed is left out.
Time per step is the difference of a long and a short run, set-up is in none.
"""
import argparse
import os
import re
import resource
import shutil
import statistics
import subprocess
import tempfile

from performance import benchmark, table

SPACING = 1e-3

LAMMPS = """units si
boundary s s s
atom_style peri
atom_modify map array
neighbor %(skin)g bin
lattice sc %(spacing)g
region block block 0 %(end)g 0 %(end)g 0 %(end)g units lattice
create_box 1 block
create_atoms 1 region block
pair_style peri/eps
pair_coeff * * 5.83e10 2.69e10 %(horizon)g 10.0 0.25 3.24e8
set group all density 2700
set group all volume %(volume)g
velocity all ramp vz 0 -100 z 0 %(length)g units box
fix 1 all nve
timestep 5e-8
neigh_modify every 1000000 delay 1000000 check no
run %(steps)d
"""

CALCULIX = """*NSET,NSET=BASE,GENERATE
1,%(base)d,1
*MATERIAL,NAME=M
*ELASTIC
7.0e10,0.3
*DENSITY
2700.
*PLASTIC
3.24e8,0.
5.0e8,1.
*SOLID SECTION,ELSET=EALL,MATERIAL=M
*INITIAL CONDITIONS,TYPE=VELOCITY
NALL,3,-100.
*BOUNDARY
BASE,3,3
*STEP,NLGEOM,INC=10000000
*DYNAMIC,EXPLICIT
1e-7,%(end)g
*NODE FILE
U
*END STEP
"""


def user_time(command, folder):
    """Seconds of the processor, and what the program printed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True,
                          env=dict(os.environ, OMP_NUM_THREADS="1"))
    if done.returncode != 0:
        raise SystemExit("failed: " + " ".join(command) + "\n" +
                         done.stdout[-500:])
    spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return spent, done.stdout


def lammps(size, steps, folder):
    with open(os.path.join(folder, "block.in"), "w") as file:
        file.write(LAMMPS % {
            "spacing": SPACING, "skin": 0.4 * SPACING, "end": size - 0.5,
            "horizon": 1.75 * SPACING, "volume": SPACING**3,
            "length": size * SPACING, "steps": steps})
    return user_time(["lmp", "-in", "block.in"], folder)[0], steps


def calculix(kind, size, steps, folder):
    edge = size + 1

    def node(i, j, k):
        return 1 + i + edge * (j + edge * k)

    places = range(edge)
    cells = range(size)
    corners = [(a, b, c) for c in (0, 1)
               for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    with open(os.path.join(folder, "block.inp"), "w") as file:
        file.write("*NODE,NSET=NALL\n")
        file.writelines("%d,%g,%g,%g\n" % (node(i, j, k), i * SPACING,
                                            j * SPACING, k * SPACING)
                        for k in places for j in places for i in places)
        file.write("*ELEMENT,TYPE=%s,ELSET=EALL\n" % kind)
        number = 0
        for k in cells:
            for j in cells:
                for i in cells:
                    number += 1
                    file.write("%d,%s\n" % (number, ",".join(
                        str(node(i + a, j + b, k + c)) for a, b, c in corners)))
        # CalculiX chooses its step itself; the number of steps follows.
        file.write(CALCULIX % {"base": edge * edge, "end": 1e-7 * steps})
    spent, printed = user_time(["ccx", "block"], folder)
    step = float(re.search(r"SELECTED time increment:\s*([0-9.Ee+-]+)",
                           printed).group(1))
    return spent, 1e-7 * steps / step


def per_item(program, size, folder):
    """ns per item and step, by a short and a long run."""
    short, long = (program(size, steps, folder) for steps in (20, 80))
    return 1e9 * (long[0] - short[0]) / ((long[1] - short[1]) * size**3)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=22)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    peers = []
    if shutil.which("lmp"):
        peers.append(("LAMMPS, peri/eps, 26 neighbors", lammps))
    if shutil.which("ccx"):
        peers += [("CalculiX, explicit, %s" % kind,
                   lambda *rest, kind=kind: calculix(kind, *rest))
                  for kind in ("C3D8R", "C3D8")]
    rows = {}
    for _ in range(arguments.repeat):
        for program in ("spg_step", "fem_step"):
            pattern = "johnson_cook_(bond_residual|viscous|b_bar)/%d$"
            for name, ns in benchmark(program,
                                      pattern % arguments.size).items():
                rows.setdefault("Sabot, " + name, []).append(ns)
        with tempfile.TemporaryDirectory() as folder:
            for name, program in peers:
                rows.setdefault(name, []).append(
                    per_item(program, arguments.size, folder))
    table(("program", "ns per item and step"),
          [(name, "%.0f" % statistics.median(values))
           for name, values in rows.items()])


if __name__ == "__main__":
    main()
