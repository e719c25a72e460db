#!/usr/bin/env python3
"""All choices of particles with each other: run_choices.py SABOT SOURCE_FOLDER WORK_FOLDER

Every approximation x stabilization x failure criterion x rule for failed metal x neighbor
policy is a bar that is torn; its bytes are the same on 1 and 3 ranks and after a resume.
"""
import itertools
import json
import os
import shutil
import subprocess
import sys
import unittest

from program import BAR, SOURCE, WORK, folder, result, sabot

CRITERIA = {"damage": "Critical damage = 0.1",
            "effective plastic strain": "Critical effective plastic strain = 0.05",
            "maximum principal stress": "Critical principal stress = 250 MPa",
            "maximum shear strain": "Critical shear strain = 0.05"}
HEAD = """set Title          = torn in every way
set End time       = {end}
set List of outputs = averages
include {materials}/al6061-t6.prm
subsection Materials
  subsection al6061-t6
    subsection Johnson-Cook
      set Damage = true
    end
  end
end
subsection Outputs
  subsection averages
    set Type     = history
    set Interval = 0.2 us
  end
end
"""
# Longer than all bars side by side are wide: ranks share each of them.
BAR = """  subsection {name}
    set Discretization          = SPG
    set Material                = al6061-t6
    set Size                    = 16 mm, 2 mm, 2 mm
    set Center                  = 0 mm, {y} mm, {z} mm
    set Nodal spacing           = 1 mm
    set Initial velocity        = 300 m/s, 0 m/s, 20 m/s
    set Clamped faces           = -x
    set Approximation           = {approximation}
    set Stabilization           = {stabilization}
    set Failure criterion       = {criterion}
    set {critical}
    set Failed metal carries    = {rule}
    set Neighbor policy         = {policy}
    set Kernel update interval  = 10
    set Failure check interval  = 5
  end
"""


def choices():
    """What the program offers, by entry of a body of particles."""
    done = sabot("parameters", "--format", "json")
    entries = json.loads(done.stdout)["Bodies"]["<SPG box>"]
    return {name: entries[name]["pattern_description"].split("[Selection ")[1]
            .rstrip(" ]").split("|")
            for name in ("Approximation", "Stabilization", "Failure criterion",
                         "Failed metal carries", "Neighbor policy")}


def write_scene(path, approximation, stabilization, offered):
    """@return the bars."""
    kinds = list(itertools.product(offered["Failure criterion"],
                                   offered["Failed metal carries"],
                                   offered["Neighbor policy"]))
    bars, names = "", []
    for b, (criterion, rule, policy) in enumerate(kinds):
        names.append("%s %s %s" % (criterion, rule, policy))
        bars += BAR.format(name=names[-1], y=2.5 * (b % 6), z=2.5 * (b // 6),
                           approximation=approximation, stabilization=stabilization,
                           criterion=criterion, critical=CRITERIA[criterion], rule=rule,
                           policy=policy)
    with open(path, "w") as file:
        # Second gradients make shorter steps, and grow without bound where much has failed.
        file.write(HEAD.format(materials=os.path.abspath(os.path.join(SOURCE, "prm/materials")),
                               end="1.5 us" if stabilization == "second gradient" else
                               "2.5 us") +
                   "set List of bodies = %s\nsubsection Bodies\n%send\n"
                   % (", ".join(names), bars))
    return names


class Choices(unittest.TestCase):
    def test_all_with_each_other(self):
        os.makedirs(WORK, exist_ok=True)
        scene = os.path.join(WORK, "choices.prm")
        offered = choices()
        self.assertEqual(sorted(offered["Failure criterion"]), sorted(CRITERIA))
        for approximation in offered["Approximation"]:
            for stabilization in offered["Stabilization"]:
                if stabilization == "second gradient" and "convex" not in approximation:
                    continue  # refused
                with self.subTest(approximation + ", " + stabilization):
                    names = write_scene(scene, approximation, stabilization, offered)
                    self.compare(scene, names)

    def compare(self, scene, names):
        histories = {}
        for ranks in (1, 3):
            out = folder("choices%d" % ranks)
            every = () if ranks == 1 else (
                "--set", "Checkpoint at the end=false", "--set",
                "Checkpoint interval in steps=%d" % (0.6 * r["steps"]))
            done = sabot("run", scene, "-o", out, "--quiet", *every, ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stdout)
            r = result(out)
            histories[ranks] = os.path.join(out, "history.h5")
        parted = folder("choices-parted")
        shutil.copytree(os.path.join(WORK, "choices3"), parted)
        os.remove(os.path.join(parted, "history.h5"))
        done = sabot("resume", parted, "--quiet", ranks=3)
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(os.path.join(parted, "log.txt")) as file:
            self.assertIn("resumed at step %d," % (0.6 * r["steps"]), file.read())
        histories["resumed"] = os.path.join(parted, "history.h5")
        for which, other in histories.items():
            same = subprocess.run(["cmp", histories[1], other], stdout=subprocess.PIPE,
                                  universal_newlines=True)
            self.assertEqual(same.stdout, "", which)
        for name in names:
            self.assertGreater(r["bodies"][name]["bonds_broken_fraction"], 0., name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
