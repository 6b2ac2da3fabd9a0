#!/usr/bin/env python3
"""no_multicast_test.py BIN: on a machine whose only interface is `lo`, taktd and takt find each other without a URL.

LCM's multicast has no route there: taktd says so and serves tcpq on loopback, where takt looks by itself. Runs in
a separate network namespace. If the machine permits none, runs in the guest of with-vcan.
"""
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time

from running_daemon import NETWORK, PATIENCE, ROOT, check, failures

NAMESPACES = (["unshare", "--net"], ["unshare", "--net", "--map-root-user"])
GUEST = [ROOT / "test/support/with-vcan", "-m", "uml", "-t", "180", *NAMESPACES[0]]


def enter_namespace(arguments):
    """Starts this test again where the only interface is the loopback. Does not return."""
    again = [sys.executable, os.path.abspath(__file__), *arguments, "--inside"]
    for way in NAMESPACES:
        if subprocess.run([*way, "true"], stderr=subprocess.DEVNULL).returncode == 0:
            os.execvp(way[0], [*way, *again])
    os.execv(GUEST[0], [*GUEST, *again])


def takt_status(binaries):
    """Runs `takt status` without a URL, as a user does who knows none."""
    return subprocess.run([binaries / "takt", "status", "--json"], capture_output=True, text=True)


def await_status(binaries, daemon):
    """Repeats `takt status` until it succeeds: a busy machine may need more than one call."""
    until = time.monotonic() + PATIENCE
    while True:
        status = takt_status(binaries)
        if status.returncode == 0 or daemon.poll() is not None or time.monotonic() > until:
            return status


def judge_status(status):
    check(f"takt status without a URL: exit {status.returncode} {status.stderr.strip()}", status.returncode == 0)
    buses = json.loads(status.stdout)["buses"] if status.returncode == 0 else []
    names = [node["name"] for bus in buses for node in bus["nodes"]]
    check(f"and it tells of the nodes: {names}", names == ["shoulder", "elbow", "io"])


def judge_daemon(said):
    told = [line for line in said.splitlines() if "LCM: " in line]
    check(f"taktd speaks of LCM once: {told}", len(told) == 1)
    wanted = ("no multicast route", "tcpq protocol on loopback", "LCM_DEFAULT_URL=tcpq://127.0.0.1:7700")
    missing = [words for words in wanted if words not in "".join(told)]
    check(f"and says why, what and where: {missing} is missing", not missing)


def judge_taken_port(binaries):
    """Any program may have the port of the hub, so taktd does not become a client of that program."""
    with socket.create_server(("127.0.0.1", 7700)) as other, tempfile.TemporaryFile("w+") as said:
        daemon = subprocess.Popen([binaries / "taktd", NETWORK, "--bus", "sim", "--rt", "off"], stderr=said)
        try:
            until = time.monotonic() + PATIENCE
            text = ""
            while "the network is ready" not in text and time.monotonic() < until:
                time.sleep(0.05)
                text = os.pread(said.fileno(), 1 << 20, 0).decode()
            check("a port that is taken is told", "port 7700 of loopback is used by another program" in text, text)
            check("and the bus runs all the same", "the network is ready" in text, text)
            daemon.send_signal(signal.SIGTERM)
            code = daemon.wait(PATIENCE)
            check(f"taktd ended with exit code {code}", code == 0)
        finally:
            daemon.kill()
        other.setblocking(False)
        try:
            other.accept()
            came = True
        except BlockingIOError:
            came = False
        check("nobody connects to the one who has the port", not came)


def main(binaries):
    binaries = pathlib.Path(binaries).resolve()
    os.environ.pop("LCM_DEFAULT_URL", None)
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    nobody = takt_status(binaries)
    alone = nobody.returncode == 3 and "is taktd running?" in nobody.stderr
    check(f"before taktd nobody answers: exit {nobody.returncode} {nobody.stderr.strip()}", alone)
    with tempfile.TemporaryFile("w+") as said:
        daemon = subprocess.Popen([binaries / "taktd", NETWORK, "--bus", "sim", "--rt", "off"], stderr=said)
        try:
            judge_status(await_status(binaries, daemon))
            daemon.send_signal(signal.SIGTERM)
            code = daemon.wait(PATIENCE)
            check(f"taktd ended with exit code {code}", code == 0)
        finally:
            daemon.kill()
        said.seek(0)
        judge_daemon(said.read())
    judge_taken_port(binaries)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    if sys.argv[-1] != "--inside":
        enter_namespace(sys.argv[1:])
    sys.exit(main(sys.argv[1]))
