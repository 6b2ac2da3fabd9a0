#!/usr/bin/env python3
"""gateway_dialogue_test.py BIN [--record] [NAME...]: dialogues with the gateway of a live taktd.

test/e2e/dialogues/*.txt were recorded from a taktd with simulated devices (plant.yaml), each answer as it came;
without --record they are played again and every answer has to be the same. `--record` writes the answers anew.

  # ...      comment
  > line     typed; the next line is typed when all answers to this one have come
  ? line     the same, and typed again until the answer is the recorded one: process data and states take some cycles
  < line     received
Answers ([n] and #) come in their order, and so do the unrequested messages of each node (1 10 BOOT_UP). CiA 309-3
does not define the order between answers and messages.
"""
import pathlib
import socket
import subprocess
import sys
import tempfile
import time

from running_daemon import PATIENCE, await_true

HERE = pathlib.Path(__file__).resolve().parent / "dialogues"
QUIET = 4  # recording: so long nothing comes any more


class Client:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(str(path))
        self.unread = b""

    def say(self, line):
        self.socket.sendall(line.encode() + b"\r\n")

    def line(self, wait):
        """Returns the next line, or None if none came in this time."""
        until = time.monotonic() + wait
        while b"\r\n" not in self.unread:
            self.socket.settimeout(max(until - time.monotonic(), 0.001))
            try:
                some = self.socket.recv(4096)
            except TimeoutError:
                return None
            if not some:
                sys.exit("taktd has closed the connection")
            self.unread += some
        line, self.unread = self.unread.split(b"\r\n", 1)
        return line.decode()


class Daemon:
    def __init__(self, binaries, folder):
        self.path, self.log = folder / "gateway", folder / "events"
        command = [f"{binaries}/taktd", HERE / "plant.yaml", "--bus", "sim", "--gateway", f"unix:{self.path}",
                   "--events", self.log, "--lcm-url", "memq://"]
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __enter__(self):
        await_true("boot of both nodes", lambda: self.log.exists() and self.log.read_text().count('"boot_done"') == 2, self.process)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(PATIENCE)


def turns(file):
    """What is typed, how, and what came: lists of [kind, line, answers]; comments as ["#", line, []]."""
    out = []
    for line in file.read_text().splitlines():
        kind, rest = line[:1], line[2:]
        if kind in (">", "?"):
            out.append([kind, rest, []])
        elif kind == "<":
            out[-1][2].append(rest)
        else:
            out.append(["#", line, []])
    return out


def record(client, kind, line):
    if kind == "?":
        time.sleep(QUIET)
    client.say(line)
    came = [client.line(PATIENCE)]
    while not any(one.startswith("[") for one in came):
        came.append(client.line(PATIENCE))
    while (more := client.line(QUIET)) is not None:
        came.append(more)
    return came


def come(client, count):
    came = []
    while len(came) < count:
        line = client.line(PATIENCE)
        if line is None:
            return came + ["(nothing more)"]
        came.append(line)
    return came


def apart(lines):
    """Sorts the lines by their source: answers, or messages of a net and node."""
    out = {}
    for line in lines:
        source = "answers" if line.startswith(("[", "#")) else tuple(line.split()[:2])
        out.setdefault(source, []).append(line)
    return out


def replay(client, kind, line, expected, where):
    until = time.monotonic() + PATIENCE
    while True:
        client.say(line)
        came = come(client, len(expected))
        if apart(came) == apart(expected):
            return
        if kind == ">" or time.monotonic() > until:
            sys.exit(f"{where}: {line}\nexpected {expected}\ngot      {came}")


def play(binaries, file, recording):
    with tempfile.TemporaryDirectory() as folder, Daemon(binaries, pathlib.Path(folder)) as daemon:
        client = Client(daemon.path)
        out = []
        for kind, line, expected in turns(file):
            if kind == "#":
                out.append(line)
                continue
            came = expected
            if recording:
                came = record(client, kind, line)
            else:
                replay(client, kind, line, expected, file.name)
            out += [f"{kind} {line}"] + [f"< {one}" for one in came]
        if recording:
            file.write_text("\n".join(out) + "\n")
        else:  # nothing else may have come
            replay(client, ">", "[4294967295] set network 1", ["[4294967295] OK"], file.name)


def main():
    binaries, *words = sys.argv[1:]
    recording = "--record" in words
    names = [word for word in words if word != "--record"]
    files = [file for file in sorted(HERE.glob("*.txt")) if not names or file.stem in names]
    if not files:
        sys.exit("no dialogue")
    for file in files:
        play(binaries, file, recording)
        print(f"{file.name}: {'recorded' if recording else 'the same once more'}")


main()
