"""Disks that are full: the message says so, and nothing that was there before is lost."""

import os
import resource
import shutil
import signal
import subprocess
import unittest

from program import PATIENCE_S, PROGRAM, ROW, ProgramTest

LONG_ROW = ROW.replace("count = 12", "count = 400")


def with_room_for(size):
    """No file of the program, or of what it starts, may grow beyond so many bytes: to it that is a full disk."""

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


class FullDisk(ProgramTest):
    def in_little_room(self, size, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE_S, preexec_fn=with_room_for(size))

    def test_of_a_run_stay_its_summary_and_what_was_recorded(self):
        recording = self.folder / "row.topple"
        recording.write_text("old")
        result = self.in_little_room(40000, "run", self.write("row.toml", LONG_ROW), "--out", recording)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("row.topple.part: cannot be written: File too large\n", result.stderr)
        self.assertIn("is in " + str(recording) + ".part, and can be read.", result.stderr)
        self.assertIn("  hash ", result.stdout)
        self.assertNotIn("  recording ", result.stdout)
        self.assertEqual(recording.read_text(), "old")
        part = self.folder / "row.topple.part"
        self.assertRegex(self.succeeds("export", part, "-o", self.folder / "row.csv").stderr, r"was cut off before its run ended; what is there goes up to")

    def test_what_was_there_stays_when_its_successor_cannot_be_written(self):
        recording = self.record()
        for name, arguments in [("a.csv", ["export"]), *((f"a.{ending}", ["plot", "--figure", "arrival"]) for ending in ("svg", "png", "pdf"))]:
            with self.subTest(name=name):
                path = self.folder / name
                path.write_text("old")
                result = self.in_little_room(4000, *arguments, recording, "-o", path)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn("File too large", result.stderr)
                self.assertEqual(path.read_text(), "old")
                self.assertEqual(list(self.folder.glob("*.part")), [])

    def test_standard_output_that_cannot_be_written_is_no_success(self):
        layout = self.write("row.toml", ROW)
        for arguments in [["run", layout], ["run", layout, "--json"], ["layout", layout], ["--help"]]:
            with self.subTest(arguments=arguments), open("/dev/full", "w", encoding="utf-8") as full:
                result = subprocess.run([PROGRAM, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE_S, check=False)
                self.assertEqual(result.returncode, 1)
                self.assertIn("Standard output cannot be written: No space left on device", result.stderr)

    def test_finished_validation_runs_that_cannot_be_kept_are_said(self):
        kept = self.folder / "kept.jsonl"
        result = self.in_little_room(100, "validate", "closed_forms", "--quick", "--kept", kept)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn(f"Finished runs cannot be kept in {kept}: File too large.", result.stderr)

    def test_hdf5_in_any_little_room(self):
        recording = self.record(LONG_ROW)
        disk = self.folder / "disk"
        disk.mkdir()
        # A disk of its own, for the library's way out of a full one needs more room elsewhere.
        for size in [4, 12, 64, 120]:
            mounted = f'mount -t tmpfs -o size={size}k disk "$1" && echo old >"$1/a.h5" && shift && exec "$@"'
            command = ["sh", "-c", mounted, "sh", disk, PROGRAM, "export", recording, "-o", disk / "a.h5"]
            unshare = [shutil.which("unshare") or "unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"])]
            result = subprocess.run([*map(str, unshare + command)], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            if "mount" in result.stderr or "unshare" in result.stderr:
                self.skipTest("nothing can be mounted here")
            with self.subTest(size=size):
                self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
                self.assertRegex(result.stderr, r"a\.h5: .*: No space left on device\n")


if __name__ == "__main__":
    unittest.main()
