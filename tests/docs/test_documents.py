# SPDX-License-Identifier: Apache-2.0
"""The documents say what is so: their commands run, their links lead somewhere, the manual is the
one the program prints. A block that begins with ```sh run is run as it stands, in a folder of its
own that holds scenes/, with the program on the path."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
PROGRAM = Path(os.environ.get("EXITANCE_PROGRAM", ROOT / "build/bin/exitance"))
DOCUMENTS = {path: path.read_text(encoding="utf-8")
             for path in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])}
OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


def run_block(commands):
    """What the shell says to the commands in a folder of their own."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scenes").symlink_to(ROOT / "scenes")
        return subprocess.run(
            ["bash", "-eu"], input=commands, cwd=folder, text=True, capture_output=True,
            timeout=300, env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"})


class Commands(unittest.TestCase):
    def test_runnable_blocks_run(self):
        found = 0
        for document, text in DOCUMENTS.items():
            for commands in re.findall(r"^```sh run\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
                found += 1
                with self.subTest(document=document.name, commands=commands):
                    done = run_block(commands)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    self.assertNotIn("nan", done.stdout.split(","), "a probe that finds nothing")
        self.assertGreater(found, 0)

    def test_a_wrong_command_is_noticed(self):
        self.assertNotEqual(run_block("exitance slove\necho fine\n").returncode, 0)

    def test_tests_that_are_named_exist(self):
        """`Suite.Name` in the tables of formats."""
        cases = set()
        for source in ROOT.glob("tests/**/*.cpp"):
            cases.update(map(".".join, re.findall(
                r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\((\w+), (\w+)",
                source.read_text(encoding="utf-8"), re.MULTILINE)))
        named = re.findall(r"`([A-Z]\w+\.[A-Z]\w+)`", DOCUMENTS[ROOT / "docs/formats.md"])
        self.assertGreater(len(named), 20)
        self.assertEqual(set(named) - cases, set())

    def test_make_targets_that_are_named_exist(self):
        targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
        for document, text in DOCUMENTS.items():
            for target in re.findall(r"(?:`|^    |^)make ([a-z]+)", text, re.MULTILINE):
                with self.subTest(document=document.name, target=target):
                    self.assertIn(target, targets)

    def test_commands_and_options_that_are_named_exist(self):
        sections = program("manual").split("\n## exitance ")[1:]
        options = {s.split("\n")[0]: {"--help", *OPTION.findall(s)} for s in sections}
        options["COMMAND"] = {"--help"}
        lines = 0
        for document, text in DOCUMENTS.items():
            shown = re.findall(r"^\s*(?:build/bin/)?exitance (.*)$", text, re.MULTILINE)
            shown += re.findall(r"`(?:build/bin/)?exitance ([^`\n]+)`", text)
            for line in shown:
                lines += 1
                command, _, rest = line.split("#")[0].split(" >")[0].partition(" ")
                with self.subTest(document=document.name, line=line):
                    if command.startswith("-"):
                        self.assertIn(command, program("--help"))
                        continue
                    self.assertIn(command, options)
                    self.assertLessEqual(set(OPTION.findall(rest)), options[command])
        self.assertGreater(lines, 10)


class Pages(unittest.TestCase):
    def test_manual_is_what_the_program_prints(self):
        self.assertEqual(DOCUMENTS[ROOT / "docs/manual.md"], program("manual"),
                         "run: build/bin/exitance manual > docs/manual.md")

    def test_schema_is_what_the_program_prints(self):
        self.assertEqual((ROOT / "docs/project.schema.json").read_text(encoding="utf-8"),
                         program("manual", "--schema"),
                         "run: build/bin/exitance manual --schema > docs/project.schema.json")

    def test_manual_and_help_name_the_same_options(self):
        for section in program("manual").split("\n## exitance ")[1:]:
            command = section.split("\n")[0]
            shown = program(command, "--help")
            with self.subTest(command=command):
                self.assertEqual(set(OPTION.findall(shown.split("Example")[0])) - {"-h", "--help"},
                                 set(OPTION.findall(section.split("Example")[0])))

    def test_links_lead_somewhere(self):
        for document, text in DOCUMENTS.items():
            for link in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
                if "://" not in link:
                    with self.subTest(document=document.name, link=link):
                        self.assertTrue((document.parent / link).exists())

    def test_every_page_is_listed(self):
        listed = DOCUMENTS[ROOT / "docs/README.md"]
        for document in DOCUMENTS:
            if document.parent != ROOT and document.name != "README.md":
                name = document.relative_to(ROOT / "docs")
                with self.subTest(page=name):
                    self.assertIn(f"({name})", listed)

    def test_readme_fits_two_screens(self):
        self.assertLessEqual(len(DOCUMENTS[ROOT / "README.md"].splitlines()), 120)


if __name__ == "__main__":
    unittest.main()
