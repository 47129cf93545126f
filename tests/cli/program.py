# SPDX-License-Identifier: Apache-2.0
"""The program from outside: a folder of its own for every test, and a small scene to light."""
import json
import os
import re
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("EXITANCE_PROGRAM", str(ROOT / "build/bin/exitance"))

WRONG_USE, BAD_INPUT, COULD_NOT_FINISH = 2, 3, 4


def box(lamp=True, patches=1):
    """AFIT geometry: a closed box of 1 m seen from inside, grey 0.5, each wall in so many patches,
    and a lamp of 0.2 m, 5 cm below the ceiling."""
    points = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    # Corner i = 4 x + 2 y + z; counter-clockwise seen from inside.
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    polygons = [[i + 1 for i in face] + [1] for face in faces]
    if lamp:
        y = 0.95
        first = len(points) + 1
        points += [(0.4, y, 0.4), (0.6, y, 0.4), (0.6, y, 0.6), (0.4, y, 0.6)]
        polygons.append([first, first + 1, first + 2, first + 3, 2])
    lines = ["a box", "ccw nopurge", f"points {len(points)} patches {len(polygons)} attributes 2"]
    lines += [f"{x} {y} {z}" for x, y, z in points]
    lines += [f"4 {a} {b} {c} {d} attribute {k} patch {patches}" for a, b, c, d, k in polygons]
    lines += ["color 0.5 0.5 0.5", "color 0.5 0.5 0.5 emit 10 10 10"]
    return "\n".join(lines) + "\n"


def glb_json(path):
    """The JSON chunk of a binary glTF whose lengths add up."""
    data = Path(path).read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data)), "no whole .glb"
    json_bytes, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    return json.loads(data[20:20 + json_bytes])


def extras(path):
    return glb_json(path)["asset"]["extras"]["exitance"]


def change_extras(path, **values):
    """Writes the same file with other members there."""
    file = glb_json(path)
    file["asset"]["extras"]["exitance"].update(values)
    text = json.dumps(file).encode()
    text += b" " * (-len(text) % 4)
    old = Path(path).read_bytes()
    end = 20 + struct.unpack_from("<I", old, 12)[0]
    data = struct.pack("<I4s", len(text), b"JSON") + text + old[end:]
    Path(path).write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(data)) + data)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def start(self, *arguments, **more):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, **more)

    def run_program(self, *arguments, **more):
        process = self.start(*arguments, **more)
        out, err = process.communicate(timeout=300)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def succeed(self, *arguments, **more):
        done = self.run_program(*arguments, **more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def refuse(self, code, message, *arguments, **more):
        """Ends with `code` and one line on stderr that matches `message`; writes nothing new."""
        before = self.listing()
        done = self.run_program(*arguments, **more)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        self.assertRegex(done.stderr, message)
        self.assertEqual(done.stdout, "")
        errors = [line for line in done.stderr.splitlines() if not re.match(r"warning \d+: ", line)]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertEqual(self.listing(), before)
        return done

    def listing(self):
        return {p.relative_to(self.folder): p.stat().st_size for p in self.folder.rglob("*")}
