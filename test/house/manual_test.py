#!/usr/bin/env python3
"""manual_test.py BIN          checks the manual pages that the programs write, and the width of their help texts
manual_test.py --self-test  shows that the checks can fail

Each command, argument and option of --help is on its page, and the pages have no mistakes for man (and mandoc, if it is there).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAMS = ("takt", "taktd", "takt-follow", "takt-home", "takt-jog", "takt-logic", "takt-move")
ENTRY = re.compile(r"^  (?! )(\S+(?:, ?\S+)*)", re.M)


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60, **options)


def named_in(help_text):
    """The names that a help text lists: options, arguments and commands, but not the notes of the text."""
    names = set()
    for part in re.findall(r"^[A-Z][^\n]*:\n((?:  .*\n)+)", help_text, re.M):
        for entry in ENTRY.findall(part):
            names.update(name for name in entry.split(",") if name)
    return names


def missing(help_text, page):
    plain = re.sub(r"\\f[BIR]|\\&", "", page).replace("\\-", "-").replace("\\e", "\\")
    def has(name):  # a command of takt has a page of its own, takt-plan(1)
        return re.search(rf"(?<![\w-])(?:takt-)?{re.escape(name.split('{')[0])}(?![\w])", plain)
    return sorted(name for name in named_in(help_text) if not has(name))


def commands_of(binaries, program, *path):
    """Each command with its help text, which also lists the commands below it."""
    text = run(binaries / program, *path, "--help", env=os.environ | {"COLUMNS": "100"}).stdout
    yield path, text
    if "COMMAND" not in text.split("\n\n")[0]:
        return
    listed = re.split(r"\n\n(?=Options:)", text)[-1]
    for group in re.findall(r"^(?!Options|Positionals|Examples?:)[A-Z][^\n]*:\n((?:  .*\n)+)", listed, re.M):
        for name in re.findall(r"^  ([a-z-]+) ", group, re.M):
            if run(binaries / program, *path, name, "--help").returncode == 0:
                yield from commands_of(binaries, program, *path, name)


def wrong_in_pages(binaries, folder):
    count = 0
    for program in PROGRAMS:
        done = run(binaries / program, "--manual", folder)
        if done.returncode != 0:
            yield f"{program} --manual: {done.stderr}"
        for path, text in commands_of(binaries, program):
            count += 1
            page = folder / ("-".join((program, *path[:1])) + (".8" if program == "taktd" else ".1"))
            if not page.exists():
                yield f"{page.name} is missing"
            elif absent := missing(text, page.read_text()):
                yield f"{page.name} lacks {absent} of {program} {' '.join(path)} --help"
    if count < 40:
        yield f"only {count} commands were found"
    for page in sorted(folder.iterdir()):
        done = run("man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page, env=os.environ | {"LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
        if done.returncode != 0 or done.stderr:
            yield f"{page.name}: man says {done.stderr[:300]}"
        if shutil.which("mandoc"):
            done = run("mandoc", "-Tlint", "-Werror", page)
            if done.returncode != 0:
                yield f"{page.name}: mandoc says {done.stdout[:300]}"


def wrong_in_widths(binaries):
    for program in PROGRAMS:
        for path, _ in commands_of(binaries, program):
            for width in (50, 80):
                text = run(binaries / program, *path, "--help", env=os.environ | {"COLUMNS": str(width)}).stdout
                wide = [line for line in text.splitlines() if len(line) > width and len(max(line.split(), key=len)) < width // 2]
                if wide or not text:
                    yield f"{program} {' '.join(path)} --help at {width} columns: {wide[:2]}"


def wrong_in_help(binaries):
    takt = binaries / "takt"
    whole = run(takt, "--help").stdout
    for words, same in ((["help"], ["--help"]), (["help", "plan"], ["plan", "--help"]), (["help", "eds", "show"], ["eds", "show", "--help"])):
        if run(takt, *words).stdout != run(takt, *same).stdout:
            yield f"takt {' '.join(words)} is not takt {' '.join(same)}"
    if "Before the bus runs:\n" not in whole or "Subcommands:" in whole:
        yield f"takt --help has no groups:\n{whole}"
    alone = run(takt)
    if alone.returncode != 2 or alone.stderr != whole:
        yield f"takt alone: {alone.returncode} {alone.stderr}"
    eds = run(takt, "eds")
    if eds.returncode != 2 or eds.stderr != run(takt, "eds", "--help").stdout:
        yield f"takt eds alone: {eds.returncode} {eds.stderr}"
    slip = run(takt, "help", "plam")
    if slip.returncode != 2 or "did you mean 'plan'?" not in slip.stderr:
        yield f"takt help plam: {slip.returncode} {slip.stderr}"
    if any("\033" in run(binaries / program, "--help").stdout for program in PROGRAMS):
        yield "a help text has escape sequences"


def self_test():
    text = "Usage: x\n\nOptions:\n  -h,--help   Print\n  --node N    a node\n\nExamples:\n"
    page = ".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\n.TP\n\\fB\\-\\-no\\fR"
    sys.exit(0 if missing(text, page) == ["--node"] and missing(text, page + " \\fB\\-\\-node\\fR") == [] else "the checks can't fail")


def main():
    if sys.argv[1] == "--self-test":
        self_test()
    binaries = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        wrong = [*wrong_in_pages(binaries, pathlib.Path(folder)), *wrong_in_widths(binaries), *wrong_in_help(binaries)]
    for line in wrong:
        print(line)
    sys.exit(bool(wrong))


main()
