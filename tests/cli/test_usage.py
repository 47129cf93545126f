# SPDX-License-Identifier: Apache-2.0
"""Wrong use ends with exit code 2 and one line that says what was wrong."""
import re
import unittest

from program import PROGRAM, WRONG_USE, ProgramTest, box


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
                ("--error", "0.1%", "--error: '0.1%'"),
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


if __name__ == "__main__":
    unittest.main()
