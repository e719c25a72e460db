#!/usr/bin/env python3
"""Slips in loads, drives and contacts, and files that are no scenes:
run_slips_of_loads.py SABOT SOURCE_FOLDER WORK_FOLDER

Each is a sound scene with one mistake. It is refused, or warned of, in one line
that names entry and line.
"""
import os
import shutil
import subprocess
import sys
import unittest

from program import ENVIRONMENT, SABOT, WORK
from scene_text import section


BLOCK = {"Size": "4 mm, 4 mm, 4 mm", "Cell size": "2 mm", "Material": "steel"}
FLYING = dict(BLOCK, Center="0 mm, 0 mm, 4.01 mm",
              **{"Initial velocity": "0 m/s, 0 m/s, -10 m/s"})
RIGID = dict(BLOCK, Discretization="rigid")
PRESSURE = {"Type": "pressure", "Body": "block", "Faces": "+z",
            "Pressure": "1 MPa"}
UP = {"Type": "prescribed motion", "Body": "block", "Faces": "+z",
      "Velocity": "0 m/s, 0 m/s, 5 m/s"}
TABLE = dict(PRESSURE, Course="table", Times="0 us, 1 us, 2 us",
             Factors="0, 1, 0")


def scene(block, loads=None, couplings=None, bodies=None, more=""):
    bodies = dict({"block": block}, **(bodies or {}))
    text = "set End time = 30 us\n" + more
    for kind, listed in (("bodies", bodies), ("loads", loads),
                         ("couplings", couplings)):
        if listed:
            text += "set List of %s = %s\n" % (kind, ", ".join(listed))
            text += section(kind.capitalize(), listed)
    return text + section("Materials", {"steel": {
        "Density": "7830 kg/m^3", "Young's modulus": "206 GPa"}})


def with_load(block=None, **change):
    load = {k.replace("_", " "): v for k, v in change.items()}
    return scene(block or BLOCK, {"push": dict(PRESSURE, **load)})


def contact(first, second=None):
    couplings = {"impact": first}
    if second:
        couplings["again"] = second
    return scene(BLOCK, couplings=couplings, bodies={"rod": FLYING})


MEET = {"Bodies": "block, rod"}


def with_zone(loads=None, plate=None, zone=None):
    """A plate and its zone, which reaches the faces -x, -z and +z."""
    return scene(
        dict(BLOCK, Size="12 mm, 6 mm, 2 mm", **dict({"Cell size": "1 mm"},
                                                     **(plate or {}))), loads,
        {"seam": {"Type": "tie", "Follower": "zone", "Leader": "block"}},
        {"zone": dict({"Discretization": "SPG", "Carve from": "block",
                       "Material": "steel", "Size": "4 mm, 4 mm, 2 mm",
                       "Center": "-4 mm, 0 mm, 0 mm", "Nodal spacing": "1 mm"},
                      **(zone or {}))})


CLAMPED = {"Clamped faces": "-x"}

# Text of the scene, words of the one line that refuses it.
REFUSED = (
    (scene(BLOCK, more="set List of quantities = force\n") + section(
        "Quantities", {"force": {"Type": "section force", "Body": "block",
                                 "Point": "0 mm, 0 mm, 3 mm"}}),
     ("Quantities/force/Point", "outside of body \"block\"",
      "from -2 to 2 mm")),
    (scene(BLOCK, {"up": UP, "out": dict(UP, Faces="+x",
                                         Velocity="5 m/s, 0 m/s, 0 m/s")}),
     ("Loads/out/Faces", "2) mm of body", "is moved by \"up\", too")),
    (scene(RIGID, {"one": {k: v for k, v in UP.items() if k != "Faces"},
                   "two": {k: v for k, v in UP.items() if k != "Faces"}},
           more="set Largest step = 1 us\n"),
     ("Loads/two/Body", "\"one\" prescribes the motion")),
    (scene(BLOCK, {"up": dict(UP, Components="w")}),
     ("Loads/up/Components", "is not a component; allowed: x, y, z")),
    (scene(dict(BLOCK, **{"Driven faces": "+z", "Prescribed components": "u"})),
     ("Prescribed components", "is not a component")),
    (contact({"Bodies": "block, rod, block"}),
     ("Couplings/impact/Bodies", "names \"block\" twice")),
    (contact(MEET, {"Bodies": "rod, block"}),
     ("Couplings/again/Bodies", "\"block\" and \"rod\" meet in \"impact\"")),
    (contact({"Type": "self-contact", "Bodies": "block"},
             {"Type": "self-contact", "Bodies": "rod, block"}),
     ("Couplings/again/Bodies", "\"block\" touches itself in \"impact\"")),
    (scene(dict(BLOCK, Size="4, 4, 4 mm")),
     ("Bodies/block/Size", "some numbers have a unit and others none")),
    (scene(dict(BLOCK, **{"Cell size": "0x2 mm"})), ("Bodies/block/Cell size",)),
    (scene({k: v for k, v in BLOCK.items()},
           bodies={"b" * 250: dict(BLOCK, Center="0 mm, 0 mm, 9 mm")}),
     ("List of bodies", "is too long for the name of a file")),
    ("include %s\n" % os.path.dirname(WORK), ("cannot read parameter file",)),
    ("include /dev/zero\n", ("has more than 64 MB",)),
)

