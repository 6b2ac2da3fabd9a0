#!/usr/bin/env python3
"""judge_pdos.py BIN: a part of the PDO matrix on vcan0, by frames that this script writes itself.

First it is the master of a simulated device (`takt sim`): each transmission type, inhibit time, event
timer, remote requests, frames of wrong length. Then taktd is the master: remote requests and type 0 on the wire.
judge_families.py tests the device families. Wireshark's dissector reads all frames.
Runs inside with-vcan. Exit code 1: a check failed.
"""
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import time

from dissector import judge_dissector, recording

NETWORK = pathlib.Path(__file__).resolve().parent / "pdo_types.yaml"
NODE, TPDO, RPDO = 5, 0x185, 0x205
RTR = 0x40000000
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


class Bus:
    """A CAN_RAW socket on vcan0, and one TPDO of a device there."""

    def __init__(self, node=NODE, number=1):
        self.node, self.record = node, 0x1800 + number - 1
        self.tpdo = 0x80 + 0x100 * number + node
        self.socket = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind(("vcan0",))

    def send(self, identifier, data=b"", length=None):
        size = len(data) if length is None else length
        self.socket.send(struct.pack("<IB3x8s", identifier, size, data))

    def frames(self, seconds):
        """Yields (time, identifier, payload) of the frames that come within `seconds`."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                raw = self.socket.recv(16)
            except TimeoutError:
                return
            can_id, size = struct.unpack("<IB", raw[:5])
            yield time.monotonic(), can_id, raw[8:8 + size]

    def take(self, seconds, identifier):
        """[(time, payload)] of the data frames of this identifier that come within `seconds`."""
        return [(when, data) for when, can_id, data in self.frames(seconds) if can_id == identifier]

    def sdo(self, index, sub, value, size):
        """Expedited download; returns the abort code, 0 if the device accepted the value, None without an answer."""
        command = 0x23 | (4 - size) << 2
        self.send(0x600 + self.node, struct.pack("<BHBI", command, index, sub, value))
        for _, can_id, data in self.frames(2):
            if can_id == 0x580 + self.node and data[1:4] == struct.pack("<HB", index, sub):
                return struct.unpack("<I", data[4:])[0] if data[0] == 0x80 else 0
        return None

    def change(self, value):
        """Writes 0x2001:01. The device returns the value in 0x2101:01, the first four bytes of TPDO1."""
        self.sdo(0x2001, 1, value, 4)

    def configure(self, kind, inhibit=0, timer=0):
        self.send(0, bytes((0x80, self.node)))
        self.sdo(self.record, 1, 0x80000000 | self.tpdo, 4)
        abort = self.sdo(self.record, 2, kind, 1)
        self.sdo(self.record, 3, inhibit, 2)
        self.sdo(self.record, 5, timer, 2)
        self.sdo(self.record, 1, self.tpdo, 4)
        self.change(0)
        self.take(0.05, self.tpdo)
        self.send(0, bytes((0x01, self.node)))
        return abort

    def sync(self, count=1):
        """Sends `count` SYNCs and returns the frames of the TPDO that follow them."""
        found = []
        for _ in range(count):
            self.send(0x080)
            found += self.take(0.06, self.tpdo)
        return found

    def remote(self):
        self.send(self.tpdo | RTR, length=8)
        return self.take(0.15, self.tpdo)


def value(frames):
    return [data[0] for _, data in frames]


def judge_synchronous(bus):
    bus.configure(0)
    check(value(bus.sync(3)) == [0], "type 0: its state with the first SYNC, then nothing")
    bus.change(1)
    bus.change(2)
    check(value(bus.take(0.1, TPDO)) == [], "type 0: an event alone sends nothing")
    check(value(bus.sync(3)) == [2], "type 0: two events, one frame with the newest data")
    bus.configure(1)
    check(len(bus.sync(5)) == 5, "type 1: with each of 5 SYNCs")
    bus.configure(3)
    check(len(bus.sync(9)) == 3, "type 3: with each third of 9 SYNCs")


def judge_remote(bus):
    bus.configure(252)
    check(bus.remote() == [], "type 252: no answer before the first SYNC")
    check(bus.sync() == [], "type 252: SYNC sends nothing")
    bus.change(5)
    check(value(bus.remote()) == [0], "type 252: the answer was sampled at SYNC")
    bus.configure(253)
    bus.change(6)
    check(value(bus.remote()) == [6], "type 253: the answer is sampled at the request")


def judge_events(bus):
    for kind in (254, 255):
        bus.configure(kind)
        check(len(bus.take(0.15, TPDO)) == 1, f"type {kind}: its state once")
        bus.send(0x080)
        check(bus.take(0.15, TPDO) == [], f"type {kind}: SYNC means nothing")
        check(value(bus.remote()) == [0], f"type {kind}: a remote request is answered")
    bus.configure(255, inhibit=8000)
    start = time.monotonic()
    for step in (1, 2, 3):
        bus.change(step)
    frames = bus.take(1.5, TPDO)
    late = [f for f in frames if f[0] - start > 0.5]
    check(value(late) == [3], f"inhibit 0.8 s: three events, one frame with the newest: {value(frames)}")
    bus.configure(255, timer=200)
    frames = bus.take(1.3, TPDO)
    check(5 <= len(frames) <= 8, f"event timer 200 ms: {len(frames)} frames in 1.3 s")


def judge_refusals(bus):
    bus.send(0, bytes((0x80, NODE)))
    for kind in (241, 251):
        check(bus.sdo(0x1800, 2, kind, 1) == 0x06090030, f"type {kind} is refused with 0609 0030")
    bus.configure(255)
    bus.take(0.1, TPDO)
    bus.send(RPDO, bytes(3))
    check([d[:2] for _, d in bus.take(0.3, 0x080 + NODE)] == [b"\x10\x82"], "a short RPDO: EMCY 8210")
    bus.send(RPDO, bytes((9, 0, 0, 0, 0, 0, 0, 0)))
    check(value(bus.take(0.3, TPDO)) == [9], "the next one of right length is used")


def judge_master(bus, binaries):
    taktd = subprocess.Popen([binaries / "taktd", NETWORK, "--for", "9s"])
    seen = {}
    for _, can_id, data in bus.frames(8.5):
        seen.setdefault(can_id, []).append(data)
    check(taktd.wait(timeout=180) == 0, f"taktd ended with exit code {taktd.returncode}")
    polls, answers = len(seen.get(TPDO | RTR, [])), len(seen.get(TPDO, []))
    check(polls >= 15, f"taktd asks for TPDO1 each 100 ms: {polls} remote requests")
    check(abs(polls - answers) <= 1, f"and each is answered: {answers}")
    sent = seen.get(RPDO, [])
    check(sent == [bytes((7, 0, 0, 0, 9, 0, 0, 0))], f"RPDO1 of type 0 goes out once: {sent}")


def judge_all(binaries):
    simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
    bus = Bus()
    try:
        check(any(bus.sdo(0x1017, 0, 0, 2) == 0 for _ in range(10)), "the device answers")
        for judge in (judge_synchronous, judge_remote, judge_events, judge_refusals):
            judge(bus)
        judge_master(bus, binaries)
    finally:
        simulation.terminate()
        simulation.wait()


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        with recording(log):
            judge_all(pathlib.Path(binaries))
        judge_dissector(check, log, 500, remote=[TPDO])
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
