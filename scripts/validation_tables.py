#!/usr/bin/env python3
"""Prints the tables of doc/validation.md from the studies of validation.sh.

scripts/validation_tables.py DIR [--figures FOLDER]

DIR holds one folder per study, as `sabot study prm/studies/NAME.prm -o DIR/NAME
--runs DIR/runs` leaves them; those that are not there are left out. Repeats are averaged:
mean +- standard deviation of one run. --figures copies charts.
"""
import argparse
import collections
import csv
import os
import shutil
import statistics

MEASURED = 344.  # m/s, Schwer 2009
ABSORBED = 5593.  # J, of 6398 J
# What Wu and Wu 2018 say of the residual velocity, by parameter and value.
PAPER = {
    ("friction", "0.3"): "1 % error", ("friction", "0.2"): "6 % error",
    ("failure strain", "SPG 0.4"): "1 % error",
    ("failure strain", "SPG 0.2"): "marginal difference to 0.4",
    ("failure strain", "FEM erosion 0.4"): "20 % error",
    ("failure strain", "FEM erosion 0.2"): "40 % error",
    ("zone", "30 mm"): "1 % error",
    ("zone", "60 mm"): "nearly identical to 30 mm",
}
ORDER = ("spacing", "friction", "failure-strain", "zone", "real", "weldox", "copper-taylor")
# Outlines of Zelepugin et al. 2023 in mm: length, foot, radii at shares of the length.
COPPER = {
    "1 OFHC 210 m/s": (14.796, 8.397, 5.347, 5.192, 4.929, 4.400, 4.111),
    "2 ETP 718 K": (16.603, 5.595, 4.663, 4.663, 4.512, 3.920, 3.390),
    "4 M1 167 m/s": (25.648, 6.911, 4.713, 4.567, 4.323, 3.949, 3.903),
    "5 M1 225 m/s": (22.253, 8.020, 5.128, 4.934, 4.634, 4.080, 3.931),
}
CHARTS = (("spacing", "residual-velocity-at-spacing"),
          ("friction", "residual-velocity-history"),
          ("weldox", "residual-velocity-at-impact"))


