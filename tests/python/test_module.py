"""The Python module from outside: the same bits, words and numbers as the program's, and nothing of it ends the interpreter."""
import contextlib
import io
import os
import re
import signal
import tempfile
import threading
import time
import unittest
from pathlib import Path

import h5py
import numpy as np
import topple

SOURCE = Path(os.environ["TOPPLE_SOURCE_DIR"])
ROW = "[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = {}\ngap_mm = 16.5\n\n[model]\nname = \"{}\"\n"


def row(count, model="rigid"):
    return topple.read_layout(ROW.format(count, model), "row.toml")


class Layouts(unittest.TestCase):
    def test_bricks_are_where_the_text_says(self):
        layout = row(4)
        self.assertEqual(len(layout), 4)
        np.testing.assert_allclose(layout.feet, [[0.024 * i, 0, 0] for i in range(4)], atol=1e-12)
        np.testing.assert_array_equal(layout.headings, np.zeros(4))
        np.testing.assert_array_equal(layout.kind_of, np.zeros(4))
        self.assertEqual(layout.colors.shape, (4, 3))
        self.assertEqual([(part.name, part.first, part.count, part.line) for part in layout.parts], [("row 1", 0, 4, True)])
        self.assertAlmostEqual(layout.kinds[0].height, 0.048)
        self.assertEqual(layout.summary()["bricks"], 4)
        self.assertEqual(layout.doubts(), [])

    def test_settings_go_over_the_text(self):
        layout = row(4).with_settings(["row.0.count=7"])
        self.assertEqual(len(layout), 7)
        self.assertEqual(layout.settings, ["row.0.count=7"])
        self.assertEqual(len(topple.load_layout(SOURCE / "scenes/report_row.toml", ["row.0.count=9"])), 9)

    def test_doubts_have_words(self):
        doubts = topple.read_layout(ROW.format(3, "rigid") + "[[brick]]\nat_mm = [500, 0]\n").doubts()
        self.assertEqual(doubts[0]["brick"], 3)
        self.assertIn("brick 3", doubts[0]["words"].lower())

    def test_every_problem_is_named(self):
        with self.assertRaises(topple.Error) as refused:
            topple.read_layout("[[row]]\ncount = 0\ngap_mm = 1\ncolour = 3\n", "mine.toml")
        self.assertIn("mine.toml:2:9: row.0.count", str(refused.exception))
        self.assertIn("mine.toml:4:1: row.0.colour", str(refused.exception))
        self.assertIsInstance(refused.exception, ValueError)


