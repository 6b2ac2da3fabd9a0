#!/usr/bin/env python3
"""run_judge.py COMMAND...: runs a judge, for example `with-vcan python3 judge_sdo.py BIN`, and then has Wireshark's
dissector read what the judge has recorded. Exit code: that of the command; 1: the dissector found something."""
import os
import subprocess
import sys
import tempfile

from dissector import dissect_all

failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def main(command):
    with tempfile.TemporaryDirectory() as folder:
        code = subprocess.run(command, env=os.environ | {"JUDGE_RECORDINGS": folder}).returncode
        if code == 0:
            check(dissect_all(check, folder) > 0, "the judge has recorded its bus")
    return 1 if failures else code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
