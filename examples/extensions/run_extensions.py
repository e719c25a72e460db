#!/usr/bin/env python3
"""Each extension is one file: nothing else changes, and its scene has the
answer that can be known without running it.

run_extensions.py SABOT SABOT_EXTENDED SOURCE_FOLDER WORK_FOLDER
"""
import csv
import glob
import json
import math
import os
import shutil
import subprocess
import sys
import unittest

SABOT, EXTENDED, SOURCE, WORK = sys.argv[1:5]
sys.path.insert(0, os.path.join(SOURCE, "tests/scenes"))
from vtu import read_vtu  # noqa: E402

HERE = os.path.join(SOURCE, "examples/extensions")
# File, without ending: what it adds, as kind and name.
EXAMPLES = {
    "material_law": ("material law", "Voce"),
    "equation_of_state": ("equation of state", "Murnaghan"),
    "failure_criterion": ("failure criterion", "maximum principal strain"),
    "stabilization": ("stabilization", "residual damping"),
    "friction_law": ("friction law", "flash heating"),
    "load": ("load", "drag"),
    "quantity": ("quantity of interest", "velocity of a piece"),
    "output": ("output", "CSV")}
# OpenMPI refuses root unless told twice.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def start(program, *arguments, ranks=1):
    command = [program, *arguments]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-np", str(ranks)] + command
    return subprocess.run(command, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True,
                          timeout=600, env=ENVIRONMENT)


def scene(name):
    return os.path.join(HERE, name + ".prm")


def folder(name):
    path = os.path.join(WORK, name)
    shutil.rmtree(path, ignore_errors=True)
    return path


def choices(program, name):
    """What a program may choose by name: a dictionary of kind and name to
    description, from the reference that it writes."""
    out = folder(name)
    start(program, "reference", out)
    found, kind = {}, None
    with open(os.path.join(out, "registries.md")) as file:
        for line in file:
            cells = [cell.strip() for cell in line.split("|")]
            if line.startswith("## "):
                kind = line[3:].strip()
            elif kind and len(cells) == 4 and cells[1] != "name" and \
                    not cells[1].startswith("---"):
                found[kind, cells[1]] = cells[2]
    return found


def linked_files(target):
    """Inputs of a program's link in build.ninja."""
    path = os.path.join(os.path.dirname(EXTENDED), "build.ninja")
    with open(path) as file:
        for line in file:
            if line.startswith("build %s: " % target):
                return line.split("|")[0].split()[3:]
    return []


