#!/usr/bin/env python3
"""guest.py RESULTS COMMAND... - runs COMMAND, which starts guest_tests.py by with-vcan, and sorts its output.

RESULTS/NAME.out is the output of the test NAME, and RESULTS/NAME.code its exit code. A test that the guest has not
finished has no code. RESULTS/guest.out and guest.code are those of COMMAND itself. Exit code: always 0, because
result.py gives the result of each test.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import threading

LIMIT = 3000  # s of the machine for all tests; less than that of ctest, so that results are kept
BEGIN = re.compile(r"\x1ebegin (\w+)\n")
END = re.compile(r"\x1eend (\w+) (-?\d+)\n")


def sort(lines, results):
    """Writes each line to the file of the test that runs; lines of the guest itself to guest.out."""
    guest = out = open(results / "guest.out", "w", buffering=1)
    for line in lines:
        if begun := BEGIN.search(line):
            out.write(line[:begun.start()])
            out = open(results / f"{begun[1]}.out", "w", buffering=1)
        elif ended := END.search(line):
            out.write(line[:ended.start()])
            out.close()
            (results / f"{ended[1]}.code").write_text(ended[2])
            out = guest
        else:
            out.write(line)
    if out is not guest:
        out.close()
    guest.close()


def main(results, *command):
    results = pathlib.Path(results)
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)
    guest = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    limit = threading.Timer(LIMIT, guest.terminate)
    limit.start()
    sort(guest.stdout, results)
    code = guest.wait()
    limit.cancel()
    (results / "guest.code").write_text(str(code))
    finished = len(list(results.glob("*.code"))) - 1
    print((results / "guest.out").read_text(), f"the guest ended with {code}; it has finished {finished} tests", sep="")


if __name__ == "__main__":
    main(*sys.argv[1:])
