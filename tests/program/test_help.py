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
            # The page's: test_show.py starts the first, and the others need the page as it is built, which is tested with it.
            if verb in ("show", "studio", "render"):
                continue
            with self.subTest(verb=verb):
                result = subprocess.run(example_of(verb), shell=True, cwd=self.folder, env=env, capture_output=True, text=True, timeout=PATIENCE_S)
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_version_is_the_one_of_the_project(self):
        self.assertRegex(self.succeeds("--version").stdout, r"^topple \d+\.\d+\.\d+, up to [24] lanes on this processor\n$")

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

    def test_misuse_is_told_in_plain_words(self):
        layout = self.write("row.toml", "")
        for arguments, words in [
            ([], "A command is missing; there are layout, picture, plan, run, times, risk, show, studio, render, plot, export, replay, convergence and validate."),
            (["fly"], "'fly' is no command of topple; there are layout, picture, plan, run, "),
            (["run", layout, "--fast"], "'--fast' is no option of topple run."),
            (["run", layout, "again"], "'again' is one word too many for topple run."),
            (["run", layout, "--out"], "--out needs a value."),
            (["run", layout, "--until", "1", "--until", "2"], "--until is given more than once."),
            (["run", layout, "--threads", "1.5"], "--threads: '1.5' is not a whole number from 1 to 1024"),
            (["run", layout, "--lanes", "3"], "--lanes: '3' is not 1, 2 or 4"),
            (["run", layout, "--model", "jelly"], "--model: 'jelly' is not pivot, hinge or rigid"),
            (["render", layout, "-o", "a.mp4", "--speed", "0"], "--speed: '0' is not a number from 0.001 to 1000"),
            (["plot", layout, "-o", "a.svg", "--figure", "sound"], "--figure: 'sound' is not motion, arrival, speed or energy"),
            (["plot", layout, "-o", "a.svg", "--figure", "speed", "--bricks", "1"], "--bricks chooses the curves of --figure motion; a figure of speed is of all"),
        ]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.fails(2, *arguments).stderr.splitlines()[0][: len(words)], words)
        self.assertIn("`topple run --help` says more.", self.fails(2, "run", layout, "--fast").stderr)


if __name__ == "__main__":
    unittest.main()
