# SPDX-License-Identifier: Apache-2.0
"""exitance view from outside: what its server gives to a page of its own, and what it refuses."""
import base64
import http.client
import json
import re
import signal
import socket
import struct
import time
import unittest
from pathlib import Path
from urllib.parse import urlsplit

from program import BAD_INPUT, COULD_NOT_FINISH, WRONG_USE, ProgramTest, box, extras, glb_json


GRID = """quantity = "photometric"
[[material]]
name = "lamp"
exitance = 100
[[material]]
name = "grey"
reflectance = 0.5
[[polygon]]
material = "lamp"
corners = [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]]
[[polygon]]
material = "grey"
corners = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]
[[grid]]
name = "few"
origin = [0, 0, 0]
u = [1, 0, 0]
v = [0, 0, 1]
normal = [0, 1, 0]
columns = 2
rows = 1
[[grid]]
name = "many"
origin = [0, 0, 0]
u = [1, 0, 0]
v = [0, 0, 1]
normal = [0, 1, 0]
columns = 200
rows = 200
"""


class Viewing(ProgramTest):
    """A server with a solved box."""

    def setUp(self):
        super().setUp()
        self.write("box.geom", box())
        self.succeed("solve", "box.geom", "-o", "box.glb", "--error", "0.3", "--quiet")

    def view(self, *arguments):
        return self.serve("view", *arguments, "--no-open", "--quiet")

    def serve(self, *arguments):
        process = self.start(*arguments)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        address = urlsplit(process.stdout.readline().strip())
        self.assertEqual(address.hostname, "127.0.0.1")
        self.assertRegex(address.path, r"^/[0-9a-f]{32}/$")
        self.port, self.base = address.port, address.path
        return process

    def ask(self, path, method="GET", body=None, **headers):
        """Status, headers and content of what is below the token's path."""
        return self.ask_exactly(self.base + path, method, body, **headers)

    def ask_exactly(self, path, method="GET", body=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        self.addCleanup(connection.close)
        connection.request(method, path, body,
                           {name.replace("_", "-"): value for name, value in headers.items()})
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()

    def listen(self):
        """An open page: its stream of events."""
        page = socket.create_connection(("127.0.0.1", self.port), timeout=60)
        self.addCleanup(page.close)
        page.sendall(f"GET {self.base}events HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n"
                     .encode())
        return page

    def ends(self, process, within=30):
        process.wait(timeout=within)
        return process.returncode


class Served(Viewing):
    def test_page_and_solution_come_with_a_strict_policy(self):
        self.view("box.glb")
        for path, kind in [("", "text/html; charset=utf-8"),
                           ("index.html", "text/html; charset=utf-8"),
                           ("viewer.js", "text/javascript; charset=utf-8"),
                           ("viewer.css", "text/css; charset=utf-8"),
                           ("solution.glb", "model/gltf-binary")]:
            with self.subTest(path=path):
                status, headers, content = self.ask(path)
                self.assertEqual((status, headers["Content-Type"]), (200, kind))
                self.assertGreater(len(content), 100)
                policy = dict(part.strip().split(" ", 1)
                              for part in headers["Content-Security-Policy"].split(";"))
                self.assertEqual(policy["default-src"], "'none'")
                self.assertEqual(policy["script-src"], "'self'")
                self.assertEqual(policy["connect-src"], "'self'")
                self.assertEqual(policy["frame-ancestors"], "'none'")
                self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
                self.assertEqual(headers["Referrer-Policy"], "no-referrer")
                self.assertNotIn("Access-Control-Allow-Origin", headers)
        self.assertEqual(self.ask("solution.glb")[2], (self.folder / "box.glb").read_bytes())

    def test_the_address_without_its_last_slash_leads_to_the_one_with_it(self):
        self.view("box.glb")
        for method in ["GET", "HEAD"]:
            status, headers, _ = self.ask_exactly(self.base[:-1], method)
            self.assertEqual((status, headers["Location"]), (308, self.base))
        self.assertEqual(self.ask_exactly(self.base[:-1], "POST", "{}")[0], 404)

    def test_page_names_no_other_place(self):
        self.view("box.glb")
        page = self.ask("")[2].decode()
        self.assertEqual(re.findall(r"""(?:src|href)=["']?(?:https?:)?//""", page), [])

    def test_solution_outlives_its_name(self):
        self.view("box.glb")
        held = (self.folder / "box.glb").read_bytes()
        (self.folder / "box.glb").unlink()
        self.assertEqual(self.ask("solution.glb")[2], held)

    def test_own_page_may_ask(self):
        self.view("box.glb")
        status, _, _ = self.ask("solution.glb", Origin=f"http://127.0.0.1:{self.port}",
                                Sec_Fetch_Site="same-origin")
        self.assertEqual(status, 200)
        self.assertEqual(self.ask("", Host=f"localhost:{self.port}")[0], 200)

    def test_port_and_the_two_who_want_it(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            free = probe.getsockname()[1]
        self.view("box.glb", "--port", free)
        self.assertEqual(self.port, free)
        self.refuse(COULD_NOT_FINISH, f"port {free} cannot be had", "view", "box.glb", "--no-open",
                    "--port", free)


class Grids(Viewing):
    def test_readings_of_every_group(self):
        self.write("room.toml", GRID)
        self.succeed("solve", "room.toml", "-o", "room.glb", "--error", "0.3", "--quiet")
        self.view("room.glb")
        status, headers, content = self.ask("grids.json")
        self.assertEqual((status, headers["Content-Type"]), (200, "application/json"))
        few, many = json.loads(content)
        self.assertIsNone(many, "more sensors than a page wants")
        self.assertEqual(len(few), 2 * 3)
        self.write("points.csv", "x,y,z,nx,ny,nz\n0.25,0,0.5,0,1,0\n0.75,0,0.5,0,1,0\n")
        probed = self.succeed("probe", "room.glb", "--points", "points.csv", "-o", "-").stdout
        for k, line in enumerate(probed.splitlines()[1:]):
            for mine, theirs in zip(few[3 * k:3 * k + 3], map(float, line.split(",")[6:])):
                self.assertAlmostEqual(mine, theirs, delta=1e-4 * theirs)

    def test_none(self):
        self.view("box.glb")
        self.assertEqual(self.ask("grids.json")[2], b"[]")


class Refused(Viewing):
    def test_other_hosts(self):
        """A name of elsewhere that leads to this machine (DNS rebinding)."""
        self.view("box.glb")
        for host in ["example.org", f"example.org:{self.port}", "127.0.0.1", "127.0.0.1:1",
                     f"127.0.0.1:{self.port}.example.org", f"[::1]:{self.port}", ""]:
            with self.subTest(host=host):
                self.assertEqual(self.ask("solution.glb", Host=host)[0], 421)

    def test_other_origins_and_sites(self):
        self.view("box.glb")
        for origin in ["http://example.org", "null", f"https://127.0.0.1:{self.port}",
                       "http://127.0.0.1:1", f"http://127.0.0.1:{self.port}@example.org"]:
            with self.subTest(origin=origin):
                self.assertEqual(self.ask("solution.glb", Origin=origin)[0], 403)
                self.assertEqual(self.ask("command", "POST", '{"command": "stop"}',
                                          Origin=origin)[0], 403)
        for site in ["cross-site", "same-site"]:
            self.assertEqual(self.ask("solution.glb", Sec_Fetch_Site=site)[0], 403)

    def test_paths_without_the_token(self):
        self.view("box.glb")
        wrong = "0" * 32 if self.base != "/" + "0" * 32 + "/" else "1" * 32
        for path in ["/", "/solution.glb", "/index.html", f"/{wrong}/solution.glb",
                     self.base[:-2] + "/solution.glb", self.base[:-2], self.base[:-1] + "x",
                     "//" + self.base]:
            with self.subTest(path=path):
                self.assertEqual(self.ask_exactly(path)[0], 404)

    def test_paths_outside_the_page(self):
        self.view("box.glb")
        for path in ["box.glb", "../box.glb", "%2e%2e/box.geom", "..%2f..%2fetc/passwd",
                     "/etc/passwd", "viewer.js/../../box.geom", "solution_glb", "viewerxjs",
                     "index.html%00.js", "%2fetc%2fpasswd"]:
            with self.subTest(path=path):
                self.assertEqual(self.ask(path)[0], 404)

    def test_other_methods(self):
        self.view("box.glb")
        for method in ["PUT", "DELETE", "PATCH", "OPTIONS"]:
            with self.subTest(method=method):
                self.assertEqual(self.ask("solution.glb", method)[0], 405)
        self.assertEqual(self.ask("solution.glb", "POST", "{}")[0], 404)

    def test_oversized_requests(self):
        self.view("box.glb")
        self.assertEqual(self.ask("command", "POST", "x" * 2000)[0], 413)
        self.assertEqual(self.ask("x" * 10000)[0], 414)
        self.assertNotEqual(self.ask("", Cookie="x" * 20000)[0], 200)
        self.assertEqual(self.ask("")[0], 200, "and still serves its page")

    def test_bodies_where_none_belongs_and_of_unannounced_length(self):
        self.view("box.glb")
        for method, path in [("GET", ""), ("HEAD", ""), ("POST", "command"), ("POST", "none")]:
            for content in ["{}", "x" * 3000]:
                with self.subTest(method=method, path=path, size=len(content)):
                    self.assertEqual(self.answers(method, self.base + path, "Transfer-Encoding: "
                                                  "chunked", f"{len(content):x}\r\n{content}\r\n"
                                                  "0\r\n\r\n"), ["413"])
                    if method != "POST":
                        self.assertEqual(self.answers(method, self.base + path, "Content-Length: "
                                                      f"{len(content)}", content), ["413"])
        self.assertEqual(self.answers("GET", self.base, "Content-Length: 0", ""), ["200"])

    def test_what_follows_a_refused_body_is_no_request(self):
        """A request hidden in the body of another one is not answered."""
        self.view("box.glb")
        hidden = f"GET {self.base} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n"
        for method, path, status in [("GET", self.base, "413"), ("POST", "/", "404")]:
            self.assertEqual(self.answers(method, path, f"Content-Length: {len(hidden)}", hidden),
                             [status])

    def answers(self, method, path, header, body):
        """The status of every answer to what is sent at once."""
        page = socket.create_connection(("127.0.0.1", self.port), timeout=20)
        self.addCleanup(page.close)
        page.sendall(f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n"
                     f"{header}\r\n\r\n{body}".encode())
        answers = b""
        try:
            while block := page.recv(65536):
                answers += block
        except ConnectionResetError:  # what was not read is thrown away
            pass
        return re.findall(r"^HTTP/1\.1 (\d+) ", answers.decode("latin-1"), re.MULTILINE)

    def test_a_body_that_is_announced_and_never_sent(self):
        self.view("box.glb")
        hung = socket.create_connection(("127.0.0.1", self.port), timeout=20)
        self.addCleanup(hung.close)
        hung.sendall(f"POST {self.base}command HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n"
                     "Content-Length: 99999999999\r\n\r\n".encode())
        self.assertEqual(self.ask("")[0], 200)
        self.assertIn(b" 413 ", hung.recv(100))

    def test_other_commands(self):
        self.view("box.glb")
        for body in ["", "{", "[]", '{"command": "rm"}', '{"command": 1}', '"stop"']:
            with self.subTest(body=body):
                self.assertEqual(self.ask("command", "POST", body)[0], 400)

    def test_other_machines(self):
        """Only the loopback is listened on."""
        self.view("box.glb")
        table = Path("/proc/net/tcp").read_text(encoding="ascii").split("\n")[1:]
        listening = [line.split()[1] for line in table if line and line.split()[3] == "0A"]
        ours = [place for place in listening if int(place.split(":")[1], 16) == self.port]
        self.assertEqual([place.split(":")[0] for place in ours], ["0100007F"])


class Ends(Viewing):
    def test_with_ctrl_c(self):
        process = self.view("box.glb")
        self.listen()
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.ends(process), 0)

    def test_when_the_last_page_closes(self):
        process = self.view("box.glb")
        first, second = self.listen(), self.listen()
        self.assertIn(b"200 OK", first.recv(4096))
        first.close()
        time.sleep(4.5)
        self.assertIsNone(process.poll(), "one page is still open")
        second.close()
        self.assertEqual(self.ends(process), 0)

    def test_not_when_it_is_to_stay(self):
        process = self.view("box.glb", "--keep")
        page = self.listen()
        self.assertIn(b"200 OK", page.recv(4096))
        page.close()
        time.sleep(4.5)
        self.assertIsNone(process.poll())
        self.assertEqual(self.ask("")[0], 200)


class Live(Viewing):
    def events(self, page):
        """Yields (event, data) until the stream ends."""
        text = b""
        while block := page.recv(65536):
            text += block
            *whole, text = text.split(b"\n\n")
            for event in whole:
                found = re.search(rb"event: (\w+)\ndata: (.*)$", event)
                if found:
                    yield found[1].decode(), json.loads(found[2])

    def test_scene_is_lit_while_pages_watch(self):
        """Pause keeps it, resume goes on, stop keeps what there is."""
        self.write("room.geom", box(patches=8))
        process = self.view("room.geom", "-o", "room.glb", "--error", "0.003")
        phases, solutions = [], 0
        for event, data in self.events(self.listen()):
            if event == "solution":
                solutions = data
                status, _, content = self.ask("solution.glb")
                self.assertEqual(status, 200)
                self.write("seen.glb", content)
                self.assertIn("_EXITANCE_0",
                              glb_json(self.folder / "seen.glb")["meshes"][0]["primitives"][0]
                              ["attributes"])
                if solutions == 2:
                    self.assertEqual(self.ask("command", "POST", '{"command": "pause"}')[0], 204)
            else:
                phases.append(data["phase"])
                if data["paused"]:
                    rays = data["rays"]
                    time.sleep(0.5)
                    self.assertEqual(self.ask("command", "POST", '{"command": "resume"}')[0], 204)
                elif solutions >= 3:
                    self.assertGreater(data["rays"], rays) if data["phase"] != "done" else None
                    self.assertEqual(self.ask("command", "POST", '{"command": "stop"}')[0], 204)
                if data["phase"] == "done":
                    break
        self.assertGreaterEqual(solutions, 3)
        self.assertEqual(self.ask("solution.glb")[2], (self.folder / "room.glb").read_bytes())
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.ends(process), 0)
        self.succeed("info", "room.glb")

    def test_what_changed_leads_from_each_revision_to_the_next(self):
        """What a page is told to copy and to add gives the file, byte for byte."""
        self.write("room.geom", box(patches=8))
        process = self.view("room.geom", "-o", "room.glb", "--error", "0.003")
        held, revision, sizes, page = None, 0, [], self.listen()
        for event, data in self.events(page):
            if event == "progress":
                if data["phase"] == "done":
                    break
                if len(sizes) == 4:
                    self.ask("command", "POST", '{"command": "stop"}')
            elif held is None:
                _, headers, held = self.ask("solution.glb")
                revision = int(headers["ETag"].strip('"'))
            else:
                status, _, delta = self.ask(f"delta?from={revision}")
                self.assertEqual(status, 200)
                held, revision = self.applied(held, delta)
                sizes.append((len(delta), len(held)))
        if revision != int(self.ask("solution.glb", "HEAD")[1]["ETag"].strip('"')):
            held, _ = self.applied(held, self.ask(f"delta?from={revision}")[2])
        self.assertEqual(held, (self.folder / "room.glb").read_bytes())
        self.assertGreaterEqual(len(sizes), 3)
        self.assertTrue(any(delta < 0.7 * whole for delta, whole in sizes), sizes)
        process.send_signal(signal.SIGINT)

    def applied(self, before, delta):
        magic, revision, size, pieces = struct.unpack_from("<4s3I", delta)
        self.assertEqual(magic, b"XDL1")
        new, after = 16 + 8 * pieces, bytearray()
        for k in range(pieces):
            start, length = struct.unpack_from("<2I", delta, 16 + 8 * k)
            if start == 0xffffffff:
                after += delta[new:new + length]
                new += length
            else:
                after += before[start:start + length]
        self.assertEqual((len(after), new), (size, len(delta)))
        return bytes(after), revision

    def test_revisions_that_are_gone(self):
        self.view("box.glb")
        for query in ["", "?from=", "?from=0", "?from=1", "?from=2", "?from=-1", "?from=1x",
                      "?from=99999999999999999999", "?from=../box.glb"]:
            with self.subTest(query=query):
                self.assertEqual(self.ask("delta" + query)[0], 410)

    def test_solve_is_shown_and_goes_on_when_the_page_closes(self):
        self.write("room.geom", box(patches=4))
        process = self.serve("solve", "room.geom", "-o", "room.glb", "--error", "0.02", "--view",
                             "--no-open")
        page = self.listen()
        self.assertIn(b"200 OK", page.recv(4096))
        page.close()
        said, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)
        self.assertRegex(said, r"room\.glb: \d+ vertices")
        whole = self.succeed("solve", "room.geom", "-o", "alone.glb", "--error", "0.02")
        self.assertEqual((self.folder / "room.glb").read_bytes(),
                         (self.folder / "alone.glb").read_bytes(), whole.stdout)

    def test_a_solve_that_a_page_stops_says_so(self):
        self.write("room.geom", box(patches=8))
        process = self.serve("solve", "room.geom", "-o", "room.glb", "--error", "0.003", "--view",
                             "--no-open")
        page = self.listen()
        next(self.events(page))
        self.assertEqual(self.ask("command", "POST", '{"command": "stop"}')[0], 204)
        for event, data in self.events(page):
            if event == "progress" and data["phase"] == "done":
                break
        page.close()
        said, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertIn("stopped early", said)

    def test_the_scene_after_view_is_no_camera(self):
        done = self.run_program("solve", "--view", "box.geom", "-o", "again.glb", "--error", "0.3",
                                env={"PATH": "/nowhere"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no browser could be opened", done.stderr)
        self.assertEqual((self.folder / "again.glb").read_bytes(),
                         (self.folder / "box.glb").read_bytes())

    def test_a_solve_that_nobody_can_watch_ends(self):
        """No browser, and nobody came."""
        done = self.run_program("solve", "box.geom", "-o", "again.glb", "--error", "0.3", "--view",
                                env={"PATH": "/nowhere"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no browser could be opened", done.stderr)
        self.assertEqual((self.folder / "again.glb").read_bytes(),
                         (self.folder / "box.glb").read_bytes())

    def test_ctrl_c_keeps_what_is_lit(self):
        self.write("room.geom", box(patches=8))
        process = self.view("room.geom", "-o", "room.glb", "--error", "0.003")
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.ends(process, 60), 0)
        self.succeed("info", "room.glb")


class Radview(Viewing):
    def up_of(self, *arguments):
        process = self.serve("radview", *arguments, "--no-open", "--quiet")
        page = self.listen()
        for event, data in Live.events(self, page):
            if event == "solution" or data["phase"] != "done":
                continue
            break
        self.write("seen.glb", self.ask("solution.glb")[2])
        process.send_signal(signal.SIGINT)
        self.ends(process)
        return extras(self.folder / "seen.glb")["up"]

    def test_scene(self):
        self.write("room.toml", GRID + "[solve]\nerror = 0.3\n")
        for arguments, up in [([], [0, 1, 0]), (["z"], [0, 0, 1]), (["-y"], [0, -1, 0]),
                              (["-z"], [0, 0, -1])]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.up_of("room.toml", *arguments), up)

    def test_solution(self):
        self.serve("radview", "box.glb", "-z", "--no-open", "--quiet")
        self.write("seen.glb", self.ask("solution.glb")[2])
        self.assertEqual(extras(self.folder / "seen.glb")["up"], [0, 0, -1])
        self.assertEqual(extras(self.folder / "box.glb")["up"], [0, 1, 0])
        self.serve("radview", "box.glb", "--no-open", "--quiet")
        self.assertEqual(self.ask("solution.glb")[2], (self.folder / "box.glb").read_bytes())

    def test_refusals(self):
        for message, *axis in [("up-axis: found 'x', expected y, -y, z or -z", "x"), ("excludes", "y", "-z"), ("excludes", "-y", "-z")]:
            self.refuse(WRONG_USE, message, "radview", "box.glb", *axis, "--no-open")
        self.refuse(BAD_INPUT, "none.glb", "radview", "none.glb", "--no-open")


class OnePage(Viewing):
    def test_holds_everything(self):
        self.succeed("view", "box.glb", "--html", "box.html")
        page = (self.folder / "box.html").read_text(encoding="utf-8")
        self.assertNotRegex(page.split("<body")[0], r'(?:src|href)="\./')
        self.assertIn("default-src 'none'", page)
        data = re.search(r'<script type="application/octet-stream" id="solution">([^<]*)<', page)[1]
        self.assertEqual(base64.b64decode(data, validate=True),
                         (self.folder / "box.glb").read_bytes())

    def test_from_a_scene(self):
        self.succeed("view", "box.geom", "--html", "box.html", "--error", "0.3", "-o", "kept.glb")
        self.assertEqual((self.folder / "kept.glb").read_bytes(),
                         (self.folder / "box.glb").read_bytes())


class WrongUse(Viewing):
    def test_is_said(self):
        self.refuse(BAD_INPUT, "none.glb", "view", "none.glb", "--no-open")
        self.write("half.glb", (self.folder / "box.glb").read_bytes()[:5000])
        self.refuse(BAD_INPUT, "half.glb", "view", "half.glb", "--no-open")
        self.refuse(WRONG_USE, "--port", "view", "box.glb", "--port", "70000")
        self.refuse(WRONG_USE, "excludes", "view", "box.glb", "--port", "80", "--html", "a.html")
        self.refuse(WRONG_USE, "solution already", "view", "box.glb", "-o", "other.glb")
        for message, *more in [("--view needs --output", "--view", "--log", "csv"),
                               ("excludes", "--view", "--compare"),
                               ("a table", "--view", "--log", "csv", "-o", "new.glb"),
                               ("requires --view", "--no-open", "-o", "new.glb")]:
            self.refuse(WRONG_USE, message, "solve", "box.geom", *more)
        self.refuse(WRONG_USE, "--html: 'page.txt' is not allowed, expected a name that ends in .html",
                    "view", "box.glb", "--html", "page.txt")

    def test_a_model_that_is_no_solution_is_lit_anew(self):
        """So is what a page exports with its light in the colours; a user may expect otherwise."""
        self.succeed("convert", "box.geom", "model.glb")
        done = self.succeed("view", "model.glb", "--html", "model.html", "--error", "0.3")
        self.assertIn("model.glb is a model, not a solution", done.stderr)
        self.assertNotIn("not a solution",
                         self.succeed("view", "box.glb", "--html", "box.html").stderr)


if __name__ == "__main__":
    unittest.main()
