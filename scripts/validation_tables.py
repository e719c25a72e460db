#!/usr/bin/env python3
"""Prints the tables of doc/validation.md from the studies of validation.sh.

scripts/validation_tables.py DIR [--figures FOLDER]

DIR holds one folder per study, as `sabot study prm/studies/NAME.prm -o DIR/NAME
--runs DIR/runs` leaves them. --figures copies charts there and draws sections at four times.
"""
import argparse
import csv
import json
import os
import shutil
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MEASURED = 344.  # m/s, Schwer 2009
# What Wu and Wu 2018 say of the residual velocity, by study and value.
PAPER = {
    ("friction", "0.3"): "1 % error", ("friction", "0.2"): "6 % error",
    ("failure strain", "SPG 0.4"): "1 % error",
    ("failure strain", "SPG 0.2"): "marginal difference to 0.4",
    ("failure strain", "FEM erosion 0.4"): "20 % error",
    ("failure strain", "FEM erosion 0.2"): "40 % error",
    ("zone", "30 mm"): "1 % error",
    ("zone", "60 mm"): "nearly identical to 30 mm",
}
ORDER = ("spacing", "unyielding", "friction", "failure-strain", "zone", "projectile",
         "projectile-spg", "projectile-failing",
         "symmetry", "physics", "method", "projectile-taylor")


class Study:
    def __init__(self, folder, name):
        self.folder, self.name = os.path.join(folder, name), name
        self.runs = os.path.join(folder, "runs")
        with open(os.path.join(self.folder, "study.csv"), newline="") as file:
            self.rows = list(csv.DictReader(file))
        head = list(self.rows[0])
        # Parameters stand between the status and the first quantity.
        first = next(i for i, column in enumerate(head) if "[" in column)
        self.parameters = head[2:first]
        self.quantities = [c for c in head[first:head.index("CPU time [s]")]
                           if not c.startswith("relative error")]

    def value(self, quantity="residual velocity [m/s]", **choice):
        """Of the completed run with these labels; None: there is none."""
        for row in self.rows:
            if row["status"] == "completed" and row.get(quantity) and all(
                    row[key.replace("_", " ")] == label
                    for key, label in choice.items()):
                return float(row[quantity])
        return None

    def result(self, row):
        path = os.path.join(self.runs, row["run"], "result.json")
        if not os.path.exists(path):
            return {}
        with open(path) as file:
            return json.load(file)


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print()


def number(text, pattern="%.1f", factor=1.):
    return pattern % (factor * float(text)) if text else "–"


def print_study(study):
    print("### %s\n" % study.name)
    print("    build/release/sabot study prm/studies/%s.prm -o "
          "results/validation/%s --runs results/validation/runs\n"
          % (study.name, study.name))
    has_speed = "residual velocity [m/s]" in study.quantities
    has_paper = study.name != "projectile-failing" and any(
        (p, row[p]) in PAPER for row in study.rows for p in study.parameters)
    head = list(study.parameters)
    has_measured = has_speed and study.name != "unyielding"
    head += ["residual velocity m/s"] + (
        ["against 344 %"] if has_measured else []) if has_speed else [
        q for q in study.quantities]
    # What is left of a projectile that sheds debris.
    has_pieces = study.name == "projectile-failing"
    head += ["largest piece m/s", "its share %"] if has_pieces else []
    head += ["paper"] if has_paper else []
    head += ["energy residual %", "steps", "CPU s"]
    rows = []
    for row in study.rows:
        cells = [row[p] for p in study.parameters]
        done = row["status"] == "completed"
        if not done:
            cells += [row["status"] + ": " + row["reason"]]
            cells += [""] if has_measured else []
            if not has_speed:
                cells += [""] * (len(study.quantities) - 1)
        elif has_speed:
            v = float(row["residual velocity [m/s]"])
            cells += ["%.1f" % v]
            if has_measured:
                cells += ["%+.1f" % (100 * (v - MEASURED) / MEASURED)]
        else:
            cells += [number(row[q], "%.5g") for q in study.quantities]
        if has_pieces:
            slug = study.result(row).get("bodies", {}).get("slug", {})
            piece = (slug.get("fragments") or [None])[0]
            cells += ["–", "–"] if not done or not piece else [
                "%.1f" % -piece["velocity"][2],
                "%.0f" % (100 * piece["mass"] / slug["mass"])]
        if has_paper:
            cells.append("; ".join(PAPER[p, row[p]] for p in study.parameters
                                   if (p, row[p]) in PAPER))
        cells += [number(row["energy residual"], "%.2f", 100.),
                  number(row["steps"], "%.0f"), number(row["CPU time [s]"])]
        rows.append(cells)
    table(head, rows)


