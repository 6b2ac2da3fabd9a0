#!/usr/bin/env python3
"""tidy.py BUILD JOBS - clang-tidy over all production sources. Exit code 1: clang-tidy found something."""
import sys

from checked_sources import ROOT, check, output_of

TIDY = "clang-tidy-19"


def main(build, jobs):
    common = output_of(TIDY, "--version") + (ROOT / ".clang-tidy").read_bytes()
    return check("tidy", build, jobs, common, lambda entry: (TIDY, "-quiet", "-p", build, entry["file"]))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
