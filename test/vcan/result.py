#!/usr/bin/env python3
"""result.py RESULTS NAME [judge] - prints the output of the test NAME in the guest that guest.py ran.

Wireshark's dissector then reads the recordings of this test. Exit code: that of the test; 1: the dissector found a
mistake, or the guest ended before the test; 77: this processor has no way to SocketCAN.
"""
import pathlib
import sys

from dissector import dissect_all

IMPOSSIBLE = "77"
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def read(file):
    return file.read_text() if file.exists() else ""


def main(results, name, kind="program"):
    results = pathlib.Path(results)
    print(read(results / f"{name}.out"), end="", flush=True)
    code = read(results / f"{name}.code")
    if not code:
        of_guest = read(results / "guest.code")
        print(read(results / "guest.out"), f"FAIL  the guest ended with {of_guest or 'no code'} before this test did", sep="")
        return int(IMPOSSIBLE) if of_guest == IMPOSSIBLE else 1
    if code == "0" and kind == "judge":
        check(dissect_all(check, results / name) > 0, "the judge has recorded its bus")
    return 1 if failures or code != "0" else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
