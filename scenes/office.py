#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the furniture and walls of office.toml: an open-plan office of 8 x 2.8 x 6 m.

x runs along the window wall (z = 0), y is up, z runs to the corridor wall (z = 6); metres. Bodies
are closed and face outwards; where one stands on another the hidden face is left out, so that no
two faces lie in one place. Only the Python standard library is used:

    python3 scenes/office.py -o scenes/office.gltf
"""
import argparse
import base64
import json
import math
import random
import struct

WIDTH, HEIGHT, DEPTH = 8.0, 2.8, 6.0

# Diffuse reflectance per band.
MATERIALS = {
    "wall paint": (0.72, 0.71, 0.68),
    "ceiling paint": (0.84, 0.84, 0.83),
    "carpet": (0.16, 0.18, 0.22),
    "window pane": (0.06, 0.07, 0.09),
    "window frame": (0.75, 0.75, 0.74),
    "door wood": (0.45, 0.29, 0.16),
    "desk wood": (0.58, 0.47, 0.34),
    "white metal": (0.78, 0.78, 0.77),
    "grey metal": (0.42, 0.43, 0.44),
    "black plastic": (0.05, 0.05, 0.055),
    "screen glass": (0.03, 0.03, 0.035),
    "blue fabric": (0.09, 0.17, 0.36),
    "green felt": (0.24, 0.38, 0.27),
    "paper red": (0.50, 0.13, 0.10),
    "paper ochre": (0.60, 0.44, 0.16),
    "paper blue": (0.14, 0.26, 0.45),
    "paper white": (0.74, 0.73, 0.68),
}


class Model:
    """Polygons by (body name, material)."""

    def __init__(self):
        self.parts = {}

    def face(self, body, material, corners):
        self.parts.setdefault((body, material), []).append(corners)

    def polygon_count(self):
        return sum(len(faces) for faces in self.parts.values())


class Placed:
    """A body under construction, turned about the vertical and moved."""

    def __init__(self, model, body, x=0.0, z=0.0, turn=0.0):
        self.model, self.body, self.x, self.z = model, body, x, z
        self.cos, self.sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def place(self, p):
        x, y, z = p
        return (self.x + x * self.cos + z * self.sin, y, self.z - x * self.sin + z * self.cos)

    def face(self, material, *corners):
        self.model.face(self.body, material, [self.place(c) for c in corners])

    def box(self, material, low, high, without="", **other):
        """An axis-aligned block. `without` names faces to leave out, `other` faces of another
        material: b(ottom) t(op) w(est, -x) e(ast, +x) n(orth, -z) s(outh, +z)."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        faces = {
            "b": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
            "t": [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
            "w": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
            "e": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
            "n": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
            "s": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        }
        for name, corners in faces.items():
            if name not in without:
                self.face(other.get(name, material), *corners)

    def frustum(self, material, low, high, half_low, half_high):
        """A square pyramid without its tip, from y = low to high; no bottom face."""
        a = [(-half_low, low, -half_low), (half_low, low, -half_low),
             (half_low, low, half_low), (-half_low, low, half_low)]
        b = [(-half_high, high, -half_high), (half_high, high, -half_high),
             (half_high, high, half_high), (-half_high, high, half_high)]
        for i in range(4):
            j = (i + 1) % 4
            self.face(material, a[j], a[i], b[i], b[j])
        self.face(material, b[3], b[2], b[1], b[0])


