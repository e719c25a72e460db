#!/usr/bin/env python3
"""What users get wrong in scenes: run_input.py SABOT SOURCE_FOLDER WORK_FOLDER

Scenes that cannot be meant are warned of, those that cannot be are refused, in
one line each; and what looks odd but is right passes without a word.
"""
import json
import os
import shutil
import sys
import unittest

from program import SOURCE, WORK, result, sabot
from scene_text import section


STEEL = {"Density": "7830 kg/m^3", "Young's modulus": "206 GPa"}
PLATE = {"Size": "20 mm, 20 mm, 2 mm", "Center": "0 mm, 0 mm, -1 mm",
         "Cell size": "2 mm", "Material": "steel"}
ROD = {"Size": "4 mm, 4 mm, 4 mm", "Center": "0 mm, 0 mm, 2.01 mm",
       "Cell size": "2 mm", "Material": "steel",
       "Initial velocity": "0 m/s, 0 m/s, -300 m/s"}
BLOCK = {"Size": "4 mm, 4 mm, 4 mm", "Cell size": "2 mm", "Material": "steel"}
IMPACT = {"impact": {"Bodies": "plate, rod"}}


def scene(bodies, couplings=None, materials=None, listed=None, **entries):
    """The text of a scene; @p listed: the couplings that count, all for None."""
    couplings = couplings or {}
    entries = {k.replace("_", " ").capitalize(): v for k, v in entries.items()}
    entries.setdefault("End time", "30 us")
    entries["List of bodies"] = ", ".join(bodies)
    entries["List of couplings"] = ", ".join(
        couplings if listed is None else listed)
    text = "".join("set %s = %s\n" % item for item in entries.items())
    text += section("Materials", materials or {"steel": STEEL})
    text += section("Bodies", bodies)
    return text + (section("Couplings", couplings) if couplings else "")


def write(name, text):
    os.makedirs(WORK, exist_ok=True)
    path = os.path.join(WORK, name)
    with open(path, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())
    return path


