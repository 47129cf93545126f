# SPDX-License-Identifier: Apache-2.0
"""exitance solve --memory: the process stays below it, and what it could not do is said."""
import os
import subprocess
import unittest

from program import COULD_NOT_FINISH, PROGRAM, ROOT, WRONG_USE, ProgramTest, extras

OFFICE = ROOT / "scenes/office.toml"


class Memory(ProgramTest):
    def solve(self, *arguments):
        """Output, and the most that the process had resident [MB]."""
        output = self.folder / "office.glb"
        process = subprocess.Popen([PROGRAM, "solve", OFFICE, "-o", output, *arguments],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        said = process.stdout.read()
        process.stderr.close()
        process.stdout.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return said, output, usage.ru_maxrss * 1024 / 1e6

    def test_stays_below_the_limit_and_says_so(self):
        said, output, resident = self.solve("--error", "0.05", "--memory", "100")
        self.assertLess(resident, 100)
        self.assertRegex(said, r"memory +elements were not divided beyond a mesh of [0-9. k]+ vertices "
                               r"\(triangles add some in the file\): "
                               r"--memory 100 MB has room for no more")
        found = extras(output)
        self.assertEqual(found["options"]["memory"], "100")
        self.assertGreater(found["error"]["rms"], 0.05)
        self.assertIn("Memory: elements were not divided", self.succeed("info", output).stdout)

    def test_what_fits_is_the_same(self):
        said, output, resident = self.solve("--error", "0.2")
        before = output.read_bytes()
        said, output, resident = self.solve("--error", "0.2", "--memory", "2000")
        self.assertNotIn("memory", said)
        self.assertEqual(output.read_bytes(), before)

    def test_refuses(self):
        self.refuse(COULD_NOT_FINISH, "--memory 10 MB: this scene needs at least about [0-9]+ MB",
                    "solve", OFFICE, "-o", "x.glb", "--memory", "10")
        self.refuse(WRONG_USE, "--memory cannot be had with --solver shooting, .*--solver gathering",
                    "solve", OFFICE, "-o", "x.glb", "--memory", "1000", "--solver", "shooting")
        self.refuse(WRONG_USE, "memory", "solve", OFFICE, "-o", "x.glb", "--memory", "0")


if __name__ == "__main__":
    unittest.main()
