#!/usr/bin/env python3
"""Slips in what studies set: run_slips_of_studies.py SABOT SOURCE_FOLDER WORK_FOLDER

What a study varies goes to the scene as options of a command line. The answer
names the line of the study instead, in one line, from the study and from its
runs.
"""
import os
import shutil
import sys
import unittest

from program import WORK, sabot
from scene_text import section

SCENE = """set End time = 1 us
set List of bodies = plate
set List of quantities = speed
""" + section("Quantities", {"speed": {"Body": "plate"}}) + section(
    "Materials", {"steel": {"Density": "7830 kg/m^3",
                            "Young's modulus": "206 GPa"}}) + section(
    "Bodies", {"plate": {"Size": "20 mm, 20 mm, 2 mm", "Cell size": "2 mm",
                         "Material": "steel"}})
STUDY = """set Scene = %s
set Fixed entries = %s
subsection Parameters
  subsection size
    set Entries = %s
    set Values = %s
  end
end
subsection Quantities
  subsection speed
  end
end
"""


def write(name, text):
    os.makedirs(WORK, exist_ok=True)
    path = os.path.join(WORK, name)
    with open(path, "w") as file:
        file.write(text)
    return path


class SlipsOfStudies(unittest.TestCase):
    def test_a_study_tells_of_what_it_sets_by_its_own_line(self):
        write("varied.prm", SCENE)
        size = "Bodies/plate/Cell size"
        for given, line, part in (
                (("varied.prm", "", size, "2 mm; -1 mm"), 6,
                 "Parameters/size/Values: \"Bodies/plate/Cell size\" cannot be "
                 "\"-1 mm\""),
                (("varied.prm", "", "Bodies/plate/Cell siez", "2 mm"), 5,
                 "Parameters/size/Entries: unknown entry \"Cell siez\""),
                (("varied.prm", "", "Bodies/plat/Cell size", "2 mm"), 5,
                 "has no \"Bodies/plat\"; did you mean \"plate\"?"),
                (("varied.prm", "", "Bodies/plate/Geometry", "boxx"), 6,
                 "boxx"),
                (("varied.prm", "", "List of bodies", "plat"), 6,
                 "did you mean \"plate\"?"),
                (("varied.prm", "", "Scene", "varied.prm; gone.prm"), 6,
                 "gone.prm"),
                (("varied.prm", "End time=2 kg", size, "2 mm"), 2,
                 "Fixed entries: \"End time\" cannot be \"2 kg\""),
                (("varied.prm", "End time", size, "2 mm"), 2,
                 "Section/Name=value"),
                (("gone.prm", "", size, "2 mm"), 1, "gone.prm")):
            path = write("study.prm", STUDY % given)
            done = sabot("study", path, "--list")
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertTrue(done.stdout.startswith(
                "error: %s:%d: " % (path, line)), done.stdout)
            self.assertIn(part, done.stdout)
            self.assertNotIn("--set", done.stdout)
            self.assertEqual(len(done.stdout.splitlines()), 1, done.stdout)
        # Which quantities there are.
        path = write("study.prm", (STUDY % ("varied.prm", "", size, "2 mm"))
                     .replace("  subsection speed\n  end\n", ""))
        done = sabot("study", path, "--list")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("it has speed", done.stdout)
        # What only the run itself finds out.
        path = write("study.prm", STUDY % (
            "varied.prm", "", "Bodies/plate/Clamped faces", "-w"))
        out = os.path.join(WORK, "study")
        shutil.rmtree(out, ignore_errors=True)
        done = sabot("study", path, "-o", out)
        self.assertIn("%s:6: Parameters/size/Values: Bodies/plate/Clamped faces"
                      % path, done.stdout)
        self.assertNotIn("--set", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
