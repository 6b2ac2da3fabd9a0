#!/usr/bin/env python3
"""judge_bit_rate.py BIN: `takt lss set-bitrate --activate` changes a bus of two real controllers.

takt has can0; on can1 are LSS slaves written from the standard, which change can1 when they are told to. What the
controllers run at is read back from the kernel: its netlink attributes, and the registers that the driver wrote.
Then taktd boots a device at the new bit rate. Runs inside with-rt-can, with the interpreter of the judges' environment.
Exit code 1: a check failed.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

import can

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "vcan"))
from scripted_slaves import Slave, Slaves

NETWORK = HERE / "half_rate.yaml"
MASTER, DEVICES = "can0", "can1"
KBIT = {0: 1000, 2: 500, 3: 250, 4: 125}  # by index of CiA 305, table 1
DELAY = 1000  # ms; the machine is emulated
CLOCK = 8_000_000  # Hz, of the SJA1000 behind its divider
WAITING, ACTIVATE = 0x04, 0x15
without_rights = ["setpriv", "--bounding-set=-net_admin", "--inh-caps=-net_admin"]
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


class Devices(Slaves):
    """Slaves that change the bit rate of their controller one delay after they are told to."""

    def take(self, message):
        super().take(message)
        if message.data[0] == ACTIVATE:
            self.bus.shutdown()  # silent from here on
            time.sleep(self.slaves[0].delay / 1000)
            set_link(DEVICES, KBIT[self.slaves[0].bit_timing])
            self.bus = can.Bus(interface="socketcan", channel=DEVICES)


def set_link(interface, kbit):
    for words in (["down"], ["type", "can", "bitrate", str(kbit * 1000)], ["up"]):
        subprocess.run(["ip", "link", "set", interface, *words], check=True)


def link(interface):
    told = subprocess.run(["ip", "-details", "-json", "link", "show", interface], capture_output=True, check=True)
    return json.loads(told.stdout)[0]


def bit_rate(interface):
    return link(interface)["linkinfo"]["info_data"]["bittiming"]["bitrate"]


def register_bit_rate(interface):
    """By the bit timing registers BTR0 and BTR1 that the driver wrote last, as it tells in the kernel's log."""
    log = subprocess.run(["dmesg"], capture_output=True, text=True, check=True).stdout
    btr0, btr1 = (int(number, 16) for number in re.findall(interface + r": setting BTR0=(\w+) BTR1=(\w+)", log)[-1])
    quanta = 1 + (btr1 & 0x0F) + 1 + (btr1 >> 4 & 7) + 1
    return CLOCK // ((btr0 & 0x3F) + 1) // quanta


def lss(binaries, *words, by=()):
    done = subprocess.run([*by, binaries / "takt", "lss", *words, "--bus", MASTER], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout.strip(), done.stderr.strip()


def change_to(binaries, kbit, by=()):
    return lss(binaries, "set-bitrate", str(kbit), "--all", "--activate", str(DELAY), by=by)


def judge_rights(binaries, bus):
    """Who may not change the interface changes no device either."""
    code, out, said = change_to(binaries, 500, without_rights)
    check(code == 3 and "needs root, or CAP_NET_ADMIN" in said, f"without CAP_NET_ADMIN: {code} {out} {said}")
    check(not bus.commands and bit_rate(MASTER) == 1_000_000, f"and no frame was sent: {bus.commands}")


def judge_change(binaries, bus, kbit):
    before, begun = link(MASTER), len(bus.commands)
    code, out, said = change_to(binaries, kbit)
    check(code == 0 and f"the bus runs at {kbit} kbit/s" in out, f"to {kbit} kbit/s: {code} {out} {said}")
    for interface in (MASTER, DEVICES):
        rates = bit_rate(interface), register_bit_rate(interface)
        check(rates == (kbit * 1000, kbit * 1000), f"{interface} by netlink and by its registers: {rates}")
    after, kept = link(MASTER), lambda one: (one["txqlen"], one["linkinfo"]["info_data"]["restart_ms"])
    check("UP" in after["flags"] and kept(after) == kept(before), f"it is up, with its queue and restart-ms: {kept(after)}")
    told = [(when, frame[0]) for when, frame in bus.commands[begun:]]
    check([code for _, code in told[-2:]] == [ACTIVATE, WAITING], f"activation and its end came: {[hex(code) for _, code in told]}")
    silent = told[-1][0] - told[-2][0]
    check(silent >= 2 * DELAY / 1000, f"silence between them: {silent:.1f} s")
    check(not any(slave.configuring for slave in bus.slaves), "all devices are in waiting state again")
    code, out, said = lss(binaries, "inquire", *"--vendor 0x15A --product 2 --revision 0x10003 --serial 7 --json".split())
    check(code == 0 and json.loads(out)["node_id"] == 9, f"and one answers at the new bit rate: {out.split()} {said}")


def judge_daemon(binaries):
    """taktd at the new bit rate, and a device on the other controller."""
    device = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", DEVICES])
    ear, counts, lock = can.Bus(interface="socketcan", channel=DEVICES), {}, threading.Lock()

    def count(message):
        with lock:
            counts[message.arbitration_id] = counts.get(message.arbitration_id, 0) + 1

    hearing = can.Notifier(ear, [count])
    with tempfile.TemporaryDirectory() as folder:
        events = pathlib.Path(folder) / "events.jsonl"
        done = subprocess.run([binaries / "taktd", NETWORK, "--for", "10s", "--events", events], capture_output=True, text=True, timeout=120)
        told = [json.loads(line) for line in events.read_text().splitlines()]
    hearing.stop()
    ear.shutdown()
    device.terminate()
    device.wait()
    check(done.returncode == 0 and "runs at" not in done.stderr, f"taktd warns of no other bit rate: {done.stderr.splitlines()[:1]}")
    check([event["node"] for event in told if event["kind"] == "boot_done"] == [5], "and boots the device")
    syncs, answers = counts.get(0x080, 0), counts.get(0x185, 0)
    check(syncs >= 20 and answers >= 20, f"{syncs} SYNCs crossed the wire, {answers} TPDOs came back")


def main(binaries):
    binaries = pathlib.Path(binaries)
    bus = Devices(DEVICES, [Slave(7, node_id=9), Slave(8, node_id=10)])
    judge_rights(binaries, bus)
    for kbit in (125, 500):
        judge_change(binaries, bus, kbit)
    bus.stop()
    judge_daemon(binaries)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
