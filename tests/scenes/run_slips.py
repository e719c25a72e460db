#!/usr/bin/env python3
"""Slips of the pen in a sound scene: run_slips.py SABOT SOURCE_FOLDER WORK_FOLDER

Each scene is the first plate with one entry as somebody may mistype it. The
answer names the entry with its value and line, and what would be right. All are
checked by one process.
"""
import os
import shutil
import subprocess
import sys
import unittest

from program import ENVIRONMENT, SABOT, SOURCE, WORK

# Entry, value, words of the one line that refuses it.
REFUSED = (
    ("Bodies/projectile/Initial velocity", "-970 m/s", "3 values"),
    ("Bodies/projectile/Initial velocity", "0 mm/s, 0 mm/s, -970000 mm/s",
     "units m/s, km/s, mm/us"),
    ("Bodies/plate/Size", "203 mm, -203 mm, 12.7 mm", "from 1e-09"),
    ("Bodies/plate/Size", "203, 203, 12.7", "check the units"),
    ("Bodies/plate/Discretization", "fem", "did you mean \"FEM\"?"),
    ("Bodies/plate/Clamped faces", "x+", "allowed: -x, +x"),
    ("Bodies/plate/Material", "tungsten", "there is: "),
    ("Bodies/plate/Material", "al6061", "did you mean \"al6061-t6\"?"),
    ("Bodies/plate/Growth ratio", "0.8", "from 1 to 3"),
    ("Bodies/core/Center", "0 mm, 0 mm, 6.35 mm",
     "the body from -12.7 to 0 mm"),
    ("Bodies/core/Carve from", "core", "cannot be carved from itself"),
    ("Bodies/core/Carve from", "palte", "did you mean \"plate\"?"),
    ("Bodies/core/Carve from", "wall", "there is: "),
    ("Bodies/core/Nodal spacing", "0 mm", "from 1e-09"),
    ("Bodies/core/Nodal spacing", "1 um", "particles"),
    ("Bodies/core/Kernel update interval", "30.5",
     "a whole number of at least 1"),
    ("Bodies/core/Critical effective plastic strain", "40 %",
     "0.3 for 30 %"),
    ("Bodies/projectile/Mesh file", "rod.msh", "Geometry = file"),
    ("Bodies/projectile/Nodal spacing", "1 mm", "belongs to Bodies/core"),
    ("Bodies/projectile/Friction coefficient", "0.3", "Couplings/impact"),
    ("Bodies/projectile/Radus", "8 mm", "did you mean \"Radius\"?"),
    ("Bodies/projectile/Radius", "16.7/2 mm", "formulas are not worked out"),
    ("Bodies/projectile/Radius", "8.35 MM", "did you mean the unit mm?"),
    ("Bodies/projectile/Radius", "8.35MM", "did you mean the unit mm?"),
    ("End time", "100 usec", "did you mean the unit us?"),
    ("End time", "0.1 seconds", "did you mean the unit s?"),
    ("Bodies/projectile/Length", "23mm long", "units m, cm, mm"),
    ("Bodies/projectile/Center", "0 mm, 0 mm, 5 mm", "overlap by 6.5 mm"),
    ("Bodies/projectile/Rotation axis", "0, 0, 0", "no direction"),
    ("Materials/al6061-t6/Poisson's ratio", "0,33", "as in 0.33"),
    ("Materials/al6061-t6/Young's modulus", "70 Gpa",
     "did you mean the unit GPa?"),
    ("Materials/al6061-t6/Density", "2.7e-9", "sound speed of 6.149e+09 m/s"),
    ("Materials/al6061-t6/Density", "2.7", "check the units"),
    ("Materials/al6061-t6/Density", "2.7e-6 kg/mm^3", "units kg/m^3, g/cm^3"),
    ("Couplings/impact/Bodies", "projectile, core, plates",
     "did you mean \"plate\"?"),
    ("Couplings/impact/Bodies", "projectile", "two bodies at least"),
    ("Couplings/impact/Friction coefficient", "-0.3", "from 0 to 2"),
    ("Couplings/zone/Follower", "plate", "tied to itself"),
    ("Outputs/fields/Interval", "0 us", "from 1e-15"),
    ("Outputs/fields/Type", "vtk", "did you mean \"VTU\"?"),
    ("Quantities/hole/Type", "diameter", "did you mean \"hole diameter\"?"),
    ("Quantities/residual velocity/Direction", "0, 0, 0", "not zero"),
    ("End time", "-0.1 ms", "from 1e-12"),
    ("Step factor", "90 %", "0.3 for 30 %"),
    ("Checkpoint at the end", "yes", "true or false"),
    ("List of couplings", "zone, impact, debris, friction",
     "\"friction\" is listed, but there is no"),
    ("List of bodies", "plate core projectile",
     "separated by commas: \"plate, core, projectile\""),
    ("List of bodies", "core, projectile",
     "does not stand in \"List of bodies\""),
)

# The same of one warning.
WARNED = (
    ("Bodies/projectile/Rotation angle", "30", "is the unit deg missing"),
    ("Bodies/projectile/Sector", "quarter", "\"Symmetry faces\""),
    ("Bodies/projectile/Cell size", "40 mm", "more than the body is across"),
    ("Bodies/plate/Coarsest cell size", "1 mm", "finer than the \"Cell size\""),
    ("Bodies/projectile/Coarsest cell size", "9 mm", "rings of cells grow"),
    ("Bodies/plate/Refined zone center", "1 mm, 0 mm, 0 mm",
     "without \"Refined zone size\""),
    ("Bodies/projectile/Initial velocity", "0 m/s, 0 m/s, 970 m/s",
     "check the sign of the velocity"),
    ("Bodies/projectile/Center", "200 mm, 0 mm, 11.51 mm", "miss each other"),
    ("Outputs/fields/Interval", "5 ms", "longer than the run"),
    ("End time", "100", "is a unit missing"),
)


def scene(entry, value):
    sections = entry.split("/")
    return ("include %s/prm/perforation/first.prm\n" % SOURCE +
            "".join("subsection %s\n" % s for s in sections[:-1]) +
            "set %s = %s\n" % (sections[-1], value) +
            "end\n" * (len(sections) - 1))


class Slips(unittest.TestCase):
    def test_each_is_told_by_entry_and_with_what_would_be_right(self):
        shutil.rmtree(WORK, ignore_errors=True)
        os.makedirs(WORK)
        files = []
        for number, (entry, value, _) in enumerate(REFUSED + WARNED):
            files.append(os.path.join(WORK, "%d.prm" % number))
            with open(files[-1], "w") as file:
                file.write(scene(entry, value))
        done = subprocess.run([SABOT, "check"] + files, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=ENVIRONMENT,
                              universal_newlines=True, timeout=600)
        self.assertEqual(done.returncode, 1)
        answers = done.stdout.split("checking ")[1:]
        self.assertEqual(len(answers), len(files))
        for number, answer in enumerate(answers):
            entry, value, words = (REFUSED + WARNED)[number]
            lines = answer.splitlines()
            self.assertEqual(lines[0], files[number])
            told = [line for line in lines
                    if line.startswith(("error: ", "warning: "))]
            with self.subTest(entry=entry, value=value, told=told):
                self.assertEqual(len(told), 1)
                is_refused = number < len(REFUSED)
                self.assertEqual(told[0].startswith("error: "), is_refused)
                self.assertEqual(len(lines) == 2, is_refused)
                self.assertIn(words, told[0])
                self.assertLess(len(told[0]), 700)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
