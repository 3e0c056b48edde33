"""What the tests of the built program share: starting it, small layouts, a folder of their own."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ.get("TOPPLE_PROGRAM", "topple")
SOURCE = pathlib.Path(os.environ.get("TOPPLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
VERBS = ["layout", "picture", "plan", "run", "times", "risk", "show", "studio", "render", "plot", "export", "replay", "convergence", "validate"]
PATIENCE_S = 600  # A sanitizer on a busy machine is slow; no test waits this long when all is well.

ROW = """title = "A row"
[contact]
brick_restitution = 0.0
[[push]]
brick = 0
angular_speed_rad_s = 8.0
[[row]]
from_mm = [0, 0]
heading_deg = 0
count = 12
pitch_mm = 36
"""

# So small a step and so long a row that the run takes minutes: it is always interrupted.
ENDLESS = ["--set", "time_step_s=0.000001", "--set", "row.0.count=3000"]

# Wider apart than a brick is high: the first falls flat and reaches none.
BROKEN_ROW = ROW.replace("pitch_mm = 36", "pitch_mm = 60")


def topple(*arguments, cwd=None, env=None):
    """Runs the program to its end."""
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, env=env, capture_output=True, text=True, timeout=PATIENCE_S)


def start(*arguments, cwd=None, env=None):
    """Starts the program and does not wait."""
    return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=cwd, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_until(true, what):
    """Waits for a claim to become true, as a function."""
    deadline = time.monotonic() + PATIENCE_S
    while not true():
        if time.monotonic() > deadline:
            raise AssertionError("waited in vain for " + what)
        time.sleep(0.02)


def interrupt(process):
    """Ctrl-C, and what the program then says and returns."""
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=PATIENCE_S)
    return process.returncode, output, errors


def example_of(verb):
    """The example at the end of a verb's help."""
    lines = [line.strip() for line in topple(verb, "--help").stdout.strip().splitlines()]
    return lines[-1] if lines[-2:-1] == ["Example:"] else None


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="topple-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def record(self, text=ROW, name="row"):
        """A recording of a layout, on disk."""
        layout = self.write(name + ".toml", text)
        recording = self.folder / (name + ".topple")
        self.succeeds("run", layout, "--out", recording)
        return recording

    def succeeds(self, *arguments, **more):
        result = topple(*arguments, **more)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def fails(self, code, *arguments, says="", **more):
        result = topple(*arguments, **more)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertRegex(result.stderr, re.compile(says))
        return result
