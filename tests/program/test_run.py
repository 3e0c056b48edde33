"""`topple run` and `topple layout`: the JSON, the exit codes, the recording that grows, Ctrl-C."""

import json
import signal
import unittest

from program import BROKEN_ROW, ENDLESS, PATIENCE_S, ROW, ProgramTest, interrupt, start, topple, wait_until


class Run(ProgramTest):
    def json_of(self, *arguments):
        return json.loads(self.succeeds("run", *arguments, "--json").stdout)

    def test_standard_output_is_one_json_object_with_the_documented_keys(self):
        summary = self.json_of(self.write("row.toml", ROW))
        kinds = {
            "version": str, "layout": str, "title": str, "model": str, "time_step_s": float, "bricks": int, "fallen": int, "standing": int,
            "front_speed_m_s": float, "duration_s": float, "steps": int, "wall_s": float, "cpu_s": float, "peak_memory_bytes": int, "hash": str,
            "end": str, "end_brick": type(None), "end_words": str, "hits": list, "recording": type(None),
        }
        self.assertEqual(set(summary), set(kinds))
        for key, kind in kinds.items():
            self.assertIsInstance(summary[key], kind, key)
        self.assertEqual((summary["bricks"], summary["fallen"], summary["standing"]), (12, 12, 0))
        self.assertEqual(summary["end"], "at_rest")
        self.assertRegex(summary["hash"], "^[0-9a-f]{16}$")
        self.assertGreater(summary["cpu_s"], 0.0)
        self.assertGreater(summary["front_speed_m_s"], 0.1)

    def test_the_hits_are_in_the_json_in_the_order_of_time(self):
        hits = self.json_of(self.write("row.toml", ROW))["hits"]
        self.assertEqual([(hit["by"], hit["brick"]) for hit in hits], [(i, i + 1) for i in range(10)])
        times = [hit["time_s"] for hit in hits]
        self.assertEqual(times, sorted(times))

    def test_the_same_run_has_the_same_hash_with_any_number_of_threads(self):
        layout = self.write("row.toml", ROW)
        self.assertEqual(self.json_of(layout)["hash"], self.json_of(layout, "--threads", 3)["hash"])

    def test_the_same_run_has_the_same_hash_with_any_number_of_lanes(self):
        layout = self.write("row.toml", ROW)
        hashes = {self.json_of(layout, "--model", "rigid", *lanes)["hash"] for lanes in ((), ("--lanes", 1), ("--lanes", 2))}
        self.assertEqual(len(hashes), 1)

    def test_the_profile_names_the_stages_of_a_step(self):
        layout = self.write("row.toml", ROW)
        summary = self.json_of(layout, "--model", "rigid", "--profile")
        stages = {row["stage"]: row for row in summary["profile"]}
        self.assertEqual(stages["advance fronts"]["calls"], summary["steps"])
        self.assertEqual(stages["in a plane"]["depth"], 1)
        self.assertIn(summary["lanes"], (2, 4))
        self.assertEqual(self.json_of(layout, "--model", "rigid", "--profile", "--lanes", 1)["lanes"], 1)
        self.assertIsNone(self.json_of(layout, "--model", "pivot", "--profile")["lanes"])
        self.assertRegex(self.succeeds("run", layout, "--model", "rigid", "--profile", "--lanes", 2).stdout, r"\n  lanes        2\n")
        self.assertRegex(self.succeeds("run", layout, "--model", "pivot", "--profile").stdout, r"stage +calls +time +share\n +step the model +[0-9,]+ ")

    def test_a_wave_that_dies_is_no_failure(self):
        summary = self.json_of(self.write("row.toml", BROKEN_ROW))
        self.assertEqual((summary["fallen"], summary["standing"]), (1, 11))
        self.assertEqual((summary["end"], summary["end_brick"]), ("wave_died", 0))

    def test_without_a_speed_the_json_says_null(self):
        self.assertIsNone(self.json_of(self.write("one.toml", ROW.replace("count = 12", "count = 1")))["front_speed_m_s"])

    def test_until_stops_the_run_at_that_time(self):
        summary = self.json_of(self.write("row.toml", ROW), "--until", "0.1")
        self.assertEqual(summary["end"], "time_limit")
        self.assertAlmostEqual(summary["duration_s"], 0.1, delta=2 * summary["time_step_s"])

    def test_set_and_model_are_over_what_the_layout_says(self):
        layout = self.write("row.toml", ROW)
        summary = self.json_of(layout, "--model", "pivot", "--set", "row.0.count=7", "--set", "time_step_s=0.001")
        self.assertEqual((summary["model"], summary["bricks"], summary["time_step_s"]), ("pivot", 7, 0.001))

    def test_another_model_than_the_layout_names_has_its_own_settings(self):
        layout = self.write("row.toml", ROW + '[model]\nname = "pivot"\ntime_step_s = 0.001\nhit = "same"\n')
        other = self.json_of(layout, "--model", "rigid")
        self.assertEqual(other["hash"], self.json_of(self.write("plain.toml", ROW), "--model", "rigid")["hash"])
        self.assertEqual(self.json_of(layout, "--model", "pivot")["time_step_s"], 0.001)
        recording = self.folder / "row.topple"
        self.succeeds("run", layout, "--model", "rigid", "--out", recording)
        self.assertIn(other["hash"], self.succeeds("replay", recording).stdout)

    def test_the_summary_for_people_is_on_standard_output(self):
        result = self.succeeds("run", self.write("row.toml", ROW))
        self.assertIn("12 fallen, 0 standing", result.stdout)
        self.assertRegex(result.stderr, r"^([\d,]+ of 12 bricks, .*\n)*$")  # A slow machine says how far it is.

    def test_bad_input_is_exit_code_2_and_the_message_goes_to_standard_error(self):
        layout = self.write("row.toml", ROW)
        for arguments, says in [
            ([self.folder / "none.toml"], "none.toml"),
            ([self.folder], "director"),
            ([self.write("bad.toml", "[[row]\n")], r"bad.toml:1:\d+"),
            ([self.write("empty.toml", "")], "empty.toml"),
            ([self.write("key.toml", ROW + "colour = 3\n")], r"key.toml:\d+:\d+"),
            ([layout, "--set", "row.0.count=-3"], "count"),
            ([layout, "--model", "jelly"], "jelly"),
            ([layout, "--set", "time_step_s=0"], "time_step_s"),
        ]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.fails(2, "run", *arguments, "--json", says=says).stdout, "")

    def test_a_recording_cannot_be_run_and_out_must_name_one(self):
        recording = self.record()
        for arguments in [["run"], ["layout"], ["convergence", "-o", self.folder / "a.svg"]]:
            self.fails(2, arguments[0], recording, *arguments[1:], says=f"is a recording; {arguments[0]} takes a layout")
        self.fails(2, "run", self.folder / "row.toml", "--out", self.folder / "row.csv", says=".topple")

    def test_a_place_that_cannot_be_written_is_exit_code_1(self):
        self.fails(1, "run", self.write("row.toml", ROW), "--out", self.folder / "none" / "row.topple", says="none")

    def test_out_leaves_a_whole_recording_and_no_part_of_one(self):
        recording = self.folder / "row.topple"
        summary = self.json_of(self.write("row.toml", ROW), "--out", recording)
        self.assertEqual(summary["recording"], str(recording))
        self.assertEqual(recording.read_bytes()[:8], b"TOPPLE01")
        self.assertEqual(list(self.folder.glob("*.part")), [])
        self.assertIn("12 fallen", self.succeeds("replay", recording).stdout + self.succeeds("run", self.folder / "row.toml").stdout)


