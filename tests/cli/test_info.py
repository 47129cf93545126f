# SPDX-License-Identifier: Apache-2.0
"""exitance info: numbers that can be worked out by hand, and what becomes of bad files."""
import json
import unittest

from program import BAD_INPUT, WRONG_USE, ProgramTest, box

LAMP = """
quantity = "photometric"
[[luminaire]]
name = "panel"
shape = "rectangle"
position = [0, 2, 0]
aim = [0, -1, 0]
width = 0.5
height = 0.4
lumens = 3000
group = "office"
"""


class Info(ProgramTest):
    def facts(self, *arguments):
        return json.loads(self.succeed("info", *arguments, "--json").stdout)

    def test_a_box_in_words(self):
        text = self.succeed("info", self.write("box.geom", box())).stdout
        self.assertTrue(text.startswith("a box\n"))
        self.assertIn("AFIT geometry, without a unit of light", text)
        # Six walls of 1 m² and a lamp of 0.2 m × 0.2 m that emits 10 per m².
        self.assertIn("7 polygons, all quads, 2 surfaces, 6.04 m²", text)
        self.assertIn("1 × 1 × 1 m, from (0, 0, 0) to (1, 1, 1)", text)
        self.assertRegex(text, r"attribute 1 +reflectance 0\.5, 6 m², two-sided\n")
        self.assertRegex(text, r"attribute 2 +reflectance 0\.5, 0\.04 m², emits 10\n")
        self.assertIn("Light: 0.4 in all, from 1 light group", text)
        self.assertIn("No cameras.", text)
        self.assertIn("No problems found.", text)

    def test_the_same_as_json(self):
        facts = self.facts(self.write("box.geom", box()))
        self.assertEqual(facts["kind"], "scene")
        self.assertEqual(facts["polygons"], 7)
        self.assertAlmostEqual(facts["area"], 6.04, places=12)
        self.assertAlmostEqual(facts["flux"], 0.4, places=12)
        self.assertEqual(facts["bounds"], {"lower": [0, 0, 0], "upper": [1, 1, 1]})
        self.assertEqual([m["reflectance"] for m in facts["materials"]], [[0.5] * 3] * 2)
        self.assertEqual(facts["problems"], [])

    def test_light_has_a_unit_and_a_group(self):
        path = self.write("lamp.toml", LAMP)
        text = self.succeed("info", path).stdout
        self.assertIn("Light: 3000 lm in all", text)
        self.assertIn("office: 3000 lm from 0.2 m² of 1 surface", text)
        self.assertIn("emits 15000 lm/m²", text)  # 3000 / 0.2
        group, = self.facts(path)["groups"]
        self.assertEqual(group["name"], "office")
        self.assertAlmostEqual(group["flux"], 3000, places=9)

    def test_problems_are_told_with_their_place(self):
        scene = box(lamp=False).replace("color 0.5 0.5 0.5\n", "color 1 0.5 0.5\n", 1)
        scene = scene.replace("4 1 3 4 2", "4 1 3 4 4")  # a quad with a corner twice: a triangle
        path = self.write("bad.geom", scene)
        text = self.succeed("info", path).stdout
        self.assertIn("bad.geom:18:1: the reflectance 1 of 'attribute 1' is limited to 0.98", text)
        self.assertIn("nothing emits light: the scene stays dark", text)
        self.assertEqual(len(self.facts(path)["problems"]), 2)

    def test_an_mgf_and_what_it_does_against_the_rules(self):
        path = self.write("t.mgf", "m glass =\n c\n ts .9 0\n rs .1 0\nv a =\n p 0 0 0\nv b =\n"
                          " p 2 0 0\nv c =\n p 2 1 0\nf a b c\nstray line\n")
        text = self.succeed("info", path).stdout
        self.assertRegex(text, r"glass +reflectance 0, 1 m², two-sided, mirrors 0\.1, transmits 0\.9")
        self.assertRegex(text, r"  2\. .*t\.mgf:12: 'stray' is no entity of MGF")
        self.assertRegex(text, r"  1\. .*t\.mgf:1: mirror-like reflection")
        material, = self.facts(path)["materials"]
        for band in material["transmittance"]:
            self.assertAlmostEqual(band, 0.9, places=4)
        self.refuse(BAD_INPUT, r"t\.mgf:1: mirror-like .*--strict; 2 warnings", "info", path, "--strict")
        self.refuse(BAD_INPUT, r"--max-polygons raises", "info", self.write("s.mgf", "v a =\nsph a 1\n"),
                    "--max-polygons", "100")
        self.refuse(WRONG_USE, "--tolerance: '0' is not allowed", "info", path, "--tolerance", "0")
        done = self.succeed("solve", path, "-o", "t.glb")
        self.assertRegex(done.stderr, r"(?m)^warning 1: .*t\.mgf:1: .*\n^warning 2: .*t\.mgf:12: ")

    def test_a_solution_is_described_too(self):
        scene = self.write("box.geom", box())
        self.succeed("solve", scene, "-o", "box.glb", "--error", "0.3")
        text = self.succeed("info", "box.glb").stdout
        self.assertIn("a box\n", text)
        self.assertRegex(text, r"Mesh: \d+ vertices, \d+ triangles")
        self.assertIn("Energy: 0.4 emitted", text)
        facts = self.facts("box.glb")
        self.assertEqual(facts["kind"], "solution")
        self.assertAlmostEqual(facts["energy"]["emitted"], 0.4, places=6)

    def test_bad_files(self):
        good = box()
        for name, text, message in [
                ("empty.geom", "", r"empty\.geom:1:1: found the end of the file"),
                ("word.geom", good.replace("nopurge", "nopurg"),
                 r"word\.geom:2:5: found 'nopurg', .* did you mean 'nopurge'"),
                ("nan.geom", good.replace("0 0 0\n", "0 nan 0\n", 1), r"nan\.geom:4:3: found 'nan'"),
                ("rho.geom", good.replace("color 0.5", "color 1.5", 1), r"rho\.geom:23:7: .*'1\.5'"),
                ("huge.geom", good.replace("points 12", "points 99999999"), r"huge\.geom:16:\d+: "),
                ("cut.glb", b"glTF\2\0\0\0\xff\xff\xff\x7f", r"cut\.glb: found 12 bytes"),
                ("binary.toml", b"\0\1\2\3", r"binary\.toml:1:\d+: not TOML"),
                ("key.toml", LAMP.replace("lumens", "lumen"),
                 r"key\.toml:10:1: .* did you mean 'lumens'"),
                ("self.toml", '[[geometry]]\nfile = "self.toml"\n',
                 r"self\.toml:2:8: .* includes itself"),
                ("notes.txt", "hello", r"notes\.txt: not a scene that can be read"),
        ]:
            with self.subTest(name=name):
                self.refuse(BAD_INPUT, message, "info", self.write(name, text))
        self.refuse(BAD_INPUT, r"gone\.geom: there is no such file", "info", "gone.geom")
        self.refuse(WRONG_USE, "file is required", "info")


if __name__ == "__main__":
    unittest.main()
