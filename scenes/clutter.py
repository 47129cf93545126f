#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a room full of things: 100 boxes and 100 finely divided balls under six ceiling panels.

Metres; y up; the room is 8 x 3 x 8. --detail divides the balls; triangles grow with its square:

    --detail 10     37 kilotriangles
    --detail 34    450 kilotriangles

An MGF file is written (-o). The same numbers come out every time. Only the Python standard library
is used.
"""
import argparse
import math
import random

ROOM = (8.0, 3.0, 8.0)
# Chromaticity, reflectance.
PAINTS = {"wall": (0.340, 0.340, 0.73), "floor": (0.365, 0.355, 0.36),
          "wood": (0.420, 0.380, 0.40), "red": (0.510, 0.320, 0.24), "blue": (0.230, 0.240, 0.28),
          "white": (0.333, 0.335, 0.80)}
EXITANCE = 8700  # of the panels [lm/m2]


class Mgf:
    def __init__(self, out):
        self.out, self.points = out, 0
        for name, (x, y, reflectance) in PAINTS.items():
            out.write(f"m {name} =\n\tsides 1\n\tc\n\tcxy {x} {y}\n\trd {reflectance}\n")
        out.write(f"m panel =\n\tsides 1\n\tc\n\trd 0\n\ted {EXITANCE}\n")

    def body(self, name, paint, points, faces, normals=None):
        """`faces`: tuples of indices into `points`, counter-clockwise from outside."""
        self.out.write(f"o {name}\nm {paint}\n")
        for i, p in enumerate(points):
            self.out.write("v %d =\n\tp %.6f %.6f %.6f\n" % ((self.points + i,) + p))
            if normals:
                self.out.write("\tn %.6f %.6f %.6f\n" % normals[i])
        for face in faces:
            self.out.write("f " + " ".join(str(self.points + i) for i in face) + "\n")
        self.out.write("o\n")
        self.points += len(points)


def box(size, turn, at):
    c, s = math.cos(turn), math.sin(turn)
    points = []
    for y in (-1, 1):
        for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            u, v = x * size[0] / 2, z * size[2] / 2
            points.append((at[0] + c * u + s * v, at[1] + y * size[1] / 2, at[2] - s * u + c * v))
    faces = [(0, 1, 2, 3), (7, 6, 5, 4)]
    for i in range(4):
        j = (i + 1) % 4
        faces.append((i, i + 4, j + 4, j))
    return points, faces


def ball(radius, at, detail):
    """Triangles between `detail` rings of 2 `detail` corners."""
    normals = [(0.0, 1.0, 0.0)]
    around = 2 * detail
    for ring in range(1, detail):
        polar = math.pi * ring / detail
        for k in range(around):
            a = 2 * math.pi * k / around
            normals.append((math.sin(polar) * math.cos(a), math.cos(polar),
                            math.sin(polar) * math.sin(a)))
    normals.append((0.0, -1.0, 0.0))
    last = len(normals) - 1
    faces = []
    for k in range(around):
        n = (k + 1) % around
        faces.append((0, 1 + n, 1 + k))
        for ring in range(detail - 2):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            faces += [(a + k, a + n, b + k), (a + n, b + n, b + k)]
        faces.append((last, 1 + (detail - 2) * around + k, 1 + (detail - 2) * around + n))
    points = [tuple(at[i] + radius * n[i] for i in range(3)) for n in normals]
    return points, faces, normals


def write(room, detail):
    rng = random.Random(20)
    x, y, z = ROOM
    shell = [(0, 0, 0), (x, 0, 0), (x, 0, z), (0, 0, z), (0, y, 0), (x, y, 0), (x, y, z), (0, y, z)]
    room.body("floor", "floor", shell, [(3, 2, 1, 0)])
    room.body("walls", "wall", shell, [(4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                                      (3, 0, 4, 7)])
    for i in range(6):
        cx, cz = (1.6 + 2.4 * (i % 3), 2.2 + 3.6 * (i // 3))
        panel = [(cx - 0.3, y - 0.02, cz - 0.3), (cx + 0.3, y - 0.02, cz - 0.3),
                 (cx + 0.3, y - 0.02, cz + 0.3), (cx - 0.3, y - 0.02, cz + 0.3)]
        room.body(f"panel{i + 1}", "panel", panel, [(0, 1, 2, 3)])
    paints = sorted(set(PAINTS) - {"wall", "floor"})
    taken = []  # centre, radius of the ball around

    def place(radius):
        while True:
            at = tuple(rng.uniform(radius + 0.02, ROOM[i] - radius - 0.1) for i in range(3))
            if all(math.dist(at, c) > radius + r + 0.01 for c, r in taken):
                taken.append((at, radius))
                return at

    for i in range(100):
        size = tuple(rng.uniform(0.15, 0.6) for _ in range(3))
        at = place(0.5 * math.hypot(*size))
        room.body(f"box{i + 1}", rng.choice(paints), *box(size, rng.uniform(0, math.pi), at))
    for i in range(100):
        radius = rng.uniform(0.08, 0.25)
        room.body(f"ball{i + 1}", rng.choice(paints), *ball(radius, place(radius), detail))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--detail", type=int, default=10, help="rings of a ball (3 ... 200)")
    parser.add_argument("-o", "--output", default="clutter.mgf", help="the MGF file")
    options = parser.parse_args()
    if not 3 <= options.detail <= 200:
        parser.error("--detail: expected 3 ... 200")
    with open(options.output, "w", encoding="ascii") as out:
        write(Mgf(out), options.detail)


if __name__ == "__main__":
    main()
