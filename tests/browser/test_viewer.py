# SPDX-License-Identifier: Apache-2.0
"""The walkthrough in a real browser: Debian's Chromium, headless, with software rendering. The
checks themselves are in *.test.mjs."""
import os
import shutil
import subprocess
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("EXITANCE_PROGRAM", str(ROOT / "build/bin/exitance"))


class Browser(unittest.TestCase):
    def test_walkthrough(self):
        self.assertTrue(shutil.which("chromium"), "scripts/setup test installs it")
        self.assertTrue((ROOT / "build/node/node_modules/playwright-core").is_dir(),
                        "scripts/setup test installs it")
        done = subprocess.run(
            ["node", "--test", "--test-reporter", "spec",  # says at its end what failed
             *sorted((ROOT / "tests/browser").glob("*.test.mjs"))],
            timeout=590, text=True, capture_output=True,
            env={**os.environ, "EXITANCE_PROGRAM": PROGRAM, "EXITANCE_SOURCE_DIR": str(ROOT)})
        self.assertEqual(done.returncode, 0, done.stdout[-6000:] + done.stderr[-2000:])


class Types(unittest.TestCase):
    def test_of_the_page_hold(self):
        done = subprocess.run(["npm", "run", "--silent", "check"], cwd=ROOT / "viewer", timeout=300,
                              text=True, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
