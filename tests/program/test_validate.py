"""`topple validate`: exit codes, JSON, the page, kept runs."""

import json
import unittest

from program import SOURCE, ProgramTest, topple


class Validate(ProgramTest):
    def validate(self, *arguments):
        return topple("validate", "closed_forms", "--quick", "--sources", SOURCE / "validation", "--kept", self.folder / "kept.jsonl", *arguments)

    def test_the_closed_forms_hold_and_the_page_is_written(self):
        result = self.validate("--json", "--html", self.folder / "page")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual((report["claims_failing"], report["quick"]), (0, True))
        self.assertGreater(report["claims_holding"], 10)
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertIn("One brick: closed forms", page)
        self.assertTrue((self.folder / "page" / "figures" / "closed_forms.svg").stat().st_size > 1000)

    def test_a_claim_that_does_not_hold_gives_exit_code_1(self):
        folder = self.folder / "sources" / "closed_forms"
        folder.mkdir(parents=True)
        for file in (SOURCE / "validation" / "closed_forms").glob("*.toml"):
            text = file.read_text(encoding="utf-8").replace("2.694811", "2.794811")
            (folder / file.name).write_text(text, encoding="utf-8")
        result = topple("validate", "--quick", "--sources", folder.parent, "--kept", self.folder / "kept.jsonl")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("FAILS", result.stdout)

    def test_runs_are_not_kept_in_a_file_that_holds_something_else(self):
        (self.folder / "kept.jsonl").write_text("My notes\n")
        for fresh in ([], ["--fresh"]):
            result = self.validate(*fresh)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn("kept.jsonl: it holds something else.", result.stderr)
            self.assertEqual((self.folder / "kept.jsonl").read_text(), "My notes\n")

    def test_an_unknown_source_is_bad_input(self):
        self.assertEqual(topple("validate", "moon", "--sources", SOURCE / "validation", "--kept", self.folder / "k").returncode, 2)


if __name__ == "__main__":
    unittest.main()
