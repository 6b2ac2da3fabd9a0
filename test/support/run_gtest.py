#!/usr/bin/env python3
"""run_gtest.py PROGRAM SHARD SHARDS - runs every SHARDS-th test of a GoogleTest program in one process.

One process for each test would cost more time than most tests. If the process ends early, the test that was running has
failed, and the remaining tests run in a new process. If it ends badly although no test has failed, for example because of a
leak, each test runs in a process of its own to find which one it is. Prints what failed tests have printed, and a last line
for share/test.sh. Exit code 1: a test failed.
"""
import re
import subprocess
import sys

# A test may print text without an end of line before them.
BEGUN = re.compile(r"\[ RUN      \] (\S+)$")
ENDED = re.compile(r"\[ +(OK|FAILED|SKIPPED) +\] (\S+?)(?:, where .*)? \(\d+ ms\)$")


def tests_of(program):
    listed = subprocess.run([program, "--gtest_list_tests"], stdout=subprocess.PIPE, text=True, check=True).stdout
    suite, tests = "", []
    for line in listed.splitlines():
        name = line.split("#")[0].rstrip()
        if line.startswith("  "):
            if not name.lstrip().startswith("DISABLED_") and not suite.startswith("DISABLED_"):
                tests.append(suite + name.lstrip())
        elif name.endswith("."):
            suite = name
    return tests


def run(program, tests):
    """Returns the verdict and the output of each test that began, and the exit code."""
    process = subprocess.run([program, "--gtest_filter=" + ":".join(tests)], stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    verdicts, output, current = {}, {}, None
    for line in process.stdout.decode(errors="replace").splitlines():
        if begun := BEGUN.search(line):
            current = begun[1]
            verdicts[current], output[current] = "FAILED", []
        elif current:
            output[current].append(line)
            ended = ENDED.search(line)
            if ended and ended[2] == current:
                verdicts[current], current = ended[1], None
    return verdicts, output, process.returncode


def run_all(program, tests):
    """The outputs of the tests that failed, by their names."""
    failed, left = {}, tests
    while left:
        verdicts, output, code = run(program, left)
        bad = {test: output[test] for test, verdict in verdicts.items() if verdict == "FAILED"}
        if not verdicts or (code != 0 and not bad):
            if len(left) == 1:
                return failed | {left[0]: [f"ends with exit code {code}"] + output.get(left[0], [])}
            for test in left:
                failed |= run_all(program, [test])
            return failed
        failed |= bad
        left = [test for test in left if test not in verdicts]
    return failed


def main(program, shard, shards):
    tests = tests_of(program)[int(shard)::int(shards)]
    failed = run_all(program, tests)
    for test, output in failed.items():
        print(f"--- {test} failed:", *output, sep="\n")
    for test in failed:
        print(f"FAILED {test}")
    print(f"tests: {len(tests) - len(failed)} passed, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