class Input(unittest.TestCase):
    def warnings(self, text):
        done = sabot("check", write("scene.prm", text))
        self.assertEqual(done.returncode, 0, done.stdout)
        return [line for line in done.stdout.splitlines()
                if line.startswith("warning: ")]

    def assertWarns(self, text, *parts):
        """One warning for each of @p parts, and no other."""
        found = self.warnings(text)
        self.assertEqual(len(found), len(parts), found)
        for warning, part in zip(found, parts):
            self.assertIn(part, warning)

    def assertRefused(self, text, *parts, name="scene.prm"):
        done = sabot("check", write(name, text))
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(len(done.stdout.strip().splitlines()), 1, done.stdout)
        for part in parts:
            self.assertIn(part, done.stdout)

    def test_bodies_that_meet_need_a_contact(self):
        both = {"plate": PLATE, "rod": ROD}
        self.assertWarns(scene(both, IMPACT))
        # 0.01 mm at 300 m/s.
        self.assertWarns(scene(both), "meet after 0.03333 us")
        self.assertWarns(scene(both, IMPACT, listed=[]),
                         "\"Couplings/impact\" is described but not in the list")
        # Not before the end, not at all, and beside it.
        self.assertWarns(scene(both, end_time="0.02 us"))
        for change in ({"Initial velocity": "0 m/s, 0 m/s, 300 m/s"},
                       {"Center": "12.01 mm, 0 mm, 2.01 mm"}):
            self.assertWarns(scene({"plate": PLATE, "rod": {**ROD, **change}}))
        # Along a diagonal; with a drive; at rest, face on face.
        self.assertWarns(scene({"plate": PLATE, "rod": dict(
            ROD, **{"Center": "9 mm, 0 mm, 7 mm",
                    "Initial velocity": "-300 m/s, 0 m/s, -300 m/s"})}),
            "meet after 16.67 us")
        drive = {"Initial velocity": "0 m/s, 0 m/s, 0 m/s",
                 "Driven faces": "+z",
                 "Prescribed velocity": "0 m/s, 0 m/s, -10 m/s"}
        self.assertWarns(scene({"plate": PLATE, "rod": {**ROD, **drive}}),
                         "meet after 1 us")
        still = {"Initial velocity": "0 m/s, 0 m/s, 0 m/s",
                 "Center": "0 mm, 0 mm, 2 mm"}
        self.assertWarns(scene({"plate": PLATE, "rod": {**ROD, **still}}),
                         "touch each other, but no contact")
        # Tied; or edge on edge, where there is nothing to hold.
        tie = {"joint": {"Type": "tie", "Follower": "rod", "Leader": "plate"}}
        self.assertWarns(scene({"plate": PLATE, "rod": {**ROD, **still}}, tie))
        beside = dict(ROD, Center="12 mm, 0 mm, 2 mm")
        self.assertWarns(scene({"plate": PLATE, "rod": beside}))
        # Particles and rigid bodies alike.
        for other in ({"Discretization": "SPG", "Nodal spacing": "2 mm"},
                      {"Discretization": "rigid", "Cell size": "2 mm"}):
            rod = {k: v for k, v in ROD.items() if k != "Cell size"}
            self.assertWarns(scene({"plate": PLATE, "rod": {**rod, **other}}),
                             "meet after 0.03333 us")

    def test_rigid_bodies_whose_motion_is_prescribed_cannot_meet(self):
        rigid = {"Discretization": "rigid", "Motion": "prescribed"}
        both = {"plate": {**PLATE, **rigid}, "rod": {**ROD, **rigid}}
        self.assertRefused(scene(both, IMPACT), "Bodies/rod/Motion",
                           "the two meet after 0.03333 us")
        free = {**both["rod"], "Motion": "free"}
        self.assertWarns(scene({**both, "rod": free}, IMPACT))

    def test_contacts_that_never_act(self):
        def with_rod(**change):
            return scene({"plate": PLATE, "rod": dict(ROD, **{
                k.replace("_", " "): v for k, v in change.items()})}, IMPACT)
        away = {"Initial_velocity": "0 m/s, 0 m/s, 300 m/s"}
        self.assertWarns(with_rod(**away), "fly apart: check the sign")
        self.assertWarns(with_rod(Center="0 mm, 0 mm, 20 mm",
                                  Initial_velocity="0 m/s, 0 m/s, -100 m/s"),
                         "would meet after 180 us")
        self.assertWarns(with_rod(Center="40 mm, 0 mm, 2.01 mm"),
                         "miss each other")
        self.assertWarns(with_rod(Initial_velocity="0 m/s, 0 m/s, 0 m/s"),
                         "rest with each other")
        # What slides along or is driven may touch.
        self.assertWarns(with_rod(Initial_velocity="100 m/s, 0 m/s, 0 m/s"))
        self.assertWarns(scene({"plate": dict(
            PLATE, **{"Driven faces": "-x",
                      "Prescribed velocity": "0 m/s, 0 m/s, 9 m/s"}),
            "rod": dict(ROD, **{"Initial velocity": "0 m/s, 0 m/s, 0 m/s"})},
            IMPACT))
        # A third body sets the second one in motion.
        wall = dict(PLATE, Center="0 mm, 0 mm, -5 mm")
        self.assertWarns(scene(
            {"plate": PLATE, "rod": ROD, "wall": wall},
            {"impact": IMPACT["impact"], "behind": {"Bodies": "plate, wall"}}),
            "bodies \"rod\" and \"wall\" meet")
        # Particles that hold together have no debris.
        particles = {"Size": "4 mm, 4 mm, 4 mm", "Discretization": "SPG",
                     "Nodal spacing": "2 mm", "Material": "steel"}
        pieces = {"pieces": {"Type": "self-contact", "Bodies": "block"}}
        self.assertWarns(scene({"block": particles}, pieces),
                         "no bond of its bodies can fail")
        self.assertWarns(scene({"block": dict(
            particles, **{"Failure criterion": "maximum principal stress",
                          "Critical principal stress": "2 GPa"})}, pieces))

    def test_planes_of_symmetry_that_differ(self):
        plate = dict(PLATE, Size="10 mm, 10 mm, 2 mm",
                     Center="5 mm, 5 mm, -1 mm",
                     **{"Symmetry faces": "-x, -y"})
        rod = dict(ROD, Center="2 mm, 2 mm, 2.01 mm")

        def check(rod, *parts):
            self.assertWarns(scene({"plate": plate, "rod": rod}, IMPACT), *parts)
        cut = {"Symmetry faces": "-x, -y"}
        check({**rod, **cut})
        check(rod, "ends on the plane of symmetry x = 0 mm",
              "ends on the plane of symmetry y = 0 mm")
        check(dict(rod, **{"Symmetry faces": "-x"}), "y = 0 mm")
        check(dict(rod, Center="0 mm, 5 mm, 2.01 mm"), "reaches across")
        check(dict(rod, Center="5 mm, 5 mm, 2.01 mm"))
        # Nothing but a guide holds a rigid body on its side.
        rigid = dict(rod, Discretization="rigid")
        check(rigid, "a rigid body cannot be cut", "a rigid body cannot be cut")
        check(dict(rigid, Motion="prescribed"))
        # A zone of particles that lacks the planes of its host.
        core = {"Discretization": "SPG", "Carve from": "plate",
                "Size": "4 mm, 4 mm, 2 mm", "Center": "2 mm, 2 mm, -1 mm",
                "Nodal spacing": "1 mm", "Material": "steel"}
        zone = {"zone": {"Type": "tie", "Follower": "core", "Leader": "plate"}}
        self.assertWarns(scene({"plate": plate, "core": {**core, **cut}}, zone))
        moving = dict(core, **{"Initial velocity": "0 m/s, 0 m/s, 1 m/s"}, **cut)
        self.assertWarns(scene({"plate": plate, "core": moving}, zone),
                         "starts with another velocity")
        self.assertEqual(
            sum("ends on the plane of symmetry" in w for w in
                self.warnings(scene({"plate": plate, "core": core}, zone))), 2)

    def test_contradictory_conditions_on_a_node(self):
        def plate(**change):
            return scene({"plate": dict(PLATE, **{
                k.replace("_", " "): v for k, v in change.items()})})
        up = "0 m/s, 0 m/s, 5 m/s"
        self.assertRefused(plate(Clamped_faces="-x", Driven_faces="-x",
                                 Prescribed_velocity=up),
                           "Bodies/plate/Driven faces", "22 nodes")
        # Along the edge of two faces; on a plane of symmetry.
        self.assertRefused(plate(Clamped_faces="-x", Driven_faces="+y",
                                 Prescribed_velocity=up),
                           "2 nodes", "(-10, 10, ")
        self.assertRefused(plate(Symmetry_faces="-z", Driven_faces="-x",
                                 Prescribed_velocity=up), "11 nodes")
        # Apart from each other, at rest, or only along the plane they agree.
        for change in (dict(Driven_faces="+x"),
                       dict(Driven_faces="-x", Prescribed_velocity="0, 0, 0"),
                       dict(Clamped_faces="", Symmetry_faces="-z",
                            Driven_faces="-x", Prescribed_components="x, y",
                            Prescribed_velocity="5 m/s, 0 m/s, 5 m/s")):
            done = sabot("check", write("scene.prm", plate(
                **{"Clamped_faces": "-x", "Prescribed_velocity": up,
                   **change})))
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_ties_of_nodes_that_something_else_moves(self):
        left = dict(BLOCK, Center="-4 mm, 0 mm, 0 mm")
        particles = {"Size": "4 mm, 4 mm, 4 mm", "Discretization": "SPG",
                     "Nodal spacing": "2 mm", "Material": "steel"}

        def joint(follower="block", leader="left"):
            return {"Type": "tie", "Follower": follower, "Leader": leader}

        def check(left_more, block_more):
            return scene({"left": {**left, **left_more},
                          "block": {**particles, **block_more}},
                         {"joint": joint()})
        clamped = {"Clamped faces": "-x"}
        self.assertRefused(check({}, clamped), "Couplings/joint/Follower",
                           "9 nodes", "along x, y, z")
        self.assertRefused(check({}, {"Symmetry faces": "-y"}), "3 nodes",
                           "along y")
        # The leader is held alike.
        self.assertWarns(check({"Clamped faces": "+x"}, clamped))
        self.assertWarns(check({"Symmetry faces": "-y"},
                               {"Symmetry faces": "-y"}))

        # Two leaders: the first holds the common edge, momentum stays.
        below = dict(BLOCK, Center="0 mm, -4 mm, 0 mm")
        bodies = {"left": dict(left, **{"Initial velocity":
                                        "0 m/s, 0 m/s, 10 m/s"}),
                  "below": below, "block": particles}
        ties = {"joint left": joint(), "joint below": joint(leader="below")}
        text = scene(bodies, ties, end_time="10 us", step_factor="0.4")
        self.assertWarns(text, "3 nodes of body \"block\"")
        out = os.path.join(WORK, "two-ties")
        shutil.rmtree(out, ignore_errors=True)
        done = sabot("run", write("two-ties.prm", text), "-o", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(os.path.join(out, "result.json")) as file:
            result = json.load(file)
        self.assertLess(result["momentum_residual_max"], 1e-12)
        self.assertLess(result["energy_residual_max"], 0.01)
        # What check says the run says, in its log and its results.
        self.assertIn("3 nodes of body", result["warnings"][0])
        with open(os.path.join(out, "log.txt")) as file:
            self.assertIn("3 nodes of body", file.read())

        # A chain through an edge: both ties would move it.
        bodies = {"left": left, "block": BLOCK,
                  "top": dict(BLOCK, Center="0 mm, 4 mm, 0 mm")}
        self.assertRefused(scene(bodies, {
            "one": joint(), "two": joint("top", "block")}),
            "follows in one of the ties", "(-2, 2, ")
        self.assertWarns(scene(bodies, {
            "one": joint("left", "block"), "two": joint("top", "block")}))

    def test_overlaps_are_those_of_the_shapes(self):
        ball = {"Geometry": "sphere", "Radius": "5 mm", "Cell size": "2 mm",
                "Material": "steel"}

        def two(first, second):
            return scene({"one": first, "two": second},
                         {"touch": {"Bodies": "one, two"}})
        # Balls on a diagonal, whose boxes overlap: 11.26 mm apart, and 9.
        flying = dict(ball, **{"Initial velocity": "-9 m/s, -9 m/s, -9 m/s"})
        self.assertWarns(
            two(ball, dict(flying, Center="6.5 mm, 6.5 mm, 6.5 mm"))
            .replace("30 us", "1 ms"))
        self.assertRefused(two(ball, dict(ball, Center="5.2 mm, 5.2 mm, 5.2 mm")),
                           "Bodies/two/Center", "overlap by")
        # One within the other, with no surfaces that cross.
        self.assertRefused(two(ball, dict(ball, Radius="1 mm",
                                          **{"Cell size": "0.5 mm"})), "overlap")
        # Boxes tell a hundredth of a millimeter; crossed bars have no node in
        # each other.
        self.assertRefused(two(BLOCK, dict(BLOCK, Center="0 mm, 0 mm, 3.99 mm")),
                           "overlap by 0.01 mm")
        bar = dict(BLOCK, Size="12 mm, 2 mm, 2 mm", **{"Cell size": "2 mm"})
        self.assertRefused(two(bar, dict(bar, Size="2 mm, 12 mm, 2 mm")),
                           "overlap")
        particles = {"Size": "4 mm, 4 mm, 4 mm", "Discretization": "SPG",
                     "Nodal spacing": "2 mm", "Material": "steel"}
        self.assertRefused(two(dict(ball, Center="0 mm, 0 mm, 6 mm"), particles),
                           "overlap")

    def test_sizes_are_counted_before_they_are_made(self):
        def limit():
            import resource
            resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

        def refuse(body, *parts):
            path = write("scene.prm", scene(body))
            done = sabot("check", path, preexec_fn=limit)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(len(done.stdout.strip().splitlines()), 1)
            for part in parts:
                self.assertIn(part, done.stdout)
        fine = {"Cell size": "1 mm", "Material": "steel"}
        particles = {"Nodal spacing": "1 mm", "Discretization": "SPG",
                     "Material": "steel"}
        refuse({"block": dict(fine, Size="5, 5, 5")},
               "Bodies/block/Cell size", "1.25e+11 cells", "5000 x 5000 x 5000")
        refuse({"block": dict(fine, Size="1000, 1000, 1000",
                              **{"Cell size": "1 um"})}, "1e+27 cells")
        refuse({"block": dict(fine, Size="5, 5, 5", Discretization="rigid")},
               "Bodies/block/Cell size", "cells")
        refuse({"block": dict(particles, Size="5, 5, 5")},
               "Bodies/block/Nodal spacing", "1.25e+11 particles")
        refuse({"ball": dict(fine, Geometry="sphere", Radius="5")},
               "Bodies/ball/Cell size", "cells")
        refuse({"rod": dict(fine, Geometry="cylinder", Radius="3", Length="10")},
               "Bodies/rod/Cell size", "cells")
        refuse({"rod": dict(fine, Geometry="projectile", Radius="3",
                            Length="10", **{"Nose length": "6"})}, "cells")
        refuse({"rod": dict(particles, Geometry="sphere", Radius="5")},
               "Bodies/rod/Nodal spacing", "cells")
        # Grown cells count as they are; a zone has to be inside.
        refined = {"Refined zone size": "10 mm, 10 mm, 10 mm"}
        refuse({"plate": dict(fine, Size="5, 5, 5", **refined,
                              **{"Growth ratio": "1.001"})}, "cells")
        self.assertWarns(scene({"plate": dict(
            fine, Size="200 mm, 200 mm, 10 mm", **refined,
            **{"Growth ratio": "1.5"})}))
        self.assertRefused(scene({"plate": dict(
            fine, Size="20 mm, 20 mm, 10 mm", **refined,
            **{"Refined zone center": "500 mm, 0 mm, 0 mm"})}),
            "reaches outside the body", "from 495 to 505 mm")

    def test_layers_of_slivers(self):
        plate = {"Size": "20 mm, 20 mm, 10 mm", "Cell size": "1 mm",
                 "Material": "steel"}

        def with_zone(size):
            return scene({"plate": dict(plate, **{"Refined zone size": size})})
        self.assertWarns(with_zone("10 mm, 10 mm, 9.9 mm"),
                         "the worst 0.05 mm beside 0.99 mm")
        self.assertWarns(with_zone("10 mm, 10 mm, 10 mm"))
        # Thin, but all of it is.
        self.assertWarns(scene({"plate": dict(plate,
                                              Size="20 mm, 20 mm, 0.1 mm")}),
                         "more than the body is across")
        self.assertWarns(scene({"plate": dict(
            plate, Size="20 mm, 20 mm, 0.1 mm", Discretization="rigid")}))

    def test_values_of_materials_with_a_lost_unit(self):
        cook = {"Model": "Johnson-Cook", "Density": "7830 kg/m^3",
                "Young's modulus": "206 GPa"}
        flow = {"Initial yield stress": "806 MPa",
                "Hardening modulus": "614 MPa", "Melt temperature": "1793 K",
                "Specific heat": "460 J/kg/K"}

        def material(elastic=None, law=None, model="Johnson-Cook"):
            return scene({"block": dict(BLOCK, Material="metal")}, materials={
                "metal": dict({**cook, **(elastic or {}), "Model": model},
                              **{model: {**flow, **(law or {})}})})
        self.assertWarns(material())
        path = "Materials/metal/Johnson-Cook/"
        celsius = {"Room temperature": "20", "Melt temperature": "1540"}
        self.assertWarns(
            material(law=celsius),
            path + "Melt temperature: 1540 is the melting point of carbon",
            path + "Room temperature: 20 is read as kelvin; 20 degrees Celsius")
        for law, expected in (
                ({"Melt temperature": "650"}, "far too low"),
                ({"Initial yield stress": "806", "Hardening modulus": "0"},
                 "Initial yield stress: it first yields at 806 Pa"),
                ({"Initial yield stress": "90 GPa"}, "is a unit wrong?"),
                ({"Hardening modulus": "614"}, "Hardening modulus: 614 is next"),
                ({"Initial temperature": "25"}, "25 is read as kelvin"),
                ({"Initial temperature": "1800 K"}, "no strength at all"),
                ({"Specific heat": "4.6"}, "Specific heat: 4.6 is far from")):
            self.assertWarns(material(law=law), expected)
        # Tonnes per cubic millimeter and megapascals look like a solid's speed
        # of sound, too.
        self.assertWarns(material({"Density": "7.83e-6",
                                   "Young's modulus": "206"},
                                  {"Initial yield stress": "0.806",
                                   "Hardening modulus": "0"}),
                         "is that of a gas", "is softer than a gel")
        self.assertWarns(material({"Density": "2700 kg/m^3",
                                   "Young's modulus": "70 GPa"},
                                  {"Melt temperature": "650 K"}),
                         "the melting point of aluminum")
        # Hot and cold metals, and soft ones, are none of this.
        for law in ({"Initial temperature": "77 K"},
                    {"Initial temperature": "1200 K"},
                    {"Melt temperature": "1500 K"},
                    {"Initial yield stress": "30 MPa"}):
            self.assertWarns(material(law=law))

    def test_end_times_without_a_unit(self):
        block = {"block": BLOCK}
        self.assertWarns(scene(block, end_time="30"), "is a unit missing")
        self.assertWarns(scene(block, end_time="30 ms"))

    def test_text_as_editors_save_it(self):
        text = scene({"block": BLOCK}, title="Prüfkörper")
        self.assertWarns(text)
        done = sabot("check", write("bom.prm", b"\xef\xbb\xbf" + text.encode()))
        self.assertEqual(done.returncode, 0, done.stdout)
        for end in ("\r\n", "\r"):
            self.assertWarns(text.replace("\n", end))
        self.assertWarns(text.replace("End time = ", "End time = \u00a0"))
        self.assertWarns(text.replace("30 us", "30 µs")
                         .replace("kg/m^3", "kg/m³"))
        self.assertWarns(text.replace("Young's", "Young’s"))
        self.assertRefused(text.encode("latin-1"), "scene.prm:1:", "0xfc",
                           "save the file as UTF-8")
        self.assertRefused(text.encode("utf-16"), "UTF-16")
        # In a comment it does no harm.
        self.assertWarns(text.encode().replace(
            b"set Title = Pr\xc3\xbcfk\xc3\xb6rper", b"# Pr\xfcfk\xf6rper"))
        self.assertRefused(("set Title = a\n" * 2) + text, "was already set")

    def test_includes(self):
        # Itself, by another way of writing it, and in a circle.
        self.assertRefused("include ./scene.prm\n", "includes itself",
                           "scene.prm:1:")
        write("other.prm", "include %s/scene.prm\n" % WORK)
        self.assertRefused("include other.prm\n", "includes itself")
        # The same file in two branches of a family, and in two sections.
        write("steel.prm", section("Materials", {"steel": STEEL}))
        write("cells.prm", "set Cell size = 0.5 mm\nset Material = steel\n")
        write("family.prm", "include steel.prm\n")
        text = """include family.prm
include ./steel.prm
set End time = 1 us
set List of bodies = one, two
subsection Bodies
  subsection one
    include cells.prm
  end
  subsection two
    include cells.prm
    set Center = 0 mm, 0 mm, 9 mm
  end
end
"""
        self.assertWarns(text)

    def test_names_that_would_meet_in_the_results(self):
        far = dict(BLOCK, Center="0 mm, 0 mm, 9 mm")
        self.assertRefused(scene({"rod 1": BLOCK, "rod-1": far}),
                           "\"rod 1\" and \"rod-1\"", "rename one")
        self.assertWarns(scene({"rod 1": BLOCK, "rod 2": far}))
        self.assertRefused(scene({"ledger": BLOCK}), "\"ledger\"")
        text = scene({"plate": PLATE, "rod": ROD}, IMPACT)
        self.assertRefused(text.replace("bodies = plate", "bodies = plate, plate"),
                           "names \"plate\" twice")
        self.assertRefused(text.replace("couplings = impact",
                                        "couplings = impact, impact"),
                           "names \"impact\" twice")

    def test_measured_values_have_the_unit_of_their_quantity(self):
        text = scene({"block": dict(BLOCK, **{
            "Initial velocity": "0 m/s, 0 m/s, 10 m/s"})},
            end_time="1 us", list_of_quantities="speed")
        text += section("Quantities", {"speed": {"Type": "velocity",
                                                 "Body": "block"}})
        write("scene.prm", text)

        def study(value, **more):
            return sabot("study", write("study.prm", (
                "set Scene = scene.prm\n" + section("Parameters", {"cells": {
                    "Entries": "Bodies/block/Cell size", "Role": "spacing",
                    "Values": more.get("values", "2 mm")}}) +
                section("Quantities", {"speed": {"Measured value": value}}))),
                "--list")
        for value in ("10 m/s", "10", "0.01 km/s"):
            done = study(value)
            self.assertEqual(done.returncode, 0, done.stdout)
        for value in ("10 mm", "10 kg"):
            done = study(value)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn("Quantities/speed/Measured value: is " + value,
                          done.stdout)
            self.assertIn("in m/s", done.stdout)
        done = study("10 m/s", values="2 kg")
        self.assertEqual(done.returncode, 1, done.stdout)

    def test_plan_and_run_say_what_check_says(self):
        text = scene({"plate": PLATE, "rod": ROD}, end_time="0.5 us")
        path, out = write("scene.prm", text), os.path.join(WORK, "said")
        shutil.rmtree(out, ignore_errors=True)
        said = self.warnings(text)
        self.assertEqual(len(said), 1)
        plan = os.path.join(WORK, "plan.json")
        done = sabot("plan", path, "--json", plan)
        self.assertIn(said[0], done.stdout)
        self.assertEqual(done.stdout.count("warning: "), 1, done.stdout)
        with open(plan) as file:
            self.assertEqual(["warning: " + w for w in
                              json.load(file)["warnings"]], said)
        done = sabot("run", path, "-o", out)
        self.assertIn(said[0], done.stdout)
        with open(os.path.join(out, "result.json")) as file:
            self.assertEqual(["warning: " + w for w in
                              json.load(file)["warnings"]], said)

    def test_a_study_is_no_scene_and_a_scene_no_study(self):
        for command, file, entry, other in (
                ("run", "prm/studies/zone.prm", "zone.prm:4: Scene", "study"),
                ("check", "prm/studies/zone.prm", "zone.prm:4: Scene", "study"),
                ("plan", "prm/studies/zone.prm", "zone.prm:4: Scene", "study"),
                ("study", "prm/perforation/quick.prm", "List of bodies", "run")):
            done = sabot(command, os.path.join(SOURCE, file),
                         *(() if command in ("check", "plan")
                           else ("-o", os.path.join(WORK, "none"))))
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(len(done.stdout.splitlines()), 1, done.stdout)
            self.assertIn(entry, done.stdout)
            self.assertIn('by "sabot %s"' % other, done.stdout)
            self.assertFalse(os.path.exists(os.path.join(WORK, "none")))

    def test_a_nose_is_what_it_is_called(self):
        def nose(kind, length):
            return scene({"rod": {
                "Geometry": "projectile", "Radius": "2 mm", "Length": "6 mm",
                "Nose": kind, "Nose length": length, "Cell size": "1 mm",
                "Material": "steel"}})
        for kind, length in (("spherical", "2 mm"), ("spherical", "1 mm"),
                             ("ogive", "2 mm"), ("conical", "1 mm")):
            self.assertWarns(nose(kind, length))
        self.assertIn("10 times the radius", " ".join(
            self.warnings(nose("ogive", "20 mm"))))
        self.assertRefused(nose("spherical", "2.1 mm"), "Bodies/rod/Nose length",
                           "at most as long as the radius")
        self.assertRefused(nose("ogive", "1.9 mm"), "Bodies/rod/Nose length",
                           "at least as long as its radius")

    def test_entries_of_a_shape_that_do_not_act(self):
        def warns(change, *parts):
            self.assertWarns(scene({"block": {**BLOCK, **change}}), *parts)
        warns({"Rotation axis": "1, 0, 0"}, "no effect without")
        warns({"Rotation center": "0 mm, 0 mm, 1 mm"}, "no effect without")
        warns({"Rotation axis": "1, 0, 0", "Rotation angle": "30 deg"})
        warns({"Rotation center": "0 mm, 0 mm, 1 mm",
               "Yaw pitch roll": "30 deg, 0 deg, 0 deg"})
        warns({"Refined zone size": "0 mm, 0 mm, 0 mm"})
        fine = {"Refined zone size": "2 mm, 2 mm, 2 mm"}
        for grading in ({"Coarsest cell size": "4 mm"}, {"Growth ratio": "1.3"}):
            warns(grading, "this has none")
            warns({**grading, **fine})
        rod = {"Geometry": "cylinder", "Radius": "8 mm", "Length": "8 mm",
               "Material": "steel", "Coarsest cell size": "4 mm"}
        self.assertWarns(scene({"rod": rod}), "rings of cells grow")
        self.assertWarns(scene({"rod": {**rod, "Growth ratio": "1.2"}}))
        self.assertRefused(
            scene({"block": {**BLOCK, "Refined zone size": "2 mm, 0 mm, 2 mm"}}),
            "Bodies/block/Refined zone size", "all three")

    def test_advice_on_hourglass_energy_is_what_is_not_done_already(self):
        ball = {"Geometry": "sphere", "Radius": "2.5 mm", "Cell size": "1 mm",
                "Center": "0 mm, 0 mm, 2.8 mm", "Material": "steel",
                "Initial velocity": "0 m/s, 0 m/s, -20 m/s"}
        out = os.path.join(WORK, "hourglass")
        for control, advised in (("stiffness", False), ("viscous", True)):
            text = scene({"plate": dict(PLATE, Discretization="rigid",
                                        Motion="prescribed"),
                          "ball": {**ball, "Hourglass control": control}},
                         {"impact": {"Bodies": "plate, ball"}})
            shutil.rmtree(out, ignore_errors=True)
            done = sabot("run", write("scene.prm", text), "-o", out)
            self.assertEqual(done.returncode, 0, done.stdout)
            said = [line for line in done.stdout.splitlines()
                    if "hourglass energy of body" in line]
            self.assertEqual(len(said), 1, done.stdout)
            self.assertIn("warning: ", said[0])
            self.assertIn("\"Integration = B-bar\"", said[0])
            self.assertEqual("\"Hourglass control = stiffness\"" in said[0],
                             advised, said[0])

    def test_the_end_time_of_a_scene_that_sets_none_is_said(self):
        said = "\"End time\" is not set: the run ends after 0.0001 s"
        text = scene({"plate": PLATE})
        path = write("scene.prm", text.replace("set End time = 30 us\n", ""))
        out = os.path.join(WORK, "no-end")
        shutil.rmtree(out, ignore_errors=True)
        for command in (("check", path), ("plan", path),
                        ("run", path, "-o", out)):
            done = sabot(*command)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual(done.stdout.count(said), 1, done.stdout)
        self.assertNotIn(said, sabot("check", write("scene.prm", text)).stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
