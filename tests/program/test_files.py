"""`topple replay`, `topple export`, `topple plot`: what is read from and made of a recording."""

import csv
import json
import struct
import unittest
import xml.etree.ElementTree
import zlib

from program import ENDLESS, ROW, ProgramTest, topple


def edited(recording, old, new):
    """A recording with other bytes in its recipe, and the check of that piece put right (docs/format.md)."""
    assert len(old) == len(new)
    content = bytearray(recording.read_bytes())
    assert content[8:12] == b"RCPE"
    (length,) = struct.unpack_from("<Q", content, 16)
    place = content.index(old, 24, 24 + length)
    content[place : place + len(old)] = new
    struct.pack_into("<I", content, 12, zlib.crc32(content[24 : 24 + length]))
    return content


class Replay(ProgramTest):
    def test_a_recording_replays_the_same(self):
        result = self.succeeds("replay", self.record())
        hashes = [line.split()[-1] for line in result.stdout.splitlines()[-2:]]
        self.assertEqual(hashes[0], hashes[1])

    def test_another_restitution_is_found_with_its_first_step_and_brick(self):
        recording = self.record()
        other = self.folder / "other.topple"
        other.write_bytes(edited(recording, b"brick_restitution = 0.0", b"brick_restitution = 0.5"))
        result = topple("replay", other)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r"step \d")
        self.assertRegex(result.stdout, r"brick [01]\b")  # The first hit takes the speed of brick 0 and gives it to brick 1.

    def test_a_layout_is_run_and_replayed(self):
        self.succeeds("replay", self.write("row.toml", ROW))

    def test_damaged_cut_and_foreign_files_are_bad_input(self):
        recording = self.record()
        whole = recording.read_bytes()
        for name, content in [
            ("damaged", whole[:100] + bytes([whole[100] ^ 1]) + whole[101:]),
            ("cut", whole[:40]),
            ("empty", b""),
            ("foreign", b"\x89PNG\r\n\x1a\n" + whole[8:]),
        ]:
            with self.subTest(name=name):
                path = self.folder / (name + ".topple")
                path.write_bytes(content)
                self.fails(2, "replay", path, says=name + ".topple")

    def test_settings_for_running_are_refused_for_a_recording(self):
        recording = self.record()
        for option in [["--set", "time_step_s=0.001"], ["--model", "pivot"], ["--until", "1"]]:
            self.fails(2, "replay", recording, *option, says=option[0])


