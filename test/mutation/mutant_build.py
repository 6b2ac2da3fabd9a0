"""Makes a copy of a source tree that has all mutants at once, and builds its test programs."""
import collections
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

from mutations import instrumented

SPARE = 5  # one more mutant for each five of a room, because some do not compile
LOCATION = re.compile(r"^(?:In file included from |\s+from )?(\S+?):(\d+)[:,]", re.MULTILINE)
ERROR = re.compile(r"^(\S+?):(\d+):(?:\d+:)? (?:fatal )?error:", re.MULTILINE)
SELECTED = re.compile(r"::takt_mutant\((\d+)\)")


@dataclasses.dataclass(frozen=True)
class Project:
    root: pathlib.Path
    folders: tuple  # whose sources are mutated
    libraries: tuple  # targets that are built first, because they show soonest what does not compile
    programs: tuple  # GoogleTest programs
    configure: tuple  # the arguments of cmake, before those of the listener


class KeptSet:
    """A set of texts in a file, for the next run."""

    def __init__(self, file):
        self.file = file
        self.texts = set(json.loads(file.read_text())) if file.exists() else set()

    def __contains__(self, text):
        return text in self.texts

    def add(self, text):
        self.texts.add(text)
        self.file.write_text(json.dumps(sorted(self.texts), indent=0))


class MutantTree:
    """The copy lies in `folder`/tree and is built in tree/build/mutants, as a checkout is, so that ccache finds what it has
    compiled there."""

    def __init__(self, project, folder, jobs, programs, rooms=()):
        self.project, self.folder, self.jobs, self.programs, self.rooms = project, folder, jobs, programs, rooms
        self.tree = folder / "tree"
        self.build = self.tree / "build/mutants"
        self.refused = KeptSet(folder / "refused.json")  # keys of mutants
        self.compiled = KeptSet(folder / "compiled.json")  # digests of headers
        self.environment = os.environ | {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1"}

    def make(self, choice):
        """Builds the programs; returns the mutants that compile, as many for each room as is its share."""
        mutants = {room: self.take(choice, room, share + -(-share // SPARE)) for room, share in self.shares(choice).items()}
        while True:
            self.write([mutant for found in mutants.values() for mutant in found])
            refused = self.refused_headers() or self.refused_sources()
            if not refused:
                break
            for room, found in mutants.items():
                for mutant in found:
                    if mutant.number in refused:
                        print(f"does not compile: {mutant.where()}: {mutant.mutation.title()}", flush=True)
                        self.refused.add(mutant.key)
                found[:] = [mutant for mutant in found if mutant.number not in refused]
                found += self.take(choice, room, choice.shares[room] - len(found))
        return [mutant for room, found in mutants.items() for mutant in found[:choice.shares[room]]]

    def shares(self, choice):
        """The share of each wanted room. A room is wanted if no room is named, or if it or a folder above it is named."""
        return {room: share for room, share in choice.shares.items()
                if share and (not self.rooms or any(f"{room}/".startswith(f"{named}/") for named in self.rooms))}

    def take(self, choice, room, count):
        """The next mutants of the room that have not been refused by an earlier run."""
        taken = []
        while len(taken) < count and (mutants := choice.take(room, count - len(taken))):
            taken += [mutant for mutant in mutants if mutant.key not in self.refused]
        return taken

    def write(self, mutants):
        """Brings the copy up to date. A file that does not change keeps its time, so that it is not compiled again."""
        self.instrumented = {}
        by_path, sources = collections.defaultdict(list), {}
        for mutant in mutants:
            by_path[mutant.mutation.path].append((mutant.number, mutant.mutation))
            sources[mutant.mutation.path] = mutant.mutation.source
        for path, found in by_path.items():
            self.instrumented[path] = instrumented(sources[path], found)
        listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=self.project.root,
                                stdout=subprocess.PIPE, text=True, check=True).stdout.split("\0")
        wanted = {path for path in listed if path and (self.project.root / path).is_file()}
        for path in wanted:
            source, copy = self.project.root / path, self.tree / path
            text = self.instrumented[path].encode() if path in self.instrumented else source.read_bytes()
            if not copy.exists() or copy.read_bytes() != text:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(text)
                copy.chmod(source.stat().st_mode)
        for copy in self.tree.rglob("*"):
            path = copy.relative_to(self.tree)
            if copy.is_file() and path.parts[0] != "build" and path.as_posix() not in wanted:
                copy.unlink()

    def refused_headers(self):
        """The mutants in headers that do not compile. A header is compiled alone first, because many sources wait for it."""
        def check(path):
            digest = hashlib.sha256(self.instrumented[path].encode()).hexdigest()
            if digest in self.compiled:
                return set()
            done = subprocess.run(["c++", "-std=c++23", "-w", "-fsyntax-only", "-I.", "-I/usr/include/eigen3", "-x", "c++", path],
                                  cwd=self.tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode == 0:
                self.compiled.add(digest)
            return self.mutants_of_errors(done.stdout, self.tree) if done.returncode else set()

        headers = [path for path in self.instrumented if path.endswith(".hpp")]
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return set().union(*pool.map(check, headers))

    def refused_sources(self):
        """Builds everything; returns the mutants that do not compile."""
        self.run("cmake", *self.project.configure, "-B", self.build,
                 f"-DCMAKE_PROJECT_INCLUDE={self.tree / 'test/mutation/listen.cmake'}",
                 f"-DTAKT_LISTENING={';'.join(self.project.programs)}")
        libraries = self.project.libraries if self.programs == self.project.programs else ()
        for targets in (libraries, *([program] for program in self.programs)):
            if not targets:
                continue
            output = self.run("ninja", "-C", self.build, "-k", "0", "-j", str(self.jobs), *targets, may_fail=True)
            if output is not None:
                refused = self.mutants_of_errors(output, self.build)
                if not refused:
                    print(output[-8000:])
                    sys.exit("mutation: the copy does not build, and no mutant is the reason")
                return refused
        return set()

    def run(self, *command, may_fail=False):
        """Returns the output of a command that failed, otherwise None."""
        done = subprocess.run(command, cwd=self.tree, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
        if done.returncode == 0:
            return None
        if not may_fail:
            print(done.stdout[-8000:])
            sys.exit(f"mutation: {command[0]} fails")
        return done.stdout

    def mutants_of_errors(self, output, folder):
        """The numbers of the mutants in the lines that errors name; where there are none, in all lines that are named."""
        for pattern in (ERROR, LOCATION):
            found = set()
            for path, line in pattern.findall(output):
                file = pathlib.Path(os.path.normpath(folder / path))
                if file.is_relative_to(self.tree) and file.relative_to(self.tree).as_posix() in self.instrumented:
                    lines = file.read_text().splitlines()
                    if int(line) <= len(lines):
                        found |= {int(number) for number in SELECTED.findall(lines[int(line) - 1])}
            if found:
                return found
        return set()
