#!/usr/bin/env python3
"""readme_outputs_test.py BIN [--update]: checks that README.md and the pages of share/doc show what files contain and
what commands print.

A block that begins with `$ takt simulate` (or another of COMMANDS) and names only files of the tree must repeat lines
of the stdout of that command; `$ taktd FILE --check` too. A block that begins with `# share/...` must repeat lines of
that file. A line of three points matches any number of lines. --update corrects the blocks in which only numbers have
changed. The commands of the tutorial run in a folder that has the files of the tutorial.

Each relative link must lead to a file that exists; a link with an anchor also to a heading. The index must name every
page. README.md must not be longer than LONGEST_README lines.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
README = ROOT / "README.md"
PAGES = ROOT / "share/doc"
CHANGELOG = ROOT / "CHANGELOG.md"  # only its links are checked: it describes former versions
LONGEST_README = 250
COMMANDS = ("simulate", "audit", "plan", "budget", "eds")
SHELL = {"|", "&&", ";", "-o", ">"}  # such a command is not run here
BLOCK = re.compile(r"^```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r" *\d+(\.\d+)?")
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)


def parts_of(lines):
    """Runs of lines between those of three points."""
    parts = [[]]
    for line in lines:
        if line.strip() == "...":
            parts.append([])
        else:
            parts[-1].append(line)
    return parts


def place(part, lines, start, same):
    """The place of `part` in `lines` from `start` on; None: `lines` does not contain it."""
    for i in range(start, len(lines) - len(part) + 1):
        if all(same(a, b) for a, b in zip(part, lines[i:])):
            return i
    return None


def compare(shown, real, same):
    """(The parts of `shown` as `real` has them, None), or (None, the first part that `real` does not have)."""
    real, found, at = [line.rstrip() for line in real], [], 0
    parts = parts_of(shown)
    for i, part in enumerate(parts):
        where = place(part, real, at, same)
        if where is None or (i == 0 and part and where != 0):
            return None, part
        found.append(real[where:where + len(part)])
        at = where + len(part)
    if parts[-1] and at < len(real):
        return None, ["(the end: there is more, and no line of three points)"]
    return found, None


def is_checked(words):
    if not words or SHELL & set(words) or any(word.endswith(";") for word in words):
        return False
    return words[0] == "taktd" and "--check" in words or words[0] == "takt" and words[1] in COMMANDS


def real_lines(title, tools, folder):
    """The lines of which the block shows a part. None: the block is not checked."""
    if title.startswith("# share/"):
        return (ROOT / title[2:].split()[0]).read_text().splitlines()
    words = title.removeprefix("$ ").split() if title.startswith("$ ") else []
    files = [word for word in words if word.endswith((".yaml", ".eds", ".dcf", ".bin"))]
    if not is_checked(words):
        return None
    # A page may name a file of the tree although its commands run in another folder.
    places = [place for place in (folder, ROOT) if all((place / file).exists() for file in files)]
    if not places:
        return None
    done = subprocess.run([tools / words[0], *words[1:]], cwd=places[0], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=60)
    return done.stdout.rstrip("\n").split("\n")


def equal(a, b):
    return a == b


def equal_but_numbers(a, b):
    return NUMBER.sub("#", a) == NUMBER.sub("#", b)


def join(title, shown, parts):
    points = [line for line in shown if line.strip() == "..."]
    lines = [title, *parts[0]]
    for point, part in zip(points, parts[1:]):
        lines += [point, *part]
    return "\n".join(lines) + "\n"


def documents():
    return [README, *sorted(PAGES.glob("*.md"))]


def make_machine(folder):
    """The files that the tutorial lets its reader make."""
    shutil.copy(ROOT / "share/eds/takt_drive402.eds", folder / "drive.eds")
    network = (ROOT / "share/demo/one_axis.yaml").read_text()
    (folder / "first.yaml").write_text(network.replace("../eds/takt_drive402.eds", "drive.eds"))
    faults = re.search(r"^```yaml\n(faults:\n.*?)^```$", (PAGES / "tutorial.md").read_text(), re.MULTILINE | re.DOTALL)
    (folder / "faults.yaml").write_text(faults[1])


def check_outputs(document, tools, folder, update):
    """Titles of the blocks that were compared, and the number of those that differ."""
    text = document.read_text()
    name = document.relative_to(ROOT)
    judged, failed = [], 0
    for block in BLOCK.findall(text):
        title, *shown = block.rstrip("\n").split("\n")
        real = real_lines(title, tools, folder if document.name == "tutorial.md" else ROOT)
        if real is None:
            continue
        judged.append(title)
        shown = [line.rstrip() for line in shown]
        if title.startswith("# share/"):
            shown = ["...", *shown, "..."]
        found, missing = compare(shown, real, equal)
        if found is None and update and title.startswith("$"):
            found, missing = compare(shown, real, equal_but_numbers)
            if found is not None:
                text = text.replace(block, join(title, shown, found))
        print(("FAIL  " if found is None else "ok    ") + f"{name}: {title}")
        if found is None:
            failed += 1
            print(f"      {name} shows these lines, but they do not appear there:\n      " + "\n      ".join(missing))
    if update:
        document.write_text(text)
    return judged, failed


def anchors(document):
    """Of the headings of a page, as web viewers of Markdown make them."""
    prose = BLOCK.sub("", document.read_text())
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in HEADING.findall(prose)}


def broken_links(document):
    for link in LINK.findall(BLOCK.sub("", document.read_text())):
        if re.match(r"\w+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (document.parent / path).resolve() if path else document
        if not target.exists():
            yield f"{document.relative_to(ROOT)}: {link} leads to no file"
        elif anchor and anchor not in anchors(target):
            yield f"{document.relative_to(ROOT)}: {link} leads to no heading"


def complaints():
    """What is wrong with links, index and length."""
    for document in [*documents(), CHANGELOG]:
        yield from broken_links(document)
    index = (PAGES / "index.md").read_text()
    for page in PAGES.glob("*.md"):
        if page.name != "index.md" and f"({page.name})" not in index:
            yield f"share/doc/index.md does not name {page.name}"
    lines = len(README.read_text().splitlines())
    if lines > LONGEST_README:
        yield f"README.md has {lines} lines, at most {LONGEST_README} are allowed"


def main(binaries, update):
    tools = pathlib.Path(binaries).resolve()
    judged, failed = [], 0
    with tempfile.TemporaryDirectory() as name:
        make_machine(pathlib.Path(name))
        for document in documents():
            titles, differing = check_outputs(document, tools, pathlib.Path(name), update)
            judged += titles
            failed += differing
    families = [title for title in judged if title.startswith("$ takt simulate share/demo/")]
    shown = {start: any(title.startswith(start) for title in judged) for start in ("# share/", "$ taktd", "$ takt eds")}
    if len(families) < 5 or not all(shown.values()):
        print(f"FAIL  too few blocks: {judged}")
        failed += 1
    for complaint in complaints():
        print("FAIL  " + complaint)
        failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], "--update" in sys.argv[2:]))
