#!/usr/bin/env python3
"""Checks by names, in seconds, that each file includes what it uses. (The stage `alone` of share/test.sh asks the compiler.)

check_includes.py [ROOT]       checks ROOT (default: this checkout)
check_includes.py --self-test  shows that each rule can fail

Rules: for each name of the standard library that a file uses, the file includes a header that gives this name. A header of takt
may include it for the file; another header of the standard library may not. A production file that uses a type of takt reaches
the header that defines this type, or declares the type. Types whose name has several meanings in the tree are left to the compiler.
"""
import collections
import functools
import pathlib
import re
import sys
import tempfile

LIBRARIES = ("eds_parser", "master", "apps", "share/include", "test")

TABLE = pathlib.Path(__file__).with_name("standard_names.txt")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^">]+)[">]', re.MULTILINE)
NOT_CODE = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'""", re.DOTALL)
USED = re.compile(r"\bstd::(?:ranges::)?(\w+)")
TYPE = re.compile(r"^(?:template\s*<[^;{}]*?>\s*)?(?:class|struct|enum class|enum|union|concept)\s+(?:\[\[\w+\]\]\s*)?(\w+)"
                  r"\s*(?:final\s*)?(?::[^;{]*)?(?=[{=])|^using\s+(\w+)\s*=", re.MULTILINE)
IN_FRONT = re.compile(r"\b(?:class|struct|enum class)\s+(\w+)(?:\s*:\s*[\w:]+)?;")
NESTED = re.compile(r"^[ \t]+(?:class|struct|enum class|enum|using)\s+(\w+)\s*(?=[{=:f;])|\btypename\s+(\w+)|^template <\w+ (\w+)>",
                    re.MULTILINE)
WORD = re.compile(r"(?<![.\w>:])(?:[a-z]\w*::)*([A-Z]\w*)\b")


def headers_of_names():
    """The headers that declare each name of the table."""
    headers = collections.defaultdict(set)
    header = None
    for word in " ".join(line for line in TABLE.read_text().splitlines() if not line.startswith("#")).split():
        if word.endswith(":"):
            header = word[:-1]
        else:
            headers[word].add(header)
    return headers


HEADERS_OF = headers_of_names()


class Tree:
    def __init__(self, root):
        self.root = root
        self.files = sorted(path.relative_to(root) for library in LIBRARIES for path in (root / library).rglob("*.[ch]pp"))
        self.known = {str(file): file for file in self.files}
        self.homes = collections.defaultdict(set)
        ambiguous = set()
        for file in self.files:
            ambiguous |= {name for names in NESTED.findall(self.code(file)) for name in names}
            for outer, alias in TYPE.findall(self.code(file)):
                if file.suffix == ".hpp":
                    self.homes[outer or alias].add(file)
                else:
                    ambiguous.add(outer or alias)
        self.homes = {name: homes for name, homes in self.homes.items() if name not in ambiguous}

    @functools.cache
    def text(self, file):
        return (self.root / file).read_text()

    @functools.cache
    def code(self, file):
        return NOT_CODE.sub(" ", INCLUDE.sub(" ", self.text(file)))

    def target(self, file, name):
        """The file of the tree that `#include name` in `file` means, or nothing."""
        for candidate in (name, str(file.parent / name), f"share/include/{name}"):
            if candidate in self.known:
                return self.known[candidate]
        return None

    @functools.cache
    def reached(self, file):
        """`file`, all files of the tree that it includes, directly or not, and all foreign headers that these files
        name."""
        files, others, left = set(), set(), [file]
        while left:
            one = left.pop()
            if one in files:
                continue
            files.add(one)
            for name in INCLUDE.findall(self.text(one)):
                target = self.target(one, name)
                if target is not None:
                    left.append(target)
                else:
                    others.add(name)
        return files, others

    def missing(self, file):
        files, others = self.reached(file)
        code = self.code(file)
        for name in sorted(set(USED.findall(code))):
            headers = HEADERS_OF.get(name)
            if headers is None:
                if name != "ranges":
                    yield f"std::{name} is not in test/house/standard_names.txt"
            elif not headers & others:
                yield f"std::{name} needs <{sorted(headers)[0]}>"
        if file.parts[0] == "test":
            return  # its names of test suites are those of types
        declared = set(IN_FRONT.findall(code)) | {outer or alias for outer, alias in TYPE.findall(code)}
        for name in sorted(set(WORD.findall(code)) - declared):
            homes = self.homes.get(name)
            if homes and not homes & files and len(homes) == 1:
                yield f"{name} needs \"{sorted(map(str, homes))[0]}\""


def findings(root):
    tree = Tree(root)
    return [f"{file}: {what}" for file in tree.files for what in tree.missing(file)]


def self_test():
    good = {
        "master/part/kept.hpp": "#pragma once\n#include <vector>\nnamespace takt {\nclass Kept {};\n}\n",
        "master/part/direct.cpp": "#include <utility>\nint a() { return std::exchange(b, 1); }\n",
        "master/part/behind.cpp": '#include "master/part/kept.hpp"\nstd::vector<Kept> all;\n',
        "master/part/in_front.cpp": "class Kept;\nvoid look(const Kept&);\n",
        "master/part/comment.cpp": "// std::map, Kept\nconst char* text = \"std::map Kept\";\n",
        "test/part/suite.cpp": "TEST(Kept, IsKept) {}\n",
    }
    bad = {
        "std::map needs <map>": "#include <set>\nstd::map<int, int> m;\n",
        "std::sort needs <algorithm>": "#include <vector>\nvoid a() { std::ranges::sort(b); }\n",
        "std::no_such is not in test/house/standard_names.txt": "int a = std::no_such();\n",
        'Kept needs "master/part/kept.hpp"': "void keep(takt::Kept kept);\n",
    }
    for expected, text in [(None, None), *bad.items()]:
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for file, content in (good | ({"master/part/bad.cpp": text} if text else {})).items():
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(content)
            found = findings(root)
            wanted = [f"master/part/bad.cpp: {expected}"] if expected else []
            if found != wanted:
                sys.exit(f"expected {wanted}, found {found}")


def main(arguments):
    if arguments == ["--self-test"]:
        self_test()
        return 0
    found = findings(pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).resolve().parents[2])
    for finding in found:
        print(finding)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