class Interrupted(ProgramTest):
    def test_ctrl_c_gives_what_there_is_so_far(self):
        recording = self.folder / "row.topple"
        part = self.folder / "row.topple.part"
        process = start("run", self.write("row.toml", ROW), *ENDLESS, "--out", recording, "--json")
        wait_until(lambda: part.exists() and part.stat().st_size > 0, "the recording to grow")
        code, output, errors = interrupt(process)
        self.assertEqual(code, 130, errors)
        self.assertEqual(json.loads(output)["end"], "stopped")
        self.assertFalse(part.exists())
        self.succeeds("export", recording, "-o", self.folder / "row.csv")

    def test_a_killed_run_keeps_what_it_finished(self):
        part = self.folder / "row.topple.part"
        process = start("run", self.write("row.toml", ROW), *ENDLESS, "--out", self.folder / "row.topple")
        # Its first pieces may come to the disk in parts: it is finished once it can be read.
        wait_until(lambda: part.exists() and topple("export", part, "-o", self.folder / "events.csv", "--events").returncode == 0, "the recording to grow")
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=PATIENCE_S)
        self.assertFalse((self.folder / "row.topple").exists())
        self.succeeds("export", part, "-o", self.folder / "events.csv", "--events")

    def test_long_runs_say_how_far_they_are(self):
        process = start("run", self.write("row.toml", ROW), *ENDLESS)
        line = process.stderr.readline()
        interrupt(process)
        self.assertRegex(line, r"^[\d,]+ of 3,000 bricks, [\d.]+ s, [\d.]+ x real time\n$")

    def test_a_figure_of_an_interrupted_run_is_not_drawn(self):
        process = start("plot", self.write("row.toml", ROW), *ENDLESS, "-o", self.folder / "row.svg")
        process.stderr.readline()
        code, _, errors = interrupt(process)
        self.assertEqual(code, 130, errors)
        self.assertFalse((self.folder / "row.svg").exists())


