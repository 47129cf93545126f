# SPDX-License-Identifier: Apache-2.0
"""exitance prorad: the files and flags of the original system."""
import signal
import struct
import unittest
import urllib.request
import zlib
from urllib.parse import urlsplit

from program import BAD_INPUT, COULD_NOT_FINISH, WRONG_USE, ProgramTest, box, extras

DISPLAY = """seen from a corner
eye 0.1 0.5 0.1 lookat 0.9 0.4 0.9
up 0 1 0
fovx 60 fovy 45
near 0.01 far 10
xres 64 yres 48
diameter 1
ambient {ambient}
threshold {threshold}
"""


def pixels(path):
    """(width, height, mean of the samples) of a PNG of 8 bits; reverses the row filters."""
    data = path.read_bytes()
    width, height, depth, kind = struct.unpack_from(">IIBB", data, 16)
    assert depth == 8
    channels = {0: 1, 2: 3, 6: 4}[kind]
    at, packed = 8, b""
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw = zlib.decompress(packed)
    stride = width * channels
    above, total = bytes(stride), 0
    for y in range(height):
        method, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:][:stride])
        for x in range(stride):
            a = row[x - channels] if x >= channels else 0
            b = above[x]
            c = above[x - channels] if x >= channels else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[x] = (row[x] + [0, a, b, (a + b) // 2, paeth][method]) & 255
        above, total = row, total + sum(row)
    return width, height, total / (stride * height)


class Prorad(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("box.geom", box())
        self.display(threshold=5)

    def display(self, ambient=0, threshold=1):
        self.write("box.display", DISPLAY.format(ambient=ambient, threshold=threshold))

    def prorad(self, *arguments):
        return self.succeed("prorad", "-g", "box.geom", "-d", "box.display", "--error", "0.2",
                            *arguments)

    def names(self):
        return sorted(p.name for p in self.folder.iterdir()
                      if p.name not in ("box.geom", "box.display"))

    def test_picture_of_the_display_file(self):
        self.prorad()
        self.assertEqual(self.names(), ["box.png"])
        width, height, mean = pixels(self.folder / "box.png")
        self.assertEqual((width, height), (64, 48))
        self.assertGreater(mean, 20)

    def test_solution(self):
        done = self.prorad("-o", "lit.glb")
        self.assertEqual(self.names(), ["lit.glb", "lit.png"])
        self.assertRegex(done.stdout, r"^lit\.glb: \d+ vertices")
        # A lamp of 0.2 m × 0.2 m and 10 per square metre.
        self.assertAlmostEqual(extras(self.folder / "lit.glb")["energy"]["emitted"], 0.4, 6)

    def test_threshold(self):
        shots = []
        for threshold in (50, 5, 0.5):
            self.display(threshold=threshold)
            self.prorad("-o", "lit.glb")
            shots.append(extras(self.folder / "lit.glb")["counters"]["shots"])
        self.assertLess(shots[0], shots[1])
        self.assertLess(shots[1], shots[2])

    def test_wireframe_and_normals_are_drawn(self):
        seen = set()
        for flags in ((), ("-w",), ("-w", "-n")):
            self.prorad(*flags)
            seen.add((self.folder / "box.png").read_bytes())
        self.assertEqual(len(seen), 3)

    def test_normals_need_the_wireframe(self):
        self.refuse(WRONG_USE, "-n requires -w", "prorad", "-g", "box.geom", "-d", "box.display",
                    "-n")

    def test_no_occlusion_test(self):
        # The lamp hides nothing but a patch of the ceiling; without the test that is lit too, and
        # nothing that is sent gets lost behind it.
        self.prorad("-o", "with.glb")
        self.prorad("-o", "without.glb", "-t")
        self.assertEqual(extras(self.folder / "without.glb")["options"]["occlusion"], "false")
        self.assertNotEqual((self.folder / "with.glb").read_bytes(),
                            (self.folder / "without.glb").read_bytes())

    def test_pictures_while_solving(self):
        self.display(threshold=2)
        self.prorad("--pictures", "10", "-o", "lit.glb")
        shots = extras(self.folder / "lit.glb")["counters"]["shots"]
        numbered = [n for n in self.names() if n.startswith("lit-")]
        self.assertEqual(numbered, [f"lit-{i + 1:04}.png" for i in range(len(numbered))])
        self.assertEqual(len(numbered), shots // 10 + 1)
        self.assertEqual((self.folder / numbered[-1]).read_bytes(),
                         (self.folder / "lit.png").read_bytes())
        self.assertNotEqual((self.folder / numbered[0]).read_bytes(),
                            (self.folder / numbered[-1]).read_bytes())

    def test_shown_while_solving(self):
        """What is written is the same as without anybody watching."""
        self.prorad("-o", "lit.glb")
        process = self.start("prorad", "-g", "box.geom", "-d", "box.display", "--error", "0.2",
                             "-o", "shown.glb", "-s", "--no-open", "--log", "json")
        self.addCleanup(process.kill)
        address = urlsplit(process.stdout.readline().strip())
        self.assertRegex(process.stdout.readline(), r"^shown\.glb: \d+ vertices")
        with urllib.request.urlopen(address.geturl() + "solution.glb", timeout=20) as answer:
            self.assertEqual(answer.read(), (self.folder / "lit.glb").read_bytes())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0)
        for kind in ("glb", "png"):
            self.assertEqual((self.folder / f"shown.{kind}").read_bytes(),
                             (self.folder / f"lit.{kind}").read_bytes())

    def test_ambient_only_changes_the_picture(self):
        files = []
        for ambient in (0, 1):
            self.display(ambient=ambient, threshold=50)
            self.prorad("-o", "lit.glb")
            files.append(((self.folder / "lit.glb").read_bytes(),
                          (self.folder / "lit.png").read_bytes()))
        self.assertEqual(files[0][0], files[1][0])
        self.assertNotEqual(files[0][1], files[1][1])

    def test_refusals(self):
        self.write("cut.display", "seen\neye 1 2\n")
        self.write("cut.geom", box()[:150])
        for code, message, *arguments in [
                (WRONG_USE, "-g is required", "-d", "box.display"),
                (WRONG_USE, "-d is required", "-g", "box.geom"),
                (BAD_INPUT, r"cut\.display:2:\d+: ", "-g", "box.geom", "-d", "cut.display"),
                (BAD_INPUT, r"cut\.geom:\d+:\d+: ", "-g", "cut.geom", "-d", "box.display"),
                (BAD_INPUT, "missing.geom", "-g", "missing.geom", "-d", "box.display"),
                (WRONG_USE, "replace the input", "-g", "box.geom", "-d", "box.display", "-o",
                 "box.geom"),
                (WRONG_USE, "picture's name", "-g", "box.geom", "-d", "box.display", "-o",
                 "lit.png"),
                (WRONG_USE, "--pictures", "-g", "box.geom", "-d", "box.display", "--pictures",
                 "0"),
                (WRONG_USE, "excludes", "-g", "box.geom", "-d", "box.display", "-s", "--pictures"),
                (COULD_NOT_FINISH, "cannot write", "-g", "box.geom", "-d", "box.display", "-o",
                 "nowhere/lit.glb")]:
            with self.subTest(arguments=arguments):
                self.refuse(code, message, "prorad", *arguments)


if __name__ == "__main__":
    unittest.main()
