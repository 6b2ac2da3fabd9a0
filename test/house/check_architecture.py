#!/usr/bin/env python3
"""Compares share/doc/architecture.md with the tree, and fails on differences.

check_architecture.py [ROOT]       checks ROOT (default: this checkout)
check_architecture.py --self-test  shows that each rule can fail

Rules: the tables of the rooms are those of `check_rooms.py --table`; each path in code style exists; each function that
is named beside a file is in that file: in a table row that begins with a file and a function, and in text of the form
"`function` in `file`".
"""
import pathlib
import re
import sys
import tempfile

import check_rooms

PAGE = "share/doc/architecture.md"
ROOM_ROW = re.compile(rf"^\| `(?:{'|'.join(check_rooms.LIBRARIES)})(?:/[\w/]*)?/` \|")
CODE = re.compile(r"`([^`]+)`")
PATH = re.compile(r"[\w.-]+(?:/[\w.@-]+)*/?")
PLACE = r"`([\w./-]+\.[ch]pp)`"
FUNCTION = r"`(\w+(?:::\w+)*)`"
TOLD = (re.compile(rf"^\|(?: \w \|)? {PLACE} \| {FUNCTION} \|"), re.compile(rf"{FUNCTION} in {PLACE}"))


def rows_of_rooms():
    for library in check_rooms.LIBRARIES:
        yield from list(check_rooms.table(library))[2:]


def differing_rooms(lines):
    """(line, what) of each room that is missing, unknown, or described otherwise than in check_rooms.py."""
    expected = {row.split("|")[1]: row for row in rows_of_rooms()}
    found = {}
    for number, line in enumerate(lines, 1):
        if not ROOM_ROW.match(line):
            continue
        room = line.split("|")[1]
        if room in found:
            yield number, f"the room{room}is there twice"
        elif room not in expected:
            yield number, f"there is no room{room}"
        elif line != expected[room]:
            yield number, f"`check_rooms.py --table` says: {expected[room]}"
        found[room] = line
    for room in expected.keys() - found.keys():
        yield len(lines), f"the room{room}is missing"
    if list(found) != [room for room in expected if room in found]:
        yield len(lines), "the rooms have another order than in `check_rooms.py --table`"


def missing_paths(lines, root):
    """(line, what) of each path in code style that does not exist."""
    for number, line in enumerate(lines, 1):
        for code in CODE.findall(line):
            if "/" in code and PATH.fullmatch(code) and not pathlib.Path(root, code).exists():
                yield number, f"there is no {code}"


def has(text, name):
    """Whether a C++ file has the definition or the declaration of this function or type."""
    *scopes, last = name.split("::")
    types = r"\b(?:class|struct|enum class|union|concept)\s+"
    if not scopes:
        return re.search(rf"\b{last}\(|{types}{last}\b", text) is not None
    scope = scopes[-1]
    outside = re.search(rf"\b{scope}(?:<[^<>]*>)?::{last}\(", text)
    inside = re.search(rf"{types}{scope}\b", text) and re.search(rf"\b{last}\(|{types}{last}\b", text)
    return bool(outside or inside)


def missing_functions(lines, root):
    """(line, what) of each function that is not in the file beside it."""
    for number, line in enumerate(lines, 1):
        places = TOLD[0].findall(line) + [(path, name) for name, path in TOLD[1].findall(line)]
        for path, name in places:
            file = pathlib.Path(root, path)
            if file.is_file() and not has(file.read_text(encoding="utf-8"), name):
                yield number, f"{path} has no {name}"


def check(root):
    page = pathlib.Path(root, PAGE)
    if not page.is_file():
        return [(0, "the page is missing")]
    lines = page.read_text(encoding="utf-8").splitlines()
    return sorted([*differing_rooms(lines), *missing_paths(lines, root), *missing_functions(lines, root)])


CPP = "void Loop::run() {\n  stop();\n}\nclass Box {\n  void open() {}\n};\n"
BAD = (
    "see `master/rt/gone.cpp`",
    "see `master/gone/`",
    "| `master/rt/loop.cpp` | `Loop::stop` | ends |",
    "| A | `master/rt/loop.cpp` | `Box::close` | closes |",
    "`Loop::gone` in `master/rt/loop.cpp`",
    "`close` in `master/rt/loop.cpp`",
)
GOOD = (
    "see `master/rt/loop.cpp`, `master/rt/` and `ip link / x`",
    "| `master/rt/loop.cpp` | `Loop::run` | runs |",
    "| A | `master/rt/loop.cpp` | `Box::open` | opens |",
    "`Box` in `master/rt/loop.cpp`",
    "`stop` in `master/rt/loop.cpp`",
)


def self_test():
    complaints = []
    rows = list(rows_of_rooms())
    other = rows[0].replace(rows[0].split("|")[2], " another sentence ")
    for what, lines in {"is missing": rows[1:], "is there twice": [*rows, rows[0]], "another order": [*rows[1:], rows[0]],
                        "there is no room": [*rows, "| `master/gone/` | a room | |"], "says": [other, *rows[1:]]}.items():
        if not any(what in found for _, found in differing_rooms(lines)):
            complaints.append(f"not found: a room that {what}")
    complaints += [f"wrongly refused: {what}" for _, what in differing_rooms(["# Rooms", *rows, "text"])]
    with tempfile.TemporaryDirectory() as root:
        check_rooms.plant(root, {"master/rt/loop.cpp": CPP})
        if not check(root):
            complaints.append("not found: the page is missing")
        for text in BAD + GOOD:
            found = [*missing_paths([text], root), *missing_functions([text], root)]
            if bool(found) != (text in BAD):
                complaints.append(f"{'not found' if text in BAD else 'wrongly refused'}: {text}")
    for what in complaints:
        print(f"self-test: {what}")
    return 1 if complaints else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    complaints = check(root)
    for line, what in complaints:
        print(f"{PAGE}:{line}: {what}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
