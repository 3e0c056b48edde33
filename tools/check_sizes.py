#!/usr/bin/env python3
"""Fails on a file over 500 lines, public headers over 1,500 lines together, or a to-do left in the tree.
(Functions over 60 lines are clang-tidy's to find.)

usage: check_sizes.py [TREE]    (default: the tree this file is in)
"""
import re
import sys
from pathlib import Path

FILE_LIMIT = 500
HEADERS_LIMIT = 1500
FOLDERS = ("include", "src", "apps", "tests", "tools", "studio/src", "studio/tests", "bench", "validation", "python")
ENDINGS = (".h", ".cpp", ".py", ".ts", ".mjs", ".js", ".svelte", ".sh", ".cmake")
LOOSE = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b")


def check(tree):
    """What is too large or left undone, a line each, and how many files were looked at."""
    problems, seen, header_lines = [], 0, 0
    for file in (f for folder in FOLDERS for f in sorted((tree / folder).rglob("*"))):
        if file.suffix not in ENDINGS or "node_modules" in file.parts:
            continue
        seen += 1
        path = file.relative_to(tree)
        lines = file.read_text(encoding="utf-8").splitlines()
        if path.parts[0] == "include":
            header_lines += len(lines)
        if len(lines) > FILE_LIMIT:
            problems.append(f"{path}: {len(lines)} lines, at most {FILE_LIMIT}")
        problems += [f"{path}:{n}: {LOOSE.search(line)[0]}: do it or drop it" for n, line in enumerate(lines, 1) if LOOSE.search(line)]
    if header_lines > HEADERS_LIMIT:
        problems.append(f"include/topple: {header_lines} lines together, at most {HEADERS_LIMIT}")
    return problems, seen, header_lines


def main():
    tree = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems, seen, header_lines = check(tree)
    print("\n".join(problems + [f"{seen} files, {header_lines} lines of public headers, {len(problems)} problems"]))
    return 1 if problems or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
