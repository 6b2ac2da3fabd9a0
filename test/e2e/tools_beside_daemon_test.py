#!/usr/bin/env python3
"""tools_beside_daemon_test.py BIN: a taktd on the simulated bus, an application that moves its axes, and tools that ask it
meanwhile. Each program ends with its good exit code. Under ThreadSanitizer a data race is another exit code.
"""
import os
import sys
import tempfile
import time

from running_daemon import NETWORK, PATIENCE, ROOT, Bus, check, failures


def slow_network(folder):
    """The demo with a longer period, because a busy machine and a sanitizer are slow."""
    text = NETWORK.read_text().replace("../eds/", f"{ROOT}/share/eds/")
    path = folder / "net.yaml"
    path.write_text(text.replace("sync_period: 2000 ", "sync_period: 20000 "))
    return path


def await_good(bus, *arguments, **environment):
    """Until the tool ends with 0: on a busy machine an answer may come too late for it."""
    env = {**os.environ, **{name: str(value) for name, value in environment.items()}}
    until = time.monotonic() + PATIENCE
    while (result := bus.takt(*arguments, env=env)).returncode != 0 and time.monotonic() < until:
        time.sleep(0.2)
    check(f"takt {' '.join(arguments)}: exit code {result.returncode}", result.returncode == 0, result.stderr)
    return result.stdout


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        bus = Bus(binaries, folder)
        # A move that takt-move computes itself outlives the cycles that a busy machine misses.
        try:
            # The tools have to wait for a daemon that is still booting.
            bus.daemon = bus.start("taktd", slow_network(bus.folder), "--bus", "sim", "--no-motions")
            status = await_good(bus, "status")
            check("takt status names the axis and shows its statusword", "shoulder" in status and "stat " in status, status)
            for page in ("axes", "words", "io", "pdos", "timing", "nodes"):
                for width in (50, 80, 120):
                    view = await_good(bus, "top", "--page", page, COLUMNS=width)
                    fits = all(len(line) <= width for line in view.splitlines())
                    check(f"page {page} at {width} columns", fits and view.count("\n") > 5 and "\033" not in view, view)
            move = bus.start("takt-move", "--for", "6s", "--wait", str(PATIENCE))
            await_good(bus, "sdo", "read", "shoulder", "6041:00")
            await_good(bus, "timing")
            code = move.wait(2 * PATIENCE)
            check(f"takt-move ended with {code}", code == 0, bus.log_of("takt-move").read_text())
        finally:
            code = bus.end_daemon()
        check(f"taktd ended with {code}", code == 0, bus.log_of("taktd").read_text())
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