def print_zone(study):
    """The verdict of each run beside what the other runs gave."""
    rows = []
    base = study.rows[0]
    for row in study.rows:
        zone = study.result(row).get("zone", {}).get("core")
        if not zone or row["status"] != "completed":
            continue
        distance = [zone[key]["distance_from_tie_in_spacings"]
                    for key in ("plastic_strain_over_0.01", "broken_bonds")]
        smallest = zone["smallest_zone"]
        rows.append([row["zone"]] +
                    ["–" if d is None else "%.1f" % d for d in distance] +
                    [("at least " if zone["is_lower_bound"] else "") +
                     "%.0f x %.0f mm" % tuple(1e3 * s for s in
                                              smallest["size"][:2]),
                     "%+.0f" % smallest["seconds_saved"], zone["verdict"],
                     "%+.1f" % (float(row["residual velocity [m/s]"]) -
                                float(base["residual velocity [m/s]"])),
                     "%+.0f" % (float(base["CPU time [s]"]) -
                                float(row["CPU time [s]"]))])
    print("Zone verdict of each run (distances from the tie in spacings, of "
          "plastic strain over 1 % and of broken bonds) and what the study "
          "measured:\n")
    table(("zone", "plastic strain", "broken bonds", "smallest zone",
           "would save s", "verdict", "change m/s", "saved s"), rows)


def print_prices(study):
    """What each knob saves and changes against the first run."""
    base, rows = study.rows[0], []
    for row in study.rows[1:]:
        if row["status"] != "completed":
            continue
        rows.append([
            ", ".join("%s %s" % (p, row[p]) for p in study.parameters
                      if row[p] != base[p]),
            "%+.1f" % (float(base["CPU time [s]"]) -
                       float(row["CPU time [s]"])),
            "%+.1f" % (float(row["residual velocity [m/s]"]) -
                       float(base["residual velocity [m/s]"]))])
    print("Price list against the first run:\n")
    table(("knob", "CPU s saved", "residual velocity changes by m/s"), rows)


def print_energies(study):
    """Where the impact energy is at the end of the runs over the spacing."""
    parts = [c for c in study.rows[0] if c.startswith("energy ") and
             c.endswith("[J]")]
    print("Energy at the end, J:\n")
    table(study.parameters + [p[7:-4] for p in parts],
          [[row[p] for p in study.parameters] +
           [number(row[p], "%.0f") for p in parts] for row in study.rows
           if row["status"] == "completed"])


def print_stamp(studies):
    """The commit of the source, and how many builds made the runs."""
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always",
                             "--dirty"], stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL,
                            universal_newlines=True).stdout.strip()
    builds = set()
    for study in studies.values():
        for row in study.rows:
            path = os.path.join(study.runs, row["run"], "build.txt")
            if os.path.exists(path):
                with open(path) as file:
                    builds.add(file.read().strip())
    print("Tables of the program of commit %s%s.\n" % (
        commit or "unknown",
        "; runs of %d builds are among them" % len(builds)
        if len(builds) > 1 else ""))


