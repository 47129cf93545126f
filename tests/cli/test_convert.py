# SPDX-License-Identifier: Apache-2.0
"""exitance convert: the program from outside."""
import json
import unittest

from program import BAD_INPUT, COULD_NOT_FINISH, WRONG_USE, ProgramTest, box


class Convert(ProgramTest):
    def test_every_format_keeps_area_and_flux(self):
        scene = self.write("box.geom", box())
        for ending in ("glb", "gltf", "obj", "mgf", "rad", "geom"):
            out = f"out.{ending}"
            done = self.succeed("convert", scene, out)
            self.assertEqual(done.stdout, "")
            facts = json.loads(self.succeed("info", out, "--json").stdout)
            self.assertAlmostEqual(facts["area"], 6.04, places=5)  # float in glTF and OBJ
            self.assertAlmostEqual(facts["flux"], 0.4, places=6)

    def test_what_is_lost_is_listed(self):
        scene = self.write("box.geom", box())
        lines = self.succeed("convert", scene, "out.rad").stderr.splitlines()
        self.assertIn("lost: emission without a unit is written as W/m²", lines)
        self.assertIn("lost: 1 materials that emit lose their reflectance", lines)

    def test_wrong_use_and_bad_input(self):
        scene = self.write("box.geom", box())
        self.refuse(WRONG_USE, "ends in .geom or .glb", "convert", scene, "out.xyz")
        self.refuse(WRONG_USE, "would replace the input", "convert", scene, scene)
        self.refuse(WRONG_USE, "out is required", "convert", scene)
        self.refuse(COULD_NOT_FINISH, "cannot write", "convert", scene, "none/out.glb")
        broken = self.write("broken.obj", "v 0 0 0\nf 1 2 3\n")
        self.refuse(BAD_INPUT, r"broken\.obj: cannot be read as OBJ: ", "convert", broken, "o.glb")


if __name__ == "__main__":
    unittest.main()
