#!/usr/bin/env python3
"""Checkpoints go on with any number of ranks: run_ranks.py SABOT SOURCE_FOLDER
WORK_FOLDER [NAME...]

Each scene runs straight on one rank, and with a checkpoint on some; from that it
goes on with other numbers of ranks and has to end with the same bytes.
"""
import json
import os
import re
import shutil
import sys
import unittest

from program import SOURCE, WORK, sabot

# Name, scene, ranks that write, ranks that go on, when, settings.
SCENES = (
    ("contact, debris, broken bonds", "prm/perforation/quick.prm",
     3, (2, 4), 0.5, ("End time=6 us", "Outputs/fields/Interval=2.5 us",
                      "Ranks per checkpoint file=2")),
    ("the same from one rank", "prm/perforation/quick.prm",
     1, (3,), 0.8, ("End time=6 us", "Outputs/fields/Interval=2.5 us")),
    ("gauges, forces, friction", "tests/scenes/held-plate.prm",
     2, (1, 3), 0.5, ()),
    ("cells that turn into particles",
     "prm/perforation/self-finding-nose.prm", 2, (3,), 0.6,
     ("End time=12 us", "Outputs/fields/Interval=6 us",
      "Bodies/plate/Cell size=2.1 mm", "Bodies/projectile/Cell size=2.1 mm")),
    ("an averaged measure of failure", "tests/scenes/spg-projectile.prm",
     4, (1,), 0.8, ("Bodies/core/Nonlocal length=0.8 mm",
                    "Ranks per checkpoint file=1")),
    ("neighbors that are searched", "tests/scenes/spg-projectile.prm",
     1, (2,), 0.5, ("Bodies/core/Neighbor policy=search",)),
    ("a rigid body", "tests/scenes/rigid-projectile.prm",
     3, (4,), 0.5, ("End time=2 us",)),
    ("planes of symmetry", "tests/scenes/planes.prm", 2, (4,), 0.5, ()),
    ("a tie that tears", "tests/scenes/torn.prm", 4, (2,), 0.5,
     ("Ranks per checkpoint file=3",)),
    ("loads", "tests/scenes/loads.prm", 1, (4,), 0.5, ()),
    ("loads beside cells that turn", "tests/scenes/growing.prm", 3, (2,), 0.6,
     ()),
    ("cells that are split into lattices", "tests/scenes/growing.prm", 4, (2,),
     0.6, ("Bodies/zone/Nodal spacing=0.5 mm", "Ranks per checkpoint file=2")),
    ("erosion", "prm/perforation/fem-erosion.prm", 4, (3,), 0.8,
     ("Bodies/plate/Cell size=2.5 mm", "End time=9 us",
      "Outputs/fields/Interval=9 us")),
    ("B-bar cells that erode", "prm/perforation/fem-erosion.prm", 3, (1,), 0.8,
     ("Bodies/plate/Cell size=2.5 mm", "End time=9 us",
      "Outputs/fields/Interval=9 us", "Bodies/plate/Integration=B-bar",
      "Bodies/plate/Objective rate=Green-Naghdi")),
    ("materials, heat conduction", "tests/scenes/materials.prm", 3, (2,), 0.5,
     ()),
)


def read(path, name):
    with open(os.path.join(path, name), "rb") as file:
        return file.read()


def answers(path):
    """What a result says of the scene."""
    r = json.loads(read(path, "result.json"))
    return {key: r[key] for key in ("steps", "time", "bodies", "energy",
                                    "quantities", "couplings", "step_limits",
                                    "energy_residual_max") if key in r}


