#!/usr/bin/env python3
"""judge_families.py BIN: the device families of the PDO matrix on vcan0.

The course of test/virtual/pdo_matrix_cells.hpp, 20 times as slow, for all families at once: this script is their
master. Then taktd is the master, with other types. Wireshark's dissector reads all frames. Runs inside with-vcan. If
with-vcan has no virtual time, a failed run is repeated, up to three runs in all. Exit code 1: a check failed.
"""
import collections
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

from dissector import judge_dissector, recording
from judge_pdos import RTR, Bus, check, failures

NETWORK = pathlib.Path(__file__).resolve().parent / "pdo_families.yaml"
UNIT = 0.02  # what is 1 ms in the matrix
REFUSED = 0x06090030

# E: it changes, changes back, changes again. Raw values of inhibit time and event timer count 20 times as much as well.
COURSE = {"E": [(12, 1), (14, 0), (33, 2)], "R": (5, 15, 17, 37), "S": (10, 20, 30, 40, 50), "P": (11, 26)}
END, INHIBIT, TIMER = 103, 1800, 480

# Types, letters of what happens as in the matrix, and the frames of each family that has this type.
RUNS = [
    (0, "ETIRS", {"301": [10, 20, 40], "ars": [10, 20, 40], "Lenze": [10, 20, 30, 40, 50], "Beckhoff": [10, 40]}),
    (1, "ETIRS", dict.fromkeys(("301", "ars", "Lenze", "Beckhoff", "DRV-28"), [10, 20, 30, 40, 50])),
    (2, "ETIRS", dict.fromkeys(("301", "ars", "Lenze", "Beckhoff", "DRV-28"), [20, 40])),
    (252, "ETIRS", dict.fromkeys(("301", "ars", "Lenze", "Beckhoff"), [15, 17, 37])),
    (253, "ETIRS", dict.fromkeys(("301", "ars", "Lenze", "Beckhoff"), [5, 15, 17, 37])),
    (254, "ETIRS", {"301": [0, 9, 18, 33, 42, 66, 90], "Beckhoff": [0, 9, 18, 33, 42, 66, 90],
                    "ars": [0, 9, 18, 27, 36, 45, 54, 72, 96], "Lenze": [0, 9, 18, 27, 36, 45, 54, 72, 96],
                    "DRV-28": [24, 48, 72, 96]}),
    (254, "EIS", {"301": [0, 12, 21, 33], "Beckhoff": [0, 12, 21, 33], "ars": [0, 12, 21, 33],
                  "Lenze": [0, 12, 21, 33], "DRV-28": [12, 102]}),
    (255, "ET", {"301": [0, 12, 14, 33, 57, 81], "Beckhoff": [0, 12, 14, 33, 57, 81],
                 "ars": [0, 12, 14, 24, 33, 48, 72, 96], "Lenze": [0, 12, 14, 24, 33, 48, 72, 96],
                 "DRV-28": [24, 48, 72, 96]}),
    (255, "IR", {"301": [0, 9, 18, 37], "Beckhoff": [0, 9, 18, 37], "ars": [0, 9, 18, 37], "Lenze": [0, 9, 18, 37],
                 "DRV-28": []}),
    (255, "ISP", {"DRV-28": [11, 26]}),
]


class Device(Bus):
    """One TPDO of a device, and the object whose value it has."""

    def __init__(self, node, number, key, size):
        super().__init__(node, number)
        self.number, self.key, self.size = number, key, size

    def change(self, value):
        self.sdo(*self.key, value, self.size)

    def poke(self, value):
        """Like change(), but does not wait for the answer."""
        self.send(0x600 + self.node, struct.pack("<BHBI", 0x23 | (4 - self.size) << 2, *self.key, value))

    def respond(self):
        self.send(0x100 + 0x100 * self.number + self.node, bytes((0, 0, 0, 0, 1, 0, 0, 0)))


FAMILIES = {
    "301": (5, 1, (0x2001, 1), 4),
    "ars": (6, 1, (0x2001, 1), 4),
    "Lenze": (7, 1, (0x5C9D, 3), 2),
    "Beckhoff": (8, 1, (0x6200, 1), 1),
    "DRV-28": (9, 2, (0x2101, 3), 2),
}
ASKED = (0x185, 0x285, 0x186, 0x187, 0x188, 0x289)  # sent on remote request; only taktd requests 0x285


def course(devices, letters):
    """[(unit, action)] of the events of all these devices."""
    moments = []
    for device in devices:
        if "E" in letters:
            moments += [(unit, lambda d=device, v=value: d.poke(v)) for unit, value in COURSE["E"]]
        if "R" in letters:
            moments += [(unit, lambda d=device: d.send(d.tpdo | RTR, length=8)) for unit in COURSE["R"]]
        if "P" in letters:
            moments += [(unit, device.respond) for unit in COURSE["P"]]
    if "S" in letters:
        moments += [(unit, lambda: devices[0].send(0x080)) for unit in COURSE["S"]]
    return sorted(moments, key=lambda moment: moment[0])


