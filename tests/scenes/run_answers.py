#!/usr/bin/env python3
"""What runs answer and keep: run_answers.py SABOT SOURCE_FOLDER WORK_FOLDER

Results that are not lost, the record in log.txt, runs that go on after their
end, and forces and states over time.
"""
import glob
import math
import os
import re
import shutil
import sys
import unittest

from program import BAR, QUICK, SOURCE, WORK, folder, result, sabot
from vtu import read_vtu



def read(*names):
    with open(os.path.join(*names), "rb") as file:
        return file.read()


class Answers(unittest.TestCase):
    def run_scene(self, scene, out, *settings, ranks=1, code=0):
        words = [word for s in settings for word in ("--set", s)]
        done = sabot("run", scene, "-o", out, "--quiet", *words, ranks=ranks)
        self.assertEqual(done.returncode, code, done.stdout)
        return done

    def test_a_finished_run_goes_on_to_a_later_end(self):
        # Particles, contact, broken bonds; frames and rows of both ends fall
        # between the multiples of their intervals.
        for scene, ranks, first, last, settings in (
                (BAR, 1, "1.3 us", "5 us", ("Outputs/fields/Interval=2 us",)),
                (BAR, 2, "0.01 us", "2 us", ()),
                (QUICK, 2, "0.7 us", "1.5 us", (
                    "Outputs/fields/Interval=0.6 us",))):
            with self.subTest(scene + first):
                parted, whole = folder("extended"), folder("long")
                self.run_scene(scene, parted, "End time=" + first, *settings,
                               ranks=ranks)
                self.assertEqual(result(parted)["status"], "completed")
                done = sabot("resume", parted, "--quiet", "--set",
                             "End time=" + last, ranks=ranks)
                self.assertEqual(done.returncode, 0, done.stdout)
                self.run_scene(scene, whole, "End time=" + last, *settings,
                               ranks=ranks)
                files = sorted(
                    os.path.relpath(name, whole) for pattern in (
                        "history.h5", "sabot.pvd", "fields/*", "parameters.prm")
                    for name in glob.glob(os.path.join(whole, pattern)))
                self.assertGreater(len(files), 3)
                for name in files:
                    self.assertEqual(read(parted, name), read(whole, name),
                                     name)
                self.assertEqual(
                    sorted(os.listdir(os.path.join(parted, "fields"))),
                    sorted(os.listdir(os.path.join(whole, "fields"))))
                a, b = result(parted), result(whole)
                for key in ("bodies", "energy", "quantities", "couplings",
                            "steps", "energy_residual_max"):
                    self.assertEqual(a[key], b[key], key)
        # Not to an earlier one, nor without the checkpoint.
        done = sabot("resume", parted, "--set", "End time=1 us", ranks=2)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("can only end later", done.stdout)
        self.run_scene(BAR, folder("no-end"), "Checkpoint at the end=false")
        done = sabot("resume", os.path.join(WORK, "no-end"), "--set",
                     "End time=9 us")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("Checkpoint at the end", done.stdout)

    def test_a_self_finding_zone_of_some_size_has_particles_at_the_start(self):
        scene = os.path.join(SOURCE, "tests/scenes/growing.prm")
        for settings, share in (((), 0.25), (("Bodies/zone/Start zone=no",),
                                             0.)):
            out = folder("started")
            self.run_scene(scene, out, "End time=0.01 us", *settings)
            bodies = result(out)["bodies"]
            mass = 2700. * 200e-9
            self.assertAlmostEqual(bodies["zone"]["mass"] / mass, share)
            self.assertAlmostEqual(bodies["block"]["mass"] / mass, 1. - share)

    def test_the_expanded_parameters_are_the_same_scene(self):
        # That a zone has no particles at the start shows by what is not set.
        for scene in (BAR, os.path.join(SOURCE, "tests/scenes/found.prm"),
                      os.path.join(SOURCE, "tests/scenes/growing.prm"),
                      os.path.join(SOURCE, "tests/scenes/driven-bar.prm")):
            with self.subTest(scene):
                out, again = folder("scene"), folder("expanded")
                self.run_scene(scene, out, "End time=3 us")
                self.run_scene(os.path.join(out, "parameters.prm"), again)
                self.assertEqual(read(again, "history.h5"),
                                 read(out, "history.h5"))
                self.assertEqual(result(again)["warnings"],
                                 result(out)["warnings"])
                # Nor does going on say more than one long run does.
                done = sabot("resume", again, "--set", "End time=4 us")
                self.assertEqual(done.returncode, 0, done.stdout)
                whole = folder("whole-scene")
                self.run_scene(scene, whole, "End time=4 us")
                self.assertEqual(result(again)["warnings"],
                                 result(whole)["warnings"])

    def test_what_rests_is_not_struck_by_the_cut_last_step(self):
        # The stiffness of contact goes by the step, which the end cuts.
        scene = os.path.join(SOURCE, "tests/scenes/resting.prm")
        for end in ("40.005 us", "40.05 us", "40.09 us"):
            out = folder("resting")
            self.run_scene(scene, out, "End time=" + end)
            weight = 7830. * 18e-9 * 20e3  # [N]
            force = result(out)["quantities"]["force"]["value"]
            self.assertLess(abs(force / weight - 1.), 0.1, end)

    def test_the_cut_last_step_keeps_the_energy_of_substeps(self):
        # Within two substeps a block at rest goes up and down by its weight.
        scene = os.path.join(SOURCE, "tests/scenes/resting.prm")
        for end in ("40.005 us", "40.05 us"):
            out = folder("resting-substeps")
            self.run_scene(scene, out, "End time=" + end,
                           "Bodies/block/Cell size=0.375 mm")
            r = result(out)
            self.assertGreater(r["step_limits"]["substeps"]["block"], 1.9)
            self.assertLess(r["energy_residual_max"], 1e-6, end)

    def test_gauges_on_cells_of_several_ranks(self):
        # Velocities of nodes of other ranks are those after the last kick.
        scene = os.path.join(SOURCE, "tests/scenes/driven-bar.prm")
        gauges = ["g%d" % i for i in range(10)]
        settings = ["List of outputs=averages, middle, " + ", ".join(gauges)]
        for i, name in enumerate(gauges):
            settings += ["Outputs/%s/%s" % (name, entry) for entry in (
                "Type=gauge", "Body=bar", "Interval=0.3 us",
                "Point=%g mm, 0.75 mm, 1.25 mm" % (0.25 + 0.5 * i))]
        histories = []
        for ranks in (1, 3):
            out = folder("gauges%d" % ranks)
            self.run_scene(scene, out, "Bodies/bar/Size=6 mm, 2 mm, 2 mm",
                           "Bodies/bar/Center=3 mm, 1 mm, 1 mm", *settings,
                           ranks=ranks)
            histories.append(read(out, "history.h5"))
        self.assertEqual(histories[0], histories[1])

    def test_results_are_not_overwritten_unless_told(self):
        out = folder("kept")
        self.run_scene(BAR, out, "Outputs/fields/Interval=1 us")
        frames = set(os.listdir(os.path.join(out, "fields")))
        own = os.path.join(out, "fields", "notes.txt")
        with open(own, "w") as file:
            file.write("mine")
        before = {name: read(name) for name in
                  glob.glob(out + "/**", recursive=True)
                  if os.path.isfile(name)}
        for ranks in (1, 2):
            done = sabot("run", BAR, "-o", out, ranks=ranks)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn("--overwrite", done.stdout)
        for name, content in before.items():
            self.assertEqual(read(name), content, name)
        # Told, nothing of the old run stays, and nothing else goes.
        done = sabot("run", BAR, "-o", out, "--quiet", "--overwrite", "--set",
                     "End time=2 us", "--set", "Outputs/fields/Interval=2 us")
        self.assertEqual(done.returncode, 0, done.stdout)
        left = set(os.listdir(os.path.join(out, "fields")))
        self.assertTrue(os.path.exists(own))
        self.assertLess(len(left), len(frames))
        self.assertEqual(len(left) - 1,
                         read(out, "sabot.pvd").count(b"<DataSet"))
        self.assertEqual(len(glob.glob(out + "/checkpoint/*.h5")), 1)
        # An interrupted run can go on, and is kept, too.
        os.remove(os.path.join(out, "result.json"))
        done = sabot("run", BAR, "-o", out)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("sabot resume", done.stdout)

    def test_a_failed_run_answers_nothing(self):
        out = folder("failed")
        done = sabot("run", BAR, "-o", out, "--set", "Step factor=2", "--set",
                     "End time=1 ms", "--set", "Outputs/fields/Interval=1 ms")
        self.assertEqual(done.returncode, 2, done.stdout)
        r = result(out)
        self.assertEqual(r["status"], "failed")
        self.assertEqual(r["quantities"], {"speed": {"value": None,
                                                     "unit": "m/s"}})
        self.assertIn("are not given", done.stdout)
        self.assertNotIn("speed:", done.stdout)
        # It may be run again without more words.
        self.run_scene(BAR, out)
        self.assertAlmostEqual(result(out)["quantities"]["speed"]["value"], 10.,
                               delta=1e-9)

    def test_the_log_is_a_record(self):
        out = folder("record")
        done = sabot("run", BAR, "-o", out, "--set", "End time=60 us", "--set",
                     "Title=it's a bar")
        self.assertEqual(done.returncode, 0, done.stdout)
        log = read(out, "log.txt").decode()
        self.assertRegex(log, r"Sabot [\d.]+, revision \w+.*: it's a bar\n")
        self.assertRegex(log, r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d UTC on \S+, "
                              r"1 rank\n")
        self.assertIn("--set 'Title=it'\\''s a bar'", log)
        self.assertRegex(log, r"compiled by \w+ [\d.]+, instruction set \w+")
        # A line at each percent, which names energies and what limits the step.
        lines = re.findall(r"step +(\d+)  time (\S+) s .*\(block #\d+\).*"
                           r"kinetic \S+.*total \S+ J", log)
        self.assertGreater(len(lines), 80)
        self.assertLess(len(lines), 102)
        # Nothing is overwritten in place where there is no terminal.
        self.assertNotIn("\r", done.stdout)
        for line in log.splitlines():
            self.assertIn(line, done.stdout)
        # What the plan doubts stands in it.
        self.run_scene(QUICK, out + "-doubts", "Bodies/projectile/"
                       "Initial velocity=0 m/s, 0 m/s, -6 km/s",
                       "End time=0.01 us")
        self.assertIn("warning: body \"projectile\" is shocked beyond",
                      read(out + "-doubts", "log.txt").decode())
        self.addCleanup(shutil.rmtree, out + "-doubts")

    def test_timers_count_the_processor(self):
        out = folder("timers")
        self.run_scene(BAR, out, "End time=100 us")
        r = result(out)
        step = r["timers"]["spg step"]
        self.assertGreater(step["cpu_seconds"], 0.)
        self.assertLess(step["cpu_seconds"], 1.05 * step["seconds"])
        total = sum(t["cpu_seconds"] for name, t in r["timers"].items())
        self.assertLess(total, 1.1 * r["cpu_seconds"])
        # Per particle and step, the first forces included.
        self.assertEqual(step["items"], 216 * (r["steps"] + 1))
        self.assertAlmostEqual(step["ns_per_item"] * step["items"] * 1e-9,
                               step["cpu_seconds"])
        self.assertGreater(r["timers"]["balance"]["items"], 0)

    def test_steps_over_those_at_rest_and_what_limits_them(self):
        # Nothing deforms: the block's own step, and a last one that is cut.
        out = folder("steps")
        self.run_scene(BAR, out)
        r = result(out)
        limits, log = r["step_limits"], read(out, "log.txt").decode()
        own = 0.9 * limits["own_step_at_rest"]
        self.assertEqual(limits["own_step_of"], "particles")
        # Bulk viscosity of 0.06 shortens it wherever round-off compresses.
        self.assertGreaterEqual(r["steps"], math.ceil(r["time"] / own))
        self.assertLessEqual(r["steps"], math.ceil(1.06 * r["time"] / own))
        self.assertAlmostEqual(limits["steps_over_own"],
                               r["steps"] * own / 0.9 / r["time"])
        # Where it no longer does, the step grows back by 5 %.
        steps = {(row["name"], row["kind"]): row["steps"]
                 for row in limits["limited_by"]}
        growth = steps.pop(("growth of the step", "bound"), 0)
        self.assertLess(growth, 0.3 * r["steps"])
        self.assertEqual(steps, {("block", "particles"):
                                 r["steps"] - growth - 1,
                                 ("End time", "bound"): 1})
        self.assertIn("limited by block, particles", log)
        self.assertNotIn("messages", log)
        # A bound of the scene's own.
        self.run_scene(BAR, out + "-bound", "Largest step=0.11 us")
        self.addCleanup(shutil.rmtree, out + "-bound")
        limits = result(out + "-bound")["step_limits"]
        self.assertEqual([(row["name"], row["steps"])
                          for row in limits["limited_by"]],
                         [("Largest step", 45), ("End time", 1)])
        self.assertAlmostEqual(limits["steps_over_own"],
                               46 * limits["own_step_at_rest"] / 5e-6)

    def test_messages_are_counted(self):
        out = folder("messages")
        self.run_scene(BAR, out, ranks=2)
        r = result(out)
        # Two halves of a block, which see as much of each other: positions
        # of 32 bytes, once for the first forces and each step.
        t = r["timers"]["ghost exchange"]
        self.assertEqual(t["messages"], r["steps"] + 1)
        self.assertEqual(t["message_bytes"], 32 * t["items"])
        self.assertEqual(t["items"] % (36 * (r["steps"] + 1)), 0)
        per_step = r["messages_per_step"]
        for kind in ("messages", "message_bytes", "reductions"):
            self.assertGreater(per_step[kind]["mean"], 0)
            self.assertEqual(per_step[kind]["mean"], per_step[kind]["largest"])
        self.assertIn("per step and rank: ", read(out, "log.txt").decode())
        # One rank tells nobody anything.
        self.run_scene(BAR, out + "-alone")
        self.addCleanup(shutil.rmtree, out + "-alone")
        for rate in result(out + "-alone")["messages_per_step"].values():
            self.assertEqual(rate["largest"], 0)

    def test_answers_are_the_same_on_1_2_and_3_ranks_and_resumed(self):
        # Forces, gauge, extremes; the kernel is renewed and bonds fail between
        # the checkpoint and the end.
        scene = os.path.join(SOURCE, "tests/scenes/held-plate.prm")
        histories, answers = [], []
        for name, ranks, extra in (
                ("held1", 1, ()), ("held2", 2, ()), ("held3", 3, ()),
                ("held-parts", 2, ("Checkpoint interval in steps=35",
                                   "Checkpoint at the end=false"))):
            out = folder(name)
            self.run_scene(scene, out, *extra, ranks=ranks)
            if extra:
                os.remove(os.path.join(out, "history.h5"))
                done = sabot("resume", out, "--quiet", ranks=ranks)
                self.assertEqual(done.returncode, 0, done.stdout)
                self.assertIn("resumed at step 35",
                              read(out, "log.txt").decode())
            r = result(out)
            self.assertLess(r["momentum_residual_max"], 1e-12)
            self.assertGreater(r["bodies"]["core"]["bonds_broken"], 0)
            histories.append(read(out, "history.h5"))
            answers.append((r["quantities"], r["couplings"], r["bodies"],
                            r["step_limits"]))
        for history, answer in zip(histories[1:], answers[1:]):
            self.assertEqual(history, histories[0])
            self.assertEqual(answer, answers[0])
        for quantity in ("stress", "peak"):
            for key in ("value", "at_time", "x", "y", "z"):
                self.assertIsNotNone(answers[0][0][quantity][key])

    def test_fields_have_one_association_a_unit_and_a_size(self):
        scene = os.path.join(SOURCE, "tests/scenes/held-plate.prm")
        out = folder("fields")
        self.run_scene(scene, out, "List of outputs=averages, rear, fields",
                       "Outputs/fields/Type=VTU", "End time=3 us",
                       "Outputs/fields/Interval=3 us", ranks=2)

        def arrays(text, section):
            part = re.search("<%s.*?</%s>" % (section, section), text, re.S)
            return set(re.findall('Name="([^"]*)"', part.group(0)))
        files = sorted(glob.glob(os.path.join(out, "fields/*_000001*.vtu")))
        self.assertEqual(len(files), 6)
        in_cells = {}
        for name in files:
            text = read(name).split(b"<AppendedData")[0].decode()
            body = os.path.basename(name).split("_")[0]
            cells, points = arrays(text, "CellData"), arrays(text, "PointData")
            in_cells[body] = cells
            for field in ("stress", "von Mises", "pressure", "body", "rank",
                          "effective plastic strain"):
                self.assertIn(field, cells, name)
            for field in ("displacement", "velocity"):
                self.assertIn(field, points)
                self.assertNotIn(field, cells)
            self.assertEqual("diameter" in points, body == "core")
            if body == "core":
                self.assertEqual(cells - points, set())
            # Every array but VTK's own of the mesh tells its unit.
            units = re.findall('<InformationKey name="UNITS_LABEL"[^>]*>\\s*'
                               '([^<\\s]+)', text)
            self.assertEqual(len(units), len(re.findall(
                'DataArray [^>]*Name="(?!Points|connectivity|offsets|types)',
                text)), name)
            self.assertIn("Pa", units)
        self.assertLessEqual(in_cells["plate"], in_cells["core"])
        core = [read_vtu(name) for name in files if "/core" in name]
        diameters = [d for piece in core for d in piece["diameter"]]
        volume = sum(d ** 3 for d in diameters)
        self.assertAlmostEqual(volume, 5e-3 * 5e-3 * 4e-3, delta=0.1 * volume)
        # Pieces by size: 0 is what is left of the body.
        pieces = [int(f) for piece in core for f in piece["fragment"]]
        sizes = [pieces.count(n) for n in range(max(pieces) + 1)]
        self.assertEqual(sum(sizes), len(pieces))
        self.assertGreater(sizes[0], 0.5 * len(pieces))
        self.assertEqual(result(out)["bodies"]["core"]["fragment_count"],
                         len(sizes))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
