#!/usr/bin/env python3
"""command_line_test.py BIN: what takt and taktd say to a user who is wrong, and to one who asks."""
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DEMO = ROOT / "share/demo/two_axes.yaml"
failures = []


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print("      " + told.replace("\n", "\n      "))


class Tools:
    def __init__(self, binaries):
        self.binaries = pathlib.Path(binaries)

    def run(self, command, **options):
        words = [str(word) for word in command]
        return subprocess.run([self.binaries / words[0], *words[1:]], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=60, **options)

    def says(self, name, command, code, *parts):
        """`command` ends with `code`, and its output holds all `parts`."""
        done = self.run(command)
        told = done.stdout + done.stderr
        missing = [part for part in parts if part not in told]
        check(name, done.returncode == code and not missing, f"exit code {done.returncode}, without {missing}:\n{told}")

    def start(self, *command):
        words = [str(word) for word in command]
        return subprocess.Popen([self.binaries / words[0], *words[1:]], stderr=subprocess.DEVNULL)


def wrong_use(tools):
    tools.says("takt names the commands it has", ["takt", "plam"], 2, "no command 'plam'", " plan ")
    tools.says("takt eds names the commands it has", ["takt", "eds", "chek"], 2, "no command 'chek'", " check")
    tools.says("takt without a command is wrong use", ["takt"], 2, "--help")
    for command in ([], ["dump"], ["eds"], ["import"], ["learn"], ["plan"], ["budget"], ["sim"], ["simulate"], ["status"],
                    ["top"], ["sdo"], ["nmt"]):
        tools.says(" ".join(["takt", *command, "--help"]) + " has an example", ["takt", *command, "--help"], 0, "Example")


def dump_chooses(tools, folder):
    log = folder / "trace.log"
    log.write_text("(1.0) can0 601#4000100000000000\n(1.1) can0 581#4300100092010200\n(1.2) can0 000#0100\n"
                   "(1.3) can0 602#4000100000000000\n(1.4) can0 082#3081110000000000\n(1.5) can0 20000040#0000000000000000\n")
    lines = lambda *options: tools.run(["takt", "dump", DEMO, log, *options]).stdout.splitlines()
    check("takt dump shows all six", len(lines()) == 6, str(lines()))
    check("--only EMCY,ERROR shows two", len(lines("--only", "emcy,ERROR")) == 2, str(lines("--only", "emcy,ERROR")))
    check("--node by name shows its frames and commands to all", len(lines("--node", "shoulder")) == 3, str(lines("--node", "shoulder")))
    check("--node by id", len(lines("--node", "2", "--only", "SDO")) == 1, str(lines("--node", "2", "--only", "SDO")))
    tools.says("--node wants a node", ["takt", "dump", log, "--node", "nobody"], 2, "'nobody' is no node id 1..127")


def budget(tools):
    tools.says("the demo fits its bus", ["takt", "budget", DEMO], 0, "TPDO2 elbow", "It fits")
    tools.says("it does not fit a quarter of its bit rate", ["takt", "budget", DEMO, "--what-if", "bitrate=250"], 1,
               "It does not fit", "TOO LATE", "1000 kbit/s instead of 250", "--what-if period=")
    tools.says("a PDO of a node that there is not", ["takt", "budget", DEMO, "--what-if", "wrist.tpdo1=2"], 2, "wrist", "elbow")
    tools.says("a PDO less", ["takt", "budget", DEMO, "--what-if", "io.tpdo2=off", "--timeline"], 0, "It fits", "receive window ends 1")
    tools.says("a bit rate that there is not", ["takt", "budget", DEMO, "--what-if", "bitrate=300"], 2, "bitrate=300")


def babble(path, stop):
    """Eight bytes that an SDO client could take for an answer, on many other identifiers."""
    bus = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    bus.connect(str(path))
    while not stop.wait(0.002):
        for identifier in (0x181, 0x281, 0x5B6):
            bus.send(struct.pack("<IIBBHI8sq", 0x544B0001, identifier, 8, 0, 0, 0, b"\xe0" * 8, 0))
    bus.close()


def sdo_without_daemon(tools, folder):
    path = folder / "bus"
    devices = tools.start("takt", "sim", DEMO, "--bus", f"unix:{path}")
    while not path.exists():
        time.sleep(0.02)
    stop = threading.Event()
    babbler = threading.Thread(target=babble, args=(path, stop))
    babbler.start()
    bus = ["--bus", f"unix:{path}"]
    try:
        tools.says("an absent node does not answer, whatever else is on the bus",
                   ["takt", "sdo", "read", 55, "1000", *bus, "--timeout", 300], 1, "did not answer")
        tools.says("a present one does", ["takt", "sdo", "read", 1, "1018:1", "u32", *bus], 0, "43981\n")
        tools.says("a value of another size is not shown in a type that it has not",
                   ["takt", "sdo", "read", 1, "1018:1", "u8", *bus], 1, "4 bytes (CDAB0000), u8 takes 1")
        tools.says("names need a daemon", ["takt", "sdo", "read", "io", "1000", *bus], 2, "known to a daemon only")
    finally:
        stop.set()
        babbler.join()
        devices.terminate()
        devices.wait()


def main(binaries):
    tools = Tools(binaries)
    with tempfile.TemporaryDirectory() as folder:
        wrong_use(tools)
        dump_chooses(tools, pathlib.Path(folder))
        budget(tools)
        sdo_without_daemon(tools, pathlib.Path(folder))
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
