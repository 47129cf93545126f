# SPDX-License-Identifier: Apache-2.0
"""The tree keeps the rules of the house, and each rule notices a tree that does not."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import house

ROOT = Path(os.environ.get("EXITANCE_SOURCE_DIR", Path(__file__).resolve().parents[2]))
SPDX = "// SPDX-License-Identifier: Apache-2.0\n"


class TheTree(unittest.TestCase):
    def test_keeps_every_rule(self):
        for rule in house.RULES:
            with self.subTest(rule=rule.__name__):
                offences = rule(ROOT)
                self.assertEqual(offences, [], "\n" + "\n".join(offences))

    def test_is_looked_at(self):
        self.assertEqual(house.stage_order(ROOT)[:3], ["math", "run", "scene"])
        self.assertGreater(len(house.library(ROOT)), 20)


class TheRules(unittest.TestCase):
    """Each on a small tree with one offence planted."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.write("src/exitance/CMakeLists.txt",
                   "# SPDX-License-Identifier: Apache-2.0\n"
                   "exitance_stage(math)\nexitance_stage(run)\nexitance_stage(scene)\n"
                   "exitance_stage(mesh)\n")
        self.write("src/exitance/scene/scene.cpp", SPDX +
                   '#include "exitance/run/error.h"\n'
                   '// printf("no") and exit(1) in a comment\n'
                   'const char* text = "printf(stderr)"; int code = error.exit_code();\n')
        self.write("src/exitance/pipeline.cpp", SPDX + "Solution light(const Scene&) {\n}\n")
        for rule in house.RULES:
            self.assertEqual(rule(self.root), [], rule.__name__)

    def write(self, path, text):
        full = self.root / path
        full.parent.mkdir(parents=True, exist_ok=True)
        full.write_text(text, encoding="utf-8")

    def expect(self, rule, *offences):
        self.assertEqual(rule(self.root), list(offences))

    def test_include_to_the_right(self):
        self.write("src/exitance/scene/bad.cpp", SPDX + '#include "exitance/mesh/mesh.h"\n')
        self.expect(house.includes_to_the_right,
                    "src/exitance/scene/bad.cpp:2: scene may not include exitance/mesh/mesh.h")

    def test_run_knows_no_light(self):
        self.write("src/exitance/run/bad.h", SPDX + '#include "exitance/scene/scene.h"\n')
        self.expect(house.includes_to_the_right,
                    "src/exitance/run/bad.h:2: run may not include exitance/scene/scene.h")

    def test_relative_include(self):
        self.write("src/exitance/mesh/bad.cpp", SPDX + '#include "../scene/scene.h"\n')
        self.assertEqual(len(house.includes_to_the_right(self.root)), 1)

    def test_pipeline_in_a_stage(self):
        self.write("src/exitance/mesh/bad.cpp", SPDX + '#include "exitance/pipeline.h"\n')
        self.assertEqual(len(house.includes_to_the_right(self.root)), 1)

    def test_folder_that_is_no_stage(self):
        self.write("src/exitance/extra/bad.cpp", SPDX)
        self.assertEqual(len(house.includes_to_the_right(self.root)), 1)

    def test_heavy_header(self):
        self.write("src/exitance/scene/bad.h", SPDX + "#include <nlohmann/json.hpp>\n")
        self.write("src/exitance/scene/good.h", SPDX + "#include <nlohmann/json_fwd.hpp>\n")
        self.write("src/exitance/scene/user.cpp", SPDX + '#include "exitance/scene/bad.h"\n')
        self.expect(house.heavy_headers)
        for user in ("src/exitance/scene/user.h", "src/exitance/mesh/user.cpp"):
            self.write(user, SPDX + '#include "exitance/scene/bad.h"\n')
            self.expect(house.heavy_headers,
                        "src/exitance/scene/bad.h:2: #include <nlohmann/json.hpp>")
            self.write(user, SPDX)

    def test_crowded_run(self):
        for i in range(house.MAX_FILES_OF_RUN + 1):
            self.write(f"src/exitance/run/part{i}.h", SPDX)
        self.assertEqual(len(house.crowded_run(self.root)), 1)

    def test_printing_and_exiting(self):
        for call in ('std::printf("x");', "std::cerr << 1;", "std::exit(1);", "abort();",
                     'std::fputs("x", stderr);', 'fmt::print("x");'):
            self.write("src/exitance/mesh/bad.cpp", SPDX + f"void f() {{ {call} }}\n")
            self.assertEqual(len(house.printing_library(self.root)), 1, call)

    def test_one_child_process_may_end(self):
        self.write(str(house.ENDS_ITS_CHILD), SPDX + "    ::_exit(sent ? 0 : 1);\n")
        self.expect(house.printing_library)
        self.write(str(house.ENDS_ITS_CHILD), SPDX + "    ::_exit(2);\n")
        self.assertEqual(len(house.printing_library(self.root)), 1)

    def test_long_pipeline(self):
        self.write("src/exitance/pipeline.cpp",
                   SPDX + "Solution light(const Scene&) {\n" + "    step();\n" * 39 + "}\n")
        self.assertEqual(len(house.long_pipeline(self.root)), 1)

    def test_missing_licence(self):
        self.write("src/exitance/mesh/bad.h", "#pragma once\n")
        self.write("scripts/bad", "#!/bin/sh\n")
        self.expect(house.licence_lines, "scripts/bad:1: no SPDX line",
                    "src/exitance/mesh/bad.h:1: no SPDX line")

    def test_registry(self):
        self.write("notes.md", "from https://registry.npm" + "js.org/x\n")
        self.write("tests/package-lock.json", '{"resolved": "somewhere"}\n')
        self.assertEqual(len(house.registry_names(self.root)), 2)

    def test_vague_name(self):
        self.write("src/exitance/mesh/util.h", SPDX)
        self.expect(house.vague_names, "src/exitance/mesh/util.h: name the concept")


if __name__ == "__main__":
    unittest.main()
