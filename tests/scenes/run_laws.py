#!/usr/bin/env python3
"""What no scene may depend on: run_laws.py SABOT SOURCE_FOLDER WORK_FOLDER

Units of length and mass, the observer's place, speed and axes, the order of
bodies: pairs of runs whose numbers differ by what round-off becomes in a hundred
steps. A force that round-off chooses makes 1e-6 and more of it.
"""
import os
import sys
import unittest

from laws import View, bar_on_wall, bullet_on_zone
from program import WORK, folder, result, sabot

VIEWS = {
    "a thousand times as large": View(length=1e3),
    "a thousandth as large": View(length=1e-3),
    "a thousandth as dense and strong": View(mass=1e-3),
    "in flight": View(flight=(300., -200., 100.)),
    "far away": View(away=(10., -7., 3.)),
    "with other axes": View(axes=(1, 2, 0)),
    "in a mirror": View(signs=(-1, 1, 1)),
    "upside down": View(signs=(1, -1, -1)),
    "listed the other way round": View(is_reversed=True),
}


class Laws(unittest.TestCase):
    def numbers(self, view, scene):
        out = folder("laws")
        os.makedirs(WORK, exist_ok=True)
        prm = os.path.join(WORK, "laws.prm")
        with open(prm, "w") as file:
            file.write(scene)
        done = sabot("run", prm, "-o", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stdout)
        return view.numbers(result(out))

    def compare_views(self, scene_of):
        first = self.numbers(View(), scene_of(View()))
        for name, view in VIEWS.items():
            with self.subTest(name):
                seen = self.numbers(view, scene_of(view))
                self.assertEqual(set(seen), set(first))
                for key, (value, scale) in first.items():
                    self.assertAlmostEqual(seen[key][0] / scale, value / scale,
                                           delta=3e-8, msg=key)

    def test_a_bar_on_a_wall_is_the_same_to_all(self):
        self.compare_views(bar_on_wall)

    def test_particles_that_fail_are_the_same_to_all(self):
        self.compare_views(bullet_on_zone)

    def test_a_force_fades_at_a_rim(self):
        # Particles a tenth of a spacing beside the bullet are let go. Those
        # inside by a ten-millionth of that would be damped as if they were met;
        # as the bullet widens it keeps these, which is the rest.
        inside, outside = (
            self.numbers(View(), bullet_on_zone(View(), 0.06, aside))
            for aside in (0.1 - 1e-8, 0.1 + 1e-8))
        key = "bullet velocity 0"
        self.assertAlmostEqual(inside[key][0], outside[key][0], delta=5e-7)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
