# SPDX-License-Identifier: Apache-2.0
"""Sun, sky and named scenes, from a project to numbers and pictures."""
import math
import unittest

from program import BAD_INPUT, WRONG_USE, ProgramTest, extras

PROJECT = """quantity = "photometric"
[[material]]
name = "grey"
reflectance = 0
[[polygon]]
material = "grey"
corners = [[0, 0, 0], [0, 0, 4], [4, 0, 4], [4, 0, 0]]
[sky]
model = "uniform"
zenith_luminance = 1000
[sun]
altitude = 30
normal = 40000
[[scenes]]
name = "dull"
sun = 0
sky = 0.5
"""


class Daylight(ProgramTest):
    def setUp(self):
        super().setUp()
        self.solution = self.folder / "day.glb"
        self.succeed("solve", self.write("day.toml", PROJECT), "-o", self.solution)
        self.points = self.write("p.csv", "x,y,z,nx,ny,nz\n2,0,2,0,1,0\n")

    def probe(self, *more):
        done = self.succeed("probe", self.solution, "--points", self.points, "-o", "-", *more)
        return [float(x) for x in done.stdout.splitlines()[1].split(",")[6:]]

    def test_sun_and_sky_add_up(self):
        sky, sun = math.pi * 1000, 40000 * 0.5
        for method in ("interpolate", "gather"):
            values = self.probe("--groups", "--method", method)
            self.assertAlmostEqual(values[3], sky, delta=2e-3 * sky)
            self.assertAlmostEqual(values[6], sun, delta=2e-3 * sun)
            self.assertAlmostEqual(values[0], sky + sun, delta=2e-3 * sun)

    def test_a_scene_dims_them(self):
        dull = 0.5 * math.pi * 1000
        self.assertAlmostEqual(self.probe("--scene", "dull")[0], dull, delta=2e-3 * dull)
        self.succeed("render", self.solution, "-o", self.folder / "dull.png", "--scene", "dull",
                     "--size", "40x30")
        self.assertEqual(extras(self.solution)["scenes"],
                         [{"name": "dull", "factors": {"sky": 0.5, "sun": 0}}])

    def test_a_scene_that_is_not_there(self):
        self.refuse(WRONG_USE, "did you mean 'dull'", "probe", self.solution, "--points",
                    self.points, "-o", "-", "--scene", "dul")

    def test_a_wrong_model_is_refused_where_it_stands(self):
        wrong = self.write("wrong.toml", PROJECT.replace("uniform", "unifrom"))
        self.refuse(BAD_INPUT, r"wrong\.toml:9:9: model: found", "solve", wrong, "-o",
                    self.folder / "wrong.glb")


if __name__ == "__main__":
    unittest.main()
