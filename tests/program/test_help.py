"""The help of every verb, its example, and every way of misusing the command line."""

import os
import pathlib
import subprocess
import unittest

from program import PATIENCE_S, PROGRAM, SOURCE, VERBS, ProgramTest, example_of, topple


class Help(ProgramTest):
    def test_the_help_lists_every_verb(self):
        text = self.succeeds("--help").stdout
        for verb in VERBS:
            self.assertRegex(text, rf"\n  {verb} +\S")

    def test_the_help_of_every_verb_ends_with_an_example(self):
        for verb in VERBS:
            with self.subTest(verb=verb):
                self.assertRegex(example_of(verb) or "", rf"^topple ({verb}|run .* && topple {verb}) ")

    def test_every_example_works(self):
        (self.folder / "scenes").symlink_to(SOURCE / "scenes")
        bin_folder = self.folder / "bin"
        bin_folder.mkdir()
        (bin_folder / "topple").symlink_to(pathlib.Path(PROGRAM).resolve())
        env = dict(os.environ, PATH=f"{bin_folder}:{os.environ['PATH']}")
        for verb in VERBS:
            if verb == "show":  # It serves until Ctrl-C: test_show.py starts its example.
                continue
            with self.subTest(verb=verb):
                result = subprocess.run(example_of(verb), shell=True, cwd=self.folder, env=env, capture_output=True, text=True, timeout=PATIENCE_S)
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_version_is_the_one_of_the_project(self):
        self.assertRegex(self.succeeds("--version").stdout, r"^topple \d+\.\d+\.\d+\n$")

    def test_misuse_is_bad_input(self):
        layout = self.write("row.toml", "")
        for arguments in [
            [],
            ["fly"],
            ["run"],
            ["run", layout, "--fast"],
            ["run", layout, "--until", "0"],
            ["run", layout, "--until", "-1"],
            ["run", layout, "--until", "nan"],
            ["run", layout, "--until", "soon"],
            ["run", layout, "--threads", "0"],
            ["run", layout, "--lanes", "3"],
            ["run", layout, "--set", "height"],
            ["run", layout, "--set", "=1"],
            ["plot", layout],
            ["plot", layout, "-o", "a.gif"],
            ["plot", layout, "-o", "a.svg", "--figure", "sound"],
            ["plot", layout, "-o", "a.svg", "--bricks", "5-2"],
            ["plot", layout, "-o", "a.svg", "--bricks", "1,,2"],
            ["plot", layout, "-o", "a.svg", "--bricks", "-1"],
            ["plot", layout, "-o", "a.svg", "--bricks", "0-99999999"],
            ["export", layout, "-o", "a.txt"],
            ["export", layout, "-o", "a.h5", "--events"],
            ["show", layout, "--port", "0"],
            ["show", layout, "--port", "65536"],
        ]:
            with self.subTest(arguments=arguments):
                result = topple(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertNotEqual(result.stderr.strip(), "")
                self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