def room(model):
    shell = Placed(model, "room")
    X, Y, Z = WIDTH, HEIGHT, DEPTH
    shell.face("carpet", (0, 0, 0), (0, 0, Z), (X, 0, Z), (X, 0, 0))
    shell.face("ceiling paint", (0, Y, 0), (X, Y, 0), (X, Y, Z), (0, Y, Z))
    shell.face("wall paint", (0, 0, 0), (0, Y, 0), (0, Y, Z), (0, 0, Z))
    shell.face("wall paint", (X, 0, 0), (X, 0, Z), (X, Y, Z), (X, Y, 0))
    shell.face("wall paint", (0, 0, Z), (0, Y, Z), (X, Y, Z), (X, 0, Z))
    # The window wall: a band below, a band above, piers between, and niches 0.2 m deep.
    sill, head, deep = 0.9, 2.4, -0.2
    windows = [(0.6, 2.4), (3.1, 4.9), (5.6, 7.4)]

    def north(material, x0, x1, y0, y1, z=0.0):
        shell.face(material, (x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))

    north("wall paint", 0, X, 0, sill)
    north("wall paint", 0, X, head, Y)
    edges = [0] + [x for window in windows for x in window] + [X]
    for x0, x1 in zip(edges[::2], edges[1::2]):
        north("wall paint", x0, x1, sill, head)
    for x0, x1 in windows:
        shell.face("window frame", (x0, sill, deep), (x0, sill, 0), (x1, sill, 0), (x1, sill, deep))
        shell.face("window frame", (x0, head, deep), (x1, head, deep), (x1, head, 0), (x0, head, 0))
        shell.face("window frame", (x0, sill, 0), (x0, sill, deep), (x0, head, deep), (x0, head, 0))
        shell.face("window frame", (x1, sill, 0), (x1, head, 0), (x1, head, deep), (x1, sill, deep))
        north("window pane", x0, x1, sill, head, deep)
        frame = Placed(model, "window bars")
        middle = (x0 + x1) / 2
        frame.box("window frame", (middle - 0.03, sill, deep), (middle + 0.03, head, deep + 0.05),
                  "btn")
    door = Placed(model, "door")
    door.box("door wood", (0.5, 0.01, Z - 0.04), (1.4, 2.1, Z), "s")
    door.box("grey metal", (1.26, 1.02, Z - 0.10), (1.32, 1.05, Z - 0.04), "s")


def chair(model, name, x, z, turn):
    c = Placed(model, name, x, z, turn)
    c.frustum("black plastic", 0, 0.08, 0.26, 0.05)
    c.box("grey metal", (-0.03, 0.08, -0.03), (0.03, 0.42, 0.03), "bt")
    c.box("blue fabric", (-0.23, 0.42, -0.23), (0.23, 0.48, 0.23))
    for side in (-0.16, 0.12):
        c.box("black plastic", (side, 0.48, 0.18), (side + 0.04, 0.60, 0.21), "bt")
    c.box("blue fabric", (-0.21, 0.60, 0.17), (0.21, 1.05, 0.22))
    for x0, x1 in ((-0.225, -0.175), (0.175, 0.225)):
        c.box("black plastic", (x0 + 0.01, 0.48, -0.08), (x1 - 0.01, 0.66, -0.05), "bt")
        c.box("black plastic", (x0, 0.66, -0.16), (x1, 0.69, 0.10))


def desk(model, name, x, z, turn, lamp_side):
    """A desk of 1.4 x 0.7 m; its user sits on the +z side. Returns where its lamp shines from."""
    d = Placed(model, name, x, z, turn)
    d.box("desk wood", (-0.7, 0.695, -0.35), (0.7, 0.72, 0.35))
    for lx in (-0.65, 0.60):
        for lz in (-0.30, 0.25):
            d.box("grey metal", (lx, 0, lz), (lx + 0.05, 0.695, lz + 0.05), "bt")
    d.box("white metal", (-0.55, 0.0, -0.28), (-0.15, 0.60, 0.20), "b")
    m = Placed(model, name + " monitor", *d.place((0, 0, -0.16))[::2], turn=turn)
    m.box("black plastic", (-0.12, 0.72, -0.09), (0.12, 0.735, 0.09), "b")
    m.box("black plastic", (-0.025, 0.735, -0.03), (0.025, 0.86, -0.01), "bt")
    m.box("black plastic", (-0.29, 0.86, -0.035), (0.29, 1.20, -0.005), s="screen glass")
    k = Placed(model, name + " keyboard", *d.place((0, 0, 0.16))[::2], turn=turn)
    k.box("black plastic", (-0.22, 0.72, -0.07), (0.22, 0.735, 0.07), "b")
    lamp = Placed(model, name + " lamp", *d.place((lamp_side * 0.54, 0, -0.2))[::2], turn=turn)
    lamp.box("white metal", (-0.07, 0.72, -0.07), (0.07, 0.735, 0.07), "b")
    lamp.box("white metal", (-0.01, 0.735, -0.01), (0.01, 1.16, 0.01), "bt")
    lamp.box("white metal", (-0.05, 1.16, -0.04), (0.05, 1.185, 0.34))
    return lamp.place((0, 1.158, 0.22))