class Ranks(unittest.TestCase):
    def go_on(self, name, scene, n, others, part, settings):
        path = os.path.join(WORK, name.replace(" ", "-").replace(",", ""))
        shutil.rmtree(path, ignore_errors=True)
        os.makedirs(path)
        options = [word for setting in settings for word in ("--set", setting)]
        straight = os.path.join(path, "straight")
        done = sabot("run", os.path.join(SOURCE, scene), "-o", straight,
                     "--quiet", *options)
        self.assertEqual(done.returncode, 0, done.stdout)
        history, its = read(straight, "history.h5"), answers(straight)
        every = int(part * its["steps"]) + 1
        parted = os.path.join(path, "parted")
        done = sabot("run", os.path.join(SOURCE, scene), "-o", parted,
                     "--quiet", *options, "--set",
                     "Checkpoint interval in steps=%d" % every, "--set",
                     "Checkpoint at the end=false", ranks=n)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(read(parted, "history.h5"), history)
        for m in others:
            out = os.path.join(path, "on-%d" % m)
            shutil.copytree(parted, out)
            for file in ("history.h5", "result.json"):
                os.remove(os.path.join(out, file))
            done = sabot("resume", out, "--quiet", ranks=m)
            self.assertEqual(done.returncode, 0, done.stdout)
            log = read(out, "log.txt").decode()
            self.assertIn("resumed at step %d," % every, log)
            self.assertIn("written on %d rank" % n, log)
            self.assertEqual(read(out, "history.h5"), history,
                             "%s: from %d to %d ranks" % (name, n, m))
            self.assertEqual(answers(out), its)
            self.check_frames(out)

    def check_frames(self, out):
        """The frames of both numbers of ranks are there, and nothing else."""
        if not os.path.exists(os.path.join(out, "sabot.pvd")):
            return
        frames = re.findall(r'file="([^"]+)"', read(out, "sabot.pvd").decode())
        pieces = [os.path.join("fields", piece)
                  for frame in frames if frame.endswith(".pvtu")
                  for piece in re.findall(r'Source="([^"]+)"',
                                          read(out, frame).decode())]
        self.assertEqual(
            sorted(frames + pieces),
            sorted(os.path.join("fields", name)
                   for name in os.listdir(os.path.join(out, "fields"))))

    def test_checkpoints_go_on_with_any_number_of_ranks(self):
        for scene in SCENES:
            if len(sys.argv) < 5 or any(word in scene[0]
                                        for word in sys.argv[4:]):
                with self.subTest(scene[0]):
                    self.go_on(*scene)

    def test_a_checkpoint_of_several_files_is_whole_or_none(self):
        path = os.path.join(WORK, "files")
        shutil.rmtree(path, ignore_errors=True)
        whole, words = os.path.join(path, "whole"), []
        for word in ("End time=3 us", "Ranks per checkpoint file=2",
                     "Checkpoint interval in steps=16",
                     "Checkpoint at the end=false"):
            words += ["--set", word]
        scene = os.path.join(SOURCE, "tests/scenes/torn.prm")
        done = sabot("run", scene, "-o", whole, "--quiet", *words, ranks=4)
        self.assertEqual(done.returncode, 0, done.stdout)
        first, last = "step-0000000016", "step-0000000032"
        self.assertEqual(sorted(os.listdir(os.path.join(whole, "checkpoint"))),
                         [first + ".h5", first + ".rank-2.h5",
                          last + ".h5", last + ".rank-2.h5"])

        def remove(file):
            os.remove(file)

        def flip(file):
            with open(file, "r+b") as f:
                middle = os.path.getsize(file) // 2
                f.seek(middle)
                byte = f.read(1)
                f.seek(middle)
                f.write(bytes([byte[0] ^ 1]))

        def exchange(file):
            shutil.copy(file.replace(last, first), file)

        for number, (spoil, ranks) in enumerate(
                ((remove, 1), (flip, 2), (exchange, 3), (remove, 4))):
            out = os.path.join(path, "spoilt-%d" % number)
            shutil.copytree(whole, out)
            for name in ("history.h5", "result.json"):
                os.remove(os.path.join(out, name))
            spoil(os.path.join(out, "checkpoint", last + ".rank-2.h5"))
            done = sabot("resume", out, "--quiet", ranks=ranks)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertIn("resumed at step 16,",
                          read(out, "log.txt").decode())
            self.assertEqual(read(out, "history.h5"),
                             read(whole, "history.h5"))

        # One of the files cannot be written: exit code 4, and the checkpoint
        # before stays.
        out = os.path.join(path, "full")
        os.makedirs(os.path.join(out, "checkpoint", last + ".rank-2.h5", "x"))
        done = sabot("run", scene, "-o", out, "--quiet", *words, ranks=4)
        self.assertEqual(done.returncode, 4, done.stdout)
        self.assertIn("cannot write", done.stdout)
        self.assertIn(last + ".rank-2.h5", done.stdout)
        self.assertEqual(sorted(os.listdir(os.path.join(out, "checkpoint"))),
                         [first + ".h5", first + ".rank-2.h5",
                          last + ".rank-2.h5"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
