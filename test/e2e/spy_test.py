#!/usr/bin/env python3
"""spy_test.py BIN: what `takt spy` shows of a running taktd, in a pipe and in a terminal of 80 columns."""
import fcntl
import os
import pty
import re
import struct
import sys
import tempfile
import termios
import time

from running_daemon import NETWORK, PATIENCE, Bus, check, failures


def spy_in_terminal(bus, *words):
    """What the terminal shows until q."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.environ["TERM"] = "xterm"
        os.execv(bus.binaries / "takt", ["takt", "spy", *words, "--lcm-url", bus.url])
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    text = b""
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and b"_STATUS" not in text:
        text += os.read(terminal, 65536)
    os.write(terminal, b"q")
    try:
        while more := os.read(terminal, 65536):
            text += more
    except OSError:  # the other side is closed
        pass
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), text.decode(errors="replace")


def the_table(bus):
    done = bus.takt("spy")
    lines = done.stdout.splitlines()
    check("takt spy ends with 0", done.returncode == 0, done.stderr)
    for channel, type_name in (("DEMO_IMAGE", "image_t"), ("DEMO_STATUS", "status_t"), ("DEMO_LAYOUT", "layout_t"),
                               ("DEMO_TIMING", "timing_t")):
        check(f"{channel} is a {type_name}", any(re.match(rf"{channel} +{type_name} ", line) for line in lines), done.stdout)
    check("each line has at most 80 columns", lines and max(map(len, lines)) <= 80, done.stdout)
    image = next((line.split() for line in lines if line.startswith("DEMO_IMAGE ")), None)
    check("the image comes hundreds of times a second", image and 50 < float(image[2]) < 600, image)


def one_channel(bus):
    done = bus.takt("spy", "DEMO_IMAGE", "-n", "300")
    lines = done.stdout.splitlines()
    check("takt spy CHANNEL -n 300 prints 300 lines", done.returncode == 0 and len(lines) == 300, f"{len(lines)}: {done.stderr}")
    check("the values have the names and units of their signals",
          re.search(r" cycle=\d+ .* shoulder\.position_actual_value=\S+ rad ", lines[-1]), lines[-1])
    done = bus.takt("spy", "DEMO_STATUS", "-n", "1")
    check("lists have numbers", "nodes[0].name=\"shoulder\"" in done.stdout and 'bus="demo"' in done.stdout, done.stdout)
    done = bus.takt("spy", "DEMO_SHOULDER_STATE", "-n", "1")
    check("a channel of a node needs the network file", "--network NET.yaml" in done.stdout, done.stdout + done.stderr)
    done = bus.takt("spy", "DEMO_SHOULDER_STATE", "-n", "1", "--network", NETWORK)
    check("with it, it has names", re.search(r" position_actual_value=\S+", done.stdout), done.stdout + done.stderr)
    done = bus.takt("spy", "DEMO_STATS", "--for", "1s")
    check("a wrong channel has a guess", done.returncode == 1 and "did you mean 'DEMO_STATUS'?" in done.stderr, done.stderr)


def in_a_terminal(bus):
    code, text = spy_in_terminal(bus)
    check("q ends the view with 0", code == 0, code)
    check("the terminal is put back", text.endswith("\033[?25h\033[?1049l"), repr(text[-80:]))
    check("the view has the channels", "image_t" in text and "CHANNEL" in text, text[-2000:])
    code, text = spy_in_terminal(bus, "DEMO_STATUS")
    check("one channel has comments", code == 0 and "session" in text and "bit/s" in text, text[-2000:])


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        bus = Bus(binaries, folder)
        bus.start_daemon()
        try:
            the_table(bus)
            one_channel(bus)
            in_a_terminal(bus)
        finally:
            bus.end_daemon()
        done = bus.takt("spy", "--for", "0.5s")
        check("without a daemon it says so", done.returncode == 3 and "Is taktd running?" in done.stderr, done.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
