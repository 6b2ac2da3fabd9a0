#!/usr/bin/env python3
"""Builds the manual of the public headers with Doxygen, and compares the declarations with share/doc/api.txt.

check_api.py [ROOT]           checks ROOT (default: this checkout)
check_api.py --update [ROOT]  writes share/doc/api.txt anew, and prints what CHANGELOG.md has to contain
check_api.py --self-test      shows that each rule can fail

Rules: Doxygen has no warning (each public declaration has a comment); share/doc/api.txt lists the public declarations and the
fields of the LCM types as they are; CHANGELOG.md names the checksum of this list; the C++ examples of the pages are parts of the
programs in test/house/outside, which a test compiles.
"""
import difflib
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

LIST = "share/doc/api.txt"
HEADERS = "share/include"
PAGES = ("README.md", "share/doc/application.md")
PROGRAMS = "test/house/outside"
EXAMPLE = re.compile(r"^```cpp\n(.*?)^```", re.S | re.M)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
ADVICE = (f"If the change is meant, run `python3 test/house/check_api.py --update`, and add an entry to CHANGELOG.md that says what "
          "changed and ends with the checksum. In versions 0.x declarations are only added (share/doc/compatibility.md).")


def document(root, folder):
    """Runs Doxygen on the headers below `root`; returns its warnings. The manual and its XML are below `folder`."""
    settings = pathlib.Path(root, HEADERS, "Doxyfile").read_text(encoding="utf-8")
    done = subprocess.run(["doxygen", "-"], cwd=root, text=True, capture_output=True, check=False,
                          input=f"{settings}\nOUTPUT_DIRECTORY = {folder}\n")
    return [] if done.returncode == 0 and not done.stderr else [done.stderr.strip() or "doxygen failed"]


def text_of(element):
    """The text of an XML element in one line, without spaces that have no meaning."""
    text = " ".join("".join(element.itertext()).split()) if element is not None else ""
    return re.sub(r"(?<=[<(]) | (?=[<>(),&*])", "", text)


def parameters(member):
    """Types and default values. Names of parameters are not part of the promise."""
    for parameter in member.findall("param"):
        default = text_of(parameter.find("defval"))
        yield text_of(parameter.find("type")) + (f" = {default}" if default else "")


def declaration(member):
    """The lines of one public member of a class, a file or a namespace."""
    kind, name = member.get("kind"), text_of(member.find("name"))
    if kind == "enum":
        yield f"enum class {name} : {text_of(member.find('type'))}"
        for value in member.findall("enumvalue"):
            yield f"  {text_of(value.find('name'))} {text_of(value.find('initializer'))}".rstrip()
        return
    words = "static " if member.get("static") == "yes" else ""
    words += "virtual " if member.get("virt") in ("virtual", "pure-virtual") else ""
    words += f"{text_of(member.find('type'))} {name}".strip()
    if kind == "function":
        tail = (member.findtext("argsstring") or "").rpartition(")")[2]
        words += f"({', '.join(parameters(member))}) {tail.strip().replace('=default', '')}".rstrip()
    elif kind == "typedef":
        words = f"using {name} = {text_of(member.find('type'))}"
    else:
        initial = text_of(member.find("initializer"))
        words += f" {initial}" if initial and not member.findtext("argsstring") else ""
    yield words


def compounds(folder):
    """(header, line, lines) of each class and each free declaration in the XML of Doxygen."""
    for path in pathlib.Path(folder, "xml").glob("*.xml"):
        for compound in xml.parse(path).getroot().findall("compounddef"):
            kind = compound.get("kind")
            if kind not in ("class", "struct", "namespace") or compound.get("prot") == "private":
                continue
            members = [member for section in compound.findall("sectiondef") for member in section.findall("memberdef")
                       if member.get("prot") == "public"]
            members.sort(key=lambda member: int(member.find("location").get("line")))
            if kind == "namespace":
                for member in members:
                    place = member.find("location")
                    yield place.get("file"), int(place.get("line")), list(declaration(member))
                continue
            place = compound.find("location")
            bases = ", ".join(text_of(base) for base in compound.findall("basecompoundref"))
            lines = [f"{kind} {text_of(compound.find('compoundname'))}" + (f" : {bases}" if bases else "")]
            lines += [f"  {line}" for member in members for line in declaration(member)]
            yield place.get("file"), int(place.get("line")), lines


def lcm_fields(path):
    text = COMMENT.sub("", path.read_text(encoding="utf-8"))
    body = text[text.index("{") + 1:text.rindex("}")]
    return [" ".join(field.split()) for field in body.split(";") if field.strip()]


