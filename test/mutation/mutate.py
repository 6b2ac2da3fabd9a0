#!/usr/bin/env python3
"""mutate.py - changes the code of floors 0 to 3 in many small ways and counts how many of the changes the tests notice.

  mutate.py [--seed 1] [--count 200] [--jobs N] [--folder build/mutation]   builds, runs, reports
  mutate.py --list               only prints the mutants, without those that turn out not to compile
  mutate.py --only 17,23         runs only these mutants, for example after a test has been written
  mutate.py --programs unit_eds,unit_plan     builds and runs only these programs
  mutate.py --rooms master/wire --programs unit_wire   runs only those of the 200 mutants that are in this folder
  mutate.py --self-test          shows with a small project that mutants are caught, that they survive, and what is mutated

All mutants are in one copy of the tree, and an environment variable selects one of them at run time; so the programs are built
once. For each mutant only the tests that reach it are run, until one fails. Exit code 0: at least 95 % of the mutants are
caught, and survivors.md explains the others. testing.md describes which places are not mutated.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import sys
import time

from choice import Choice, read_sources
from mutant_build import MutantTree, Project
from mutant_runs import TestPrograms

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LEAST_PERCENT = 95
TAKT = Project(
    root=ROOT,
    # Floor 0: the tables. 1: the parser and the codecs. 2: the protocol machines and their texts. 3: the cycle.
    folders=("eds_parser", "master/wire", "master/core", "master/explain", "master/rt"),
    libraries=("takt_table", "takt_eds", "takt_check", "takt_write", "takt_budget", "takt_print", "takt_network_file",
               "takt_wire", "takt_core", "takt_explain", "takt_frame_text", "takt_rt"),
    programs=("unit_table", "unit_wire", "unit_eds", "unit_plan", "unit_core", "unit_frame_text", "unit_rt", "boot", "budget",
              "virtual"),
    # A build type without flags: not optimized, because compiling takes longer than the tests, and with assertions.
    configure=("--preset", "release", "-DCMAKE_BUILD_TYPE=Mutation", "-DTAKT_TESTS=ON", "-DTAKT_WERROR=OFF",
               "-DTAKT_UNITY=ON", "-DTAKT_PCH=ON"))
EXPLAINED = re.compile(r"^## ([0-9a-f]{8})\b.*\n\n(?:.+\n)+\n\S", re.MULTILINE)


def explained():
    """The keys of the mutants for which survivors.md has a change and, in a paragraph below, a reason."""
    return set(EXPLAINED.findall((HERE / "survivors.md").read_text(encoding="utf-8")))


def describe(mutant):
    """The section of survivors.md, without the reason."""
    mutation = mutant.mutation
    return (f"## {mutant.key} {mutation.path}, {mutation.what}\n\n"
            f"`{mutation.original}`\nbecomes `{mutation.changed or ';'}`\n")


def judge_all(programs, mutants, jobs):
    """The verdict of each mutant, printed as soon as it is known."""
    verdicts = {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for mutant, verdict in zip(mutants, pool.map(lambda mutant: programs.judge(mutant.number), mutants)):
            verdicts[mutant] = verdict
            word = "caught" if verdict.caught else "SURVIVES"
            print(f"{mutant.number:4} {word:8} {mutant.where()}: {verdict.by} ({verdict.seconds:.1f} s)", flush=True)
    return verdicts


def report(verdicts, reasons):
    """Prints the survivors and the sum; returns the exit code."""
    survivors = [mutant for mutant, verdict in verdicts.items() if not verdict.caught]
    unexplained = [mutant for mutant in survivors if mutant.key not in reasons]
    for mutant in unexplained:
        print(f"\n{describe(mutant)}\n{mutant.number}: {verdicts[mutant].by}")
    caught = len(verdicts) - len(survivors)
    percent = 100 * caught / len(verdicts) if verdicts else 0
    print(f"\n{len(verdicts)} mutants: {caught} caught ({percent:.1f} %), {len(survivors)} survive, "
          f"{len(survivors) - len(unexplained)} of them explained")
    return 0 if percent >= LEAST_PERCENT and not unexplained else 1


def write_results(file, verdicts):
    file.write_text(json.dumps([{"number": mutant.number, "key": mutant.key, "where": mutant.where(),
                                 "title": mutant.mutation.title(), "caught": verdict.caught, "by": verdict.by}
                                for mutant, verdict in verdicts.items()], indent=1))


def run(project, options, folder, reasons, least_limit=5.0):
    choice = Choice(read_sources(project.root, project.folders), options.seed, options.count)
    print(f"{choice.places} possible mutations in {choice.lines} lines of {len(choice.shares)} rooms", flush=True)
    folder.mkdir(parents=True, exist_ok=True)
    tree = MutantTree(project, folder, options.jobs, options.programs, options.rooms)
    if options.list:
        for room, share in tree.shares(choice).items():
            for mutant in tree.take(choice, room, share):
                print(f"{mutant.where()}: {mutant.mutation.title()}")
        return 0
    began = time.monotonic()
    mutants = tree.make(choice)
    print(f"built in {time.monotonic() - began:.0f} s", flush=True)
    programs = TestPrograms(folder, tree.build / "bin", options.programs, least_limit)
    programs.record()
    for test in programs.failing:
        print(f"fails without any mutant, so it is not used: {test}")
    if options.only:
        mutants = [mutant for mutant in mutants if mutant.number in options.only]
    verdicts = judge_all(programs, mutants, options.jobs)
    write_results(folder / "result.json", verdicts)
    print(f"{time.monotonic() - began:.0f} s in all")
    return report(verdicts, reasons)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build/mutation")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", type=lambda text: {int(number) for number in text.split(",")})
    parser.add_argument("--programs", type=lambda text: tuple(text.split(",")), default=TAKT.programs)
    parser.add_argument("--rooms", type=lambda text: tuple(text.split(",")), default=())
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        import self_test
        return self_test.self_test()
    return run(TAKT, options, options.folder.resolve(), explained())


if __name__ == "__main__":
    sys.exit(main())