def shelf(model, name, x, z, rng):
    """A bookshelf of 0.9 x 2.0 x 0.32 m that opens towards -z."""
    s = Placed(model, name, x, z)
    board = 0.02
    for x0 in (0, 0.9 - board):
        s.box("desk wood", (x0, 0, 0), (x0 + board, 2.0, 0.32), "b")
    s.box("desk wood", (board, 0, 0.31), (0.9 - board, 2.0, 0.32), "bwe")
    heights = [0.08, 0.46, 0.84, 1.22, 1.60]
    for y in heights:
        s.box("desk wood", (board, y, 0.0), (0.9 - board, y + board, 0.31), "wes")
    for level, y in enumerate(heights):
        books = Placed(model, name + " books", x, z)
        at = board + 0.01
        while at < 0.80:
            if rng.random() < 0.2:
                at += rng.uniform(0.05, 0.15)
                continue
            wide = min(rng.choice([0.03, 0.04, 0.06, 0.08, 0.12]), 0.87 - at)
            tall = rng.uniform(0.2, 0.33)
            colour = rng.choice(["paper red", "paper ochre", "paper blue", "paper white"])
            books.box(colour, (at, y + board, rng.uniform(0.04, 0.10)),
                      (at + wide, y + board + tall, 0.30), "b")
            at += wide + 0.004


def office():
    model, rng = Model(), random.Random(8)
    room(model)
    lamps = []
    # Two islands of four desks, a felt screen along the middle of each.
    for island, centre in enumerate((2.1, 5.7)):
        for column, dx in enumerate((-0.71, 0.71)):
            for row, (dz, turn) in enumerate(((0.38, 0), (-0.38, 180))):
                name = f"desk {island * 4 + column * 2 + row + 1}"
                # The lamp stands at the outer end of the island, whichever way the desk looks.
                outer = dx / abs(dx) * (1 if turn == 0 else -1)
                lamps.append(desk(model, name, centre + dx, 2.1 + dz, turn, outer))
                swing = rng.uniform(-25, 25)
                away = rng.uniform(0.30, 0.42) * (1 if turn == 0 else -1)
                chair(model, name.replace("desk", "chair"), centre + dx + rng.uniform(-.1, .1),
                      2.1 + dz + (0.35 if turn == 0 else -0.35) + away, turn + swing)
        screen = Placed(model, f"screen {island + 1}")
        screen.box("green felt", (centre - 1.41, 0, 2.085), (centre + 1.41, 1.25, 2.115), "b")
    # The corridor side: shelves, a partition, a table with four chairs, a cabinet with a printer.
    shelf(model, "shelf 1", 2.2, 5.66, rng)
    shelf(model, "shelf 2", 3.14, 5.66, rng)
    partition = Placed(model, "partition", 4.5, 4.9)
    partition.box("green felt", (-0.02, 0.0, -0.8), (0.02, 1.6, 0.8), "b")
    table = Placed(model, "table", 6.1, 4.8)
    table.box("desk wood", (-0.7, 0.695, -0.4), (0.7, 0.72, 0.4))
    table.frustum("grey metal", 0, 0.06, 0.3, 0.06)
    table.box("grey metal", (-0.04, 0.06, -0.04), (0.04, 0.695, 0.04), "bt")
    for i, (dx, dz, turn) in enumerate([(-0.35, 0.65, 0), (0.35, 0.72, 12), (-0.33, -0.68, 175),
                                        (0.36, -0.66, 190)]):
        chair(model, f"visitor chair {i + 1}", 6.1 + dx, 4.8 + dz, turn)
    cabinet = Placed(model, "cabinet", 7.55, 3.4)
    cabinet.box("white metal", (0, 0.0, 0), (0.44, 0.8, 1.2), "b")
    printer = Placed(model, "printer", 7.6, 3.7)
    printer.box("grey metal", (0, 0.8, 0), (0.36, 1.05, 0.42), "b")
    printer.box("paper white", (0.05, 1.05, 0.08), (0.31, 1.07, 0.38), "b")
    bin_ = Placed(model, "bin", 4.0, 2.4)
    bin_.box("grey metal", (-0.12, 0, -0.12), (0.12, 0.32, 0.12), "b", t="black plastic")
    # Eight flat luminaires under the ceiling; their lamps are in the project file.
    for row, z in enumerate((1.55, 4.45)):
        for i, x in enumerate((1.0, 3.0, 5.0, 7.0)):
            panel = Placed(model, f"panel {row * 4 + i + 1}", x, z)
            panel.box("white metal", (-0.32, 2.75, -0.32), (0.32, 2.8, 0.32), "t")
    return model, lamps


