# SPDX-License-Identifier: Apache-2.0
"""exitance convert: the program from outside."""
import base64
import json
import struct
import unittest
import zlib

from program import BAD_INPUT, COULD_NOT_FINISH, WRONG_USE, ProgramTest, box


def png_of(rows):
    """A PNG of 8-bit RGB rows."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    raw = b"".join(b"\0" + b"".join(bytes(p) for p in row) for row in rows)
    return (b"\x89PNG\r\n\x1a\n"
            + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


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
        self.assertIn("lost: 1 material that emits loses its reflectance", lines)

    def test_textures_are_lost(self):
        # A square of 1 m with a texture of two texels, one white and one black.
        png = base64.b64encode(
            png_of([[(255, 255, 255), (0, 0, 0)]])).decode()
        numbers = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
        numbers += struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
        texture = {"index": 0}
        scene = self.write("t.gltf", json.dumps({
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{
                "attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
            "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": texture,
                           "pbrMetallicRoughness": {"baseColorTexture": texture}}],
            "textures": [{"source": 0}],
            "images": [{"uri": "data:image/png;base64," + png}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                 "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                            {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
            "buffers": [{"byteLength": len(numbers), "uri": "data:application/octet-stream;base64,"
                         + base64.b64encode(numbers).decode()}]}))
        for ending in ("glb", "gltf", "obj", "mgf", "rad", "geom"):
            lines = self.succeed("convert", scene, f"out.{ending}").stderr.splitlines()
            for what in ("reflectance", "emission"):
                self.assertIn(f"lost: 1 material loses the texture of its {what} and keeps the mean",
                              lines, ending)

    def test_solutions_are_no_scenes(self):
        self.succeed("solve", self.write("box.geom", box()), "-o", "box.glb", "--error", "0.5")
        self.refuse(WRONG_USE, "is a solution already", "convert", "box.glb", "out.obj")
        self.assertFalse((self.folder / "out.obj").exists())

    def test_endings_in_upper_case(self):
        scene = self.write("BOX.GEOM", box())
        for ending in ("GLB", "GLTF", "OBJ", "MGF", "RAD"):
            self.succeed("convert", scene, f"OUT.{ending}")
            facts = json.loads(self.succeed("info", f"OUT.{ending}", "--json").stdout)
            self.assertAlmostEqual(facts["area"], 6.04, places=5)
        self.write("ROOM.TOML", '[[geometry]]\nfile = "BOX.GEOM"\n')
        self.assertIn("lighting project", self.succeed("info", "ROOM.TOML").stdout)
        self.write("T.VS3", "T two\nF 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0\nV 4 0 1 0\n"
                   "S 1 1 2 3 4 0 0 0.5 a\nEnd\n")
        self.assertIn("View3D", self.succeed("info", "T.VS3").stdout)

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
