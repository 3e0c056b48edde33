#!/usr/bin/env python3
"""Fails on an include that the architecture forbids: an arrow from a chapter to one it may not use, or a third party in the core.

usage: check_includes.py [TREE]    (default: the tree this file is in)
"""
import re
import sys
from pathlib import Path

# Who may use whom, directly; what those use in turn may be used too. The same arrows as in CMakeLists.txt and ARCHITECTURE.md.
USES = {
    "base": [],
    "layout": ["base"],
    "picture": ["layout"],
    "model": ["layout"],
    "pivot": ["model"],
    "hinge": ["model"],
    "rigid": ["model"],
    "recording": ["model"],
    "run": ["recording", "pivot", "hinge", "rigid"],
    "measure": ["recording"],
    "sweep": ["run", "measure"],
    "export": ["recording", "measure", "picture"],
    "validation": ["run", "measure", "export"],
    "all": ["run", "measure", "sweep", "export", "validation"],  # include/topple/topple.h
    "apps": ["all"],
    "python": ["all"],
}
MODELS = ["pivot", "hinge", "rigid"]
CORE = ["base", "layout", "picture", "model", "pivot", "hinge", "rigid", "recording", "run", "measure", "sweep"]

# Third parties, and the operating system, by the chapter that may have them.
FOREIGN = {
    "layout": r"toml\+\+/.*",
    "export": r"hdf5.*|H5.*|stb/.*|cairo/.*|nlohmann/.*",
    "validation": r"toml\+\+/.*|nlohmann/.*",
    "python": r"pybind11/.*",
    "apps": r"CLI/.*|httplib\.h|nlohmann/.*",
}
SYSTEM = r"(sys|netinet|arpa)/.*|unistd\.h|fcntl\.h|poll\.h|signal\.h|spawn\.h|pthread\.h|termios\.h"
MAY_USE_SYSTEM = ["export", "apps"]

STANDARD = set("""algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes climits
clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg cstddef cstdint cstdio cstdlib cstring
ctime cuchar cwchar cwctype deque exception execution expected filesystem forward_list fstream functional future initializer_list iomanip
ios iosfwd iostream istream iterator latch limits list locale map memory memory_resource mutex new numbers numeric optional ostream queue
random ranges ratio regex scoped_allocator semaphore set shared_mutex source_location span spanstream sstream stack stacktrace stdexcept
stop_token streambuf string string_view syncstream system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set
utility valarray variant vector version""".split())
# The core reads bytes and text, never paths, and never prints.
NOT_IN_CORE = {"filesystem", "fstream", "iostream", "syncstream", "csetjmp", "csignal", "random", "regex", "locale"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')


def reach(chapter):
    """A chapter and all that it may use, directly or through others."""
    found, waiting = set(), [chapter]
    while waiting:
        here = waiting.pop()
        if here not in found:
            found.add(here)
            waiting += USES[here]
    return found


def chapter_of(path):
    """The chapter that a path of the tree belongs to, or None for what is free (tests)."""
    parts = path.parts
    if parts[0] in ("apps", "python"):
        return parts[0]
    if parts[:2] == ("include", "topple"):
        return {"topple": "all", "profile": "base"}.get(path.stem, path.stem)
    if parts[0] == "src":
        return parts[2] if parts[1] == "model" and len(parts) > 3 else parts[1]
    return None


def target_of(file, name, tree):
    """The chapter that a quoted include leads to: a public header, a file below src/, or one beside the including file."""
    if name.startswith("topple/"):
        return chapter_of(Path("include") / name)
    for candidate in (file.parent / name, tree / "src" / name):
        candidate = candidate.resolve()
        if candidate.is_file() and candidate.is_relative_to(tree):
            return chapter_of(candidate.relative_to(tree))
    return "nowhere"


def problem_with(chapter, file, quoted, bracketed, tree):
    """What is wrong with one include, or None."""
    if quoted or bracketed.startswith("topple/"):
        target = target_of(file, quoted or bracketed, tree)
        if target == "nowhere":
            return "leads to no file of the tree"
        if target in MODELS and chapter in MODELS and target != chapter:
            return f"model '{chapter}' may not know model '{target}'"
        if target not in reach(chapter):
            return f"chapter '{chapter}' may not use '{target}'"
        return None
    if bracketed in STANDARD:
        return f"the core ('{chapter}') may not use <{bracketed}>" if chapter in CORE and bracketed in NOT_IN_CORE else None
    if chapter in MAY_USE_SYSTEM and re.fullmatch(SYSTEM, bracketed):
        return None
    if re.fullmatch(FOREIGN.get(chapter, r"(?!)"), bracketed):
        return None
    return f"chapter '{chapter}' may not use <{bracketed}>"


def check(tree):
    """All forbidden includes of a tree, a line each, and how many includes were looked at."""
    problems, seen = [], 0
    for folder in ("include", "src", "apps", "python"):
        for file in sorted((tree / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            path = file.relative_to(tree)
            chapter = chapter_of(path)
            if chapter not in USES:
                problems.append(f"{path}:1: there is no chapter '{chapter}'")
                continue
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                if match:
                    seen += 1
                    problem = problem_with(chapter, file, match[1], match[2] or "", tree)
                    if problem:
                        problems.append(f"{path}:{number}: {line.strip()}: {problem}")
    return problems, seen


def main():
    tree = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    problems, seen = check(tree)
    print("\n".join(problems + [f"{seen} includes, {len(problems)} forbidden"]))
    return 1 if problems or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
