#!/usr/bin/env python3
"""tidy.py BUILD JOBS - clang-tidy over the sources of eds_parser/, master/ and apps/, with the commands of BUILD.

A source that was good is not read again as long as nothing has changed that decides the result: the source and the headers of
the tree that it includes, its compile command, .clang-tidy, and the version of clang-tidy. The keys of good sources are kept in
$XDG_CACHE_HOME/takt/tidy. Headers of the system are not part of the key. Exit code 1: clang-tidy found something.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "takt" / "tidy"
TIDY = "clang-tidy-19"
INCLUDE = re.compile(rb'^#include ["<]([^">]+)[">]', re.MULTILINE)


@functools.cache
def closure(path, roots):
    """The file and all files below the roots that it includes, directly or not."""
    found, left = set(), [path]
    while left:
        file = left.pop()
        if file not in found:
            found.add(file)
            left += [root / name.decode() for name in INCLUDE.findall(contents(file)) for root in roots
                     if (root / name.decode()).is_file()]
    return sorted(found)


@functools.cache
def contents(file):
    return file.read_bytes()


def key(entry, roots, common):
    digest = hashlib.sha256(common)
    digest.update(entry["command"].replace(str(ROOT), "").encode())
    for file in closure(pathlib.Path(entry["file"]), roots):
        digest.update(contents(file))
    return digest.hexdigest()


def main(build, jobs):
    build = pathlib.Path(build).resolve()
    roots = (ROOT, build / "lcm/include")
    version = subprocess.run([TIDY, "--version"], stdout=subprocess.PIPE, check=True).stdout
    common = version + (ROOT / ".clang-tidy").read_bytes()
    folders = tuple(f"{ROOT}/{name}/" for name in ("eds_parser", "master", "apps"))
    entries = [entry for entry in json.loads((build / "compile_commands.json").read_text())
               if entry["file"].startswith(folders)]
    wanted = {CACHE / key(entry, roots, common): entry["file"] for entry in entries}
    left = [mark for mark in wanted if not mark.exists()]
    CACHE.mkdir(parents=True, exist_ok=True)

    def tidy(mark):
        done = subprocess.run([TIDY, "-quiet", "-p", build, wanted[mark]], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True)
        if done.returncode == 0:
            mark.touch()
        return wanted[mark], done

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        for source, done in pool.map(tidy, left):
            if done.returncode != 0:
                failed += 1
                print(f"--- {os.path.relpath(source, ROOT)}", done.stdout, sep="\n", flush=True)
    print(f"{len(wanted)} sources, {len(left)} read, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