def run(devices, kind, letters):
    """Runs the course. Returns the times, in units, at which each device sent its TPDO. devices: {name: Device}."""
    for device in devices.values():
        device.configure(kind, INHIBIT if "I" in letters else 0, TIMER if "T" in letters else 0)
        device.send(0, bytes((0x80, device.node)))
    ear = Bus()
    start = time.monotonic()
    ear.send(0, bytes((0x01, 0)))
    seen = {device.tpdo: [] for device in devices.values()}

    def listen(end):
        for when, identifier, _ in ear.frames(end - time.monotonic()):
            if identifier in seen:
                seen[identifier].append(round((when - start) / UNIT))

    for unit, action in course(list(devices.values()), letters):
        listen(start + unit * UNIT)
        action()
    listen(start + END * UNIT)
    return {name: seen[device.tpdo] for name, device in devices.items()}


def judge_devices(devices):
    for kind, letters, wanted in RUNS:
        chosen = {name: devices[name] for name in wanted}
        for _ in range(3):
            found = run(chosen, kind, letters)
            if found == wanted:
                break
        for name, frames in wanted.items():
            check(found[name] == frames, f"{name}, type {kind}, {letters}: {found[name]}")


def judge_refusals(devices):
    for device in devices.values():
        device.send(0, bytes((0x80, device.node)))
    for name, device in devices.items():
        for kind in (0, 241, 251, 252, 253):
            lacking = 241 <= kind <= 251 or name == "DRV-28"
            found = device.sdo(device.record, 2, kind, 1)
            check(found == (REFUSED if lacking else 0), f"{name}: type {kind} is {'refused' if lacking else 'taken'}")
    check(Device(9, 1, (0x2100, 1), 2).sdo(0x1800, 2, 254, 1) == REFUSED, "DRV-28: TPDO1 is of type 255 only")
    check(devices["Lenze"].sdo(0x1800, 1, 0xA0012345, 4) == REFUSED, "Lenze: no identifiers of 29 bits")


# PDOs that taktd shall see: identifier, and one in how many SYNCs.
MASTER_ROWS = [
    ("301, type 255, asked for each SYNC", 0x185 | RTR, 1),
    ("301, type 255, inhibit time of 5 SYNCs", 0x185, 5),
    ("301, type 252, asked for each 5th SYNC", 0x285, 5),
    ("ars, type 255, event timer of 5 SYNCs", 0x186, 5),
    ("ars, type 34", 0x286, 34),
    ("Lenze, type 0, cycle time of 10 SYNCs", 0x187, 10),
    ("Lenze, type 254, cycle time of 5 SYNCs", 0x287, 5),
    ("Beckhoff, type 1", 0x188, 1),
    ("Beckhoff, type 10", 0x288, 10),
    ("DRV-28, type 2", 0x289, 2),
    ("DRV-28, type 254, event timer of 5 SYNCs", 0x389, 5),
]


def run_master(binaries):
    """Runs taktd with all families. Returns its exit code, {identifier: frames} of 8 s, and the run of `takt param`."""
    taktd = subprocess.Popen([binaries / "taktd", NETWORK, "--for", "14s"])
    time.sleep(3)
    seen = collections.Counter(identifier for _, identifier, _ in Bus().frames(8))
    told = subprocess.run([binaries / "takt", "param", "read", "pump", "P15.13"], capture_output=True, text=True,
                          timeout=180)
    return taktd.wait(timeout=180), seen, told


def judge_master(binaries):
    def is_right(identifier, syncs):
        return seen[0x080] > 100 and abs(seen[identifier] - seen[0x080] / syncs) <= 2

    for _ in range(3):
        code, seen, told = run_master(binaries)
        if all(is_right(identifier, syncs) for _, identifier, syncs in MASTER_ROWS):
            break
    check(code == 0, f"taktd ended with exit code {code}")
    for name, identifier, syncs in MASTER_ROWS:
        check(is_right(identifier, syncs), f"{name}: {seen[identifier]} frames in {seen[0x080]} SYNCs")
    check(seen[0x489] == 0, "DRV-28, type 255: nothing without its RPDO")
    check((told.returncode, told.stdout) == (0, "0\n"), f"DRV-28, PDO1: P15.13 is {told.stdout}{told.stderr}")


def judge_all(binaries):
    simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
    devices = {name: Device(*how) for name, how in FAMILIES.items()}
    try:
        for name, device in devices.items():
            check(any(device.sdo(0x1017, 0, 0, 2) == 0 for _ in range(10)), f"{name}: the device answers")
        judge_devices(devices)
        judge_refusals(devices)
        judge_master(binaries)
    finally:
        simulation.terminate()
        simulation.wait()


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        with recording(log):
            judge_all(pathlib.Path(binaries))
        judge_dissector(check, log, 4000, remote=ASKED)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
