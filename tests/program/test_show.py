"""`topple show`: what the server gives, and all that it refuses."""

import http.client
import json
import os
import pathlib
import re
import shlex
import socket
import unittest

from program import ENDLESS, PATIENCE_S, ROW, SOURCE, ProgramTest, example_of, interrupt, start, topple


class Show(ProgramTest):
    def setUp(self):
        super().setUp()
        self.page = self.folder / "page"
        (self.page / "assets").mkdir(parents=True)
        (self.page / "index.html").write_text("<!doctype html><title>Topple</title>")
        (self.page / "assets" / "index.js").write_text("export {};")
        (self.page / "assets" / "worker.wasm").write_bytes(b"\0asm")
        (self.folder / "secret.txt").write_text("secret")
        (self.page / "link.txt").symlink_to(self.folder / "secret.txt")
        (self.page / "outside").symlink_to(self.folder)
        self.env = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.env["TOPPLE_STUDIO"] = str(self.page)

    def serve(self, *arguments):
        process = start("show", *arguments, env=self.env)
        self.addCleanup(self.stop, process)
        lines = []
        while not (lines and lines[-1].startswith("Open ")):
            line = process.stdout.readline()
            self.assertTrue(line, process.stderr.read() if not line else "")
            lines.append(line)
        self.port = int(re.search(r"http://127\.0\.0\.1:(\d+)/", lines[-1]).group(1))
        self.words = "".join(lines)
        return process

    def stop(self, process):
        if process.poll() is None:
            interrupt(process)
        process.stdout.close()
        process.stderr.close()

    def ask(self, path, method="GET", host=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        connection.putrequest(method, path, skip_host=True)
        if host != "":
            connection.putheader("Host", host or f"127.0.0.1:{self.port}")
        connection.endheaders()
        response = connection.getresponse()
        response.body = response.read()
        connection.close()
        return response

    def test_it_gives_the_page_the_recording_and_the_summary(self):
        recording = self.record()
        self.serve(recording)
        for path, kind in [
            ("/", "text/html; charset=utf-8"),
            ("/index.html", "text/html; charset=utf-8"),
            ("/assets/index.js", "text/javascript; charset=utf-8"),
            ("/assets/worker.wasm", "application/wasm"),
            ("/recording.topple", "application/octet-stream"),
            ("/summary.json", "application/json"),
        ]:
            response = self.ask(path)
            self.assertEqual((response.status, response.getheader("Content-Type")), (200, kind), path)
        # The same motion, though its pieces may come in another order than in a file that grew with its run.
        served = self.folder / "served.topple"
        served.write_bytes(self.ask("/recording.topple").body)
        for name, file in [("served.csv", served), ("kept.csv", recording)]:
            self.assertEqual(topple("export", file, "-o", self.folder / name).returncode, 0)
        self.assertEqual((self.folder / "served.csv").read_bytes(), (self.folder / "kept.csv").read_bytes())
        self.assertEqual(json.loads(self.ask("/summary.json").body)["fallen"], 12)
        self.assertEqual(self.ask("/recording.topple").getheader("Cache-Control"), "no-store")
        self.assertIn("12 fallen, 0 standing", self.words)

    def test_a_layout_is_run_first(self):
        self.serve(self.write("row.toml", ROW), "--set", "row.0.count=5")
        self.assertEqual(json.loads(self.ask("/summary.json").body)["bricks"], 5)
        self.assertEqual(self.ask("/recording.topple").body[:8], b"TOPPLE01")

    def test_every_answer_has_the_safe_headers(self):
        self.serve(self.record())
        for path in ["/", "/recording.topple", "/none"]:
            response = self.ask(path)
            self.assertIn("default-src 'none'", response.getheader("Content-Security-Policy"))
            self.assertEqual(response.getheader("X-Content-Type-Options"), "nosniff")
            self.assertIsNone(response.getheader("Access-Control-Allow-Origin"))

    def test_other_hosts_are_refused(self):
        self.serve(self.record())
        self.assertEqual(self.ask("/", host=f"localhost:{self.port}").status, 200)
        for host in ["example.org", f"example.org:{self.port}", "127.0.0.1", f"127.0.0.1:{self.port + 1}", f"127.0.0.1:{self.port}.example.org", ""]:
            for path in ["/", "/recording.topple", "/summary.json"]:
                response = self.ask(path, host=host)
                self.assertIn(response.status, [400, 403], host)
                self.assertNotIn(b"TOPPLE01", response.body)

    def test_nothing_else_is_served(self):
        self.serve(self.record())
        for path in [
            "/none", "/assets", "/assets/", "/link.txt", "/outside/secret.txt", "/row.toml", "//index.html", "/./index.html",
            "/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/assets/%2e%2e/index.html",
            "/index.html%00.js", "/etc/passwd", "http://example.org/", "/" + "a" * 4000,
        ]:
            response = self.ask(path)
            self.assertIn(response.status, [400, 404, 414], path)
            self.assertNotIn(b"secret", response.body)

    def test_only_reading_is_allowed(self):
        self.serve(self.record())
        for method in ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"]:
            self.assertEqual(self.ask("/", method=method).status, 405, method)
        head = self.ask("/recording.topple", method="HEAD")
        self.assertEqual((head.status, head.body), (200, b""))

    def test_it_listens_on_the_loopback_alone(self):
        process = self.serve(self.record())
        listening = set()
        for table in ["/proc/net/tcp", "/proc/net/tcp6"]:
            for line in pathlib.Path(table).read_text().splitlines()[1:]:
                local, state = line.split()[1], line.split()[3]
                if state == "0A" and int(local.split(":")[1], 16) == self.port:
                    listening.add(local.split(":")[0])
        self.assertEqual(listening, {"0100007F"})
        self.assertIsNone(process.poll())

    def test_a_chosen_port_that_is_taken_is_an_error_and_the_default_moves_on(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            self.fails(1, "show", self.record(), "--port", taken.getsockname()[1], env=self.env, says="cannot be used")
        self.serve(self.record())
        first = self.port
        self.serve(self.record(name="second"))
        self.assertNotEqual(self.port, first)

    def order(self, path, body, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        connection.request("POST", path, body=body, headers=headers)
        response = connection.getresponse()
        response.body = response.read()
        connection.close()
        return response

    def serve_with_orders(self):
        (self.page / "index.html").write_text("<!doctype html><html><head><title>Topple</title></head></html>")
        self.serve(self.record())
        told = re.search(r'<meta name="topple-native" content="([0-9a-f]{32}/run)" data-bricks="3000" data-recording="yes" />', self.ask("/").body.decode())
        self.assertTrue(told)
        return "/" + told.group(1)

    def test_a_layout_that_its_page_orders_is_run_and_sent_as_a_recording(self):
        path = self.serve_with_orders()
        answer = self.order(path, ROW, Origin=f"http://127.0.0.1:{self.port}")
        self.assertEqual((answer.status, answer.getheader("Content-Type")), (200, "application/octet-stream"))
        ordered = self.folder / "ordered.topple"
        ordered.write_bytes(answer.body)
        self.assertEqual(topple("replay", ordered).returncode, 0)
        expected = json.loads(topple("run", self.write("row.toml", ROW), "--json").stdout)["hash"]
        self.assertIn(expected, topple("replay", ordered).stdout)
        for _ in range(20):
            self.assertEqual(self.order(path, ROW).status, 200)  # the one before has let go

    def test_an_order_that_its_page_has_left_makes_room_for_the_next(self):
        path = self.serve_with_orders()
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE_S)
        endless = ROW.replace("count = 12", "count = 3000") + '[model]\nname = "pivot"\ntime_step_s = 0.000001\n'
        connection.request("POST", path, body=endless)
        response = connection.getresponse()
        self.assertEqual(response.read(8), b"TOPPLE01")
        response.close()
        connection.close()
        self.assertEqual(self.order(path, ROW).status, 200)

    def test_orders_of_others_are_refused(self):
        path = self.serve_with_orders()
        port = self.port
        for origin in ["https://example.org", f"http://127.0.0.1:{port + 1}", "null", f"http://127.0.0.1:{port}.example.org"]:
            self.assertEqual(self.order(path, ROW, Origin=origin).status, 403, origin)
        self.assertEqual(self.order(path, ROW, Host="example.org").status, 403)
        self.assertEqual(self.order("/" + "0" * 32 + "/run", ROW).status, 405)
        self.assertIn(self.order(path[: -len("run")] + "other", ROW).status, [404, 405])
        self.assertEqual(self.ask(path).status, 404)

    def test_a_bad_layout_is_answered_with_all_its_problems(self):
        path = self.serve_with_orders()
        answer = self.order(path, "[[row]]\ncount = 0\ngap_mm = -1\n")
        self.assertEqual(answer.status, 422)
        self.assertIn("layout.toml:2:9: row.0.count", answer.body.decode())
        self.assertIn("layout.toml:3:10: row.0.gap_mm", answer.body.decode())

    def test_ctrl_c_ends_it_well(self):
        process = self.serve(self.record())
        self.ask("/")
        code, _, errors = interrupt(process)
        self.assertEqual(code, 0, errors)

    def test_the_example_of_its_help_works(self):
        words = shlex.split(example_of("show"))
        self.assertEqual(words[:2], ["topple", "show"])
        words[2] = str(SOURCE / words[2])
        process = self.serve(*words[2:])
        self.assertEqual(self.ask("/").status, 200)
        self.assertEqual(interrupt(process)[0], 0)

    def test_without_the_page_it_says_how_to_build_it(self):
        recording = self.record()
        self.env["TOPPLE_STUDIO"] = str(self.folder / "none")
        self.fails(1, "show", recording, env=self.env, says="TOPPLE_STUDIO")

    def test_a_bad_layout_is_exit_code_2(self):
        self.assertEqual(topple("show", self.folder / "none.toml", env=self.env).returncode, 2)

    def test_ctrl_c_while_the_layout_runs_is_130(self):
        process = start("show", self.write("row.toml", ROW), *ENDLESS, env=self.env)
        process.stderr.readline()
        self.assertEqual(interrupt(process)[0], 130)


if __name__ == "__main__":
    unittest.main()
