#!/usr/bin/env python3
"""guest_tests.py TESTS RESULTS - runs tests one after the other, each in a separate network namespace. Runs inside
with-vcan.

A line of the file TESTS is a test: its name and its command, separated by tabs. A command that is a script of Python is
run by a copy of this process, which has read the libraries already. A judge leaves its recordings in RESULTS/NAME. The
variable VCAN_TESTS may have the names of the tests to run alone. guest.py reads the output.
"""
import ctypes
import gc
import importlib
import os
import pathlib
import runpy
import signal
import subprocess
import sys
import time
import traceback

LIMIT = 600  # s of the guest for a test
CLONE_NEWNET, PR_SET_CHILD_SUBREAPER = 0x40000000, 36
LIBRARIES = ("canopen", "canopen.profiles.p402", "can.interfaces.socketcan", "lcm", "tempfile", "statistics", "hashlib",
             "random", "daemon_run")
NETWORK = """link set lo up multicast on
route add 224.0.0.0/4 dev lo
link add vcan0 type vcan
link set vcan0 up
"""
libc = ctypes.CDLL(None, use_errno=True)


def become(command, recordings):
    """Prepares the process of the test, as a shell would."""
    os.dup2(sys.stdout.fileno(), sys.stderr.fileno())
    if libc.unshare(CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "no network namespace")
    subprocess.run(["ip", "-batch", "-"], input=NETWORK, text=True, check=True)
    time.sleep(0.1)  # the kernel has finished its work for the network of the last test, and delivers frames at once
    os.environ["JUDGE_RECORDINGS"] = str(recordings)
    os.setsid()
    signal.alarm(LIMIT)
    if not command[0].endswith(".py"):
        os.execvp(command[0], command)
    sys.argv, sys.path[0] = command, os.path.dirname(command[0])
    runpy.run_path(command[0], run_name="__main__")


def start(command, recordings):
    """The process of the test."""
    process = os.fork()
    if process != 0:
        return process
    code = 0
    try:
        become(command, recordings)
    except SystemExit as end:
        code = end.code or 0
        if not isinstance(code, int):  # sys.exit("what went wrong")
            print(code)
            code = 1
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    os._exit(code)


def children():
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = (folder / "stat").read_text().rpartition(")")[2].split()[1]
        except OSError:
            continue  # it has just ended
        if int(parent) == os.getpid():
            yield int(folder.name)


def end_what_is_left():
    """A process that has lost its parent becomes a child of this process."""
    while left := list(children()):
        for process in left:
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)


def main(tests, results):
    libc.prctl(PR_SET_CHILD_SUBREAPER, 1)
    wanted = os.environ.get("VCAN_TESTS", "").split()
    for library in LIBRARIES:
        importlib.import_module(library)
    gc.freeze()
    for line in pathlib.Path(tests).read_text().splitlines():
        name, *command = line.split("\t")
        if wanted and name not in wanted:
            continue
        recordings = pathlib.Path(results) / name
        recordings.mkdir()
        print(f"\x1ebegin {name}", flush=True)
        _, status = os.waitpid(start(command, recordings), 0)
        end_what_is_left()
        print(f"\x1eend {name} {os.waitstatus_to_exitcode(status)}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
