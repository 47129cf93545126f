# SPDX-License-Identifier: Apache-2.0
"""exitance info: numbers that can be worked out by hand, and what becomes of bad files."""
import json
import math
import re
import unittest
from xml.etree import ElementTree

from program import BAD_INPUT, COULD_NOT_FINISH, ROOT, WRONG_USE, ProgramTest, box, change_extras

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

# 100 cd cos γ from one lamp of 400 lm and 10 W.
IES = """IESNA:LM-63-2002
[LUMINAIRE] A downlight
TILT=NONE
1 400 1 91 1 1 2 -0.2 -0.2 0
1 1 10
""" + " ".join(map(str, range(91))) + "\n0\n" + "\n".join(
    f"{100 * math.cos(math.radians(g)):.6f}" for g in range(91)) + "\n"


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

    def test_luminaires_are_counted_with_their_flux(self):
        self.write("lamp.ies", IES)
        path = self.write("room.toml", LAMP + """
[[luminaire]]
name = "row"
file = "lamp.ies"
position = [0, 3, 0]
columns = 3
spacing = [2, 0]
dimming = 0.5
group = "office"
""")
        text = self.succeed("info", path).stdout
        # 3 × half of the 100 π lm of 100 cd cos γ.
        self.assertIn("office: 3471 lm from 0.2 m² of 1 surface and 3 luminaires", text)
        group, = self.facts(path)["groups"]
        self.assertEqual(group["luminaires"], 3)

    def test_a_lamp_in_words(self):
        path = self.write("lamp.ies", IES)
        text = self.succeed("info", path).stdout
        for line in [
                "A downlight\n", "IES LM-63-2002, 1 C-plane × 91 angles γ from 0 to 90°",
                "Flux      314.2 lm, 100.0 % below the horizontal", "LOR       78.5 %",
                "Efficacy  31.42 lm/W", "Peak      100 cd at C0, γ 0°",
                "Beam      120.0° × 120.0°", "Field     168.5° × 168.5°",
                "Symmetry  rotational", "Opening   disc, 0.2 × 0.2 × 0 m"]:
            self.assertIn(line, text)
        facts = self.facts(path)
        self.assertEqual(facts["kind"], "lamp")
        self.assertAlmostEqual(facts["flux"], 100 * math.pi, delta=0.02)
        self.assertAlmostEqual(facts["output_ratio"], 0.31415 / 0.4, delta=1e-4)
        self.assertEqual(facts["problems"], [])

    def test_the_diagram_of_a_lamp(self):
        path = self.write("lamp.ies", IES)
        self.succeed("info", path, "-o", "lamp.svg")
        svg = ElementTree.parse(self.folder / "lamp.svg").getroot()
        space = "{http://www.w3.org/2000/svg}"
        self.assertEqual(svg.find(space + "title").text, "A downlight")
        texts = ["".join(t.itertext()) for t in svg.iter(space + "text")]
        for text in ["C180 – C0", "C270 – C90", "rings: cd/klm of the lamps", "0°", "90°", "250"]:
            self.assertIn(text, texts)
        self.assertNotIn("180°", texts, "the dark half is cut off")
        # 100 cd cos γ is a circle of 250 cd/klm, the outermost ring of radius 200, whose lowest
        # point is on it.
        curves = [p.get("d") for p in svg.iter(space + "path") if p.get("d").endswith("Z")]
        self.assertEqual(len(curves), 2)
        for curve in curves:
            points = [tuple(map(float, p.split())) for p in re.split("[ML]", curve[:-1]) if p]
            self.assertAlmostEqual(max(y for _, y in points), 200, delta=0.1)
            for x, y in points:
                self.assertAlmostEqual(x * x + (y - 100) ** 2, 100 ** 2, delta=30)
        absolute = self.write("absolute.ies", IES.replace("1 400 1", "1 -1 1"))
        self.succeed("info", absolute, "-o", "absolute.svg")
        self.assertIn("rings: cd<", (self.folder / "absolute.svg").read_text())

    def test_the_diagram_of_the_documents_is_what_the_program_draws(self):
        self.succeed("info", ROOT / "scenes/lamps/pendant.ldt", "-o", "pendant.svg")
        self.assertEqual((self.folder / "pendant.svg").read_text(),
                         (ROOT / "docs/images/pendant.svg").read_text())

    def test_diagrams_that_cannot_be(self):
        lamp = self.write("lamp.ies", IES)
        self.refuse(WRONG_USE, "written as .svg", "info", lamp, "-o", "lamp.png")
        self.refuse(WRONG_USE, "needs an .ies or .ldt file", "info",
                    self.write("box.geom", box()), "-o", "box.svg")
        self.refuse(COULD_NOT_FINISH, "cannot write", "info", lamp, "-o", "gone/lamp.svg")
        self.refuse(BAD_INPUT, r"lamp\.ies: a luminaire, not a scene", "solve", lamp, "-o", "o.glb")
        self.refuse(BAD_INPUT, r"bad\.ies:4:9: found 'many'", "info",
                    self.write("bad.ies", IES.replace("91 1 1", "many 1 1")))

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
        self.assertRegex(text, r"  1\. .*t\.mgf:12: 'stray' is no entity of MGF")
        self.assertRegex(text, r"(?m)^.*t\.mgf:1: mirror-like reflection")
        material, = self.facts(path)["materials"]
        for band in material["transmittance"]:
            self.assertAlmostEqual(band, 0.9, places=4)
        self.refuse(BAD_INPUT, r"t\.mgf:12: 'stray' .*--strict", "info", path, "--strict")
        self.refuse(BAD_INPUT, r"--max-polygons raises", "info", self.write("s.mgf", "v a =\nsph a 1\n"),
                    "--max-polygons", "100")
        self.refuse(WRONG_USE, "--tolerance: '0' is not allowed", "info", path, "--tolerance", "0")
        done = self.succeed("solve", path, "-o", "t.glb")
        self.assertRegex(done.stderr, r"(?m)^note: .*t\.mgf:1: .*\n^warning 1: .*t\.mgf:12: ")

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

    def test_no_light_is_less_than_none(self):
        scene = self.write("box.geom", box())
        self.succeed("solve", scene, "-o", "box.glb", "--error", "0.3")
        path, energy = self.folder / "box.glb", self.facts("box.glb")["energy"]
        for unshot, told in (-0.1, "escaped, 0 still unshot"), (0.1, "escaped, 0.1 still unshot"):
            change_extras(path, energy=energy | {"unshot": unshot, "unit": ""})
            self.assertIn(told, self.succeed("info", path).stdout)
            self.assertEqual(self.facts(path)["energy"]["unshot"], unshot)

    def test_what_is_outside_or_beyond_memory_is_called_so(self):
        gltf = self.write("out.gltf", json.dumps(
            {"asset": {"version": "2.0"},
             "buffers": [{"byteLength": 4, "uri": "../../../etc/hostname"}]}, indent=1))
        self.refuse(BAD_INPUT, r"out\.gltf:8:\d+: .*found '\.\./\.\./\.\./etc/hostname', expected a file "
                    "in the folder of the glTF", "info", gltf)
        ply = self.write("many.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\n"
                         "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                         "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n"
                         "3 0 1 2\n")
        done = self.run_program("info", ply)
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertRegex(done.stderr, r"many\.ply: cannot be read as PLY: ")
        self.assertNotIn("bad_alloc", done.stderr)

    def test_one_is_no_plural(self):
        one = self.write("one.toml", """[[material]]
name = "m"
reflectance = 0.5
[[polygon]]
material = "m"
corners = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]
""")
        self.assertIn("Geometry: 1 polygon, a quad, 1 surface, 1 m²",
                      self.succeed("info", one).stdout)
        self.succeed("solve", one, "-o", "one.glb")
        self.assertRegex(self.succeed("info", "one.glb").stdout,
                         r"Mesh: \d+ vertices, \d+ triangles, 1 material\n")

    def test_diffuse_transmission_is_called_so(self):
        mgf = self.write("td.mgf", "m veil =\n  c\n  td 0.3\n  rd 0.2\nv a =\n p 0 0 0\nv b =\n"
                         " p 1 0 0\nv c =\n p 0 1 0\nf a b c\n")
        text = self.succeed("info", mgf).stdout
        self.assertIn("transmits 0.3 diffusely (taken as absorbed)", text)
        self.assertNotIn("transmits 0.3,", text)

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
