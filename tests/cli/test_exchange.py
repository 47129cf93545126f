# SPDX-License-Identifier: Apache-2.0
"""exitance exchange: the program from outside, against closed forms."""
import csv
import unittest

from program import BAD_INPUT, COULD_NOT_FINISH, ROOT, WRONG_USE, ProgramTest

SIGMA = 5.670374419e-8
TWO_BOXES = ROOT / "scenes/two_boxes.vs3"


def combined(text):
    """The two boxes as two surfaces: later walls of each are added to its first."""
    out = []
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == "S":
            target = 1 if words[-1].startswith("room") else 7
            if int(words[1]) != target:
                words[7] = str(target)
            line = " ".join(words)
        out.append(line)
    return "\n".join(out) + "\n"


class Exchange(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("boxes.vs3", combined(TWO_BOXES.read_text()))

    def rows(self, *arguments, scene=None):
        self.succeed("exchange", scene or self.scene, "-o", "heat.csv", *arguments)
        with open(self.folder / "heat.csv", newline="") as file:
            return {row["name"]: {k: float(v) if v else None for k, v in row.items()
                                  if k != "name"} for row in csv.DictReader(file)}

    def test_a_box_in_a_room(self):
        """Q = σ A₁ (T₁⁴ − T₂⁴) / (1/ε₁ + A₁/A₂ (1/ε₂ − 1)); closure is enforced, so that only the
        small factor from the room to the box is not exact."""
        rows = self.rows("--temperature", "box*=400", "--temperature", "room*=20 C")
        self.assertEqual(set(rows), {"room_floor", "box_bottom"})
        Q = SIGMA * 0.96 * (400**4 - 293.15**4) / (1 / 0.2 + 0.96 / 6 * (1 / 0.9 - 1))
        self.assertAlmostEqual(rows["box_bottom"]["heat"], Q, delta=1e-3 * Q)
        self.assertAlmostEqual(rows["room_floor"]["heat"], -Q, delta=1e-3 * Q)
        self.assertAlmostEqual(rows["room_floor"]["temperature"], 293.15, places=6)

    def test_power_gives_the_temperature_back(self):
        rows = self.rows("--power", "box*=50", "--temperature", "room*=300", "--emissivity",
                         "box*=0.5")
        self.assertAlmostEqual(rows["box_bottom"]["heat"], 50, places=3)
        expected = (50 * (1 / 0.5 + 0.16 * (1 / 0.9 - 1)) / (SIGMA * 0.96) + 300**4) ** 0.25
        self.assertAlmostEqual(rows["box_bottom"]["temperature"], expected, delta=0.05)

    def test_table_of_surfaces_and_printed_balance(self):
        table = self.write("s.csv", "name,temperature,heat_flux,emissivity\n"
                                    "room_*,27 °C,,\nroom_floor,,0,0.5\n\"box_*\",77 C,,0.8\n")
        done = self.succeed("exchange", TWO_BOXES, "--surfaces", table)
        self.refuse(WRONG_USE, "would replace the input", "exchange", TWO_BOXES, "--surfaces", table,
                    "-o", table)
        lines = done.stdout.splitlines()
        self.assertEqual(len(lines), 1 + 12 + 1)
        floor = lines[1].split()
        self.assertEqual(floor[:3], ["room_floor", "1", "0.5"])
        self.assertTrue(27 < float(floor[4]) < 77)  # it reradiates
        self.assertAlmostEqual(float(floor[-1]), 0, delta=1e-3)
        self.assertRegex(lines[-1], r"balance: (\S+) W given = \1 W taken in \+ 0 W lost")

    def test_an_open_enclosure_radiates_to_its_surroundings(self):
        plate = self.write("plate.vs3", "F 3\nV 1 0 0 0\nV 2 2 0 0\nV 3 2 1 0\nV 4 0 1 0\n"
                                        "S 1 1 2 3 4 0 0 0.6 plate\nEnd\n")
        rows = self.rows("--temperature", "plate=350", "--surroundings", "-10 C", scene=plate)
        q = 0.6 * SIGMA * (350**4 - 263.15**4)
        self.assertAlmostEqual(rows["plate"]["heat"], 2 * q, delta=1e-4 * q)
        self.refuse(BAD_INPUT, "the enclosure is open, 100 % .* expected --surroundings",
                    "exchange", plate, "--temperature", "plate=350")

    def test_later_wins(self):
        table = self.write("s.csv", "name,temperature\n*,300\n")
        rows = self.rows("--surfaces", table, "--temperature", "box*=350", "--heat-flux",
                         "box*=0")
        self.assertAlmostEqual(rows["box_bottom"]["temperature"], 300, delta=1e-3)

    def test_wrong_use_and_bad_input(self):
        run = ("exchange", self.scene)
        self.refuse(WRONG_USE, "--temperature: found 'box', expected NAME=VALUE", *run,
                    "--temperature", "box")
        self.refuse(WRONG_USE, "--temperature: found 'warm', expected a temperature", *run,
                    "--temperature", "box*=warm")
        self.refuse(WRONG_USE, "found '-300 C', expected a temp", *run, "--temperature",
                    "box*=-300 C")
        self.refuse(WRONG_USE, "found '1.5', expected an emissivity", *run, "--emissivity",
                    "box*=1.5")
        self.refuse(WRONG_USE, "no surface is called 'rom_floor', did you mean 'room_floor'",
                    *run, "--temperature", "rom_floor=3")
        self.refuse(BAD_INPUT, "'room_floor' has neither", *run, "--temperature", "box*=300")
        self.refuse(BAD_INPUT, "level of the others is not determined", *run, "--heat-flux", "*=0")
        self.refuse(COULD_NOT_FINISH, "cannot write", *run, "--temperature", "*=300", "-o",
                    "none/heat.csv")
        for text, message in (
                ("", r"s\.csv:1:1: found nothing"),
                ("name,colour\n", r"s\.csv:1:6: found a column 'colour', expected a header"),
                ("temperature\n", r"s\.csv:1:1: found no column 'name'"),
                ("name,temperature\nbox*\n", r"s\.csv:2:1: found 1 columns, expected 2"),
                ("name,temperature\nbox*,hot\n", r"s\.csv:2:6: found 'hot', expected a temp"),
                ("name,temperature\n\nbax,3\n", r"s\.csv:3:5: no surface is called 'bax'")):
            with self.subTest(text=text):
                self.refuse(BAD_INPUT, message, *run, "--surfaces", self.write("s.csv", text))
        self.refuse(BAD_INPUT, r"none\.csv: cannot be read", *run, "--surfaces", "none.csv")

    def test_quiet(self):
        done = self.succeed("exchange", self.scene, "--temperature", "*=300", "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))


if __name__ == "__main__":
    unittest.main()
