"""`topple times`: the time sheet as a table, as JSON and as CSV."""

import csv
import json
import unittest

from program import BROKEN_ROW, ProgramTest

# A row that splits by half a width: the last of four strikes two rows at once.
SPLIT = """title = "A split"
[[push]]
angular_speed_rad_s = 6
[[row]]
count = 4
pitch_mm = 24
[[row]]
from_mm = [96, 13]
count = 3
pitch_mm = 24
[[row]]
from_mm = [96, -13]
count = 3
pitch_mm = 24
[model]
name = "rigid"
"""


class Times(ProgramTest):
    def test_the_branches_of_a_split_stand_together(self):
        lines = self.succeeds("times", self.write("split.toml", SPLIT)).stdout.splitlines()
        self.assertRegex(lines[0], r"^A split \(.*split.toml\), by rigid$")
        self.assertRegex(lines[2], r"^  row 1 +4 +4 +0\.\d{3} +0\.\d{3} +0\.\d{3} +\d+\.\d +\d\.\d{3}  push at 0 s$")
        self.assertEqual(sorted(line.split()[2] for line in lines[3:5]), ["2", "3"])
        self.assertEqual([line[0] for line in lines[3:5]], ["\u250c", "\u2514"])
        for line in lines[3:5]:
            self.assertRegex(line, r"  row 1, brick 3$")
        self.assertRegex(lines[5], r"^  all +10 +10 ")

    def test_json_and_csv_say_the_same_of_a_recording(self):
        recording, table = self.record(SPLIT), self.folder / "times.csv"
        result = self.succeeds("times", recording, "--json", "-o", table)
        self.assertEqual(result.stderr, f"Wrote {table}\n")
        parts = json.loads(result.stdout)["parts"]
        with table.open(newline="") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(list(rows[0]), list(parts[0]))
        for part, row in zip(parts, rows, strict=True):
            for key, value in part.items():
                with self.subTest(part=part["part"], key=key):
                    self.assertEqual(row[key], "" if value is None else row[key] if isinstance(value, float) else str(value))
                    if isinstance(value, float):
                        self.assertEqual(float(row[key]), value)
        self.assertEqual([part["start"] for part in parts], [0, 1, 1])
        self.assertEqual([part["from_brick"] for part in parts], [None, 3, 3])
        self.assertEqual(parts[1]["from_part"], "row 1")

    def test_what_is_not_reached_says_so(self):
        broken = BROKEN_ROW + "[[row]]\nfrom_mm = [1000, 0]\ncount = 2\npitch_mm = 24\n"
        lines = self.succeeds("times", self.write("broken.toml", broken)).stdout.splitlines()
        self.assertRegex(lines[3], r"^  row 2 +2 +0 +- +- +- +- +-  not reached$")
        self.assertRegex(lines[2], r"^  row 1 +12 +1 +(0\.\d{3}) +\1 +0.000 +- +-  push at 0 s$")

    def test_refuses_other_endings(self):
        self.fails(2, "times", self.record(), "-o", "times.txt", says="must end in .csv")


if __name__ == "__main__":
    unittest.main()
