# SPDX-License-Identifier: Apache-2.0
"""exitance solve --error: what has not come to it says so, and why; so does info of the file."""
import json
import signal
import unittest

from program import BAD_INPUT, ROOT, ProgramTest, box, change_extras, extras

CORNELL = ROOT / "scenes/cornell.toml"
MISSED = r"the error aimed at, {}, is not reached: {}"


class ReachedError(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output = self.folder / "out.glb"

    def solve(self, *arguments, scene=CORNELL):
        return self.succeed("solve", scene, "-o", self.output, *arguments).stdout

    def expect_missed(self, said, aim, reason):
        """In one line of the summary, and in what info says."""
        text = MISSED.format(aim, reason)
        self.assertRegex(said, rf"\n  warning {text}.*\n  work ")
        self.assertEqual(said.count("is not reached"), 1)
        self.assertRegex(self.succeed("info", self.output).stdout, rf"Error: .*\n  {text}")
        self.assertIs(self.facts()["error_reached"], False)

    def facts(self):
        return json.loads(self.succeed("info", "--json", self.output).stdout)

    def change(self, **values):
        change_extras(self.output, **values)

    def test_reached(self):
        self.assertNotIn("warning", self.solve("--error", "0.1"))
        facts = self.facts()
        self.assertIs(facts["error_reached"], True)
        self.assertIsNone(facts["stopped"])
        self.assertNotIn("stopped", extras(self.output))
        self.assertNotIn("reached", self.succeed("info", self.output).stdout)

    def test_time(self):
        said = self.solve("--error", "0.0005", "--time", "0.3")
        self.expect_missed(said, "0.05 %", r"--time 0\.3 s was over; more time, or --resume")
        self.assertEqual(self.facts()["stopped"], "time")
        self.assertEqual(extras(self.output)["stopped"], "time")

    def test_time_that_sufficed(self):
        self.change_of_rough(stopped="time")
        told = self.succeed("info", self.output).stdout
        self.assertRegex(told, r"Error: .*\n  stopped by --time\n")
        self.assertNotIn("not reached", told)

    def change_of_rough(self, **values):
        self.solve("--error", "0.2")
        self.change(**values)

    def test_interrupt(self):
        process = self.start("solve", CORNELL, "-o", self.output, "--error", "0.0005", "--log",
                             "json")
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        said, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, err)
        self.expect_missed(said, "0.05 %", "it was stopped before; --resume goes on")
        self.assertEqual(said.count("stopped early"), 1)
        self.assertEqual(self.facts()["stopped"], "interrupt")

    def test_what_is_kept_is_measured_by_what_is_asked_now(self):
        self.solve("--error", "0.2")
        said = self.solve("--error", "0.001", "--time", "0", "--resume", self.output)
        self.assertRegex(said, "warning " + MISSED.format("0.1 %", "--time was over"))
        self.assertNotIn("reached", self.succeed("info", self.output).stdout)

    def test_options_that_leave_it_coarse(self):
        room = self.write("box.geom", box())
        for reason, *arguments in (
                ("--no-adaptive forbids", "--no-adaptive"),
                (r"elements were not divided below --min-area 1 m²; a smaller one", "--min-area", "1"),
                (r"--unshot 0\.3 ended the work; --error alone", "--unshot", "0.3"),
                (r"--next-shot 0\.01 ended the work", "--next-shot", "0.01"),
                ("--solver jacobi ends when .* smaller --element-size", "--solver", "jacobi",
                 "--element-size", "0.5")):
            with self.subTest(arguments=arguments):
                said = self.solve("--error", "0.01", *arguments, scene=room)
                self.expect_missed(said, "1 %", reason)

    def test_more_that_did_not_help(self):
        # Two carpets of different colour in one place: rays meet either, whatever the mesh.
        room = """[[material]]
name = "white"
reflectance = 0.7
[[material]]
name = "black"
reflectance = 0
[[polygon]]
material = "white"
corners = [[0, 0, 0], [0, 0, 3], [3, 0, 3], [3, 0, 0]]
[[polygon]]
material = "black"
corners = [[0, 0, 1], [0, 0, 3], [3, 0, 3], [3, 0, 1]]
[[polygon]]
material = "white"
corners = [[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]]
[[luminaire]]
name = "lamp"
shape = "rectangle"
position = [1.5, 2, 1.5]
aim = [0, -1, 0]
width = 0.5
height = 0.5
lumens = 1000
"""
        said = self.solve("--error", "0.005", scene=self.write("carpets.toml", room))
        self.expect_missed(said, "0.5 %", "smaller elements made it no better; .* --patch-size")

    def test_memory_is_told_once(self):
        said = self.solve("--error", "0.02", "--memory", "90", scene=ROOT / "scenes/office.toml")
        self.expect_missed(said, "2 %", "there was no memory for more; give it more --memory")
        self.assertEqual(said.count("no more"), 1)

    def test_what_is_hardly_known_confirms_nothing(self):
        told = "whether the error aimed at, 20 %, is reached is uncertain"
        for rms, confidence, uncertain in (0.15, 0.01, False), (0.15, 0.12, True), (0.01, 0.3, True):
            self.change_of_rough(error={"rms": rms, "confidence": confidence, "points": 640})
            self.assertEqual(told in self.succeed("info", self.output).stdout, uncertain)
            self.assertIs(self.facts()["error_reached"], None if uncertain else True)

    def test_what_stopped_it_must_be_known(self):
        self.change_of_rough(stopped="weather")
        self.refuse(BAD_INPUT, r"stopped: found \"weather\", expected time or interrupt", "info",
                    self.output)


if __name__ == "__main__":
    unittest.main()
