# SPDX-License-Identifier: Apache-2.0
"""What the tutorial shows of its room is what stands in scenes/first_room.toml."""
import os
import re
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))


class Tutorial(unittest.TestCase):
    def test_excerpts_are_in_the_scene(self):
        scene = (ROOT / "scenes/first_room.toml").read_text(encoding="utf-8")
        tutorial = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
        excerpts = re.findall(r"^```toml\n(.*?)^```$", tutorial, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(excerpts), 3)
        for excerpt in excerpts:
            with self.subTest(excerpt=excerpt):
                self.assertIn(excerpt, scene)


if __name__ == "__main__":
    unittest.main()