# Text of the scene, words of the one warning; none where it is in order.
WARNED = (
    (with_load(), None),
    (with_load(Pressure="0 Pa"), "Loads/push/Pressure: is 0: it does nothing"),
    (scene(BLOCK, {"push": {k: v for k, v in PRESSURE.items()
                            if k != "Pressure"}}), "no \"Pressure\" is set"),
    (scene(BLOCK, {"g": {"Acceleration": "0, 0, 0"}}), "is 0: it does nothing"),
    (scene(BLOCK, {"g": {}}), None),
    (with_load(Pressure="10000 GPa"), "the modulus of \"block\""),
    (scene(BLOCK, {"up": {k: v for k, v in UP.items() if k != "Velocity"}}),
     "no \"Velocity\" is set"),
    (scene(BLOCK, {"push": TABLE}), None),
    (scene(BLOCK, {"push": dict(TABLE, Times="0, 1, 2")}),
     "0.003 % of the first stretch of the table"),
    (scene(BLOCK, {"push": dict(TABLE, Times="40 us, 50 us, 60 us")}),
     "begin after the end time"),
    (scene(BLOCK, {"push": dict(TABLE, Factors="0, 0, 0")}), "are all 0"),
    (scene(BLOCK, {"push": dict(PRESSURE, Course="table")}), "it is constant"),
    (scene(dict(BLOCK, **{"Driven faces": "+z"})),
     "no \"Prescribed velocity\" is set"),
    (scene(dict(BLOCK, **{"Prescribed velocity": "0 m/s, 0 m/s, 5 m/s"})),
     "has no effect without \"Driven faces\""),
    (scene(dict(BLOCK, **{"Symmetry faces": "-x", "Initial velocity":
                          "9 m/s, 0 m/s, 0 m/s"})),
     "across the body's plane of symmetry x"),
    (scene(dict(BLOCK, **{"Symmetry faces": "-x", "Initial velocity":
                          "0 m/s, 9 m/s, 0 m/s"})), None),
    (with_zone(), None),
    (with_zone(plate=CLAMPED), "Bodies/block/Clamped faces: \"-x\" does not "
     "hold the particles of its zone \"zone\""),
    (with_zone(plate=CLAMPED, zone={"Clamped faces": "x = -6 mm"}), None),
    (with_zone(plate={"Clamped faces": "+x"}), None),
    (with_zone(plate={"Driven faces": "x = -6 mm", "Prescribed velocity":
                      "0 m/s, 0 m/s, 5 m/s"}), "does not move the particles"),
    (with_zone({"push": PRESSURE}),
     "\"+z\" of \"block\" does not load the particles"),
    (with_zone({"push": PRESSURE, "more": dict(PRESSURE, Body="zone")}), None),
    (with_zone({"g": {"Bodies": "block"}}), "not its zone \"zone\""),
    (with_zone({"g": {"Bodies": "block, zone"}}), None),
    (contact(MEET), None),
    (contact({"Type": "self-contact", "Bodies": "rod"}, MEET), None),
)


class Slips(unittest.TestCase):
    def check(self, texts):
        """Exit code and answers, one for each scene."""
        shutil.rmtree(WORK, ignore_errors=True)
        os.makedirs(WORK)
        files = []
        for number, text in enumerate(texts):
            files.append(os.path.join(WORK, "%d.prm" % number))
            with open(files[-1], "w") as file:
                file.write(text)
        done = subprocess.run([SABOT, "check"] + files, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=ENVIRONMENT,
                              universal_newlines=True, timeout=600)
        answers = done.stdout.split("checking ")[1:]
        self.assertEqual(len(answers), len(files), done.stdout)
        return done.returncode, answers

    def test_what_cannot_be_is_refused(self):
        code, answers = self.check([text for text, _ in REFUSED])
        self.assertEqual(code, 1)
        for answer, (_, words) in zip(answers, REFUSED):
            lines = answer.splitlines()
            with self.subTest(words=words, lines=lines):
                self.assertEqual(len(lines), 2)
                self.assertTrue(lines[1].startswith("error: "))
                for word in words:
                    self.assertIn(word, lines[1])

    def test_what_can_hardly_be_meant_is_said(self):
        code, answers = self.check([text for text, _ in WARNED])
        self.assertEqual(code, 0)
        for answer, (_, words) in zip(answers, WARNED):
            said = [line for line in answer.splitlines()
                    if line.startswith(("warning: ", "error: "))]
            with self.subTest(words=words, said=said):
                self.assertEqual(len(said), 0 if words is None else 1)
                if words is not None:
                    self.assertIn(words, said[0])
                    self.assertIn(".prm:", said[0])

    def test_a_folder_is_no_scene(self):
        os.makedirs(WORK, exist_ok=True)
        for command in ("check", "run", "plan"):
            done = subprocess.run([SABOT, command, WORK], cwd=WORK,
                                  stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, env=ENVIRONMENT,
                                  universal_newlines=True, timeout=60)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn("cannot read parameter file \"" + WORK, done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
