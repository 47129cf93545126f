#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes an aircraft cabin: fuselage from inside, operator consoles with slanted panels and
screens, chairs, bins, a duct and overhead lights.

Metres; x along the fuselage, y up, z to the right; the floor is y = 0. --rows says how many rows
of two consoles there are, --detail how finely rounded parts are divided and how many keys a
console has. Polygons grow with rows and with the square of detail:

    --rows  5 --detail 1    2 104 polygons
    --rows 12 --detail 2   13 032 polygons
    --rows 20 --detail 3   41 344 polygons
    --rows 30 --detail 5  149 568 polygons
    --rows 55 --detail 7  503 356 polygons

Three files are written: the AFIT geometry (-o), beside it the display file, and a lighting project
with names, light groups, cameras and a grid. Every body is closed and faces the air; corners that
coincide are one point of the file. Where a body stands on another the hidden face is left out.
Only the Python standard library is used.
"""
import argparse
import math
import os

# name, reflectance, emitted exitance [lm/m2]
ATTRIBUTES = [
    ("lining", (0.68, 0.68, 0.66), None),
    ("floor", (0.22, 0.22, 0.24), None),
    ("console", (0.36, 0.40, 0.40), None),
    ("panel", (0.14, 0.15, 0.16), None),
    ("screen", (0.03, 0.04, 0.03), (12, 40, 22)),
    ("keys", (0.55, 0.55, 0.52), None),
    ("cushion", (0.10, 0.16, 0.28), None),
    ("frame", (0.45, 0.45, 0.46), None),
    ("bins", (0.74, 0.73, 0.70), None),
    ("duct", (0.52, 0.53, 0.55), None),
    ("light", (0.60, 0.60, 0.60), (11000, 10700, 9800)),
]
INDEX = {name: i + 1 for i, (name, _, _) in enumerate(ATTRIBUTES)}

PITCH = 1.3                   # metres of fuselage per row
RADIUS, CENTRE = 1.75, 0.85   # of the fuselage's circle; its floor chord is y = 0


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Cabin:
    """Points, each once, and polygons."""

    def __init__(self):
        self.points, self.index, self.polygons = [], {}, []

    def point(self, p):
        text = "%.10g %.10g %.10g" % tuple(round(c, 8) + 0.0 for c in p)
        if text not in self.index:
            self.points.append(text)
            self.index[text] = len(self.points)
        return self.index[text]

    def polygon(self, attribute, corners):
        ids = [self.point(c) for c in corners]
        longest = [0.0, 0.0]
        for i in range(len(corners)):
            edge = subtract(corners[i], corners[i - 1])
            longest[i % 2] = max(longest[i % 2], math.sqrt(dot(edge, edge)))
        patches = math.ceil(longest[0] / 0.35) * math.ceil(longest[1] / 0.35)
        self.polygons.append((ids, INDEX[attribute], patches))

    def body(self, faces, inwards=False):
        """Adds a closed body, turned so that it faces outwards (inwards: a room). `faces` are
        (attribute, corners); attribute None closes the body but is hidden and left out."""
        volume = 0.0
        for _, corners in faces:
            for i in range(1, len(corners) - 1):
                volume += dot(corners[0], cross(corners[i], corners[i + 1]))
        turned = (volume < 0) != inwards
        for attribute, corners in faces:
            if attribute:
                self.polygon(attribute, corners[::-1] if turned else corners)


def cap(ring):
    """A convex ring of an even number of points as quads across it."""
    n = len(ring)
    return [[ring[i], ring[i + 1], ring[n - 2 - i], ring[n - 1 - i]] for i in range(n // 2 - 1)]


def extrude(attribute, rings, caps=(True, True), cap_faces=cap):
    """The faces between consecutive rings of points, and of both ends (hidden where False)."""
    faces = []
    names = attribute if isinstance(attribute, list) else [attribute] * len(rings[0])
    end = names[1]
    for a, b in zip(rings, rings[1:]):
        for i in range(len(a)):
            j = (i + 1) % len(a)
            faces.append((names[i], [a[i], a[j], b[j], b[i]]))
    faces += [(end if caps[0] else None, c[::-1]) for c in cap_faces(rings[0])]
    faces += [(end if caps[1] else None, c) for c in cap_faces(rings[-1])]
    return faces


def steps(low, high, count):
    return [low + (high - low) * i / count for i in range(count + 1)]


def rounded(a0, b0, a1, b1, radius, detail):
    """A rectangle with corners rounded in detail - 1 steps (detail 1: not at all)."""
    if detail == 1:
        return [(a0, b0), (a1, b0), (a1, b1), (a0, b1)]
    ring = []
    for quarter, (a, b) in enumerate([(a1, b0), (a1, b1), (a0, b1), (a0, b0)]):
        ca = a - radius if a == a1 else a + radius
        cb = b - radius if b == b1 else b + radius
        for i in range(detail):
            angle = math.pi / 2 * (quarter - 1 + i / (detail - 1))
            ring.append((ca + radius * math.cos(angle), cb + radius * math.sin(angle)))
    return ring


def prism_along_x(cabin, attribute, profile, x0, x1, divisions):
    """Extrudes a profile of (z, y) points."""
    rings = [[(x, y, z) for z, y in profile] for x in steps(x0, x1, divisions)]
    cabin.body(extrude(attribute, rings))


def block_on(cabin, attribute, origin, u, v, n, low, high, height, top=None):
    """A block on the plane origin + a u + b v, from (a, b) = low to high; no face underneath."""
    def at(a, b, c):
        return tuple(origin[k] + a * u[k] + b * v[k] + c * n[k] for k in range(3))
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    rings = [[at(a, b, c) for a, b in corners] for c in (0.0, height)]
    faces = extrude(attribute, rings, (False, True))
    if top:
        faces[-1] = (top, faces[-1][1])
    cabin.body(faces)


def fuselage(cabin, rows, detail):
    """The lining, the floor and two bulkheads: one closed body, seen from inside."""
    length = rows * PITCH + 0.7
    along = steps(0.0, length, max(2, 2 * detail * rows))
    half = math.pi - math.acos(CENTRE / RADIUS)   # from the top down to the floor
    count = 12 * detail + 1                       # odd: one segment lies across the top
    ring = [(RADIUS * math.sin(t), CENTRE + RADIUS * math.cos(t)) for t in steps(-half, half, count)]
    floor_half = ring[-1][0]
    ring[0], ring[-1] = (-floor_half, 0.0), (floor_half, 0.0)
    columns = 4 * detail
    across = steps(0.0, 1.0, columns)

    faces = []
    for x0, x1 in zip(along, along[1:]):
        for (z0, y0), (z1, y1) in zip(ring, ring[1:]):
            faces.append(("lining", [(x0, y0, z0), (x0, y1, z1), (x1, y1, z1), (x1, y0, z0)]))
        for s, t in zip(across, across[1:]):
            z0, z1 = floor_half * (2 * s - 1), floor_half * (2 * t - 1)
            faces.append(("floor", [(x0, 0.0, z1), (x0, 0.0, z0), (x1, 0.0, z0), (x1, 0.0, z1)]))

    def between(x, i, s):  # on the chord between the left and right ring points of one height
        (zl, yl), (zr, _) = ring[i], ring[count - i]
        return (x, yl, zl + (zr - zl) * s)

    # Chords of different width are divided alike, so the last strip narrows into the top segment.
    last = (count - 1) // 2
    for x, forward in ((0.0, True), (length, False)):
        bulkhead = []
        for i in range(last - 1):
            for s, t in zip(across, across[1:]):
                bulkhead.append([between(x, i, s), between(x, i, t),
                                 between(x, i + 1, t), between(x, i + 1, s)])
        left, right = (x, ring[last][1], ring[last][0]), (x, ring[last + 1][1], ring[last + 1][0])
        low = [between(x, last - 1, s) for s in across]
        middle = columns // 2
        bulkhead += [[low[k], low[k + 1], left] for k in range(middle)]
        bulkhead += [[low[k], low[k + 1], right] for k in range(middle, columns)]
        bulkhead.append([low[middle], right, left])
        faces += [("lining", corners if forward else corners[::-1]) for corners in bulkhead]
    cabin.body(faces, inwards=True)
    return length


def console(cabin, x, side, detail):
    """An operator console against the wall on `side` (+1 right, -1 left), 1.1 m wide."""
    profile = [(1.00, 0.0), (1.00, 0.66), (0.72, 0.66), (0.72, 0.70), (1.02, 0.72), (1.18, 1.15),
               (1.42, 1.18), (1.42, 0.0)]

    def ends(r):  # the profile is not convex: three quads that are
        return [[r[0], r[1], r[4], r[7]], [r[1], r[2], r[3], r[4]], [r[4], r[5], r[6], r[7]]]

    x0, x1 = x - 0.55, x + 0.55
    names = ["console", "console", "console", "console", "panel", "console", "console", None]
    rings = [[(s, y, side * z) for z, y in profile] for s in steps(x0, x1, detail)]
    cabin.body(extrude(names, rings, cap_faces=ends))

    def plane(a, b):  # the frame of the plane between two profile points
        (za, ya), (zb, yb) = a, b
        size = math.hypot(zb - za, yb - ya)
        v = (0.0, (yb - ya) / size, side * (zb - za) / size)
        return (x, ya, side * za), (1.0, 0.0, 0.0), v, (0.0, v[2] * side, -v[1] * side), size

    origin, u, v, n, size = plane(profile[4], profile[5])
    for a in (-0.27, 0.27):
        block_on(cabin, "frame", origin, u, v, n, (a - 0.22, 0.14), (a + 0.22, size - 0.02), 0.02,
                 top="screen")
    buttons = 5 + 3 * detail
    for i in range(buttons):
        a = -0.48 + 0.96 * (i + 0.5) / buttons
        for row in range(detail):
            b = 0.02 + 0.10 * (row + 0.5) / detail
            w, h = 0.3 / buttons, 0.03 / detail
            block_on(cabin, "keys", origin, u, v, n, (a - w, b - h), (a + w, b + h), 0.008)
    origin, u, v, n, size = plane(profile[3], profile[4])
    columns, lines = 4 * detail, 1 + detail
    for i in range(columns):
        for j in range(lines):
            a, b = -0.22 + 0.44 * (i + 0.5) / columns, 0.06 + 0.16 * (j + 0.5) / lines
            w, h = 0.18 / columns, 0.065 / lines
            block_on(cabin, "keys", origin, u, v, n, (a - w, b - h), (a + w, b + h), 0.01)


def chair(cabin, x, side, detail):
    """A chair that faces the console on `side`; its post stands on the floor."""
    z = side * 0.42
    n = 4 * detail

    def circle(y, radius):
        return [(x + radius * math.cos(2 * math.pi * (i + 0.5) / n), y,
                 z + radius * math.sin(2 * math.pi * (i + 0.5) / n)) for i in range(n)]

    foot = [circle(0.0, 0.22), circle(0.06, 0.05), circle(0.40, 0.04)]
    cabin.body(extrude("frame", foot, (False, False)))

    def cushion(attribute, across, low, high, depth, height, caps=(True, True)):
        """Extruded along x: x offset `across`, (depth away from the console, height) ranges."""
        profile = rounded(depth[0], height[0], depth[1], height[1],
                          0.4 * min(depth[1] - depth[0], height[1] - height[0]), detail)
        rings = [[(x + a, h, z - side * d) for d, h in profile]
                 for a in steps(across + low, across + high, detail)]
        cabin.body(extrude(attribute, rings, caps))

    def link(across, half, depth, height, along_depth):
        """A bar between two parts that it touches, so without ends."""
        (d0, d1), (h0, h1) = depth, height
        if along_depth:
            rings = [[(x + across + a, h, z - side * d)
                      for a, h in ((-half, h0), (half, h0), (half, h1), (-half, h1))]
                     for d in (d0, d1)]
        else:
            rings = [[(x + across + a, h, z - side * d)
                      for a, d in ((-half, d0), (half, d0), (half, d1), (-half, d1))]
                     for h in (h0, h1)]
        cabin.body(extrude("frame", rings, (False, False)))

    cushion("cushion", 0.0, -0.24, 0.24, (-0.23, 0.20), (0.40, 0.50))
    cushion("cushion", 0.0, -0.23, 0.23, (0.21, 0.29), (0.40, 1.10))
    cushion("cushion", 0.0, -0.14, 0.14, (0.22, 0.28), (1.12, 1.26))
    link(0.0, 0.12, (0.20, 0.21), (0.443, 0.457), True)
    for s in (-0.21, 0.21):
        cushion("frame", s, -0.03, 0.03, (-0.16, 0.16), (0.63, 0.67))
        link(s, 0.015, (-0.02, 0.02), (0.50, 0.63), False)
    for s in (-0.10, 0.10):
        link(s, 0.01, (0.245, 0.255), (1.10, 1.12), False)


def overhead(cabin, rows, length, detail):
    """Bins and duct along the whole cabin, two lights to each row."""
    divisions = 2 * detail * rows
    for side in (-1, 1):
        profile = [(0.92, 1.95), (0.98, 1.74), (1.40, 1.70), (1.42, 1.78), (1.12, 2.12),
                   (1.00, 2.14)]
        prism_along_x(cabin, "bins", [(side * z, y) for z, y in profile], 0.02, length - 0.02,
                      divisions)
    n = 8 * detail
    duct = [(0.13 * math.cos(2 * math.pi * (i + 0.5) / n),
             2.36 + 0.13 * math.sin(2 * math.pi * (i + 0.5) / n)) for i in range(n)]
    prism_along_x(cabin, "duct", duct, 0.02, length - 0.02, divisions)
    for row in range(rows):
        x = 0.35 + PITCH * (row + 0.5)
        for z in (-0.55, 0.55):
            profile = [(z - 0.13, 2.36), (z + 0.13, 2.36), (z + 0.13, 2.40), (z - 0.13, 2.40)]
            rings = [[(s, y, t) for t, y in profile] for s in (x - 0.4, x + 0.4)]
            cabin.body(extrude(["light", "frame", "frame", "frame"], rings))


def build(rows, detail):
    cabin = Cabin()
    length = fuselage(cabin, rows, detail)
    for row in range(rows):
        x = 0.35 + PITCH * (row + 0.5)
        for side in (-1, 1):
            console(cabin, x, side, detail)
            chair(cabin, x, side, detail)
    overhead(cabin, rows, length, detail)
    return cabin, length


def write_geometry(cabin, path, rows, detail):
    with open(path, "w", encoding="utf-8") as out:
        out.write(f"Aircraft cabin, {rows} rows, detail {detail}; metres, lm/m2\n")
        out.write("ccw purge\n")
        out.write(f"points {len(cabin.points)} patches {len(cabin.polygons)} "
                  f"attributes {len(ATTRIBUTES)}\n")
        out.writelines(point + "\n" for point in cabin.points)
        for ids, attribute, patches in cabin.polygons:
            out.write(f"{len(ids)} {' '.join(map(str, ids))} attribute {attribute} "
                      f"patch {patches}\n")
        for _, colour, emission in ATTRIBUTES:
            out.write("color %g %g %g" % colour)
            out.write(" emit %g %g %g\n" % emission if emission else "\n")


def write_display(path, length):
    with open(path, "w", encoding="utf-8") as out:
        out.write("Down the aisle\n"
                  f"eye 0.3 1.65 0 lookat {length:.6g} 1.15 0\n"
                  "up 0 1 0\nfovx 80 fovy 64.37\nnear 0.05 far 200\nxres 800 yres 600\n"
                  "diameter 1\nambient 1\nthreshold 1\n")


def write_project(path, geometry, rows, length):
    middle = 0.35 + PITCH * (rows // 2 + 0.5)
    with open(path, "w", encoding="utf-8") as out:
        out.write(f'title = "Aircraft cabin, {rows} rows"\nquantity = "photometric"\n\n'
                  f'[[geometry]]\nfile = "{geometry}"\nunit = "m"\nup = "y"\n')
        for i, (name, _, emission) in enumerate(ATTRIBUTES):
            if emission:
                out.write(f'\n[[material]]\nmatch = "attribute {i + 1}"\n'
                          f'group = "{"overhead" if name == "light" else "screens"}"\n')
        for name, eye, at, fov in (
                ("aisle", (0.3, 1.65, 0), (length, 1.15, 0), 64),
                ("operator", (middle, 1.28, 0.36), (middle, 0.9, 1.2), 70),
                ("across", (middle - 1.3, 1.75, -0.55), (middle + 0.5, 0.85, 1.0), 65)):
            out.write(f'\n[[camera]]\nname = "{name}"\n'
                      f'eye = [{eye[0]:.6g}, {eye[1]:.6g}, {eye[2]:.6g}]\n'
                      f'look_at = [{at[0]:.6g}, {at[1]:.6g}, {at[2]:.6g}]\n'
                      f'up = [0, 1, 0]\nfov = {fov}\n')
        out.write(f'\n[[grid]]\nname = "aisle"\norigin = [0.35, 0.002, -0.12]\n'
                  f'u = [{PITCH * rows:.6g}, 0, 0]\nv = [0, 0, 0.24]\ncolumns = {8 * rows}\n'
                  'rows = 2\nnormal = [0, 1, 0]\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, default=4, help="rows of two consoles (1 to 200)")
    parser.add_argument("--detail", type=int, default=1, help="1 (boxes) to 12")
    parser.add_argument("-o", "--output", default="cabin.geom", help="geometry file to write")
    arguments = parser.parse_args()
    if not 1 <= arguments.rows <= 200 or not 1 <= arguments.detail <= 12:
        parser.error("--rows takes 1 to 200, --detail 1 to 12")
    cabin, length = build(arguments.rows, arguments.detail)
    stem = os.path.splitext(arguments.output)[0]
    write_geometry(cabin, arguments.output, arguments.rows, arguments.detail)
    write_display(stem + ".display", length)
    write_project(stem + ".toml", os.path.basename(arguments.output), arguments.rows, length)
    print(f"{arguments.output}: {len(cabin.polygons)} polygons, {len(cabin.points)} points")


if __name__ == "__main__":
    main()
