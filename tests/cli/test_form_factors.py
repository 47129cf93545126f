# SPDX-License-Identifier: Apache-2.0
"""exitance form-factors: the program from outside; every file it writes is read back."""
import ast
import json
import math
import signal
import struct
import subprocess
import sys
import time
import unittest
import zipfile

from program import BAD_INPUT, COULD_NOT_FINISH, WRONG_USE, ProgramTest, box

VERTICES = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 2)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def enclosure(options="", faces=FACES, emissivity=0.5):
    """View3D input: a closed box 1 × 1 × 2 seen from inside."""
    lines = ["T a box"] + ([f"C {options}"] if options else []) + ["F 3"]
    lines += [f"V {i} {x} {y} {z}" for i, (x, y, z) in enumerate(VERTICES, 1)]
    lines += [f"S {i} " + " ".join(str(v + 1) for v in face) + f" 0 0 {emissivity} wall{i}"
              for i, face in enumerate(faces, 1)]
    return "\n".join(lines + ["End of data", ""])


def npy(data):
    """The array of a .npy file as (type, shape, bytes)."""
    assert data[:8] == b"\x93NUMPY\x01\x00"
    (length,) = struct.unpack_from("<H", data, 8)
    assert (10 + length) % 64 == 0
    header = ast.literal_eval(data[10:10 + length].decode())
    assert not header["fortran_order"]
    return header["descr"], header["shape"], data[10 + length:]


def facing(a, b, c):
    """Howell's catalogue C-11: equal rectangles a × b at the distance c."""
    x, y = a / c, b / c
    p, q = math.hypot(1, x), math.hypot(1, y)
    return 2 / (math.pi * x * y) * (
        math.log(p * q / math.sqrt(1 + x * x + y * y)) + x * q * math.atan(x / q)
        + y * p * math.atan(y / p) - x * math.atan(x) - y * math.atan(y))