def print_targets(studies):
    rows = []

    def target(name, limit, values):
        """Largest relative difference of pairs, where all are there."""
        if any(v is None for pair in values for v in pair):
            rows.append((name, "≤ %g %%" % limit, "–", "not run"))
            return
        got = max(100 * abs(a - b) / abs(b) for a, b in values)
        rows.append((name, "≤ %g %%" % limit, "%.2f %%" % got,
                     "met" if got <= limit else "missed"))

    spacing = studies.get("spacing")
    if spacing:
        at = lambda h: spacing.value(method="SPG", spacing=h)
        target("residual velocity against 344 m/s at 1.0 and 0.75 mm", 1,
               [(at(h), MEASURED) for h in ("1.0 mm", "0.75 mm")])
        target("0.75 against 0.5 mm", 2, [(at("0.75 mm"), at("0.5 mm"))])
    strain = studies.get("failure-strain")
    if strain:
        target("failure strain 0.4 against 0.2", 2, [tuple(
            strain.value(failure_strain="SPG " + s) for s in ("0.4", "0.2"))])
    failing = studies.get("projectile-failing")
    if failing:
        base = {"failure_strain": "0.4", "friction": "0.3", "model": "quarter"}
        at = lambda h: failing.value(spacing=h, **base)
        what = "projectile that fails: "
        target(what + "against 344 m/s at 1.0 and 0.75 mm", 1,
               [(at(h), MEASURED) for h in ("1.0 mm", "0.75 mm")])
        target(what + "0.75 against 0.5 mm", 2, [(at("0.75 mm"), at("0.5 mm"))])
        target(what + "failure strain 0.4 against 0.2", 2, [(
            at("1.0 mm"), failing.value(**dict(
                base, spacing="1.0 mm", failure_strain="0.2")))])
    zone = studies.get("zone")
    if zone:
        target("zone of 30 against 60 mm", 1, [tuple(
            zone.value(zone=z) for z in ("30 mm", "60 mm"))])
    residuals = [(100 * float(row["energy residual"]), study.name)
                 for study in studies.values() for row in study.rows
                 if row["status"] == "completed"]
    if residuals:
        worst = max(residuals)
        rows.append(("energy residual of every completed run", "≤ 1 %",
                     "%.2f %% (%s)" % worst,
                     "met" if worst[0] <= 1 else "missed"))
    failed = sum(row["status"] != "completed" for study in studies.values()
                 for row in study.rows)
    rows.append(("runs that did not complete", "0", failed,
                 "met" if failed == 0 else "missed"))
    print("### Targets\n")
    table(("target", "bound", "got", ""), rows)


def copy_figures(studies, folder):
    os.makedirs(folder, exist_ok=True)
    for name, chart in (("spacing", "residual-velocity-history"),
                        ("spacing", "residual-velocity-over-penetration-depth"),
                        ("spacing", "residual-velocity-at-spacing"),
                        ("friction", "residual-velocity-history"),
                        ("projectile-failing",
                         "residual-velocity-history-by-spacing"),
                        ("projectile-failing", "residual-velocity-at-spacing"),
                        ("method", "cost-residual-velocity")):
        if name in studies:
            source = os.path.join(studies[name].folder, "charts",
                                  chart + ".png")
            if os.path.exists(source):
                shutil.copy(source, os.path.join(
                    folder, "%s-%s.png" % (name, chart)))
    # The first of each method, and the finest of the projectile that fails.
    completed = {name: [row for row in study.rows
                        if row["status"] == "completed"]
                 for name, study in studies.items()}
    shown, seen = [], set()
    for row in completed.get("spacing", []):
        if row["method"] not in seen:
            seen.add(row["method"])
            shown.append((studies["spacing"], row,
                          row["method"].lower().replace(" ", "-"),
                          "%s, %s" % (row["method"], row["spacing"])))
    for row in sorted(completed.get("projectile-failing", []),
                      key=lambda r: float(r["spacing"].split()[0]))[:1]:
        shown.append((studies["projectile-failing"], row, "failing-projectile",
                      "projectile that fails, %s" % row["spacing"]))
    for study, row, name, title in shown:
        subprocess.run(
            [os.path.join(ROOT, "build/release/sabot"), "picture",
             os.path.join(study.runs, row["run"]),
             "--time", "10 us, 30 us, 60 us, 100 us", "-o",
             os.path.join(folder, "section-%s.png" % name), "--title", title],
            check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--figures")
    arguments = parser.parse_args()
    studies = {name: Study(arguments.folder, name) for name in ORDER
               if os.path.exists(os.path.join(arguments.folder, name,
                                              "study.csv"))}
    if not studies:
        raise SystemExit("error: \"%s\" holds no study; run "
                         "scripts/validation.sh first" % arguments.folder)
    print_stamp(studies)
    print_targets(studies)
    for study in studies.values():
        print_study(study)
        if study.name == "zone":
            print_zone(study)
        if study.name == "method":
            print_prices(study)
        if study.name in ("spacing", "projectile", "projectile-failing"):
            print_energies(study)
    if arguments.figures:
        copy_figures(studies, arguments.figures)


if __name__ == "__main__":
    main()
