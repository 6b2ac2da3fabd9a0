#!/usr/bin/env python3
"""takt_demo_test.py BIN: `takt demo` of an installed takt moves its axes, chooses a free port, and leaves nothing behind."""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from running_daemon import PATIENCE, ROOT, await_text, check, failures


def install(binaries, prefix):
    """Copies takt as `cmake --install` does. With links instead of copies, the programs would find the tree."""
    (prefix / "bin").mkdir(parents=True)
    for program in ("takt", "taktd", "takt-move"):
        shutil.copy(pathlib.Path(binaries) / program, prefix / "bin")
    for folder in ("demo", "eds", "devices"):
        shutil.copytree(ROOT / "share" / folder, prefix / "share/takt" / folder)
    return prefix / "bin/takt"


class Demo:
    """A running `takt demo`. Its environment is that of a machine with a daemon and keys of its own."""

    def __init__(self, takt, log, *options):
        self.log = log
        env = dict(os.environ, LCM_DEFAULT_URL="tcpq://127.0.0.1:1", TAKT_KEYS="/none", NOTIFY_SOCKET="/none")
        with log.open("w") as out:
            self.process = subprocess.Popen([takt, "demo", *options], stdout=out, stderr=out, stdin=subprocess.DEVNULL, env=env)

    def text(self):
        return self.log.read_text()

    def wait_for(self, words):
        await_text(self.log, words, self.process)

    def children(self):
        return {int(entry.name) for entry in pathlib.Path("/proc").iterdir()
                if entry.name.isdigit() and parent_of(entry) == self.process.pid}


def parent_of(entry):
    try:
        return int(re.search(r"^PPid:\s+(\d+)", (entry / "status").read_text(), re.M)[1])
    except (OSError, TypeError):
        return None


def runs(pid):
    """Says whether a process runs. One that has ended, but was not yet waited for, does not."""
    try:
        return re.search(r"^State:\s+Z", pathlib.Path(f"/proc/{pid}/status").read_text(), re.M) is None
    except OSError:
        return False


def moves_on_another_port(takt, folder):
    with socket.socket() as other:
        other.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        other.bind(("127.0.0.1", 7700))
        other.listen()
        demo = Demo(takt, folder / "for", "--for", "4s")
        code = demo.process.wait(PATIENCE)
    text = demo.text()
    check("takt demo --for 4s ends by itself", code == 0, f"exit code {code}:\n{text}")
    check("the axes followed", "The axes followed." in text, text)
    ports = set(re.findall(r"tcpq://127\.0\.0\.1:(\d+)", text))
    check("one free port is used if 7700 is in use", len(ports) == 1 and "7700" not in ports, f"{ports}\n{text}")
    check("its files are those below its prefix", f"taktd {takt.parent.parent}/share/takt/demo/two_axes.yaml --bus sim" in text, text)
    check("it shows where to look", "takt top" in text and "Ctrl-C ends" not in text, text)


def ctrl_c_ends_in_order(takt, folder):
    demo = Demo(takt, folder / "ctrl_c")
    demo.wait_for(" sine  ")
    demo.process.send_signal(signal.SIGINT)
    code = demo.process.wait(PATIENCE)
    text = demo.text()
    check("Ctrl-C ends the demo with exit code 0", code == 0, f"exit code {code}:\n{text}")
    order = [text.find(words) for words in ("Ctrl-C ends the demo.", "disabling the axes", "images compared", "the ordered stop begins", "Good: ")]
    check("the axes come to rest before the bus stops", -1 not in order and order == sorted(order), f"{order}\n{text}")
    check("the usual port is used if it is free", "tcpq://127.0.0.1:7700" in text, text)


def nothing_is_left_of_a_killed_demo(takt, folder):
    demo = Demo(takt, folder / "killed")
    demo.wait_for(" move  ")
    left = demo.children()
    check("it has two programs", len(left) == 2, f"{left}\n{demo.text()}")
    demo.process.kill()
    demo.process.wait()
    until = time.monotonic() + PATIENCE
    while left and time.monotonic() < until:
        left = {pid for pid in left if runs(pid)}
        time.sleep(0.05)
    check("its programs end when it is killed", not left, str(left))


def leaves_the_axes_to_others(takt, folder):
    demo = Demo(takt, folder / "still", "--still", "--for", "10m")
    demo.wait_for("The machine is ready.")
    check("--still starts no takt-move", len(demo.children()) == 1, demo.text())
    demo.process.send_signal(signal.SIGTERM)
    code = demo.process.wait(PATIENCE)
    check("SIGTERM ends it with exit code 0", code == 0, f"exit code {code}:\n{demo.text()}")


def names_what_is_missing(takt):
    (takt.parent / "takt-move").unlink()
    for options, told in ((["--for", "1s"], "--for needs at least 4s"), ([], f"{takt.parent}/takt-move is missing")):
        done = subprocess.run([takt, "demo", *options], capture_output=True, text=True, timeout=PATIENCE)
        check(f"takt demo says: {told}", done.returncode == 2 and told in done.stderr, done.stdout + done.stderr)


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        takt = install(binaries, folder / "prefix")
        moves_on_another_port(takt, folder)
        ctrl_c_ends_in_order(takt, folder)
        nothing_is_left_of_a_killed_demo(takt, folder)
        leaves_the_axes_to_others(takt, folder)
        names_what_is_missing(takt)
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
