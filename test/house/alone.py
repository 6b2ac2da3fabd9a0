#!/usr/bin/env python3
"""alone.py BUILD JOBS - proves that each production source includes what it uses: the compiler reads each of them alone, without
a precompiled header. Needs a BUILD without TAKT_UNITY, TAKT_GROUPS and TAKT_PCH. Exit code 1: a source lacks an
include."""
import shlex
import sys

from checked_sources import check, output_of


def reading(entry):
    words = shlex.split(entry["command"])
    compiler = next(number for number, word in enumerate(words) if word.endswith(("c++", "g++", "clang++")))
    words = words[compiler:]
    del words[words.index("-o"):words.index("-o") + 2]
    return [*words, "-fsyntax-only"]


def main(build, jobs):
    return check("alone", build, jobs, output_of("c++", "--version"), reading)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
