#!/usr/bin/env python3
"""Compares the instructions of the hot loops with those that are stored.

scripts/instruction_counts.py [--program PATH] [--renew]

Runs hot_loops (benchmarks/counted) under callgrind: no timed test, so it says
the same on a busy machine. More or less than 3 % from a stored figure fails,
for what got faster is to be stored, too. Figures go by compiler, in
benchmarks/counted/instruction_counts.json; of a compiler that is not there the
counts are printed and the test is skipped (exit code 77).

--renew  stores what is counted now for this compiler; run it after a change
         that means to change them, and commit the file
"""
import argparse
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
STORED = os.path.join(ROOT, "benchmarks/counted/instruction_counts.json")
TOLERANCE = 0.03
SKIPPED = 77


def skip(reason):
    print("skipped: " + reason)
    raise SystemExit(SKIPPED)


def count(program):
    """Compiler, and instructions per item of each loop."""
    if shutil.which("valgrind") is None:
        skip("valgrind is not installed; scripts/packages.sh test")
    # OpenMPI refuses root unless told twice.
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--instr-atstart=no",
             "--callgrind-out-file=" + os.path.join(folder, "out"), program],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            universal_newlines=True, env=environment)
        if done.returncode != 0:
            raise SystemExit("error: hot_loops failed under valgrind:\n" +
                             done.stderr[-3000:])
        counts = {}
        for path in glob.glob(os.path.join(folder, "out.*")):
            with open(path) as file:
                text = file.read()
            name = re.search(r"^desc: Trigger: Client Request: (.*), (\d+) "
                             r"items$", text, re.M)
            if name:
                total = int(re.search(r"^totals: (\d+)$", text, re.M).group(1))
                counts[name.group(1)] = round(total / int(name.group(2)), 1)
    if not counts:
        raise SystemExit("error: callgrind counted nothing")
    compiler = re.search(r"^compiler: (.*)$", done.stdout, re.M).group(1)
    return compiler, counts


def compare(now, before):
    """Prints a table; whether all are within the tolerance."""
    good = True
    print("%-24s %10s %10s %8s" % ("instructions per item", "stored", "now",
                                   "change"))
    for name in sorted(set(now) | set(before)):
        if name not in now or name not in before:
            print("%-24s is %s" % (name, "not stored" if name in now
                                   else "no longer counted"))
            good = False
            continue
        change = now[name] / before[name] - 1.
        is_off = abs(change) > TOLERANCE
        good = good and not is_off
        print("%-24s %10.1f %10.1f %+7.1f %%%s"
              % (name, before[name], now[name], 100. * change,
                 " <--" if is_off else ""))
    return good


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default=os.path.join(
        ROOT, "build/release/hot_loops"))
    parser.add_argument("--renew", action="store_true")
    arguments = parser.parse_args()
    if not os.path.exists(arguments.program):
        raise SystemExit("error: build it first: ninja -C build/release "
                         "hot_loops")
    compiler, now = count(arguments.program)
    with open(STORED) as file:
        stored = json.load(file)
    print("compiler: " + compiler)
    if arguments.renew:
        stored[compiler] = now
        with open(STORED, "w") as file:
            json.dump(stored, file, indent=2, sort_keys=True)
            file.write("\n")
    if compiler not in stored:
        for name, value in sorted(now.items()):
            print("%-24s %10.1f" % (name, value))
        skip("no figures are stored for this compiler, only for %s; --renew "
             "stores them" % ", ".join(sorted(stored)))
    if not compare(now, stored[compiler]):
        print("off by more than %.0f %%: if that is meant, store the new "
              "figures with scripts/instruction_counts.py --renew"
              % (100. * TOLERANCE))
        sys.exit(1)


if __name__ == "__main__":
    main()
