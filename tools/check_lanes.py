#!/usr/bin/env python3
"""Fails if the unit that is compiled for AVX2 leaves behind what may be taken for everybody's: the linker keeps one copy of an inline
function, and one with instructions that a processor has not would end the program there (src/model/rigid/lanes.h).

usage: check_lanes.py LIBRARY    (libtopple_rigid.a)
"""
import re
import subprocess
import sys

UNIT = "lanes_4.cpp"
# <4> among its template arguments, as names are mangled; and the one way in.
OWN = re.compile(r"ILi4E|^_ZN6topple5rigid10four_lanesEv$")


def leaked(listing):
    """Symbols of the unit that others could use and that do not say for how many lanes they are, from what `nm -A` says."""
    found = []
    for line in listing.splitlines():
        words = line.split()
        if len(words) < 2 or f":{UNIT}" not in words[0]:
            continue
        kind, name = words[-2:]
        shared = kind in "WVuTDBRGS"  # What is local to the unit is its own affair.
        if shared and not OWN.search(name):
            found.append(name)
    return found


def main():
    listing = subprocess.run(["nm", "-A", "--defined-only", sys.argv[1]], capture_output=True, text=True, check=True).stdout
    found = leaked(listing)
    for name in found:
        print(f"{UNIT} defines {name}, which does not depend on the number of lanes", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
