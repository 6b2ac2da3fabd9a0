"""Runs the tests that reach a mutant, until one of them fails."""
import collections
import dataclasses
import os
import re
import resource
import signal
import subprocess
import tempfile
import time

BEGUN = re.compile(r"\[ RUN      \] (\S+)$", re.MULTILINE)
FAILED = re.compile(r"\[  FAILED  \] ([^\s,]+)(?:, where .*)? \(\d+ ms\)$", re.MULTILINE)
GOOD = re.compile(r"\[       OK \] ([^\s,]+)(?:, where .*)? \(\d+ ms\)$", re.MULTILINE)
ROUNDS_MS = (1000, 10000)  # of the first rounds of a mutant; the last round has all other tests
LONG_MS = 100
LONGEST_FILTER = 100_000  # characters; Linux takes 131071 as one argument


@dataclasses.dataclass(frozen=True)
class Test:
    program: str
    name: str
    ms: int


@dataclasses.dataclass(frozen=True)
class Verdict:
    caught: bool
    by: str  # the test that noticed it, or why no test did
    seconds: float


class TestPrograms:
    def __init__(self, folder, bin_folder, programs, least_limit=5.0):
        self.folder, self.bin, self.programs, self.least_limit = folder, bin_folder, programs, least_limit
        self.reaching = collections.defaultdict(list)  # the tests that reach a mutant
        self.reached_by = collections.Counter()  # the number of mutants that a test reaches
        self.failing = []  # without any mutant
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))

    def record(self):
        """Runs all tests without a mutant and learns which mutants each of them reaches."""
        for program in self.programs:
            notes = self.folder / f"{program}.reach"
            notes.unlink(missing_ok=True)
            began = time.monotonic()
            self.start(program, [], -1, None, {"TAKT_MUTANT_REACH": str(notes)})
            tests, everywhere = {}, set()
            for line in notes.read_text().splitlines():
                name, ms, verdict, numbers = line.split("\t")
                reached = {int(number) for number in numbers.split()}
                if verdict == "outside":
                    everywhere |= reached
                elif verdict == "passed":
                    tests[Test(program, name, int(ms))] = reached
                elif verdict == "failed":
                    self.failing.append(f"{program} {name}")
            for test, reached in tests.items():
                self.reached_by[test] = len(reached)
                for number in reached | everywhere:
                    self.reaching[number].append(test)
            print(f"{program}: {len(tests)} tests in {time.monotonic() - began:.1f} s reach "
                  f"{len(everywhere.union(*tests.values()))} mutants", flush=True)

    def judge(self, number):
        """Runs the tests that reach the mutant: first those that reach few mutants, because they are about its place."""
        began = time.monotonic()
        if not self.reaching[number]:
            return Verdict(False, "no test reaches it", 0)
        for tests in self.rounds(self.reaching[number]):
            while tests:
                noticed = self.first_that_fails(number, tests)
                if noticed is None:
                    break
                test, how = noticed
                suspects = [test] if test else tests
                # A test that also fails without the mutant, beside a busy processor, proves nothing.
                if self.first_that_fails(0, suspects) is None:
                    return Verdict(True, how, time.monotonic() - began)
                tests = [other for other in tests if other not in suspects]
        return Verdict(False, f"{len(self.reaching[number])} tests reach it, none fails", time.monotonic() - began)

    def rounds(self, tests):
        """The tests of one program that run together. Tests that take long come last."""
        left = sorted(tests, key=lambda test: (test.ms > LONG_MS, self.reached_by[test], test.ms))
        for most in (*ROUNDS_MS, None):
            programs, used = collections.defaultdict(list), 0
            while left and (most is None or used <= most):
                used += left[0].ms + 1
                programs[left[0].program].append(left.pop(0))
            yield from sorted(programs.values(), key=lambda found: sum(test.ms for test in found))

    def first_that_fails(self, number, tests):
        """(test, text) of the first test that fails with the mutant. test is None if the program ends badly, or takes too
        long, although each test that has begun has passed."""
        by_name = {test.name: test for test in tests}
        limit = self.least_limit + sum(test.ms for test in tests) / 100
        code, output = self.start(tests[0].program, list(by_name), number, limit)
        if code == 0:
            return None
        begun = BEGUN.findall(output)
        if failed := FAILED.findall(output):
            return by_name.get(failed[0]), f"{tests[0].program} {failed[0]}"
        ended = set(GOOD.findall(output))
        left = [name for name in begun if name not in ended]
        how = "takes too long" if code is None else f"ends with {code}"
        return (by_name.get(left[-1]) if left else None), f"{tests[0].program} {left[-1] if left else ''} {how}"

    def start(self, program, tests, number, limit, more=None):
        """Returns the exit code and the output of a program; the code is None if it did not end in time."""
        text = ":".join(tests)
        if len(text) > LONGEST_FILTER:
            half = len(tests) // 2
            code, output = self.start(program, tests[:half], number, limit, more)
            return (code, output) if code != 0 else self.start(program, tests[half:], number, limit, more)
        command = [self.bin / program, "--gtest_color=no", *([f"--gtest_filter={text}", "--gtest_fail_fast"] if tests else [])]
        with tempfile.TemporaryFile(dir=self.folder) as output:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                       cwd=self.folder, start_new_session=True,
                                       env=os.environ | {"TAKT_MUTANT": str(number)} | (more or {}))
            try:
                code = process.wait(limit)
            except subprocess.TimeoutExpired:
                code = None
            try:
                os.killpg(process.pid, signal.SIGKILL)  # also children that the test has left
            except ProcessLookupError:
                pass
            process.wait()
            output.seek(0)
            return code, output.read(50_000_000).decode(errors="replace")