class Study:
    def __init__(self, folder, name):
        self.folder, self.name = os.path.join(folder, name), name
        with open(os.path.join(self.folder, "study.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        head = list(rows[0])
        # Parameters stand between the status and the first quantity.
        first = next(i for i, column in enumerate(head) if "[" in column)
        self.parameters = [p for p in head[2:first] if p != "start"]
        self.quantities = [c for c in head[first:head.index("CPU time [s]")]
                           if not c.startswith("relative error")]
        self.groups = collections.OrderedDict()
        for row in rows:
            key = tuple(row[p] for p in self.parameters)
            self.groups.setdefault(key, []).append(row)


def values(rows, column):
    return [float(row[column]) for row in rows
            if row["status"] == "completed" and row.get(column)]


def with_scatter(found, digits=1):
    if not found:
        return "–"
    text = "%.*f" % (digits, statistics.mean(found))
    return text if len(found) == 1 else text + " ± %.*f" % (digits, statistics.stdev(found))


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print()


def print_plate(study):
    head = study.parameters + ["runs", "residual velocity m/s", "against 344 %",
                               "absorbed J", "against 5593 %"]
    has_paper = any((p, value) in PAPER for key in study.groups
                    for p, value in zip(study.parameters, key))
    head += (["paper"] if has_paper else []) + ["energy residual %", "steps", "CPU s"]
    rows = []
    for key, group in study.groups.items():
        speed = values(group, "residual velocity [m/s]")
        absorbed = values(group, "absorbed energy [J]")
        cells = list(key) + ["%d of %d" % (len(speed), len(group)), with_scatter(speed)]
        if speed:
            v, e = statistics.mean(speed), statistics.mean(absorbed)
            cells += ["%+.1f" % (100 * (v / MEASURED - 1)), with_scatter(absorbed, 0),
                      "%+.1f" % (100 * (e / ABSORBED - 1))]
        else:
            cells += ["–", "–", "–"]
        if has_paper:
            cells.append("; ".join(PAPER[both] for both in zip(study.parameters, key)
                                   if both in PAPER))
        cells += ["%.2f" % (100 * max(values(group, "energy residual") or [0.])),
                  "%.0f" % statistics.mean(values(group, "steps") or [0.]),
                  "%.0f" % statistics.mean(values(group, "CPU time [s]") or [0.])]
        rows.append(cells)
    table(head, rows)


def print_weldox(study):
    measured = {"303.5 m/s": "199.7", "200.4 m/s": "71.4"}
    rows = []
    for key, group in sorted(study.groups.items(),
                             key=lambda item: (item[0][1:], float(item[0][0].split()[0]))):
        speed = values(group, "residual velocity [m/s]")
        rows.append(list(key) + [with_scatter(speed), measured.get(key[0], ""),
                                 "%.0f" % statistics.mean(values(group, "steps") or [0.]),
                                 "%.0f" % statistics.mean(values(group, "CPU time [s]") or [0.])])
    table(study.parameters + ["residual velocity m/s", "measured", "steps", "CPU s"], rows)


def print_copper(study):
    rows = []
    for key, group in study.groups.items():
        exact = COPPER.get(key[0])
        if not exact:
            continue
        cells = [key[0]]
        for quantity, measured in zip(study.quantities, exact):
            found = values(group, quantity)
            cells.append("%.3f (%+.1f)" % (1e3 * found[0],
                                           100 * (1e3 * found[0] / measured - 1))
                         if found else "–")
        rows.append(cells)
    table(["bar", "length mm (off %)", "foot", "at 0.2", "0.25", "1/3", "1/2", "2/3"], rows)


def print_study(study):
    print("### %s\n" % study.name)
    print("    build/release/sabot study prm/studies/%s.prm -o "
          "results/validation/%s --runs results/validation/runs\n"
          % (study.name, study.name))
    {"weldox": print_weldox, "copper-taylor": print_copper}.get(study.name, print_plate)(study)


def print_targets(studies):
    """Nothing is tuned to these."""
    rows = []

    def mean(name, key, column):
        study = studies.get(name)
        found = values(study.groups.get(key, []), column) if study else []
        return statistics.mean(found) if found else None

    def add(name, bound, got, unit="%"):
        if got is not None:
            rows.append([name, "≤ %g %s" % (bound, unit), "%.1f %s" % (got, unit),
                         "met" if got <= bound else "missed"])

    speed, absorbed = "residual velocity [m/s]", "absorbed energy [J]"
    for h in ("1.0 mm", "0.75 mm"):
        energy = mean("spacing", ("SPG", h), absorbed)
        add("absorbed energy at %s against 5593 J" % h, 2.,
            energy and abs(100 * (energy / ABSORBED - 1)))
    all_speeds = [mean("spacing", ("SPG", h), speed) for h in ("1.27 mm", "1.0 mm", "0.75 mm")]
    if None not in all_speeds:
        add("1.27 to 0.75 mm: range of the residual velocity", 2.,
            100 * (max(all_speeds) - min(all_speeds)) / statistics.mean(all_speeds))
    strong = mean("failure-strain", ("SPG 0.4",), absorbed)
    weak = mean("failure-strain", ("SPG 0.2",), absorbed)
    if strong and weak:
        add("failure strain 0.2 against 0.4, absorbed energy", 3., 100 * abs(weak / strong - 1))
    narrow, wide = (mean("zone", (z,), speed) for z in ("30 mm", "60 mm"))
    if narrow and wide:
        add("zone of 30 against 60 mm", 1., 100 * abs(narrow / wide - 1))
    print("### Targets\n")
    table(["target", "bound", "got", ""], rows)


def copy_figures(studies, folder):
    for name, chart in CHARTS:
        source = os.path.join(studies[name].folder, "charts", chart + ".png") \
            if name in studies else ""
        if os.path.exists(source):
            shutil.copy(source, os.path.join(folder, "%s-%s.png" % (name, chart)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--figures")
    arguments = parser.parse_args()
    studies = {name: Study(arguments.folder, name) for name in ORDER
               if os.path.exists(os.path.join(arguments.folder, name, "study.csv"))}
    if arguments.figures:
        copy_figures(studies, arguments.figures)
        return
    print_targets(studies)
    for study in studies.values():
        print_study(study)


if __name__ == "__main__":
    main()