def listing(root, folder):
    """The list of all public declarations, in the order of the headers. `folder` has the XML."""
    lines, header = [], None
    for file, _, found in sorted(compounds(folder), key=lambda compound: compound[:2]):
        if file != header:
            lines += ["", f"# {file}"]
            header = file
        lines += found
    for path in sorted(pathlib.Path(root, "share/lcm").glob("*.lcm")):
        lines += ["", f"# {path.name}", *lcm_fields(path)]
    return "\n".join(lines).strip() + "\n"


def words(code):
    return "".join(COMMENT.sub("", code).split())


def uncompiled(root):
    """A sentence for each C++ example of a page that is in none of the programs. Comments and spaces do not count."""
    programs = [words(path.read_text(encoding="utf-8")) for path in pathlib.Path(root, PROGRAMS).glob("*.cpp")]
    for page in PAGES:
        for example in EXAMPLE.findall(pathlib.Path(root, page).read_text(encoding="utf-8")):
            if not any(words(example) in program for program in programs):
                yield f"{page}: no program in {PROGRAMS} contains the example that begins with: {example.splitlines()[0]}"


def checksum(text):
    return hashlib.sha256(text.encode()).hexdigest()[:8]


def check(root, update=False):
    """The violations of the rules, as sentences."""
    with tempfile.TemporaryDirectory() as folder:
        complaints = document(root, folder)
        if complaints:
            return complaints
        present = listing(root, folder)
    file = pathlib.Path(root, LIST)
    if update:
        file.write_text(present, encoding="utf-8")
    listed = file.read_text(encoding="utf-8")
    if listed != present:
        difference = difflib.unified_diff(listed.splitlines(), present.splitlines(), LIST, "the headers", "", "", 2, "")
        return ["\n".join(difference), ADVICE]
    note = f"API {checksum(listed)}"
    if note not in pathlib.Path(root, "CHANGELOG.md").read_text(encoding="utf-8"):
        return [f"CHANGELOG.md does not contain \"{note}\", the checksum of {LIST}. {ADVICE}"]
    return list(uncompiled(root))


def edit(root, path, old, new):
    file = pathlib.Path(root, path)
    text = file.read_text(encoding="utf-8")
    assert old in text, f"{path} has no {old}"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


MASTER, DRIVE = f"{HEADERS}/takt/master.hpp", f"{HEADERS}/takt/drive402.hpp"
BAD = {  # what is changed: file, old, new, part of the complaint
    "a declaration without comment": (MASTER, "  /// Returns the network that the master runs.\n", "", "not documented"),
    "a comment with an unknown command": (MASTER, "/// Calls stop().", "/// Calls @stop.", "unknown command"),
    "another type of a parameter": (MASTER, "value(std::size_t signal)", "value(std::uint32_t signal)", "uint32_t"),
    "a new enumerator": (DRIVE, "  fault,  ", "  worse,  ///< a test\n  fault,  ", "worse"),
    "a function that is gone": (DRIVE, "bool in_fault() const noexcept;", "", "in_fault"),
    "another default value": (DRIVE, "reset_low_steps = 10", "reset_low_steps = 11", "= 11"),
    "a new field of an LCM type": ("share/lcm/command_t.lcm", "{", "{ int8_t more;", "int8_t more"),
    "an edited list": (LIST, "#", "# x\n#", "x"),
    "an example that is not compiled": ("README.md", "group.send();", "group.sent();", "no program"),
    "a change without an entry": ("CHANGELOG.md", "(API ", "(PIA ", "does not contain"),
}
GOOD = {
    "another comment": (MASTER, "/// Calls stop().", "/// Calls stop() and returns."),
    "another name of a parameter": (MASTER, "value(std::size_t signal)", "value(std::size_t place)"),
    "a new private member": (DRIVE, " private:\n", " private:\n  int more_ = 0;\n"),
}


def self_test():
    """Makes each of the changes in a copy of this checkout, and checks that a rule fails."""
    here = pathlib.Path(__file__).resolve().parents[2]
    complaints = []
    for what, (path, old, new, *part) in {**BAD, **GOOD}.items():
        with tempfile.TemporaryDirectory() as root:
            for folder in (HEADERS, "share/lcm", PROGRAMS):
                shutil.copytree(here / folder, pathlib.Path(root, folder))
            pathlib.Path(root, "share/doc").mkdir()
            for file in (LIST, "CHANGELOG.md", *PAGES):
                shutil.copy(here / file, pathlib.Path(root, file))
            edit(root, path, old, new)
            found = "\n".join(check(root))
        if part and part[0] not in found:
            complaints.append(f"not found: {what}: {found}")
        if not part and found:
            complaints.append(f"wrongly refused: {what}: {found}")
    for what in complaints:
        print(f"self-test: {what}")
    return 1 if complaints else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    update = sys.argv[1:2] == ["--update"]
    rest = sys.argv[1 + update:]
    root = pathlib.Path(rest[0]) if rest else pathlib.Path(__file__).resolve().parents[2]
    complaints = check(root, update)
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
