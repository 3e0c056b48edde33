#!/usr/bin/env python3
"""Fails on a source key such as [Arnesson2020], in code or documents, that docs/references.bib does not have, and on a document's link
that leads to no file.

usage: check_references.py [TREE]    (default: the tree this file is in)
"""
import re
import sys
from pathlib import Path

FOLDERS = ("include", "src", "apps", "tests", "scenes", "docs", "studio/src", "bench", "validation")
ENDINGS = (".h", ".cpp", ".py", ".ts", ".svelte", ".md", ".toml")
KEY = re.compile(r"\[([A-Za-z]+(?:19|20)\d\d[a-z]?)\]")
LINK = re.compile(r"\]\(([^)#:\s]+)\)")
ENTRY = re.compile(r"^@\w+\{([^,\s]+),", re.MULTILINE)


def check(tree):
    """Citations without an entry, a line each; how many citations there are; the entries."""
    entries = ENTRY.findall((tree / "docs" / "references.bib").read_text(encoding="utf-8"))
    problems = [f"docs/references.bib: {key} is there twice" for key in sorted(set(entries)) if entries.count(key) > 1]
    cited = 0
    files = [f for folder in FOLDERS for f in sorted((tree / folder).rglob("*"))] + sorted(tree.glob("*.md"))
    for file in files:
        if file.suffix not in ENDINGS or "node_modules" in file.parts or not file.is_file():
            continue
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            for key in KEY.findall(line):
                cited += 1
                if key not in entries:
                    problems.append(f"{file.relative_to(tree)}:{number}: [{key}] is not in docs/references.bib")
            for link in LINK.findall(line) if file.suffix == ".md" else []:
                if not (file.parent / link).exists():
                    problems.append(f"{file.relative_to(tree)}:{number}: the link to {link} leads nowhere")
    return problems, cited, entries


def main():
    tree = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems, cited, entries = check(tree)
    print("\n".join(problems + [f"{cited} citations, {len(entries)} sources, {len(problems)} problems"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
