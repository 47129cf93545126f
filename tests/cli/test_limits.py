# SPDX-License-Identifier: Apache-2.0
"""Every limit on what is read: the error names it and its option, and the option raises it."""
import struct
import unittest

from program import BAD_INPUT, ROOT, ProgramTest

SQUARE = """m grey =
\trd 0.5
v a =
\tp 0 0 0
v b =
\tp 1 0 0
v c =
\tp 1 1 0
v d =
\tp 0 1 0
f a b c d
"""
RAD = "void plastic grey 0 0 5 .5 .5 .5 0 0\n!genbox grey box 1 1 1\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
LAMPS = """[[luminaire]]
name = "points"
shape = "point"
lumens = 100
position = [0, 0, 0]
columns = 4
rows = 5
spacing = [1, 1]
"""
GLOBE = """[[luminaire]]
name = "globe"
shape = "sphere"
radius = 1
lumens = 100
position = [0, 0, 0]
columns = 2
spacing = [3, 3]
"""
SKY = "[sky]\nmodel = \"map\"\nfile = \"sky.hdr\"\n"
# Two pixels of 1 W/(m² sr), one above the other twice.
HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + 4 * bytes([128, 128, 128, 129])


class Limits(ProgramTest):
    def check(self, path, option, least):
        """`least` is the smallest value with which `path` can be read."""
        smaller = least - 1 if isinstance(least, int) else 0.99 * least
        failed = self.run_program("info", path, f"--{option}", str(smaller))
        self.assertEqual(failed.returncode, BAD_INPUT, failed.stderr)
        self.assertIn(f"--{option} raises the limit", failed.stderr)
        self.assertEqual(failed.stdout, "")
        self.succeed("info", path, f"--{option}", str(least))

    def test_polygons(self):
        for name, text, polygons in [("a.mgf", SQUARE + SQUARE, 2), ("a.rad", RAD, 6),
                                     ("a.obj", OBJ, 2)]:
            self.check(self.write(name, text), "max-polygons", polygons)
        failed = self.run_program("info", self.write("a.toml", GLOBE), "--max-polygons", "10")
        self.assertEqual(failed.returncode, BAD_INPUT)
        self.assertIn("--max-polygons raises the limit", failed.stderr)

    def test_polygons_of_gltf(self):
        self.check(ROOT / "tests/fuzz/corpus/gltf/square.glb", "max-polygons", 2)

    def test_corners(self):
        self.check(self.write("a.mgf", SQUARE), "max-corners", 4)

    def test_lines(self):
        self.check(self.write("a.mgf", SQUARE), "max-lines", SQUARE.count("\n"))

    def test_files_and_their_depth(self):
        self.write("a.mgf", SQUARE)
        twice = self.write("b.mgf", "i a.mgf\ni a.mgf\n")
        self.check(twice, "max-files", 2)
        self.check(twice, "max-include-depth", 2)
        chain = self.write("c.toml", "[[geometry]]\nfile = \"b.mgf\"\n")
        self.check(chain, "max-include-depth", 2)

    def test_size_of_files(self):
        for name, text in [("a.mgf", SQUARE), ("a.rad", RAD), ("a.obj", OBJ), ("a.toml", LAMPS)]:
            self.check(self.write(name, text), "max-file-size", 1.0001 * len(text) / 2**20)

    def test_texture_pixels(self):
        self.check(ROOT / "tests/fuzz/corpus/gltf/textures.glb", "max-texture-pixels", 8)
        self.write("sky.hdr", HDR)
        self.check(self.write("day.toml", SKY), "max-texture-pixels", 4)

    def test_luminaires(self):
        self.check(self.write("a.toml", LAMPS), "max-luminaires", 20)

    def test_what_a_header_claims_is_not_set_aside(self):
        absurd = b"DRACO\2\2\1\0\0\0" + b"\xff\xff\xff\xff\7\3" + bytes(40)
        json = (b'{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],'
                b'"extensionsRequired":["KHR_draco_mesh_compression"],'
                b'"meshes":[{"primitives":[{"attributes":{"POSITION":0},"extensions":'
                b'{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}],'
                b'"accessors":[{"componentType":5126,"count":4,"type":"VEC3"}],'
                b'"bufferViews":[{"buffer":0,"byteLength":%d}],"buffers":[{"byteLength":%d}]}'
                % (len(absurd), len(absurd)))
        json += b" " * (-len(json) % 4)
        absurd += bytes(-len(absurd) % 4)
        chunks = (struct.pack("<I4s", len(json), b"JSON") + json +
                  struct.pack("<I4s", len(absurd), b"BIN\0") + absurd)
        path = self.write("a.glb", struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        failed = self.run_program("info", path)
        self.assertEqual(failed.returncode, BAD_INPUT, failed.stderr)
        self.assertIn("points and faces in", failed.stderr)


if __name__ == "__main__":
    unittest.main()
