# SPDX-License-Identifier: Apache-2.0
"""exitance solve: what it prints, writes and refuses."""
import fcntl
import json
import os
import pty
import signal
import struct
import termios
import time
import unittest

from program import (BAD_INPUT, COULD_NOT_FINISH, PROGRAM, ROOT, WRONG_USE, ProgramTest, box, extras,
                     glb_json)

QUICK = ("--error", "0.2")
LONG = ("--unshot", "0", "--no-adaptive")
SHOTS_OF_LONG = 2500  # at least: each of so many patches once, a matter of milliseconds each


class Solve(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("box.geom", box())
        self.output = self.folder / "box.glb"

    def solve(self, *arguments, **more):
        return self.succeed("solve", self.scene, "-o", self.output, *arguments, **more)

    def test_says_where_the_light_went(self):
        done = self.solve(*QUICK)
        self.assertEqual(done.stderr, "")
        self.assertRegex(done.stdout, r"box\.glb: \d+ vertices, \d+ triangles, light groups: ")
        self.assertRegex(done.stdout, r"energy .* emitted = .* absorbed .* escaped .* unshot")
        self.assertNotRegex(done.stdout, "\\+ -")
        self.assertRegex(done.stdout, r"error .* % ± .* % \(RMS of irradiance")
        self.assertRegex(done.stdout, r"work +[0-9.]+ [kMG]? ?rays, .* s\n")
        # A lamp of 0.2 m × 0.2 m and 10 per square metre.
        self.assertRegex(done.stdout, r"energy +0\.4 emitted")
        self.assertEqual(os.listdir(self.folder).count("box.glb"), 1)
        self.assertEqual(len(os.listdir(self.folder)), 2)

    def test_a_balance_that_is_far_off_is_a_warning(self):
        # An even lamp over a black floor of 4 m: half of its light lands within a spot of its height.
        project = """[[material]]
name = "black"
reflectance = 0
[[polygon]]
material = "black"
corners = [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]]
[[luminaire]]
name = "lamp"
shape = "point"
lumens = 1000
position = [0, HEIGHT, 0]
"""
        for height, off in ("0.0005", True), ("1", False):
            scene = self.write("lamp.toml", project.replace("HEIGHT", height))
            said = self.succeed("solve", scene, "-o", "lamp.glb", *QUICK, "--solver",
                                "shooting").stdout
            self.assertEqual("  warning the light that arrived is " in said, off, said)
            self.assertEqual("shines through it" in self.succeed("info", scene).stdout, off)

    def test_quiet(self):
        done = self.solve(*QUICK, "--quiet")
        self.assertEqual(done.stdout + done.stderr, "")
        self.assertTrue(glb_json(self.output)["meshes"])

    def test_solvers_of_elements(self):
        for solver in ("jacobi", "gauss-seidel", "southwell", "krylov", "stochastic"):
            self.solve("--error", "0.1", "--solver", solver, "--vertices", "average")
            used = extras(self.output)["options"]
            self.assertEqual((used["solver"], used["vertices"]), (solver, "average"))
            self.assertGreater(extras(self.output)["counters"]["rows"], 10)

    def test_a_transport_alone_takes_a_solver_and_says_which(self):
        for transport in ("dense", "sparse", "links", "stochastic"):
            done = self.solve("--error", "0.3", "--transport", transport)
            self.assertEqual(done.stderr, f"note: --transport {transport} is solved by --solver "
                                          "jacobi, for none was asked for\n")
            used = extras(self.output)["options"]
            self.assertEqual((used["solver"], used["transport"]), ("jacobi", transport))
        for more in ("--quiet",), ("--solver", "jacobi"):
            self.assertEqual(self.solve(*QUICK, "--transport", "links", *more).stderr, "")
        self.assertEqual(self.solve(*QUICK, "--transport", "on-the-fly").stderr, "")
        self.assertEqual(extras(self.output)["options"]["solver"], "gathering")

    def two_plates(self, *arguments):
        """Rows of the log: sweep, residual, unshot, seconds, B of ceiling and floor."""
        scene = ROOT / "scenes/two_plates.toml"
        done = self.succeed("solve", scene, "--log", "csv", *arguments)
        head, *lines = done.stdout.splitlines()
        self.assertEqual(head, "sweep,residual,unshot,seconds,B1,B2")
        return [[float(field or "nan") for field in line.split(",")] for line in lines]

    def test_two_plates_step_by_step(self):
        # B1 = 12 + B2 / 4, B2 = B1 / 6: F = 1/3 to the seven digits of the plates' distance.
        ceiling, floor = 12, 0
        for row in self.two_plates("--solver", "jacobi"):
            ceiling, floor = 12 + floor / 4, ceiling / 6
            self.assertAlmostEqual(row[4], ceiling, delta=1e-4)
            self.assertAlmostEqual(row[5], floor, delta=1e-4)
        self.assertEqual([f"{b:.4f}" for b in row[4:6]], ["12.5217", "2.0870"])
        for solver in ("jacobi", "gauss-seidel", "southwell", "krylov", "stochastic"):
            for transport in ("dense", "sparse"):
                last = self.two_plates("--solver", solver, "--transport", transport, "--unshot",
                                       "1e-7")[-1]
                self.assertAlmostEqual(last[4], 12 / (1 - 1 / 24), delta=1e-4, msg=solver)
                self.assertAlmostEqual(last[5], 2 / (1 - 1 / 24), delta=1e-4, msg=solver)

    def test_compare(self):
        done = self.succeed("solve", self.scene, "--compare", "--error", "0.2", "--transport",
                            "sparse")
        head, *lines = done.stdout.splitlines()
        self.assertRegex(head, "solver +transport +sweeps +rays +CPU s +residual +error % +RMS diff % +MB")
        self.assertEqual([line.split()[:2] for line in lines],
                         [[name, "sparse"] for name in
                          ("jacobi", "gauss-seidel", "southwell", "krylov", "stochastic")])
        for line in lines:  # 20 % is asked for; all five solve the same matrix
            self.assertLess(float(line.split()[-2]), 5, line)
        both = self.succeed("solve", self.scene, "--compare", "--error", "0.2", "--transport",
                            "links", "--solver", "jacobi").stdout.splitlines()[1:]
        self.assertEqual(len(both), 4)
        for line in both:  # against the matrix now, at 20 % each
            self.assertLess(float(line.split()[-2]), 20, line)
        rays = self.succeed("solve", self.scene, "--compare", "--error", "0.2", "--transport",
                            "stochastic").stdout.splitlines()[1:]
        self.assertEqual([line.split()[0] for line in rays], ["jacobi", "stochastic"])
        self.refuse(WRONG_USE, "--compare prints", "solve", self.scene, "--compare", "-o", "x.glb")

    def test_output_is_needed_without_a_table(self):
        self.refuse(WRONG_USE, "--output is required", "solve", self.scene)

    def test_refuses_what_cannot_be_had_together(self):
        output = ("-o", self.output)
        for message, *arguments in (
                (r"--transport links cannot .* gathering, .* expected --solver jacobi, gauss-seidel, "
                 "southwell or krylov", "--transport", "links", "--solver", "gathering"),
                (r"--transport stochastic cannot .* shooting, .* expected --solver jacobi or "
                 "stochastic", "--transport", "stochastic", "--solver", "shooting"),
                (r"--memory cannot .* jacobi \(for --transport links\), .* gathering",
                 "--transport", "links", "--memory", "500"),
                (r"--no-occlusion cannot .* jacobi \(for --transport dense\): .* shooting",
                 "--transport", "dense", "--no-occlusion"),
                (r"--vertices cannot .* gathering, .* expected .* jacobi", "--vertices", "gather"),
                (r"--element-rays cannot .* gathering", "--element-rays", "64"),
                (r"--factors cannot .* gathering", "--factors", "pairs"),
                (r"--factors pairs cannot .* --transport on-the-fly; expected hemisphere",
                 "--solver", "jacobi", "--transport", "on-the-fly", "--factors", "pairs"),
                (r"--min-area cannot .* krylov: .* expected --element-size",
                 "--solver", "krylov", "--min-area", "0.01"),
                (r"--transport stochastic cannot .* krylov, .* expected --solver jacobi or stochastic",
                 "--solver", "krylov", "--transport", "stochastic"),
                (r"--transport links cannot .* stochastic: a sample .* expected --solver jacobi, .*krylov",
                 "--solver", "stochastic", "--transport", "links"),
                (r"--factors cannot .* links, which has no matrix; expected dense or sparse",
                 "--solver", "jacobi", "--transport", "links", "--factors", "pairs"),
                (r"--next-shot cannot .* jacobi.* expected --unshot",
                 "--solver", "jacobi", "--next-shot", "0.01"),
                (r"--no-occlusion cannot .* jacobi: rays", "--solver", "jacobi", "--no-occlusion"),
                (r"--form-factor disk cannot .* jacobi", "--solver", "jacobi", "--form-factor",
                 "disk"),
                (r"--transport dense: a matrix of \d+ elements takes [\d.]+ GiB, expected at most 4",
                 "--solver", "jacobi", "--transport", "dense", "--element-size", "0.008"),
                (r"--solver: 'jakobi' is not allowed, expected one of gathering, shooting, jacobi",
                 "--solver", "jakobi")):
            self.refuse(WRONG_USE, message, "solve", self.scene, *output, *arguments)

    def test_refined_for_a_camera_or_a_grid(self):
        scene = self.write("cornell.toml", (ROOT / "scenes/cornell.toml").read_text())
        solve = ("solve", "-o", self.output, *QUICK, "--solver", "gathering", scene)
        said = self.succeed(*solve, "--view", "front").stdout
        self.assertIn("refined for what camera 'front' sees: rough elsewhere, not view-independent",
                      said)
        self.assertRegex(said, r"held-out points chosen for what camera 'front' sees\)")
        self.assertEqual(extras(self.output)["refined_for"], {"camera": "front"})
        self.succeed(*solve, "--view", "front", "--grid", "back wall")
        told = self.succeed("info", self.output).stdout
        self.assertIn("Refined for what camera 'front' sees and grid 'back wall': rough", told)
        facts = json.loads(self.succeed("info", "--json", self.output).stdout)
        self.assertEqual(facts["refined_for"], {"camera": "front", "grid": "back wall"})
        self.succeed(*solve)
        self.assertNotIn("refined_for", extras(self.output))
        self.assertNotIn("Refined", self.succeed("info", self.output).stdout)
        for message, *arguments in (
                ("no camera 'frnt', did you mean 'front'", "--view", "frnt"),
                ("no grid 'wall'.*; there are: floor, back wall", "--grid", "wall"),
                ("--grid floor cannot .* shooting, .* expected --solver gathering",
                 "--grid", "floor", "--solver", "shooting"),
                ("--no-open goes with --view alone", "--view", "front", "--no-open")):
            wrong = [a for a in solve if "--solver" not in arguments or
                     a not in ("--solver", "gathering")]
            self.refuse(WRONG_USE, message, *wrong, *arguments)

    def test_json_log(self):
        done = self.solve(*QUICK, "--log", "json")
        steps = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertGreater(len(steps), 2)
        for step in steps:
            self.assertLessEqual({"phase", "seconds", "fraction_left", "shots", "rays", "vertices"},
                                 set(step))
        for name in ("seconds", "shots", "rays"):
            values = [step[name] for step in steps]
            self.assertEqual(values, sorted(values), name)
        self.assertTrue(all(0 <= step["fraction_left"] <= 1 for step in steps))

    def test_bar_on_a_terminal(self):
        master, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 25, 60, 0, 0))
        pid = os.fork()
        if pid == 0:
            os.dup2(terminal, 2)
            os.close(1)
            os.execv(PROGRAM, [PROGRAM, "solve", str(self.scene), "-o", str(self.output), *QUICK])
        os.close(terminal)
        shown = b""
        try:
            while piece := os.read(master, 4096):
                shown += piece
        except OSError:  # the other end is closed
            pass
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), 0)
        frames = shown.decode().split("\r")
        bars = [f for f in frames if "█" in f or "─" in f]
        self.assertTrue(bars, frames)
        for bar in bars:
            self.assertLess(len(bar.removesuffix("\x1b[K")), 60)
        self.assertEqual(frames[-1], "\x1b[K", "the bar is removed at the end")

    def test_threads_do_not_change_a_byte(self):
        files = []
        for threads in (1, 2):
            self.output = self.folder / f"{threads}.glb"
            self.solve(*QUICK, "--quiet", "--threads", threads)
            files.append(self.output.read_bytes())
        self.assertEqual(files[0], files[1])

    def test_seed_changes_the_samples(self):
        files = []
        for seed in (1, 2):
            self.output = self.folder / f"{seed}.glb"
            self.solve(*QUICK, "--quiet", "--seed", seed)
            files.append(self.output.read_bytes())
        self.assertNotEqual(files[0], files[1])

    def test_interrupt_keeps_what_is_solved(self):
        self.write("box.geom", box(patches=SHOTS_OF_LONG // 6))
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                process = self.start("solve", self.scene, "-o", self.output, *LONG, "--log", "json")
                while json.loads(process.stderr.readline())["shots"] < 1:
                    pass
                process.send_signal(number)
                out, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 0, err)
                self.assertIn("stopped early", out)
                self.assertGreater(extras(self.output)["energy"]["unshot"], 0)
                self.succeed("info", self.output)
                self.output.unlink()

    def test_interrupt_is_heard_at_once(self):
        self.write("box.geom", box(patches=SHOTS_OF_LONG // 6))
        heard = "exitance: stopping, to keep what is solved; again to quit at once\n"
        for arguments, lines in ((), (heard,)), (("--quiet",), ()):
            with self.subTest(arguments=arguments):
                process = self.start("solve", self.scene, "-o", self.output, *LONG, *arguments)
                time.sleep(0.3)  # reading is done in a hundredth; if not, it would end at once
                process.send_signal(signal.SIGINT)
                out, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 0, err)
                self.assertEqual(err.splitlines(keepends=True), list(lines))
                self.output.unlink()

    def test_a_second_interrupt_writes_nothing(self):
        # A scene of which one step takes longer than it takes to send two signals.
        self.write("box.geom", box(patches=40_000))
        process = self.start("solve", self.scene, "-o", self.output, "--error", "0.01", "--solver",
                             "jacobi", "--transport", "sparse", "--element-size", "0.005")
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(err, "exitance: quit at once, nothing was written\n")
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertFalse(self.output.exists())

    def test_time_limit(self):
        self.write("box.geom", box(patches=SHOTS_OF_LONG // 6))
        done = self.solve(*LONG, "--time", "0.5", "--log", "json")
        last = json.loads(done.stderr.splitlines()[-1])
        self.assertLess(last["seconds"], 10)  # a shot and the bookkeeping after it, amply
        self.succeed("info", self.output)

    def test_settings_of_a_project(self):
        project = self.write("box.toml", 'title = "box"\n\n[[geometry]]\nfile = "box.geom"\n\n'
                                         "[solve]\nerror = 0.25\nadaptive = false\n")
        self.succeed("solve", project, "-o", self.output)
        self.assertEqual(float(extras(self.output)["options"]["error"]), 0.25)
        self.assertEqual(extras(self.output)["options"]["adaptive"], "false")
        self.succeed("solve", project, "-o", self.output, "--error", "0.3", "--adaptive")
        self.assertEqual(float(extras(self.output)["options"]["error"]), 0.3)
        self.assertEqual(extras(self.output)["options"]["adaptive"], "true")

    def test_wrong_setting_of_a_project(self):
        for line, message in [("eror = 0.1", r"box\.toml:5:\d+: .*'eror', did you mean 'error'"),
                              ("error = 7", r"box\.toml:5:\d+: .*'7'.* 0\.0001 … 1")]:
            project = self.write("box.toml", '[[geometry]]\nfile = "box.geom"\n\n[solve]\n' + line)
            self.refuse(BAD_INPUT, message, "solve", project, "-o", self.output)

    def test_bad_scenes(self):
        good = box()
        for name, text, message in [
                ("missing.geom", None, "missing.geom: "),
                ("empty.geom", "", r"empty\.geom"),
                ("folder.geom", "folder", r"folder\.geom"),
                ("cut.geom", good[:len(good) // 2], r"cut\.geom:\d+:\d+: "),
                ("nan.geom", good.replace("0.05", "nan", 1).replace("0.4", "nan", 1),
                 r"nan\.geom:\d+:\d+: .*nan"),
                ("many.geom", good.replace("patches 7", "patches 4000000000"),
                 r"many\.geom:\d+:\d+: "),
                ("index.geom", good.replace("4 1 3 4 2", "4 1 3 4 99"), r"index\.geom:\d+:\d+: .*99"),
                ("bright.geom", good.replace("color 0.5", "color 1.5", 1),
                 r"bright\.geom:\d+:\d+: .*1\.5"),
                ("binary.glb", bytes(range(256)) * 4, r"binary\.glb"),
                ("noise.toml", "= = =\n", r"noise\.toml:1:\d+: "),
        ]:
            with self.subTest(scene=name):
                if text == "folder":
                    (self.folder / name).mkdir()
                elif text is not None:
                    self.write(name, text)
                self.refuse(BAD_INPUT, message, "solve", name, "-o", self.output)

    def test_output_that_cannot_be_written(self):
        for output, code, message in [
                ("nowhere/box.glb", COULD_NOT_FINISH, "cannot write nowhere/box.glb"),
                (".", WRONG_USE, "ends in .glb"),
                ("box.png", WRONG_USE, r"'box\.png' .* ends in \.glb"),
                ("/dev/full", COULD_NOT_FINISH, "cannot write /dev/full: No space left on device"),
        ]:
            with self.subTest(output=output):
                self.refuse(code, message, "solve", self.scene, "-o", output, *QUICK)
        self.assertTrue(os.path.exists("/dev/full"))
        (self.folder / "folder.glb").mkdir()
        self.refuse(COULD_NOT_FINISH, "cannot write folder.glb: Is a directory", "solve",
                    self.scene, "-o", "folder.glb")

    def test_read_only_folder(self):
        locked = self.folder / "locked"
        locked.mkdir()
        locked.chmod(0o555)
        self.folder.chmod(0o755)
        # Root may write anywhere: try it as nobody.
        nobody = {"user": 65534, "group": 65534} if os.getuid() == 0 else {}
        self.refuse(COULD_NOT_FINISH, "cannot write .*Permission denied", "solve", self.scene, "-o",
                    locked / "box.glb", **nobody)

    def test_output_would_replace_the_input(self):
        self.solve(*QUICK)
        self.refuse(WRONG_USE, "would replace the input", "solve", self.output, "-o", self.output)

    def test_refused_before_the_work(self):
        # The work would not end before the test's patience does.
        self.write("box.geom", box(patches=SHOTS_OF_LONG // 6))
        self.refuse(COULD_NOT_FINISH, "cannot write", "solve", self.scene, "-o", "nowhere/x.glb",
                    *LONG)

    def test_earlier_output_survives_a_failure(self):
        self.solve(*QUICK)
        before = self.output.read_bytes()
        self.write("cut.geom", box()[:200])
        self.refuse(BAD_INPUT, "cut.geom", "solve", "cut.geom", "-o", self.output)
        self.assertEqual(self.output.read_bytes(), before)

    def test_out_of_memory(self):
        import resource

        def little_memory():
            resource.setrlimit(resource.RLIMIT_DATA, (300 << 20, 300 << 20))

        # Nearly two million patches, above 200 bytes each with their elements and vertices.
        self.write("box.geom", box(patches=250000))
        self.refuse(COULD_NOT_FINISH, "memory", "solve", self.scene, "-o", self.output,
                    preexec_fn=little_memory)

    def test_unlit_scene(self):
        dark = self.write("dark.geom", box(lamp=False))
        done = self.run_program("solve", dark, "-o", self.output, *QUICK)
        self.assertIn(done.returncode, (0, BAD_INPUT))
        self.assertRegex(done.stdout + done.stderr, "nothing is emitted|unlit|no light|emit")


if __name__ == "__main__":
    unittest.main()