def bisect(function, low, high):
    """Root of a function that is negative at low and positive at high."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0. else (low, middle)
    return low


class OneFile(unittest.TestCase):
    """A file adds one choice, and all else follows."""

    @classmethod
    def setUpClass(cls):
        cls.plain = choices(SABOT, "reference")
        cls.extended = choices(EXTENDED, "reference-extended")

    def test_each_has_one_file_and_one_scene(self):
        for ending in ("cc", "prm"):
            files = glob.glob(os.path.join(HERE, "*." + ending))
            self.assertEqual(sorted(os.path.basename(f)[:-len(ending) - 1]
                                    for f in files), sorted(EXAMPLES))

    def test_each_adds_its_choice_and_nothing_else(self):
        self.assertEqual(set(self.extended) - set(self.plain),
                         set(EXAMPLES.values()))
        for choice, description in self.plain.items():
            self.assertEqual(self.extended[choice], description)

    def test_nothing_else_is_linked(self):
        plain, extended = linked_files("sabot"), linked_files("sabot-extended")
        if not plain:
            self.skipTest("not built by Ninja")
        self.assertEqual(set(plain) - set(extended), set())
        self.assertEqual(
            sorted(os.path.basename(f).split(".")[0] for f in extended
                   if f not in plain), sorted(EXAMPLES))

    def test_the_manual_follows(self):
        plain = start(SABOT, "parameters").stdout
        extended = start(EXTENDED, "parameters").stdout
        for choice in EXAMPLES.values():
            text = choice[1] + ": " + self.extended[choice]
            self.assertNotIn(text, plain)
            self.assertIn(text, extended)

    def test_scenes_are_refused_without_it(self):
        for name, (_, choice) in EXAMPLES.items():
            done = start(SABOT, "check", scene(name))
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(choice, done.stdout)
            # What is like nothing that there is gets the list of it.
            self.assertRegex(done.stdout, "did you mean|expected one of|there is")
            done = start(EXTENDED, "check", scene(name))
            self.assertEqual(done.returncode, 0, done.stdout)


class Answers(unittest.TestCase):
    """Each scene has the answer that its first lines announce."""

    def run_scene(self, name, *settings, ranks=1, out=None):
        out = folder(out or name)
        words = [word for setting in settings for word in ("--set", setting)]
        done = start(EXTENDED, "run", scene(name), "-o", out, "--quiet",
                     *words, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(os.path.join(out, "result.json")) as file:
            result = json.load(file)
        self.assertEqual(result["status"], "completed")
        self.assertLess(result["energy_residual_max"], 0.01)
        return out, result

    def last_fields(self, out, body):
        files = sorted(glob.glob(os.path.join(out, "fields/%s_*.vtu" % body)))
        return read_vtu(files[-1])

    def test_material_law(self):
        out, result = self.run_scene("material_law")
        fields = self.last_fields(out, "cube")
        E, Y0, Q, b, length, speed = 70e9, 150e6, 120e6, 12., 2e-3, 20.

        def flow_stress(eps):
            return Y0 + Q * (1. - math.exp(-b * eps))

        strain = math.log(1. + speed * result["time"] / length)
        exact = bisect(lambda e: e + flow_stress(e) / E - strain, 0., 1.)
        for eps, stress in zip(fields["effective plastic strain"],
                               fields["von Mises"]):
            self.assertAlmostEqual(stress / flow_stress(eps), 1., delta=1e-9)
            self.assertAlmostEqual(eps, exact, delta=0.01 * exact)

    def test_equation_of_state(self):
        out, result = self.run_scene("equation_of_state")
        K, n, density, u, length = 2.2e9, 7., 1000., 500., 0.02

        def pressure(J):
            return K / n * (J ** -n - 1.)

        J = bisect(lambda j: density * u * u - pressure(j) * (1. - j), 0.3, 1.)
        front = u * J / (1. - J) * result["time"]
        fields = self.last_fields(out, "water")
        cells = [fields["connectivity"][i:i + 8] for i in range(
            0, len(fields["connectivity"]), 8)]
        behind = []
        for cell, p in zip(cells, fields["pressure"]):
            z = sum(fields["Points"][node][2] for node in cell) / 8.
            if 0.2 * front < z < 0.8 * front:
                behind.append(p)
        self.assertGreater(len(behind), 20)
        mean = sum(behind) / len(behind)
        self.assertAlmostEqual(mean / pressure(J), 1., delta=0.01)
        # What the shock has passed has stopped.
        mass = result["bodies"]["water"]["mass"]
        energy = 0.5 * mass * u * u * (1. - front / J / length)
        self.assertAlmostEqual(result["bodies"]["water"]["kinetic_energy"],
                               energy, delta=0.01 * 0.5 * mass * u * u)

    def test_load(self):
        _, result = self.run_scene("load")
        cube, decay = result["bodies"]["cube"], math.exp(-1.5)
        self.assertAlmostEqual(cube["velocity"][0], 100. * decay, delta=0.2)
        self.assertAlmostEqual(
            result["loads"]["medium"]["work"] / (0.5 * cube["mass"] * 1e4),
            decay ** 2 - 1., delta=2e-3)

    def test_failure_criterion(self):
        E, nu, density, v = 68.9e9, 0.33, 2700., 120.
        modulus = E * (1. - nu) / ((1. + nu) * (1. - 2. * nu))
        strain = math.log(1. + v / math.sqrt(modulus / density))
        for part, breaks in ((0.85, True), (1.3, False)):
            entry = "Bodies/bar/Critical principal strain=%.6f"
            _, result = self.run_scene("failure_criterion",
                                       entry % (part * strain))
            broken = result["bodies"]["bar"]["bonds_broken"]
            (self.assertGreater if breaks else self.assertEqual)(broken, 0)

    def test_stabilization(self):
        energy = []
        for ranks in (1, 2):
            out, result = self.run_scene("stabilization", ranks=ranks,
                                         out="stabilization-%d" % ranks)
            with open(os.path.join(out, "history.h5"), "rb") as file:
                energy.append(file.read())
            self.assertLess(result["momentum_residual_max"], 1e-9)
            self.assertGreater(self.damped(result), 1e-4)
        self.assertEqual(*energy)
        _, result = self.run_scene("stabilization", "List of couplings=",
                                   "List of bodies=striker")
        self.assertLess(abs(self.damped(result)), 1e-12)

    def damped(self, result):
        """What the striker has lost by the stabilization over what it had."""
        striker = result["bodies"]["striker"]
        lost = [value for name, value in striker.items()
                if name.startswith("stabili")]
        return lost[0] / (0.5 * striker["mass"] * 50. ** 2)

    def test_friction_law(self):
        for speed in (10., 40., 100.):
            _, result = self.run_scene(
                "friction_law",
                "Bodies/block/Initial velocity=%g m/s, 0 m/s, -5 m/s" % speed)
            v = result["bodies"]["block"]["velocity"]
            measured = (speed - v[0]) / (v[2] + 5.)
            exact = 0.1 + 0.4 * min(1., 20. / speed)
            self.assertAlmostEqual(measured, exact, delta=0.05 * exact)

    def test_quantity(self):
        _, result = self.run_scene("quantity")
        pieces = result["bodies"]["bar"]["fragments"]
        heavy, light = (result["quantities"][name]["value"]
                        for name in ("heavy piece", "light piece"))
        self.assertGreater(len(pieces), 1)
        self.assertEqual(heavy, pieces[0]["velocity"][0])
        self.assertEqual(light, pieces[1]["velocity"][0])
        weight = result["bodies"]["weight"]["velocity"][0]
        held, flying = sorted((heavy, light))
        self.assertAlmostEqual(flying, weight, delta=0.1 * weight)
        self.assertAlmostEqual(held, 0., delta=0.1 * weight)
        # In one piece it is the body.
        _, result = self.run_scene(
            "quantity", "Bodies/bar/Critical effective plastic strain=never",
            "End time=10 us")
        self.assertEqual(len(result["bodies"]["bar"]["fragments"]), 1)
        for quantity in result["quantities"].values():
            self.assertAlmostEqual(quantity["value"],
                                   result["bodies"]["bar"]["velocity"][0],
                                   places=9)

    def test_output(self):
        texts = []
        for ranks in (1, 2):
            out, result = self.run_scene("output", ranks=ranks,
                                         out="output-%d" % ranks)
            with open(os.path.join(out, "csv/block.csv"), newline="") as file:
                texts.append(file.read())
        self.assertEqual(*texts)
        rows = list(csv.DictReader(texts[0].splitlines()))
        times = [float(row["time [s]"]) for row in rows]
        self.assertGreaterEqual(len(rows), 6)
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(times[0], 0.)
        self.assertEqual(times[-1], result["time"])
        mass = 2700. * 0.005 ** 3
        for row in rows:
            self.assertAlmostEqual(float(row["velocity z [m/s]"]), 10.,
                                   places=9)
            self.assertAlmostEqual(float(row["kinetic energy [J]"]),
                                   50. * mass, places=12)
        self.assertEqual(float(rows[-1]["kinetic energy [J]"]),
                         result["bodies"]["block"]["kinetic_energy"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[5:], verbosity=2)
