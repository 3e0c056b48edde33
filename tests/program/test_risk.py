"""`topple risk`: what it says, what it keeps, how it stops."""

import json
import unittest

from program import ROW, ProgramTest, interrupt, start, wait_until

# A gap that a brick just reaches, between two rows.
WIDE = "[[push]]\nangular_speed_rad_s = 4\n[[row]]\ncount = 7\npitch_mm = 24\n[[row]]\nfrom_mm = [199.5, 0]\ncount = 5\npitch_mm = 24\n"
TOLD = ["--runs", "8", "--position-mm", "1.5", "--heading-deg", "0"]


class Risk(ProgramTest):
    def test_says_how_many_runs_fall_and_where_they_stop(self):
        layout = self.write("wide.toml", WIDE)
        words = self.succeeds("risk", layout, *TOLD).stdout
        self.assertIn("runs         8, put down with standard deviations of 1.5 mm and 0 degrees, by rigid\n", words)
        self.assertRegex(words, r"all fall     in \d of 8 runs: ")
        self.assertRegex(words, r"weak links   brick 7 \(row 2, \(199.5, 0\) mm\) stops in \d of the 8 runs that come there: ")
        said = json.loads(self.succeeds("risk", layout, *TOLD, "--json", "--threads", "2").stdout)
        self.assertEqual(said["runs"] + said["not_built"], 8)
        link = said["weak_links"][0]
        self.assertEqual((link["brick"], link["struck_by"], link["foot_m"][0]), (7, 6, 0.1995))
        self.assertEqual(link["stops"]["count"], 8 - said["whole"]["count"])
        self.assertLess(link["stops"]["low"], link["stops"]["share"])
        self.assertLess(link["stops"]["share"], link["stops"]["high"])
        self.assertEqual([part["part"] for part in said["parts"]], ["row 2", "row 1"])

    def test_finished_runs_are_kept_and_not_run_again(self):
        layout, kept = self.write("wide.toml", WIDE), self.folder / "folder" / "kept.jsonl"
        once = self.succeeds("risk", layout, *TOLD, "--json").stdout
        self.succeeds("risk", layout, "--runs", "3", *TOLD[2:], "--kept", kept)
        self.assertEqual(len(kept.read_text().splitlines()), 3)
        with kept.open("a", encoding="utf-8") as file:
            file.write('{"study":"another","seed":4}\n{"cut')
        self.assertEqual(self.succeeds("risk", layout, *TOLD, "--json", "--kept", kept).stdout, once)
        lines = kept.read_text().splitlines()
        self.assertEqual(len(lines), 3 + 2 + 5)
        self.assertEqual(self.succeeds("risk", layout, *TOLD, "--json", "--kept", kept).stdout, once)
        self.assertEqual(kept.read_text().splitlines(), lines)

    def test_a_file_that_holds_something_else_is_left_alone(self):
        layout = self.write("row.toml", ROW)
        result = self.fails(2, "risk", layout, "--kept", layout)
        self.assertIn("row.toml: it holds something else.", result.stderr)
        self.assertEqual(layout.read_text(), ROW)

    def test_ctrl_c_says_what_there_is_so_far(self):
        kept = self.folder / "kept.jsonl"
        program = start("risk", self.write("row.toml", ROW), "--runs", "1000000", "--model", "rigid", "--kept", kept)
        wait_until(lambda: kept.exists() and kept.read_text(), "the first finished run")
        code, out, err = interrupt(program)
        self.assertEqual(code, 130)
        self.assertIn("  all fall ", out)
        self.assertIn("Interrupted; finished runs are kept in " + str(kept) + ".\n", err)

    def test_refuses_what_it_cannot_ask_about(self):
        still = self.write("still.toml", "[[row]]\ncount = 3\npitch_mm = 24\n")
        self.assertIn("no brick of a line falls even when all are exactly in their places", self.fails(2, "risk", still).stderr)
        self.assertIn("--runs: '0' is not a whole number from 1 to 1000000", self.fails(2, "risk", still, "--runs", "0").stderr)
        self.assertIn("risk takes a layout", self.fails(2, "risk", self.record()).stderr)


if __name__ == "__main__":
    unittest.main()
