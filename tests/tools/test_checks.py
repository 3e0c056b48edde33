"""The checks of tools/ find what they are for. Run by ./test: python3 -m unittest discover tests/tools"""
import sys
import tempfile
import unittest
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "tools"))
import check_includes  # noqa: E402
import check_lanes  # noqa: E402
import check_references  # noqa: E402
import check_sizes  # noqa: E402


class Tree(unittest.TestCase):
    """A small tree of its own for each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name).resolve()
        for header in ("base", "layout", "model", "recording", "run", "measure", "export", "topple"):
            self.write(f"include/topple/{header}.h", "#pragma once\n")

    def write(self, path, text):
        (self.tree / path).parent.mkdir(parents=True, exist_ok=True)
        (self.tree / path).write_text(text, encoding="utf-8")


class Lanes(unittest.TestCase):
    def leaked(self, line):
        return check_lanes.leaked(f"lib.a:lanes_2.cpp.o:0 W _ZSt3maxIdERKT_S2_S2_\nlib.a:lanes_4.cpp.o:{line}\n")

    def test_what_depends_on_the_number_of_lanes_or_is_local_may_stay(self):
        for line in ("0 W _ZN6topple5rigid6largerILi4EEEddd", "0 T _ZN6topple5rigid10four_lanesEv", "0 r .LC0", "0 t _ZL5localv"):
            self.assertEqual(self.leaked(line), [], line)

    def test_an_inline_function_of_everybodys_is_found(self):
        self.assertEqual(self.leaked("0 W _ZSt3maxIdERKT_S2_S2_"), ["_ZSt3maxIdERKT_S2_S2_"])


class Includes(Tree):
    def problems(self, path, include):
        self.write(path, f"#include {include}\n")
        return check_includes.check(self.tree)[0]

    def forbidden(self, path, include):
        self.assertEqual(len(self.problems(path, include)), 1, f"{include} in {path} was not found")

    def allowed(self, path, include):
        self.assertEqual(self.problems(path, include), [])

    def test_an_arrow_along_the_order_of_the_chapters_is_allowed(self):
        self.allowed("src/recording/tracks.cpp", '"topple/layout.h"')
        self.allowed("src/run/simulate.cpp", '"topple/recording.h"')
        self.allowed("apps/topple/run.cpp", "<topple/topple.h>")

    def test_an_arrow_against_the_order_is_found(self):
        self.forbidden("src/layout/read.cpp", '"topple/recording.h"')

    def test_an_arrow_between_siblings_is_found(self):
        self.forbidden("src/measure/wave.cpp", '"topple/run.h"')

    def test_a_public_header_that_points_back_is_found(self):
        self.forbidden("include/topple/layout.h", '"topple/model.h"')

    def test_a_private_header_of_a_later_chapter_is_found(self):
        self.write("src/run/loop.h", "")
        self.forbidden("src/base/hash.cpp", '"run/loop.h"')

    def test_a_way_round_by_dots_is_found(self):
        self.write("src/run/loop.h", "")
        self.forbidden("src/base/hash.cpp", '"../run/loop.h"')

    def test_only_run_knows_a_model(self):
        self.write("src/model/pivot/fall.h", "")
        self.allowed("src/run/make_model.cpp", '"model/pivot/fall.h"')
        self.forbidden("src/recording/recorder.cpp", '"model/pivot/fall.h"')

    def test_a_model_that_includes_another_model_is_found(self):
        check_includes.USES["other"] = ["model"]
        check_includes.MODELS.append("other")
        self.addCleanup(check_includes.USES.pop, "other")
        self.addCleanup(check_includes.MODELS.remove, "other")
        self.write("src/model/pivot/fall.h", "")
        self.forbidden("src/model/other/fall.cpp", '"model/pivot/fall.h"')

    def test_a_third_party_in_the_core_is_found(self):
        self.forbidden("src/recording/file.cpp", "<hdf5.h>")

    def test_each_third_party_has_its_place(self):
        self.allowed("src/layout/read.cpp", "<toml++/toml.h>")
        self.allowed("src/export/hdf5.cpp", "<hdf5.h>")
        self.allowed("apps/topple/show.cpp", "<httplib.h>")

    def test_files_and_printing_in_the_core_are_found(self):
        self.forbidden("src/layout/read.cpp", "<fstream>")

    def test_printing_in_the_core_is_found(self):
        self.forbidden("src/run/simulate.cpp", "<iostream>")

    def test_the_operating_system_in_the_core_is_found(self):
        self.forbidden("src/run/simulate.cpp", "<sys/stat.h>")

    def test_an_include_of_nothing_is_found(self):
        self.forbidden("src/run/simulate.cpp", '"run/gone.h"')

    def test_a_folder_that_is_no_chapter_is_found(self):
        self.forbidden("src/extras/more.cpp", "<vector>")


class References(Tree):
    def test_a_key_without_an_entry_is_found_and_one_with_an_entry_is_not(self):
        self.write("docs/references.bib", "@article{Known2010,\n  title = {T}\n}\n")
        self.write("src/base/a.cpp", "// [Known" "2010] eq. 1\n// [Unknown" "1999] eq. 2\n")
        problems, cited, _ = check_references.check(self.tree)
        self.assertEqual(cited, 2)
        self.assertEqual(problems, ["src/base/a.cpp:2: [Unknown" "1999] is not in docs/references.bib"])

    def test_a_link_that_leads_nowhere_is_found(self):
        self.write("docs/references.bib", "@article{Known2010,\n}\n")
        self.write("README.md", "[the sources](docs/references.bib), [the web](https://example.org), [gone](docs/gone.md)\n")
        self.assertEqual(check_references.check(self.tree)[0], ["README.md:1: the link to docs/gone.md leads nowhere"])

    def test_an_entry_that_is_there_twice_is_found(self):
        self.write("docs/references.bib", "@article{Known2010,\n}\n@book{Known2010,\n}\n")
        self.assertEqual(len(check_references.check(self.tree)[0]), 1)


class Sizes(Tree):
    def test_a_file_of_501_lines_is_found_and_one_of_500_is_not(self):
        self.write("src/base/long.cpp", "\n" * 501)
        self.write("src/base/just.cpp", "\n" * 500)
        self.assertEqual(check_sizes.check(self.tree)[0], ["src/base/long.cpp: 501 lines, at most 500"])

    def test_public_headers_over_1500_lines_together_are_found(self):
        for name in "abcd":
            self.write(f"include/topple/{name}.h", "\n" * 400)
        self.assertEqual(len(check_sizes.check(self.tree)[0]), 1)

    def test_a_loose_to_do_is_found(self):
        self.write("src/base/a.cpp", "// TO" "DO later\n")
        self.assertEqual(len(check_sizes.check(self.tree)[0]), 1)


if __name__ == "__main__":
    unittest.main()
