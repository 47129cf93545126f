# SPDX-License-Identifier: Apache-2.0
"""Sun, sky and named scenes, from a project to numbers and pictures."""
import json
import math
import re
import unittest

from program import BAD_INPUT, ROOT, WRONG_USE, ProgramTest, extras

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

    def test_a_grid_of_the_project(self):
        project = self.write("grid.toml", PROJECT + """[[grid]]
name = "floor"
origin = [1, 0, 1]
u = [0, 0, 2]
v = [2, 0, 0]
columns = 3
rows = 2
""")
        self.succeed("solve", project, "-o", "grid.glb")
        done = self.succeed("probe", "grid.glb", "--grid", "floor", "-o", "q.csv")
        lines = (self.folder / "q.csv").read_text().splitlines()
        self.assertEqual(lines[0], "x,y,z,nx,ny,nz,E_r,E_g,E_b")
        self.assertEqual(len(lines), 7)
        first, last = ([float(x) for x in lines[i].split(",")] for i in (1, 6))
        for found, expected in zip(first[:6], [1.5, 0, 1 + 1 / 3, 0, 1, 0]):
            self.assertAlmostEqual(found, expected, places=7)
        for found, expected in zip(last[:3], [2.5, 0, 1 + 5 / 3]):
            self.assertAlmostEqual(found, expected, places=7)
        light = math.pi * 1000 + 40000 * 0.5
        self.assertAlmostEqual(first[6], light, delta=2e-3 * light)
        said = re.match(r"grid floor: 6 points, min (\S+) lx, mean (\S+) lx, max (\S+) lx, "
                        r"uniformity (\S+) \(min / mean\)\n$", done.stderr)
        self.assertTrue(said, done.stderr)
        for value in said.groups()[:3]:
            self.assertAlmostEqual(float(value), light, delta=2e-3 * light)
        self.assertAlmostEqual(float(said[4]), 1, delta=0.01)
        # Points of a table give the same.
        self.write("points.csv", "\n".join(",".join(line.split(",")[:6]) for line in lines) + "\n")
        self.assertEqual(
            self.succeed("probe", "grid.glb", "--points", "points.csv", "-o", "-").stdout,
            (self.folder / "q.csv").read_text())
        self.refuse(WRONG_USE, "did you mean 'floor'", "probe", "grid.glb", "--grid", "flor")
        self.refuse(WRONG_USE, "the solution has none", "probe", self.solution, "--grid", "floor")
        self.refuse(WRONG_USE, "excludes", "probe", "grid.glb", "--grid", "floor", "--points",
                    "points.csv", "-o", "-")
        self.refuse(WRONG_USE, "--points or --grid", "probe", "grid.glb", "-o", "-")
        self.refuse(WRONG_USE, "--output is required", "probe", "grid.glb", "--points",
                    "points.csv")

    def test_info_tells_scenes_and_where_the_sun_stands(self):
        project = self.folder / "day.toml"
        for file in (project, self.solution):
            self.assertIn("Scene dull: sky 0.5, sun 0\n", self.succeed("info", file).stdout)
            facts = json.loads(self.succeed("info", file, "--json").stdout)
            self.assertEqual(facts["scenes"],
                             [{"name": "dull", "factors": {"sky": 0.5, "sun": 0}}])
        self.assertIn("(30.0° above the horizon, azimuth 180.0° from −z over +x)",
                      self.succeed("info", project).stdout)
        sun = json.loads(self.succeed("info", project, "--json").stdout)["distant"][1]
        self.assertAlmostEqual(sun["altitude"], 30)
        self.assertAlmostEqual(sun["azimuth"], 180)
        west = self.write("west.toml", PROJECT.replace("altitude = 30",
                                                       "altitude = 30\nazimuth = 270"))
        sun = json.loads(self.succeed("info", west, "--json").stdout)["distant"][1]
        self.assertAlmostEqual(sun["azimuth"], 270)

    def test_the_worked_example_of_a_living_room(self):
        scenes = ROOT / "scenes"
        if not (scenes / "../../shared/scenes/godot/living_room.glb").exists():
            self.skipTest("../shared/scenes/godot/living_room.glb is not there")
        self.succeed("solve", scenes / "living_room_daylight.toml", "-o", "room.glb", "--error",
                     "0.3")
        # Above the courtyard's walls nothing hides the sun: 91 355 lx from 44.5 degrees, by hand.
        above = self.write("above.csv", "x,y,z,nx,ny,nz\n0,3.95,10,0,1,0\n")
        done = self.succeed("probe", "room.glb", "--points", above, "-o", "-", "--groups",
                            "--method", "gather")
        values = [float(x) for x in done.stdout.splitlines()[1].split(",")[6:]]
        pendant, sky, sun = (sum(w * e for w, e in zip((0.2126, 0.7152, 0.0722), values[i:i + 3]))
                             for i in (3, 6, 9))
        self.assertEqual(pendant, 0)
        self.assertAlmostEqual(sun, 64038, delta=150)
        self.assertLess(sky, 13777 * 1.05)  # open ground, and a little from the ground around
        self.assertGreater(sky, 0.9 * 13777)

    def test_night_is_noted(self):
        night = self.write("night.toml", PROJECT.replace("altitude = 30", "altitude = -5"))
        self.assertIn("note: ", self.succeed("solve", night, "-o", "night.glb").stderr)
        self.assertIn("night.toml:11:1: the sun is 5.0° below the horizon: it is night",
                      self.succeed("info", night).stdout)
        self.assertNotIn("night", self.succeed("info", self.folder / "day.toml").stdout)

    def test_a_wrong_model_is_refused_where_it_stands(self):
        wrong = self.write("wrong.toml", PROJECT.replace("uniform", "unifrom"))
        self.refuse(BAD_INPUT, r"wrong\.toml:9:9: model: found", "solve", wrong, "-o",
                    self.folder / "wrong.glb")


if __name__ == "__main__":
    unittest.main()
