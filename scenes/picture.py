#!/usr/bin/env python3
r"""picture.py FILE.png: draws the image that scenes/picture.toml is made of, a boat before the evening sun (600 x 400 pixels, nothing but Python).

    scenes/picture.py scenes/picture.png
    topple picture scenes/picture.png -o scenes/picture.toml --rows 18 --gap 16.5 --start line \
        --colors yellow,orange,red,crimson,violet,blue,"royal blue",ivory,black
"""
import math
import struct
import sys
import zlib

WIDTH, HEIGHT = 600, 400
YELLOW, ORANGE, RED, CRIMSON = (0xF2, 0xB9, 0x28), (0xF0, 0x82, 0x1E), (0xD9, 0x2B, 0x2B), (0xC2, 0x18, 0x5B)
VIOLET, BLUE, ROYAL = (0x78, 0x32, 0xBE), (0x14, 0x78, 0xC8), (0x2B, 0x5B, 0xD9)
IVORY, BLACK = (0xF4, 0xF1, 0xE8), (0x23, 0x26, 0x2B)

HULL = [(120, 262), (370, 262), (325, 312), (175, 312)]
SAILS = [[(236, 52), (236, 246), (110, 246)], [(256, 96), (364, 246), (256, 246)]]
MAST = [(236, 40), (256, 40), (256, 262), (236, 262)]


def inside(x, y, corners):
    """Whether a place is right of every edge of a convex shape that goes round with the clock."""
    pairs = zip(corners, corners[1:] + corners[:1])
    return all((bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0 for (ax, ay), (bx, by) in pairs)


def color_at(x, y):
    """Of a place, in pixels from the upper left."""
    if inside(x, y, HULL) or inside(x, y, MAST):
        return BLACK
    if any(inside(x, y, sail) for sail in SAILS):
        return IVORY
    if y > 290 + 8 * math.sin(x / 22):
        glitter = abs(x - 450) < 110 - 0.7 * (y - 290) and math.sin(y / 5.5) > 0.2
        return YELLOW if glitter else ROYAL if y > 345 + 8 * math.sin(x / 30 + 2) else BLUE
    if math.hypot(x - 450, y - 250) < 105:
        return YELLOW
    wave = 12 * math.sin(x / 70)
    return VIOLET if y < 55 + wave else CRIMSON if y < 110 + wave else RED if y < 170 + wave else ORANGE


def main():
    lines = (b"\0" + b"".join(bytes(color_at(x + 0.5, y + 0.5)) for x in range(WIDTH)) for y in range(HEIGHT))
    pieces = [(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(b"".join(lines), 9)), (b"IEND", b"")]
    with open(sys.argv[1], "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, content in pieces:
            file.write(struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content)))


if __name__ == "__main__":
    main()