class Layout(ProgramTest):
    def test_layout_prints_what_was_built(self):
        text = self.succeeds("layout", self.write("row.toml", ROW)).stdout
        self.assertRegex(text, r"bricks +12\n")
        self.assertRegex(text, r"length +396 mm\n")  # 11 pitches of 36 mm.
        self.assertRegex(text, r"kinds +domino: 12 bricks\n")
        self.assertRegex(text, r"colours +#c0392b: 12 bricks\n")

    def test_layout_as_json(self):
        summary = json.loads(self.succeeds("layout", self.write("row.toml", ROW), "--json").stdout)
        self.assertEqual((summary["bricks"], summary["kinds"], summary["pushes"]), (12, {"domino": 12}, 1))
        self.assertAlmostEqual(summary["length_m"], 0.396, places=9)

    def test_layout_says_where_the_run_may_stop(self):
        self.assertNotIn("doubts", self.succeeds("layout", self.write("row.toml", ROW)).stdout)
        self.assertEqual(json.loads(self.succeeds("layout", self.folder / "row.toml", "--json").stdout)["doubts"], [])
        wide = self.write("wide.toml", ROW.replace("pitch_mm = 36", "pitch_mm = 60"))
        self.assertRegex(self.succeeds("layout", wide).stdout, r"\n  doubts       Gap 52.5 mm between bricks 0 and 1 is likely beyond reach")
        self.assertEqual(len(json.loads(self.succeeds("layout", wide, "--json").stdout)["doubts"]), 5)
        still = self.write("still.toml", "[[row]]\ncount = 3\npitch_mm = 24\n")
        self.assertRegex(self.succeeds("layout", still).stdout, r"\n  doubts       .*push")

    def test_layout_checks_the_settings_of_the_model_too(self):
        for text, says in [('name = "jelly"', "jelly"), ('name = "hinge"\nhit = "same"', "hit")]:
            self.fails(2, "layout", self.write("bad.toml", f"{ROW}[model]\n{text}\n"), says=says)

    def test_a_bad_layout_is_exit_code_2(self):
        self.fails(2, "layout", self.write("bad.toml", ROW + "count = 3\n"), says="bad.toml")


if __name__ == "__main__":
    unittest.main()
