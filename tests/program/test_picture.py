"""`topple picture`: from an image to a layout that falls."""

import struct
import unittest
import zlib

from program import SOURCE, ProgramTest

BLACK, WHITE, RED = b"\0\0\0", b"\xff\xff\xff", b"\xd9\x2b\x2b"
ELL = [[BLACK, WHITE, WHITE], [BLACK, WHITE, WHITE], [BLACK, RED, WHITE]]


def png(lines, width=None, height=None):
    """A PNG of lines of colours; it may claim another size."""
    raw = b"".join(b"\0" + b"".join(line) for line in lines)
    header = struct.pack(">IIBBBBB", width or len(lines[0]), height or len(lines), 8, 2, 0, 0, 0)
    pieces = [(b"IHDR", header), (b"IDAT", zlib.compress(raw)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(c)) + n + c + struct.pack(">I", zlib.crc32(n + c)) for n, c in pieces)


class Picture(ProgramTest):
    def image(self, content=None):
        path = self.folder / "ell.png"
        path.write_bytes(png(ELL) if content is None else content)
        return path

    def made(self, *options):
        path = self.folder / "ell.toml"
        result = self.succeeds("picture", self.image(), "-o", path, *options)
        return path, result.stdout

    def test_an_image_becomes_a_field_that_stands_as_it_does(self):
        path, said = self.made("--rows", 3, "--count", 3, "--colors", "#000000,#ffffff,red")
        self.assertIn('picture = [\n  "abb",\n  "abb",\n  "arb",\n]', path.read_text())
        self.assertRegex(said, "3 rows of 3 bricks, 9 in all")
        self.assertRegex(said, "#d92b2b red +1\n")
        self.assertRegex(self.succeeds("layout", path).stdout, "#000000: 3 bricks")

    def test_all_of_it_falls_by_itself(self):
        for start, model in [("pushes", "hinge"), ("pushes", "rigid"), ("line", "rigid")]:
            with self.subTest(start=start, model=model):
                path, _ = self.made("--rows", 4, "--start", start)
                self.assertRegex(self.succeeds("run", path, "--model", model).stdout, " 0 standing")

    def test_proportions_and_numbers_are_as_asked_for(self):
        # A square image; a brick takes 16 mm along its row, and 32 mm from row to row.
        for options, said in [
            (["--rows", 10], "10 rows of 20 bricks, 200 in all, 0.32 m x 0.32 m"),
            (["--count", 20], "10 rows of 20 bricks"),
            (["--width", 320], "10 rows of 20 bricks"),
            (["--bricks", 200], "10 rows of 20 bricks"),
            (["--rows", 10, "--gap", 0.5, "--row-gap", 16], "10 rows of 50 bricks, 500 in all, 0.4 m x 0.4 m"),
        ]:
            with self.subTest(options=options):
                self.assertIn(said, self.made(*options)[1])

    def test_never_more_bricks_of_a_colour_than_there_are(self):
        _, said = self.made("--rows", 10, "--colors", "ivory=100,black=50,slate")
        self.assertIn("#23262b black      50 of 50", said)
        self.assertIn("#f4f1e8 ivory      100 of 100", said)
        out = self.folder / "none.toml"
        self.fails(2, "picture", self.image(), "-o", out, "--rows", 10, "--colors", "ivory=120,black=50", says="200 bricks.* there are 170 bricks: 30 are missing")
        self.assertFalse(out.exists())

    def test_a_jpeg_is_read_whatever_it_is_called(self):
        photo = SOURCE / "docs" / "pictures" / "studio.jpg"
        copy = self.folder / "studio.png"
        copy.write_bytes(photo.read_bytes())
        self.assertRegex(self.succeeds("picture", copy, "-o", self.folder / "a.toml").stdout, r"^\d+ rows of \d+ bricks")

    def test_a_photograph_stands_as_the_camera_was_held(self):
        photo = (SOURCE / "docs" / "pictures" / "studio.jpg").read_bytes()
        # A directory of one entry: its orientation, a quarter turn.
        exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"
        turned = self.folder / "turned.jpg"
        turned.write_bytes(photo[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + photo[2:])
        sizes = []
        for image in [SOURCE / "docs" / "pictures" / "studio.jpg", turned]:
            said = self.succeeds("picture", image, "-o", self.folder / "a.toml", "--row-gap", 0, "--gap", 16.5, "--rows", 40).stdout
            sizes.append(int(said.split()[3]))
        # Bricks as far apart as rows: broader than high, then as much higher than broad.
        self.assertAlmostEqual(sizes[0] * sizes[1], 1600, delta=60)
        self.assertGreater(sizes[0], 50)

    def test_what_is_no_image_is_bad_input(self):
        whole = png(ELL)
        for content, says in [
            (b"", "is no PNG or JPEG image"),
            (b"GIF89a" + whole, "is no PNG or JPEG image"),
            (whole[:50], "ell.png: is (damaged|no PNG)"),
            (png(ELL, 12000, 12000), "is 12000 by 12000 pixels; at most 100 million are read"),
            (png(ELL, 9000, 9000), "is damaged"),
        ]:
            with self.subTest(says=says):
                self.fails(2, "picture", self.image(content), "-o", self.folder / "a.toml", says=says)
        self.fails(2, "picture", self.folder, "-o", self.folder / "a.toml", says="is a directory, not an image")
        self.fails(2, "picture", self.folder / "none.png", "-o", self.folder / "a.toml", says="there is no such file")

    def test_misuse_is_bad_input(self):
        image = self.image()
        for options, says in [
            (["--colors", "mauve"], "'mauve' is no colour; it is written #rrggbb, or is one of red, orange"),
            (["--colors", "red=many"], "the stock must be a whole number"),
            (["--colors", "red=-1"], "the stock must be a whole number"),
            (["--colors", "#12345g"], "is no colour"),
            (["--colors", "=5"], "is no colour"),
            (["--rows", "0"], "is not a whole number"),
            (["--rows", "4000", "--count", "4000"], "cannot be a picture"),
            (["--width", "100", "--count", "5"], "both say"),
            (["--start", "line", "--row-gap", "8"], "row_pitch_mm: must be at least 72"),
            (["--start", "fire"], "'fire' is not pushes, line or none"),
        ]:
            with self.subTest(options=options):
                self.fails(2, "picture", image, "-o", self.folder / "a.toml", *options, says=says)
        self.fails(1, "picture", image, "-o", self.folder / "none" / "a.toml", says="there is no folder")


if __name__ == "__main__":
    unittest.main()