class FormFactors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("box.vs3", enclosure())

    def matrix(self, *options, scene=None):
        """F as .csv gives it."""
        self.succeed("form-factors", scene or self.scene, "-o", "F.csv", *options)
        return [[float(v) for v in line.split(",")]
                for line in (self.folder / "F.csv").read_text().splitlines()]

    def test_factors_of_a_box(self):
        F = self.matrix("--accuracy", "1e-3")
        self.assertEqual((len(F), len(F[0])), (6, 6))
        # wall5 and wall6 are the ends, 1 × 1 at the distance 2; wall1 and wall2 are 1 × 2 at 1.
        self.assertAlmostEqual(F[4][5], facing(1, 1, 2), delta=1e-3)
        self.assertAlmostEqual(F[0][1], facing(1, 2, 1), delta=1e-3)
        for i, row in enumerate(F):
            self.assertEqual(row[i], 0)
            self.assertAlmostEqual(sum(row), 1, delta=5e-3)

    def test_report_tells_sums_and_reciprocity_before_and_after(self):
        out = self.succeed("form-factors", self.scene, "-o", "F.csv", "--method", "hemisphere",
                           "--accuracy", "0.01", "--enforce", "both").stdout
        self.assertRegex(out, r"6 surfaces of 6 facets, 30 of 36 factors")
        self.assertRegex(out, r"by hemisphere, accuracy 0\.01, .* rays")
        self.assertEqual(out.count("row sums"), 2)
        after = out.split("after --enforce both")[1]
        self.assertRegex(after, r"row sums     (1\.00000\d|0\.99999\d) .* mean 1\.000000")
        self.assertIn("differ by at most 0 of", after)

    def test_matrix_market(self):
        F = self.matrix("--accuracy", "1e-3")
        self.succeed("form-factors", self.scene, "-o", "F.mtx", "--accuracy", "1e-3")
        lines = (self.folder / "F.mtx").read_text().splitlines()
        self.assertEqual(lines[0], "%%MatrixMarket matrix coordinate real general")
        self.assertIn("% 5 1 0.5 wall5", lines)
        body = [line.split() for line in lines if not line.startswith("%")]
        self.assertEqual(body[0], ["6", "6", "30"])
        self.assertEqual(len(body), 31)
        for i, j, value in body[1:]:
            self.assertEqual(float(value), F[int(i) - 1][int(j) - 1])

    def test_npz_is_a_csr_matrix_with_areas_and_names(self):
        F = self.matrix("--accuracy", "1e-3")
        self.succeed("form-factors", self.scene, "-o", "F.npz", "--accuracy", "1e-3")
        with zipfile.ZipFile(self.folder / "F.npz") as archive:
            self.assertIsNone(archive.testzip())
            arrays = {name[:-4]: npy(archive.read(name)) for name in archive.namelist()}
        self.assertEqual(arrays["format"], ("|S3", (), b"csr"))
        self.assertEqual(arrays["shape"][:2], ("<i8", (2,)))
        self.assertEqual(struct.unpack("<2q", arrays["shape"][2]), (6, 6))
        starts = struct.unpack("<7q", arrays["indptr"][2])
        columns = struct.unpack("<30q", arrays["indices"][2])
        values = struct.unpack("<30f", arrays["data"][2])
        for i in range(6):
            row = [0.0] * 6
            for k in range(starts[i], starts[i + 1]):
                row[columns[k]] = values[k]
            for found, expected in zip(row, F[i]):
                self.assertAlmostEqual(found, expected, places=7)
        self.assertEqual(struct.unpack("<6d", arrays["areas"][2]), (2, 2, 2, 2, 1, 1))
        kind, shape, data = arrays["names"]
        self.assertEqual((kind, shape), ("<U5", (6,)))
        self.assertEqual(data.decode("utf-32-le"), "".join(f"wall{i}" for i in range(1, 7)))

    def test_npz_is_what_scipy_loads(self):
        """Where SciPy is installed; the test before reads the same by hand."""
        self.succeed("form-factors", self.scene, "-o", "F.npz", "--accuracy", "1e-3")
        script = ("import scipy.sparse as s; m = s.load_npz('F.npz');"
                  "print(m.format, m.shape, m.nnz, bool(abs(m.sum(1) - 1).max() < 5e-3))")
        for python in (sys.executable, "/usr/bin/python3"):
            has = subprocess.run([python, "-c", "import scipy.sparse"], capture_output=True)
            if has.returncode == 0:
                done = subprocess.run([python, "-c", script], cwd=self.folder, text=True,
                                      capture_output=True)
                self.assertEqual(done.stdout, "csr (6, 6) 30 True\n", done.stderr)
                return
        self.skipTest("SciPy is not installed")

    def test_view3d_text(self):
        F = self.matrix("--accuracy", "1e-3")
        self.succeed("form-factors", self.scene, "-o", "F.vf", "--accuracy", "1e-3")
        text = (self.folder / "F.vf").read_text()
        header, areas, *rows = text.splitlines()
        self.assertEqual(text[30], "\n")
        self.assertEqual(header.split()[2:], ["0", "0", "0", "6"])
        self.assertEqual(areas, "2 2 2 2 1 1")
        self.assertEqual(rows[6], " ".join(["0.500"] * 6))
        self.assertEqual(rows[:6], [" ".join(f"{v:.6f}" for v in row) for row in F])

    def test_view3d_binary_as_the_file_asks(self):
        scene = self.write("binary.vs3", enclosure("out=1 eps=1e-3"))
        self.succeed("form-factors", scene, "-o", "F.vf")
        data = (self.folder / "F.vf").read_bytes()
        self.assertEqual(len(data), 32 + 4 * (6 + 36 + 6))
        self.assertEqual(data[:32].split()[2:], [b"1", b"0", b"0", b"6"])
        self.assertEqual(struct.unpack_from("<6f", data, 32), (2, 2, 2, 2, 1, 1))
        self.assertAlmostEqual(sum(struct.unpack_from("<6f", data, 56)), 1, delta=5e-3)
        self.assertEqual(struct.unpack_from("<6f", data, 32 + 24 + 144), (0.5,) * 6)

    def test_elmer(self):
        F = self.matrix("--accuracy", "1e-3")
        self.succeed("form-factors", self.scene, "-o", "ViewFactors.dat", "--accuracy", "1e-3")
        words = (self.folder / "ViewFactors.dat").read_text().split()
        at = 0
        for i in range(6):
            count, at = int(words[at]), at + 1
            self.assertEqual(count, 5)
            for _ in range(count):
                self.assertEqual(int(words[at]), i + 1)
                self.assertEqual(float(words[at + 2]), F[i][int(words[at + 1]) - 1])
                at += 3
        self.assertEqual(at, len(words))

    def test_openfoam(self):
        F = self.matrix("--accuracy", "1e-3")
        (self.folder / "constant").mkdir()
        self.succeed("form-factors", self.scene, "-o", "constant", "--format", "openfoam",
                     "--accuracy", "1e-3")
        values = (self.folder / "constant/F").read_text()
        faces = (self.folder / "constant/globalFaceFaces").read_text()
        self.assertIn("class       scalarListList;", values)
        self.assertIn("class       labelListList;", faces)
        rows = [[line[line.index("(") + 1:-1].split() for line in text.split("\n6\n(\n")[1]
                 .splitlines()[:6]] for text in (values, faces)]
        for i in range(6):
            self.assertEqual(len(rows[0][i]), len(rows[1][i]))
            for value, column in zip(rows[0][i], rows[1][i]):
                self.assertEqual(float(value), F[i][int(column)])

    def test_encl_enforces_closure_and_the_command_line_wins(self):
        scene = self.write("encl.vs3", enclosure("encl=1 eps=1e-2"))
        for row in self.matrix("--method", "hemisphere", scene=scene):
            self.assertAlmostEqual(sum(row), 1, delta=2e-6)
        out = self.succeed("form-factors", scene, "-o", "F.csv", "--enforce", "none").stdout
        self.assertNotIn("after --enforce", out)

    def test_emit_gives_total_interchange_factors(self):
        scene = self.write("emit.vs3", enclosure("encl=1 emit=1 eps=1e-3", emissivity=0.3))
        for row in self.matrix(scene=scene):
            # Everything that is emitted is absorbed in the end.
            self.assertAlmostEqual(sum(row), 0.3, delta=1e-5)
            self.assertGreater(min(row), 0)

    def test_list_row_and_column(self):
        scene = self.write("row.vs3", enclosure("row=5 col=6 eps=1e-3"))
        out = self.succeed("form-factors", scene, "-o", "F.csv").stdout
        listed = [line.split() for line in out.splitlines() if "wall5, wall6" in line]
        self.assertEqual(len(listed), 1)
        self.assertEqual(listed[0][:2], ["5", "6"])
        self.assertAlmostEqual(float(listed[0][2]), facing(1, 1, 2), delta=1e-3)
        self.assertNotIn("wall1, wall2", out)
        out = self.succeed("form-factors", self.scene, "-o", "F.csv", "--list").stdout
        self.assertEqual(sum(", wall" in line for line in out.splitlines()), 30)

    def test_divisions_agree(self):
        """Factors of whole walls follow from those of their parts."""
        scene = self.write("box.geom", box(lamp=False, patches=4).replace("nopurge", "purge"))
        whole = self.matrix("--by", "polygon", "--accuracy", "1e-3", scene=scene)
        parts = self.matrix("--by", "patch", "--accuracy", "1e-3", scene=scene)
        self.assertEqual((len(whole), len(parts)), (6, 24))
        for i in range(6):
            for j in range(6):
                mean = sum(sum(parts[4 * i + k][4 * j:4 * j + 4]) for k in range(4)) / 4
                self.assertAlmostEqual(mean, whole[i][j], delta=4e-3)
        finer = self.matrix("--by", "element", "--method", "hemisphere", "--samples", "16",
                            scene=scene)
        self.assertEqual(len(finer), 96)

    def test_every_method_is_deterministic(self):
        section = self.succeed("manual").stdout.split("## exitance form-factors")[1]
        methods = section.split("--method <")[1].split(">")[0].replace("\\|", " ").split()
        self.assertGreaterEqual(len(methods), 5)
        for method in methods:
            options = ("--method", method, "--accuracy", "0.01")
            one = self.matrix(*options, "--threads", "1")
            self.assertEqual(one, self.matrix(*options, "--threads", "3"), method)

    def test_quiet_and_json_log(self):
        done = self.succeed("form-factors", self.scene, "-o", "F.csv", "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        done = self.succeed("form-factors", self.scene, "-o", "F.csv", "--log", "json")
        steps = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertEqual(steps[-1]["phase"], "factors")
        self.assertAlmostEqual(steps[-1]["fraction_left"], 0, places=9)

    def test_interrupt_leaves_nothing_behind(self):
        scene = self.write("big.geom", box(lamp=False, patches=400))
        before = self.listing()
        process = self.start("form-factors", scene, "-o", "F.csv", "--by", "patch", "--method",
                             "monte-carlo", "--accuracy", "1e-6", "--log", "json")
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, COULD_NOT_FINISH, err)
        self.assertIn("stopped: the matrix is not complete", err)
        self.assertEqual(self.listing(), before)

    def test_wrong_use_and_bad_input(self):
        run = ("form-factors", self.scene)
        self.refuse(WRONG_USE, r"ends in \.csv, \.mtx, \.npz, \.vf, \.dat, or --format",
                    *run, "-o", "F.txt")
        self.refuse(WRONG_USE, "did you mean 'elmer'", *run, "-o", "F", "--format", "elmr")
        self.refuse(WRONG_USE, "would replace the input", *run, "-o", self.scene, "--format", "csv")
        self.refuse(COULD_NOT_FINISH, "no such folder", *run, "-o", "none", "--format", "openfoam")
        self.refuse(COULD_NOT_FINISH, "cannot write", *run, "-o", "none/F.csv")
        self.refuse(WRONG_USE, "accuracy", *run, "-o", "F.csv", "--accuracy", "0")
        self.refuse(WRONG_USE, "--samples does nothing with --method auto", *run, "-o", "F.csv",
                    "--samples", "5")
        self.refuse(WRONG_USE, r"--by patch: about .* rows .* expected at most 1e\+06", *run, "-o",
                    "F.csv", "--by", "patch", "--patch-size", "1e-6")
        self.refuse(WRONG_USE, "there are 6 surfaces", *run, "-o", "F.csv", "--row", "7")
        strange = self.write("strange.vs3", enclosure("encl=yes"))
        self.refuse(BAD_INPUT, r"strange\.vs3: C encl=yes, expected a number",
                    "form-factors", strange, "-o", "F.csv")
        huge = self.write("huge.vs3", enclosure("eps=7"))
        self.refuse(BAD_INPUT, r"huge\.vs3: --accuracy", "form-factors", huge, "-o", "F.csv")
        opened = self.write("open.vs3", enclosure("encl=1", faces=FACES[:3]))
        self.refuse(WRONG_USE, "the enclosure is open", "form-factors", opened, "-o", "F.csv")
        empty = self.write("empty.vs3", "F 3\nEnd\n")
        self.refuse(BAD_INPUT, "no polygons", "form-factors", empty, "-o", "F.csv")

    def test_a_full_disk(self):
        done = self.run_program("form-factors", self.scene, "-o", "/dev/full", "--format", "csv")
        self.assertEqual(done.returncode, COULD_NOT_FINISH)


if __name__ == "__main__":
    unittest.main()