class Runs(unittest.TestCase):
    def test_the_golden_hash(self):
        golden = [line.split() for line in (SOURCE / "tests/golden/hashes.txt").read_text().splitlines() if line and line[0] != "#"]
        scene, model, hash_ = next(line for line in golden if line[:2] == ["s_curve.toml", "rigid"])
        layout = topple.load_layout(SOURCE / "scenes" / scene).with_settings(["model.name=" + model])
        self.assertEqual(topple.simulate(layout, threads=2).hash, hash_)

    def test_numbers_of_a_run(self):
        recording = topple.simulate(row(30))
        summary = recording.summary()
        self.assertEqual((summary["fallen"], summary["standing"], summary["end"]), (30, 0, "at_rest"))
        self.assertAlmostEqual(summary["front_speed"], 0.946, delta=0.015)
        self.assertTrue(recording.fallen().all())
        np.testing.assert_array_equal(recording.first_strikers(), np.arange(30) - 1)
        wave = recording.wave()
        self.assertTrue((np.diff(wave["arrival"]) > 0).all())
        self.assertEqual(wave["front_speed"], summary["front_speed"])
        events = recording.events()
        self.assertEqual((events["kind"] == "arrived").sum(), 30)
        self.assertTrue((np.diff(events["time"]) >= 0).all())
        energy = recording.energy()
        total = energy["kinetic"] + energy["potential"]
        self.assertLessEqual(total.max() - total[0], 1e-3 * abs(total[-1]))

    def test_where_bricks_are(self):
        for model in ("rigid", "hinge", "pivot"):
            recording = topple.simulate(row(5, model))
            positions, orientations = recording.poses(0.3)
            at = recording.at(2, 0.3)
            np.testing.assert_array_equal(positions[2], at["position"])
            np.testing.assert_array_equal(orientations[2], at["orientation"])
            self.assertAlmostEqual(np.linalg.norm(at["orientation"]), 1, places=12)
            motion = recording.motion(2, np.array([0.0, 0.3]))
            np.testing.assert_array_equal(motion[1], [at["tilt"], at["tilt_rate"], at["tilt_acceleration"]])
            self.assertEqual(motion[0, 0], 0)
            # A turn by the tilt about y.
            self.assertAlmostEqual(2 * np.arctan2(at["orientation"][2], at["orientation"][0]), at["tilt"], places=6)
        with self.assertRaises(IndexError):
            recording.at(5, 0)

    def test_until_and_watch(self):
        self.assertEqual(topple.simulate(row(30), until=0.1).summary()["end"], "time_limit")
        seen = []
        topple.simulate(row(20000), watch=lambda time, arrived: seen.append((time, arrived)))
        self.assertTrue(seen)
        self.assertEqual(topple.simulate(row(20000), watch=lambda time, arrived: False).summary()["end"], "stopped")

    def test_what_watch_raises_comes_out(self):
        def watch(time, arrived):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            topple.simulate(row(20000), watch=watch)

    def test_an_interrupt_ends_a_run_that_does_not_end(self):
        layout = row(300).with_settings(["every_brick_moves=true"])
        main = threading.main_thread().ident
        threading.Thread(target=lambda: (time.sleep(0.2), signal.pthread_kill(main, signal.SIGINT))).start()
        with self.assertRaises(KeyboardInterrupt):
            topple.simulate(layout)

    def test_a_model_refuses_in_words(self):
        with self.assertRaisesRegex(topple.Error, "rigid"):
            topple.simulate(topple.load_layout(SOURCE / "scenes/by_hand.toml", ["model.name=hinge"]))

    def test_risk_is_the_programs(self):
        found = topple.risk(topple.load_layout(SOURCE / "scenes/by_hand.toml"), runs=20, heading=np.radians(1.7), threads=2)
        self.assertEqual((found["whole"]["count"], found["runs"], found["not_built"]), (12, 20, 0))
        self.assertEqual([(link["brick"], link["struck_by"], link["count"]) for link in found["weak_links"]], [(39, 38, 8)])
        self.assertEqual(found["parts"][0]["part"], "row 3")


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.recording = topple.simulate(row(6))

    def test_a_recording_comes_back(self):
        path = self.folder / "row.topple"
        self.recording.export(path)
        again = topple.load_recording(path)
        self.assertEqual(again.hash, self.recording.hash)
        np.testing.assert_array_equal(again.poses(0.4)[0], self.recording.poses(0.4)[0])
        self.assertEqual(len(again.layout), 6)
        self.assertEqual(topple.replay(again)["same"], True)

    def test_tables_scenes_and_figures(self):
        self.recording.export(self.folder / "row.h5")
        with h5py.File(self.folder / "row.h5") as file:
            self.assertEqual(file["end"].attrs["reason"], b"at_rest")
        self.recording.export(self.folder / "events.csv", events=True)
        self.assertIn("struck", (self.folder / "events.csv").read_text())
        self.recording.export(self.folder / "row.glb", fps=30)
        self.assertEqual((self.folder / "row.glb").read_bytes()[:4], b"glTF")
        self.recording.plot(self.folder / "speed.svg", "speed")
        self.assertIn("<svg", (self.folder / "speed.svg").read_text())

    def test_errors_are_words(self):
        with self.assertRaisesRegex(topple.Error, "none.toml: there is no such file"):
            topple.load_layout("none.toml")
        with self.assertRaisesRegex(topple.Error, "must end in"):
            self.recording.export(self.folder / "row.txt")
        with self.assertRaisesRegex(topple.Error, "not motion, arrival"):
            self.recording.plot(self.folder / "row.svg", "sped")
        with self.assertRaisesRegex(topple.Error, "cannot be"):
            self.recording.export(self.folder / "none" / "row.csv")


class Documents(unittest.TestCase):
    def test_the_lines_of_the_documents_run(self):
        home = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scenes").symlink_to(SOURCE / "scenes")
            os.chdir(folder)
            try:
                for document in ("README.md", "docs/python.md"):
                    lines = re.search(r"```python\n(.*?)```", (SOURCE / document).read_text(), re.S)[1]
                    names = {}
                    with contextlib.redirect_stdout(io.StringIO()) as said:
                        exec(lines, names)
                    self.assertIn("0.9", said.getvalue())
                self.assertTrue(Path("row.topple").is_file())
                self.assertGreater(names["hardest"], 0)
                self.assertEqual(names["positions"].shape, (60, 3))
            finally:
                os.chdir(home)


if __name__ == "__main__":
    unittest.main()