def write_gltf(model, path):
    materials = list(MATERIALS)
    binary, views, accessors, meshes, nodes = bytearray(), [], [], [], []

    def accessor(data, kind, component, count, **bounds):
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary.extend(data)
        accessors.append({"bufferView": len(views) - 1, "componentType": component,
                          "count": count, "type": kind, **bounds})
        return len(accessors) - 1

    bodies = {}
    for (body, material), faces in model.parts.items():
        points, index, triangles = [], {}, []
        for face in faces:
            ids = []
            for corner in face:
                key = struct.unpack("<3f", struct.pack("<3f", *(c + 0.0 for c in corner)))
                if key not in index:
                    index[key] = len(points)
                    points.append(key)
                ids.append(index[key])
            for i in range(1, len(ids) - 1):
                triangles.extend((ids[0], ids[i], ids[i + 1]))
        position = accessor(b"".join(struct.pack("<3f", *p) for p in points), "VEC3", 5126,
                            len(points), min=[min(p[a] for p in points) for a in range(3)],
                            max=[max(p[a] for p in points) for a in range(3)])
        indices = accessor(struct.pack(f"<{len(triangles)}I", *triangles), "SCALAR", 5125,
                           len(triangles))
        bodies.setdefault(body, []).append({"attributes": {"POSITION": position},
                                            "indices": indices,
                                            "material": materials.index(material)})
    for body, primitives in bodies.items():
        nodes.append({"name": body, "mesh": len(meshes)})
        meshes.append({"name": body, "primitives": primitives})
    gltf = {
        "asset": {"version": "2.0", "generator": "Exitance scenes/office.py"},
        "scene": 0,
        "scenes": [{"name": "office", "nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*MATERIALS[name], 1], "metallicFactor": 0, "roughnessFactor": 1}}
            for name in materials],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary), "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(bytes(binary)).decode()}],
    }
    with open(path, "w", encoding="utf-8") as out:
        json.dump(gltf, out, separators=(",", ":"))
        out.write("\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", default="office.gltf")
    arguments = parser.parse_args()
    model, lamps = office()
    write_gltf(model, arguments.output)
    print(f"{arguments.output}: {model.polygon_count()} polygons")
    for i, lamp in enumerate(lamps):
        print(f"desk lamp {i + 1} at", [round(c, 4) for c in lamp])


if __name__ == "__main__":
    main()
