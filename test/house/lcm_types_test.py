#!/usr/bin/env python3
"""lcm_types_test.py BIN SOURCE - checks that lcm-gen accepts the output of `takt export lcm`, and that its C++, Python
and Java code have the fingerprints that takt computes."""
import importlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MASK = (1 << 64) - 1
# Names that are words of some language.
NASTY = """
bus: {{name: class}}
master: {{sync_period: 10000}}
nodes:
  import: &node
    node_id: 1
    dcf: {folder}/words.eds
  a-b: {{<<: *node, node_id: 2}}
  While: {{<<: *node, node_id: 3}}
"""
WORDS = ("int", "class", "from", "None", "encode", "linux", "9 lives", "utime")


def run(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def words_eds(text):
    """The encoder of the tree with the names of its input objects changed."""
    for number, word in enumerate(WORDS):
        text = re.sub(rf"(\[60000?sub{number + 1}\]\s+ParameterName=)[^\r\n]*", rf"\g<1>{word}", text, flags=re.I)
        text = re.sub(rf"(\[6401sub{number + 1}\]\s+ParameterName=)[^\r\n]*", rf"\g<1>{word}", text, flags=re.I)
    return text


def told(files):
    """{package.type: fingerprint} from the comments of the .lcm files."""
    found = {}
    for file in files:
        text = file.read_text()
        package = re.search(r"^package (\w+);", text, re.M)[1]
        name = re.search(r"^struct (\w+)$", text, re.M)[1]
        found[f"{package}.{name}"] = int(re.search(r"Fingerprint (0x[0-9A-F]{16})", text)[1], 16)
    return found


def of_python(types, folder):
    sys.path.insert(0, str(folder))
    found = {}
    for name in types:
        package, kind = name.split(".")
        module = importlib.import_module(package)
        found[name] = int.from_bytes(getattr(module, kind)._get_packed_fingerprint(), "big")
    sys.path.pop(0)
    return found


def of_cpp(types, folder):
    lines = [f'#include "{name.replace(".", "/")}.hpp"' for name in types]
    lines += ["#include <cstdio>", "int main() {"]
    for name in types:
        kind = name.replace(".", "::")
        lines.append(f'  std::printf("{name} %016llx\\n", static_cast<unsigned long long>({kind}::getHash()));')
    (folder / "main.cpp").write_text("\n".join(lines + ["}", ""]))
    flags = run("pkg-config", "--cflags", "lcm").split()
    run("c++", "-std=c++17", "-O0", f"-I{folder}", *flags, folder / "main.cpp", "-o", folder / "fingerprints")
    return {name: int(value, 16) for name, value in (line.split() for line in run(folder / "fingerprints").splitlines())}


def of_java(types, folder):
    """Java computes the fingerprint from the constant of the class; this function has the rule of its
    _hashRecursive."""
    found = {}
    for name in types:
        text = (folder / (name.replace(".", "/") + ".java")).read_text()
        assert re.search(r"\(hash\s*<<\s*1\)\s*\+\s*\(\(hash\s*>>\s*63\)\s*&\s*1\)", text), text
        base = int(re.search(r"LCM_FINGERPRINT_BASE\s*=\s*(0x[0-9a-fA-F]+)L", text)[1], 16)
        found[name] = ((base << 1) & MASK) + (base >> 63 & 1)
    return found


def main(bin_dir, source):
    takt = pathlib.Path(bin_dir) / "takt"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "words.eds").write_text(words_eds((source / "share/eds/takt_io401.eds").read_text()))
        (folder / "nasty.yaml").write_text(NASTY.format(folder=folder))
        types = {}
        for network in [*sorted((source / "share/demo").glob("*.yaml")), folder / "nasty.yaml"]:
            out = folder / "lcm" / network.stem
            files = [pathlib.Path(line) for line in run(takt, "export", "lcm", network, "-o", out).splitlines()]
            assert files, network
            types.update(told(files))
            run("lcm-gen", "-x", "-p", "-j", "--cpp-hpath", folder, "--ppath", folder, "--jpath", folder, *files)
        for language in (of_python, of_cpp, of_java):
            theirs = language(types, folder)
            assert theirs == types, (language.__name__, {k: (hex(types[k]), hex(theirs[k])) for k in types if types[k] != theirs[k]})
        if shutil.which("javac"):
            stub = folder / "lcm/lcm"
            stub.mkdir(parents=True, exist_ok=True)
            (stub / "LCMEncodable.java").write_text("package lcm.lcm; public interface LCMEncodable {}\n")
            (stub / "LCMDataInputStream.java").write_text(
                "package lcm.lcm; public class LCMDataInputStream extends java.io.DataInputStream {"
                " public LCMDataInputStream(byte[] b) { super(new java.io.ByteArrayInputStream(b)); } }\n")
            classes = [folder / (name.replace(".", "/") + ".java") for name in types]
            run("javac", "-nowarn", "-d", folder / "classes", *stub.glob("*.java"), *classes)
    print(f"{len(types)} types, fingerprints equal in C++, Python and Java")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
