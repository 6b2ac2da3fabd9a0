"""Runs a check over the sources of eds_parser/, master/ and apps/, with the commands of a build folder.

A source that has passed is not read again until something changes that decides the result: the source and the files of
the tree that it includes, its compile command, and what the check names as common (its settings, the version of its
program). The keys of good sources are kept in $XDG_CACHE_HOME/takt/CHECK. Headers of the system are not part of the
key.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "takt"
INCLUDE = re.compile(rb'^#include ["<]([^">]+)[">]', re.MULTILINE)


@functools.cache
def contents(file):
    return file.read_bytes()


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


def key(entry, roots, common):
    digest = hashlib.sha256(common)
    digest.update(entry["command"].replace(str(ROOT), "").encode())
    for file in closure(pathlib.Path(entry["file"]), roots):
        digest.update(contents(file).replace(str(ROOT).encode(), b""))
    return digest.hexdigest()


def output_of(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout


def check(name, build, jobs, common, command):
    """Runs `command(entry)` for each entry of compile_commands.json. Returns the exit code: 1 if one of them has failed."""
    build = pathlib.Path(build).resolve()
    roots = (ROOT, build / "lcm/include")
    cache = CACHE / name
    cache.mkdir(parents=True, exist_ok=True)
    entries = [entry for entry in json.loads((build / "compile_commands.json").read_text())
               if not entry["file"].startswith(f"{build}/lcm/") and entry["file"].endswith((".cpp", ".cxx"))]
    wanted = {cache / key(entry, roots, common): entry for entry in entries}
    left = [mark for mark in wanted if not mark.exists()]

    def run(mark):
        entry = wanted[mark]
        done = subprocess.run(command(entry), cwd=entry["directory"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode == 0:
            mark.touch()
        return entry["file"], done

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        for source, done in pool.map(run, left):
            if done.returncode != 0:
                failed += 1
                print(f"--- {os.path.relpath(source, ROOT)}", done.stdout, sep="\n", flush=True)
    print(f"{len(wanted)} sources, {len(left)} read, {failed} with findings")
    return 1 if failed else 0
