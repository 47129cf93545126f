# SPDX-License-Identifier: Apache-2.0
"""exitance solve --resume: goes on from a file, or says why not."""
import signal
import unittest

from program import BAD_INPUT, ROOT, WRONG_USE, ProgramTest, box, extras

ROUGH = ("--error", "0.2")


class Resume(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("box.geom", box())
        self.rough, self.output = self.folder / "rough.glb", self.folder / "box.glb"
        self.succeed("solve", self.scene, "-o", self.rough, *ROUGH)

    def solve(self, *arguments):
        return self.succeed("solve", self.scene, "-o", self.output, "--resume", self.rough,
                            *arguments)

    def test_goes_on(self):
        cornell = ROOT / "scenes/cornell.toml"
        self.succeed("solve", cornell, "-o", self.rough, *ROUGH)
        self.assertGreater(extras(self.rough)["error"]["rms"], 0.015)
        done = self.succeed("solve", cornell, "-o", self.output, "--resume", self.rough, "--error",
                            "0.015")
        self.assertNotIn("kept", done.stdout)
        after = extras(self.output)
        self.assertLessEqual(after["error"]["rms"], 0.015)
        self.assertEqual(float(after["options"]["error"]), 0.015)

    def test_nothing_left_to_do(self):
        done = self.solve(*ROUGH)
        self.assertIn("rough.glb has the error asked for: nothing is left to do", done.stdout)
        self.assertEqual(self.output.read_bytes(), self.rough.read_bytes())

    def test_without_time_the_file_is_kept(self):
        done = self.solve("--error", "0.001", "--time", "0")
        self.assertIn("rough.glb is kept: nothing better was found", done.stdout)
        self.assertEqual(self.output.read_bytes(), self.rough.read_bytes())

    def test_onto_itself(self):
        before = extras(self.rough)["error"]["rms"]
        self.succeed("solve", self.scene, "-o", self.rough, "--resume", self.rough, "--error", "0.01")
        self.assertLess(extras(self.rough)["error"]["rms"], before)

    def test_interrupt(self):
        process = self.start("solve", self.scene, "-o", self.output, "--resume", self.rough,
                             "--error", "0.0002", "--log", "json")
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn("stopped early", out)
        self.assertLessEqual(extras(self.output)["error"]["rms"],
                             extras(self.rough)["error"]["rms"])

    def test_refuses(self):
        other = self.write("other.geom", box().replace("emit 10 10 10", "emit 9 10 10"))
        dark = self.write("dark.geom", box(lamp=False))
        cut = self.write("cut.glb", self.rough.read_bytes()[:-100])
        text = self.write("text.glb", "no glTF")
        for code, message, *arguments in [
                (BAD_INPUT, r"of another scene: material '.*' emits 10 10 10, expected 9 10 10",
                 other),
                (BAD_INPUT, r"of another scene: its geometry, patterns or lamps differ", dark),
                (BAD_INPUT, r"light groups 'light', and this solve 'all'; .* --groups file",
                 self.scene, "--groups", "none"),
                (WRONG_USE, r"--resume cannot be had with --solver jacobi: .* not in a file",
                 self.scene, "--solver", "jacobi"),
                (WRONG_USE, r"--resume cannot be had with --solver shooting", self.scene,
                 "--unshot", "0.1"),
                (BAD_INPUT, r"cut\.glb: ", self.scene, "--resume", cut),
                (BAD_INPUT, r"text\.glb: ", self.scene, "--resume", text),
                (BAD_INPUT, r"nowhere\.glb", self.scene, "--resume", "nowhere.glb"),
        ]:
            with self.subTest(message=message):
                resume = () if "--resume" in arguments else ("--resume", self.rough)
                self.refuse(code, message, "solve", *arguments, *resume, "-o", self.output)
        self.refuse(WRONG_USE, "--compare begins every solve anew", "solve", self.scene, "--compare",
                    "--resume", self.rough)


if __name__ == "__main__":
    unittest.main()
