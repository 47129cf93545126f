# SPDX-License-Identifier: Apache-2.0
"""Wrong use ends with exit code 2 and one line that says what was wrong."""
import re
import subprocess
import unittest

from program import BAD_INPUT, COULD_NOT_FINISH, PROGRAM, WRONG_USE, ProgramTest, box


class Usage(ProgramTest):
    def commands(self):
        listed = self.succeed("--help").stdout.split("Subcommands:\n")[1].split("\n\n")[0]
        return [line.split()[0] for line in listed.splitlines() if re.match(r"  \S", line)]

    def test_help_of_every_command(self):
        commands = self.commands()
        self.assertIn("solve", commands)
        for command in commands:
            with self.subTest(command=command):
                text = self.succeed(command, "--help").stdout
                self.assertIn(f"Usage: exitance {command}", text)
                self.assertRegex(text, r"Examples?:\n  exitance " + command)
                self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def test_version(self):
        self.assertRegex(self.succeed("--version").stdout, r"^exitance \d+\.\d+\.\d+\n$")

    def test_no_command(self):
        self.refuse(WRONG_USE, "[Cc]ommand is required")

    def test_unknown_command(self):
        self.refuse(WRONG_USE, "unknown command 'slove', did you mean 'solve'", "slove")

    def test_unknown_option(self):
        self.refuse(WRONG_USE, "unknown option '--eror', did you mean '--error'",
                    "solve", "a.geom", "-o", "b.glb", "--eror", "1")

    def test_missing_scene(self):
        self.refuse(WRONG_USE, "scene is required", "solve", "-o", "b.glb")

    def test_missing_value(self):
        self.refuse(WRONG_USE, "--error", "solve", "a.geom", "-o", "b.glb", "--error")

    def test_values_out_of_range(self):
        scene = self.write("box.geom", box())
        for option, value, expected in [
                ("--error", "0", r"--error: '0' .* 0\.0001 … 1"),
                ("--error", "nan", "--error: 'nan'"),
                ("--error", "1e999", "--error: '1e999'"),
                ("--error", "small", "--error: 'small'"),
                ("--error", "0.1 %", "--error: '0.1 %'"),
                ("--error", "200%", r"--error: '200%' .* 0\.0001 … 1"),
                ("--time", "3m", "--time: '3m'"),
                ("--time", "-1", "--time: '-1' .* at least 0"),
                ("--threads", "1.5", r"--threads: '1\.5'"),
                ("--threads", "99999999999999", "--threads: '9+'"),
                ("--seed", "-3", "--seed: '-3'"),
                ("--solver", "magic", "--solver: 'magic' .* one of .*shooting"),
                ("--log", "xml", "--log"),
        ]:
            with self.subTest(option=option, value=value):
                self.refuse(WRONG_USE, expected, "solve", scene, "-o", "b.glb", option, value)

    def test_option_given_twice(self):
        self.refuse(WRONG_USE, "--error", "solve", "a.geom", "-o", "b.glb", "--error", "0.1",
                    "--error", "0.2")

    def test_quiet_and_a_log_exclude_each_other(self):
        self.refuse(WRONG_USE, "exclude", "solve", "a.geom", "-o", "b.glb", "-q", "--log", "json")


class FoundByUse(ProgramTest):
    """What once ended in a crash, or in silence."""

    def solution(self):
        scene = self.write("box.geom", box())
        solved = self.folder / "box.glb"
        self.succeed("solve", scene, "-o", solved, "--error", "0.2", "-q")
        return solved

    def test_places_beyond_all_scenes(self):
        solved = self.solution()
        self.refuse(WRONG_USE, "beyond 1e9 m", "render", solved, "-o", self.folder / "x.png",
                    "--eye", "1e30", "0", "0", "--look-at", "1", "1", "1")
        points = self.write("far.csv", "x,y,z,nx,ny,nz\n0,1e20,0,0,1,0\n")
        for method in ("gather", "interpolate"):
            self.refuse(BAD_INPUT, "far.csv:2:3: found y = 1e20", "probe", solved,
                        "--points", points, "-o", self.folder / "q.csv", "--method", method)

    def test_a_scene_without_polygons(self):
        self.refuse(BAD_INPUT, "no polygons", "solve", self.write("empty.toml", ""),
                    "-o", self.folder / "e.glb")

    def test_a_key_without_end(self):
        endless = self.write("key.toml", ".".join(["a"] * 50_000) + " = 1\n")
        self.refuse(BAD_INPUT, "key.toml:1:1: found a key of more than 256 parts", "info", endless)

    def test_a_solution_is_no_scene(self):
        self.refuse(WRONG_USE, "is a solution already", "solve", self.solution(),
                    "-o", self.folder / "again.glb")

    def test_output_that_cannot_be_printed(self):
        scene = self.write("box.geom", box())
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "info", scene], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, COULD_NOT_FINISH)

    def test_the_light_of_a_solve_that_had_no_time_is_unshot(self):
        said = self.succeed("solve", self.write("box.geom", box()), "-o", self.folder / "b.glb",
                            "--solver", "shooting", "--time", "0").stdout
        self.assertIn("100 % unshot; balance off by 0 %", said)

    def test_without_time_light_is_sketched(self):
        done = self.succeed("solve", self.write("box.geom", box()), "-o", self.folder / "b.glb",
                            "--time", "0")
        self.assertIn(" 0 % unshot;", done.stdout)
        self.assertIn("most often there was too little time to divide the mesh", done.stdout)


if __name__ == "__main__":
    unittest.main()
