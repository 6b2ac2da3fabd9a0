#!/usr/bin/env python3
"""json_doc_test.py BIN: checks that every key of the JSON documents of takt plan, budget, import and smooth is in
share/doc/json.md."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def keys_of(value):
    if isinstance(value, dict):
        for key, below in value.items():
            yield key
            yield from keys_of(below)
    if isinstance(value, list):
        for below in value:
            yield from keys_of(below)


def main():
    takt = pathlib.Path(sys.argv[1]) / "takt"
    documented = set(re.findall(r"`([a-z_0-9]+)`", (ROOT / "share/doc/json.md").read_text()))
    networks = sorted((ROOT / "share/demo").glob("*.yaml"))
    commands = [[verb, network] for verb in ("plan", "budget", "import") for network in networks]
    commands += [["plan", network, "--diff-devices"] for network in networks]
    commands += [["plan", networks[0], "--diff", networks[1]]]
    commands += [["budget", networks[-1], "--what-if", "bitrate=250"]]
    commands += [["od", "elbow", "--defaults", "--network", ROOT / "share/demo/two_axes.yaml"]]
    log = pathlib.Path(tempfile.mkdtemp()) / "trace.log"
    subprocess.run([takt, "simulate", networks[-1], "--for", "4s", "--move", "--candump", log], capture_output=True, timeout=60)
    commands += [["smooth", log]]
    missing = {}
    for command in commands:
        done = subprocess.run([takt, *command, "--json"], capture_output=True, text=True, timeout=60)
        for key in keys_of(json.loads(done.stdout)):
            if key not in documented:
                missing.setdefault(key, command[0])
    shutil.rmtree(log.parent)
    for key, verb in missing.items():
        print(f"share/doc/json.md does not describe the key `{key}` of takt {verb} --json")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
