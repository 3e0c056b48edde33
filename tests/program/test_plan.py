"""`topple plan`: what it draws, as PDF and SVG, and what it refuses."""

import subprocess
import unittest

from program import ROW, SOURCE, ProgramTest


class Plan(ProgramTest):
    def words(self, path):
        """All that is written in a PDF."""
        return subprocess.run(["pdftotext", "-layout", path, "-"], capture_output=True, text=True, check=True).stdout

    def test_one_sheet_has_the_title_the_scale_the_parts_and_the_colours(self):
        path = self.folder / "plan.pdf"
        result = self.succeeds("plan", SOURCE / "scenes" / "by_hand.toml", "-o", path)
        self.assertEqual(result.stdout, "1:5 on one sheet of A4\n")
        self.assertEqual(result.stderr, f"Wrote {path}\n")
        words = self.words(path)
        for wanted in ["Put down by hand", "by_hand.toml", "1:5", "A4", "1 of 1", "row 1 \u00b7 21", "curve 2 \u00b7 12", "brick 1 to 3", "#1e8449", "736.4 mm", "push",
                       "domino, 48 \u00d7 24 \u00d7 7.5 mm"]:
            self.assertIn(wanted, words)

    def test_what_a_table_has_no_room_for_is_counted(self):
        path = self.folder / "plan.pdf"
        rows = "".join(f'[[row]]\nfrom_mm = [{60 * i}, 0]\ncount = 2\npitch_mm = 24\ncolor = "#0000{i:02x}"\n' for i in range(35))
        self.succeeds("plan", self.write("rows.toml", rows), "-o", path, "--paper", "A4")
        words = self.words(path)
        listed = len([line for line in words.splitlines() if "#0000" in line])
        self.assertLess(listed, 12)
        self.assertRegex(words, rf"and {35 - listed} more colours +{2 * (35 - listed)}\b")

    def test_several_sheets_are_numbered_and_named(self):
        path = self.folder / "plan.pdf"
        result = self.succeeds("plan", self.write("row.toml", ROW), "-o", path, "--scale", "1:1", "--paper", "A4")
        self.assertEqual(result.stdout, "1:1 on 2 sheets of A4, and one that shows where they lie\n")
        words = self.words(path)
        self.assertIn("Sheet 2 of 2, 1:1", words)
        self.assertIn("all 2, of 1:1", words)
        self.assertEqual(words.count("A row: row 1"), 2)
        self.assertEqual(words.count("\f"), 3)

    def test_a_doubt_is_told_and_marked(self):
        path = self.folder / "plan.pdf"
        self.succeeds("plan", self.write("wide.toml", ROW.replace("36", "90")), "-o", path)
        words = " ".join(self.words(path).split())
        self.assertIn("Where it may stop", words)
        self.assertIn("Gap 82.5 mm between bricks 0 and 1", words)

    def test_an_svg_is_as_large_as_its_scale_asks(self):
        path = self.folder / "plan.svg"
        self.succeeds("plan", self.write("row.toml", ROW), "-o", path, "--scale", "1:2")
        self.assertIn("<svg ", path.read_text())

    def test_refuses_what_cannot_be(self):
        row = self.write("row.toml", ROW)
        self.fails(2, "plan", row, "-o", "plan.png", says="must end in .pdf or .svg")
        self.fails(2, "plan", row, "-o", "plan.pdf", "--scale", "2:1", says="--scale: '2:1' is not a scale from 1:1 to 1:100000")
        self.fails(2, "plan", row, "-o", "plan.pdf", "--paper", "A5", says="--paper: 'A5' is not A4, A3, A2, A1, A0 or letter")
        self.fails(2, "plan", row, "-o", "plan.svg", "--scale", "1", "--paper", "A4", says="not both")
        self.fails(2, "plan", self.record(), "-o", "plan.pdf", says="plan takes a layout")


if __name__ == "__main__":
    unittest.main()