class Export(ProgramTest):
    def rows(self, *arguments):
        path = self.folder / "out.csv"
        self.succeeds("export", *arguments, "-o", path)
        with path.open(newline="") as stream:
            return list(csv.reader(stream))

    def test_the_events_have_the_documented_columns(self):
        rows = self.rows(self.record(), "--events")
        self.assertEqual(rows[0], "time_s,event,brick,by,force_n,impulse_n_s,x_m,y_m,z_m".split(","))
        struck = [row for row in rows[1:] if row[1] == "struck"]
        self.assertEqual([int(row[2]) for row in struck], list(range(1, 12)))
        times = [float(row[0]) for row in rows[1:]]
        self.assertEqual(times, sorted(times))

    def test_the_knots_tell_time_and_brick(self):
        rows = self.rows(self.record())
        self.assertIn("time_s", rows[0])
        self.assertIn("brick", rows[0])
        self.assertGreater(len(rows), 24)
        self.assertTrue(all(len(row) == len(rows[0]) for row in rows))

    def test_a_layout_is_run_first(self):
        recorded = self.rows(self.record())
        self.assertEqual(self.rows(self.folder / "row.toml"), recorded)

    def test_hdf5_is_hdf5(self):
        path = self.folder / "row.h5"
        self.succeeds("export", self.record(), "-o", path)
        self.assertEqual(path.read_bytes()[:8], b"\x89HDF\r\n\x1a\n")

    def test_a_scene_is_gltf_of_all_that_is_there(self):
        whole = self.record(ROW.replace("count = 12", "count = 100")).read_bytes()
        cut = self.folder / "cut.topple"
        cut.write_bytes(whole[: len(whole) * 9 // 10])
        for options in [], ["--fps", "24"]:
            path = self.folder / "run.glb"
            self.succeeds("export", cut, "-o", path, *options)
            content = path.read_bytes()
            self.assertEqual(struct.unpack_from("<4sII", content), (b"glTF", 2, len(content)))
            scene = json.loads(content[20 : 20 + struct.unpack_from("<I", content, 12)[0]])
            moving = {channel["target"]["node"] for channel in scene["animations"][0]["channels"]}
            self.assertIn(0, moving)
            self.assertNotIn("hash", scene["asset"]["extras"])

    def test_an_option_of_another_ending_is_refused(self):
        layout = self.write("row.toml", ROW)
        self.fails(2, "export", layout, "-o", self.folder / "a.csv", "--fps", "24", says="--fps is for")
        self.fails(2, "export", layout, "-o", self.folder / "a.glb", "--events", says="--events chooses")
        self.fails(2, "export", layout, "-o", self.folder / "a.gltf", says="must end in .csv, .h5 or .glb")

    def test_a_place_that_cannot_be_written_is_exit_code_1(self):
        self.fails(1, "export", self.record(), "-o", self.folder / "none" / "a.csv", says="none")

    def test_a_place_that_cannot_be_written_is_told_before_the_run(self):
        layout = self.write("row.toml", ROW)
        for verb, name in [("export", "a.csv"), ("plot", "a.svg"), ("render", "a.mp4")]:
            with self.subTest(verb=verb):
                self.fails(1, verb, layout, *ENDLESS, "-o", self.folder / "none" / name, says="cannot be written: there is no folder .*none")

    def test_a_recording_that_was_cut_off_says_how_far_it_goes(self):
        whole = self.record(ROW.replace("count = 12", "count = 100")).read_bytes()
        cut = self.folder / "cut.topple"
        cut.write_bytes(whole[: len(whole) * 9 // 10])
        result = self.succeeds("export", cut, "-o", self.folder / "cut.csv")
        self.assertRegex(result.stderr, r"cut\.topple was cut off before its run ended; what is there goes up to [\d.]+ s\.\n")


class Plot(ProgramTest):
    LABELS = {
        "motion": ["Angle [°]", "Angular velocity [rad/s]", "Angular acceleration [rad/s²]", "Time [s]", "brick 0"],
        "arrival": ["Arrival time [s]", "Distance along the run [mm]"],
        "speed": ["Front speed [m/s]", "Distance along the run [mm]"],
        "energy": ["Time [s]", "kinetic", "potential"],
    }

    def test_every_figure_in_every_format(self):
        recording = self.record()
        for figure in self.LABELS:
            for ending, magic in [(".svg", b"<?xml"), (".png", b"\x89PNG"), (".pdf", b"%PDF")]:
                with self.subTest(figure=figure, ending=ending):
                    path = self.folder / (figure + ending)
                    self.succeeds("plot", recording, "-o", path, "--figure", figure)
                    content = path.read_bytes()
                    self.assertEqual(content[: len(magic)], magic)
                    self.assertGreater(len(content), 4000)
        self.assertEqual(list(self.folder.glob("*.part")), [])

    def test_axes_have_names_and_units_and_there_is_a_curve_a_brick(self):
        recording = self.record()
        for figure, labels in self.LABELS.items():
            path = self.folder / (figure + ".svg")
            self.succeeds("plot", recording, "-o", path, "--figure", figure)
            tree = xml.etree.ElementTree.parse(path)
            text = " ".join("".join(element.itertext()) for element in tree.iter("{http://www.w3.org/2000/svg}text"))
            for label in labels:
                self.assertIn(" ".join(label.split()), " ".join(text.split()), figure)

    def test_chosen_bricks_are_drawn(self):
        path = self.folder / "motion.svg"
        self.succeeds("plot", self.record(), "-o", path, "--bricks", "0,3-5")
        text = path.read_text(encoding="utf-8")
        for brick, drawn in [(0, True), (1, False), (3, True), (4, True), (5, True), (6, False)]:
            self.assertEqual(f"brick {brick}<" in text, drawn, brick)

    def test_a_brick_that_is_not_there_is_bad_input(self):
        self.fails(2, "plot", self.record(), "-o", self.folder / "a.svg", "--bricks", "12", says="0 to 11")

    def test_without_gnuplot_it_says_so(self):
        result = topple("plot", self.record(), "-o", self.folder / "a.svg", env={"PATH": str(self.folder)})
        self.assertEqual(result.returncode, 1)
        self.assertIn("gnuplot is not installed", result.stderr)
        self.assertFalse((self.folder / "a.svg").exists())

    def test_a_wave_of_one_brick_has_no_arrival_figure(self):
        recording = self.record(ROW.replace("count = 12", "count = 1"), "one")
        self.fails(1, "plot", recording, "-o", self.folder / "a.svg", "--figure", "arrival", says="fewer than two")

    def test_the_convergence_figure_prints_the_slopes(self):
        layout = self.write("row.toml", ROW)
        result = self.succeeds("convergence", layout, "-o", self.folder / "convergence.svg")
        slopes = {line.split()[0]: float(line.split()[-1]) for line in result.stdout.splitlines() if line.split()[0] in ("euler", "semi_implicit", "rk4")}
        self.assertAlmostEqual(slopes["euler"], 1.0, delta=0.05)
        self.assertAlmostEqual(slopes["semi_implicit"], 1.0, delta=0.05)
        self.assertAlmostEqual(slopes["rk4"], 4.0, delta=0.2)
        self.assertGreater((self.folder / "convergence.svg").stat().st_size, 4000)


if __name__ == "__main__":
    unittest.main()
