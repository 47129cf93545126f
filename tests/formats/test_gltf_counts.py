# SPDX-License-Identifier: Apache-2.0
"""exitance info on real glTF files agrees with a count of our own: a reader of a few lines that knows
node matrices and triangles, no more."""
import json
import os
import struct
import subprocess
import unittest
from array import array
from math import sqrt
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("EXITANCE_PROGRAM", ROOT / "build/bin/exitance"))
SCENES = ROOT.parent / "shared/scenes/godot"
IDENTITY = [[float(i == j) for j in range(4)] for i in range(3)]


def times(a, b):
    """Of affine 3 x 4 matrices."""
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0)
             for j in range(4)] for i in range(3)]


def placing(node):
    if "matrix" in node:
        return [[node["matrix"][4 * j + i] for j in range(4)] for i in range(3)]
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    scale, move = node.get("scale", [1, 1, 1]), node.get("translation", [0, 0, 0])
    return [[turn[i][j] * scale[j] for j in range(3)] + [move[i]] for i in range(3)]


class Count:
    def __init__(self, path):
        data = path.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.gltf, self.bytes = json.loads(data[20:20 + size]), data[28 + size:]
        self.triangles, self.flat, self.area = 0, 0, 0.0
        for root in self.gltf["scenes"][self.gltf.get("scene", 0)]["nodes"]:
            self.visit(root, IDENTITY)

    def values(self, index, kind, count):
        accessor = self.gltf["accessors"][index]
        view = self.gltf["bufferViews"][accessor["bufferView"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        assert view.get("byteStride", 0) in (0, 4 * count)
        out = array(kind)
        out.frombytes(self.bytes[begin:begin + accessor["count"] * count * out.itemsize])
        return out

    def visit(self, index, above):
        node = self.gltf["nodes"][index]
        here = times(above, placing(node))
        if "mesh" in node:
            for primitive in self.gltf["meshes"][node["mesh"]]["primitives"]:
                assert primitive.get("mode", 4) == 4
                self.add(primitive, here)
        for child in node.get("children", []):
            self.visit(child, here)

    def add(self, primitive, here):
        flat = self.values(primitive["attributes"]["POSITION"], "f", 3)
        points = [[sum(here[i][k] * flat[3 * p + k] for k in range(3)) + here[i][3]
                   for i in range(3)] for p in range(len(flat) // 3)]
        kind = {5121: "B", 5123: "H", 5125: "I"}[
            self.gltf["accessors"][primitive["indices"]]["componentType"]]
        indices = self.values(primitive["indices"], kind, 1)
        for i in range(0, len(indices), 3):
            a, b, c = (points[indices[i + k]] for k in range(3))
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]]
            area = sqrt(sum(x * x for x in normal)) / 2
            longest = max(sum((p - q) ** 2 for p, q in zip(e, f))
                          for e, f in ((a, b), (b, c), (c, a)))
            self.area += area
            self.triangles += 1
            self.flat += area <= 1e-7 * longest


class Counts(unittest.TestCase):
    def test_triangles_and_area(self):
        for name in ("living_room.glb", "zdm2.glb"):
            with self.subTest(name):
                if not (SCENES / name).exists():
                    self.skipTest(f"../shared/scenes/godot/{name} is not there")
                out = subprocess.run([PROGRAM, "info", SCENES / name, "--json"],
                                     capture_output=True, text=True, check=True).stdout
                facts, count = json.loads(out), Count(SCENES / name)
                # Triangles without area are left out, and told.
                self.assertEqual(facts["polygons"], count.triangles - count.flat)
                self.assertAlmostEqual(facts["area"] / count.area, 1, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
