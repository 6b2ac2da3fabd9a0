#!/usr/bin/env python3
"""tools_beside_daemon_test.py BIN: a taktd on the simulated bus, an application that moves its axes, and tools that ask it
meanwhile. Each program ends with its good exit code. Under ThreadSanitizer a data race is another exit code.
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NETWORK = ROOT / "share/demo/two_axes.yaml"
PATIENCE = 180  # s
failures = []


def check(good, what, otherwise=""):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        print(otherwise)
        failures.append(what)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Bus:
    def __init__(self, binaries, folder):
        self.binaries, self.folder = pathlib.Path(binaries), pathlib.Path(folder)
        self.url = f"tcpq://127.0.0.1:{free_port()}"
        text = NETWORK.read_text().replace("../eds/", f"{ROOT}/share/eds/")
        text = text.replace("sync_period: 2000 ", "sync_period: 20000 ")  # a busy machine and a sanitizer are slow
        self.network = self.folder / "net.yaml"
        self.network.write_text(text)

    def start(self, name, *arguments):
        said = open(self.folder / f"{name}.log", "w")
        return subprocess.Popen([self.binaries / name, *arguments, "--lcm-url", self.url], stdout=said, stderr=said)

    def tool(self, *arguments, **environment):
        return subprocess.run([self.binaries / "takt", *arguments, "--lcm-url", self.url], capture_output=True, text=True,
                              env={**os.environ, **{name: str(value) for name, value in environment.items()}})

    def said(self, name):
        return (self.folder / f"{name}.log").read_text()

    def await_good(self, *arguments, **environment):
        """Until the tool ends with 0: the daemon may still boot its devices."""
        until = time.monotonic() + PATIENCE
        while (result := self.tool(*arguments, **environment)).returncode != 0 and time.monotonic() < until:
            time.sleep(0.2)
        check(result.returncode == 0, f"takt {' '.join(arguments)}: exit code {result.returncode}", result.stderr)
        return result.stdout


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        bus = Bus(binaries, folder)
        # A move that takt-move computes itself outlives the cycles that a busy machine misses.
        daemon = bus.start("taktd", bus.network, "--bus", "sim", "--no-motions")
        try:
            status = bus.await_good("status")
            check("shoulder" in status and "stat " in status, "takt status names the axis and shows its statusword", status)
            for page in ("axes", "words", "io", "pdos", "timing", "nodes"):
                for width in (50, 80, 120):
                    view = bus.await_good("top", "--page", page, COLUMNS=width)
                    fits = all(len(line) <= width for line in view.splitlines())
                    check(fits and view.count("\n") > 5 and "\033" not in view, f"page {page} at {width} columns", view)
            move = bus.start("takt-move", "--for", "6s", "--wait", str(PATIENCE))
            bus.await_good("sdo", "read", "shoulder", "6041:00")
            bus.await_good("timing")
            check(move.wait(2 * PATIENCE) == 0, f"takt-move ended with {move.returncode}", bus.said("takt-move"))
        finally:
            daemon.send_signal(signal.SIGTERM)
            code = daemon.wait(PATIENCE)
        check(code == 0, f"taktd ended with {code}", bus.said("taktd"))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
