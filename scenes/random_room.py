#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a room of random size with random boxes, paints and ceiling panels: a lighting project.

Every --seed gives another room, the same one each time. Only the Python standard library is used.
"""
import argparse
import random


def quad(name, material, corners):
    text = ", ".join("[%.4f, %.4f, %.4f]" % c for c in corners)
    return f'[[polygon]]\nname = "{name}"\nmaterial = "{material}"\ncorners = [{text}]\n'


def outward_box(name, material, low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    faces = [[(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
             [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
             [(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)],
             [(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)],
             [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)]]
    if y0 > 0:
        faces.append([(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)])
    return "".join(quad(name, material, face) for face in faces)


def room(seed):
    rng = random.Random(seed)
    x, y, z = rng.uniform(2, 8), rng.uniform(2.2, 4), rng.uniform(2, 8)
    text = [f'title = "Random room {seed}"\nquantity = "photometric"\n']
    for i in range(5):
        colour = ", ".join(f"{rng.uniform(0.1, 0.85):.2f}" for _ in range(3))
        text.append(f'[[material]]\nname = "paint{i}"\nreflectance = [{colour}]\n')
    text.append('[[material]]\nname = "lamp"\nreflectance = 0\nexitance = 10000\n')
    paint = lambda: f"paint{rng.randrange(5)}"
    text.append(quad("floor", paint(), [(0, 0, 0), (0, 0, z), (x, 0, z), (x, 0, 0)]))
    text.append(quad("ceiling", paint(), [(0, y, 0), (x, y, 0), (x, y, z), (0, y, z)]))
    text.append(quad("south", paint(), [(0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)]))
    text.append(quad("north", paint(), [(0, 0, z), (0, y, z), (x, y, z), (x, 0, z)]))
    text.append(quad("west", paint(), [(0, 0, 0), (0, y, 0), (0, y, z), (0, 0, z)]))
    text.append(quad("east", paint(), [(x, 0, 0), (x, 0, z), (x, y, z), (x, y, 0)]))
    for i in range(rng.randint(1, 3)):
        w, d = rng.uniform(0.1, 0.9), rng.uniform(0.1, 0.9)
        a, b = rng.uniform(0.1, x - w - 0.1), rng.uniform(0.1, z - d - 0.1)
        h = y - rng.uniform(0.01, 0.4)
        text.append(quad("lamp", "lamp", [(a, h, b), (a + w, h, b), (a + w, h, b + d), (a, h, b + d)]))
    for i in range(rng.randint(0, 5)):
        size = [rng.uniform(0.1, 0.35 * side) for side in (x, 0.8 * y, z)]
        a, b = rng.uniform(0.05, x - size[0] - 0.05), rng.uniform(0.05, z - size[2] - 0.05)
        low = 0 if rng.random() < 0.6 else rng.uniform(0.05, 0.9 * y - size[1] - 0.45)
        low = max(low, 0)
        text.append(outward_box(f"box{i}", paint(), (a, low, b),
                                (a + size[0], min(low + size[1], y - 0.45), b + size[2])))
    return "\n".join(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", default="room.toml")
    options = parser.parse_args()
    with open(options.output, "w", encoding="ascii") as out:
        out.write(room(options.seed))


if __name__ == "__main__":
    main()
