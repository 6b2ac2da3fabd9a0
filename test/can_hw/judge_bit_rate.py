#!/usr/bin/env python3
"""judge_bit_rate.py BIN: `takt lss set-bitrate --activate` changes a bus of two real controllers.

takt has can0. On can1 are LSS slaves written from the standard, which change can1 when takt commands it. The bit
rates of the controllers are read back from the kernel: its netlink attributes, and the registers that the driver wrote.
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
DELAYS = [4000 << step for step in range(4)]  # ms; the machine is emulated, and may be busy besides
ANSWER = 0.5  # s; takt waits 1 s
PATIENCE = 180  # s
CLOCK = 8_000_000  # Hz, of the SJA1000 behind its divider
WAITING, ACTIVATE = 0x04, 0x15
without_rights = ["setpriv", "--bounding-set=-net_admin", "--inh-caps=-net_admin"]
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


class Devices(Slaves):
    """Slaves that change the bit rate of their controller one delay after the command. `late`: on this machine
    they took longer for an answer or for the change than a device may, so nothing can be said about takt."""

    def __init__(self):
        self.late = False
        super().__init__(DEVICES, [Slave(7, node_id=9), Slave(8, node_id=10)])

    def take(self, message):
        super().take(message)
        allowed = ANSWER
        if message.data[0] == ACTIVATE:
            delay = self.slaves[0].delay / 1000
            self.bus.shutdown()  # silent from here on
            time.sleep(delay)
            set_link(DEVICES, KBIT[self.slaves[0].bit_timing])
            self.bus = can.Bus(interface="socketcan", channel=DEVICES)
            allowed = 2 * delay
        self.late = self.late or time.time() - message.timestamp > allowed

    def await_last(self, command):
        """Waits until the thread of the slaves has taken this command of takt."""
        until = time.monotonic() + PATIENCE
        while not self.late and time.monotonic() < until:
            if self.commands and self.commands[-1][1][0] == command:
                return
            time.sleep(0.1)


def set_link(interface, kbit):
    for words in (["down"], ["type", "can", "bitrate", str(kbit * 1000)], ["up"]):
        subprocess.run(["ip", "link", "set", interface, *words], check=True)


def link(interface):
    told = subprocess.run(["ip", "-details", "-json", "link", "show", interface], capture_output=True, check=True)
    return json.loads(told.stdout)[0]


def bit_rate(interface):
    return link(interface)["linkinfo"]["info_data"]["bittiming"]["bitrate"]


def register_bit_rate(interface):
    """The bit rate by the registers BTR0 and BTR1 that the driver wrote last, according to the kernel's log."""
    log = subprocess.run(["dmesg"], capture_output=True, text=True, check=True).stdout
    btr0, btr1 = (int(number, 16) for number in re.findall(interface + r": setting BTR0=(\w+) BTR1=(\w+)", log)[-1])
    quanta = 1 + (btr1 & 0x0F) + 1 + (btr1 >> 4 & 7) + 1
    return CLOCK // ((btr0 & 0x3F) + 1) // quanta


def lss(binaries, *words, by=()):
    done = subprocess.run([*by, binaries / "takt", "lss", *words, "--bus", MASTER], capture_output=True, text=True)
    return done.returncode, done.stdout.strip(), done.stderr.strip()


def change_to(binaries, kbit, delay, by=()):
    return lss(binaries, "set-bitrate", str(kbit), "--all", "--activate", str(delay), by=by)


def judge_rights(binaries):
    """If takt may not change the interface, it changes no device either."""
    bus = Devices()
    code, out, said = change_to(binaries, 500, DELAYS[0], without_rights)
    bus.stop()
    check(code == 3 and "needs root, or CAP_NET_ADMIN" in said, f"without CAP_NET_ADMIN: {code} {out} {said}")
    check(not bus.commands and bit_rate(MASTER) == 1_000_000, f"and no frame was sent: {bus.commands}")


def judge_change(binaries, kbit):
    """If the machine was too slow for the devices, the test restores everything and tries a longer delay."""
    begun = bit_rate(MASTER) // 1000
    for delay in DELAYS:
        before, bus = link(MASTER), Devices()
        changed = change_to(binaries, kbit, delay)
        bus.await_last(WAITING)
        commands = list(bus.commands)
        found = lss(binaries, "inquire", *"--vendor 0x15A --product 2 --revision 0x10003 --serial 7 --json".split())
        bus.stop()
        if not bus.late or delay == DELAYS[-1]:
            break
        print(f"      the devices were late with a delay of {delay} ms: once more")
        set_link(MASTER, begun)
        set_link(DEVICES, begun)

    code, out, said = changed
    check(not bus.late, f"the devices were in time, with a delay of {delay} ms")
    check(code == 0 and f"the bus runs at {kbit} kbit/s" in out, f"to {kbit} kbit/s: {code} {out} {said}")
    for interface in (MASTER, DEVICES):
        rates = bit_rate(interface), register_bit_rate(interface)
        check(rates == (kbit * 1000, kbit * 1000), f"{interface} by netlink and by its registers: {rates}")
    after, kept = link(MASTER), lambda one: (one["txqlen"], one["linkinfo"]["info_data"]["restart_ms"])
    check("UP" in after["flags"] and kept(after) == kept(before), f"it is up, with its queue and restart-ms: {kept(after)}")
    codes = [frame[0] for _, frame in commands]
    check(codes[-2:] == [ACTIVATE, WAITING], f"activation and its end came: {[hex(code) for code in codes]}")
    silent = commands[-1][0] - commands[-2][0]
    check(silent >= 2 * delay / 1000, f"silence between them: {silent:.1f} s")
    check(not any(slave.configuring for slave in bus.slaves), "all devices are in waiting state again")
    code, out, said = found
    check(code == 0 and json.loads(out)["node_id"] == 9, f"and one answers at the new bit rate: {out.split()} {said}")


def judge_daemon(binaries):
    """taktd boots a device on the other controller at the new bit rate."""
    device = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", DEVICES])
    ear, counts, lock = can.Bus(interface="socketcan", channel=DEVICES), {0x080: 0, 0x185: 0}, threading.Lock()

    def count(message):
        with lock:
            counts[message.arbitration_id] = counts.get(message.arbitration_id, 0) + 1

    hearing = can.Notifier(ear, [count])
    with tempfile.TemporaryDirectory() as folder:
        events = pathlib.Path(folder) / "events.jsonl"
        taktd = subprocess.Popen([binaries / "taktd", NETWORK, "--events", events], stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + PATIENCE
        while min(counts[0x080], counts[0x185]) < 20 and time.monotonic() < until:
            time.sleep(0.1)
        taktd.terminate()
        _, said = taktd.communicate()
        booted = [event["node"] for event in map(json.loads, events.read_text().splitlines()) if event["kind"] == "boot_done"]
    hearing.stop()
    ear.shutdown()
    device.terminate()
    device.wait()
    check(taktd.returncode == 0 and "runs at" not in said, f"taktd warns of no other bit rate: {taktd.returncode} {said.splitlines()[:1]}")
    check(set(booted) == {5}, f"and boots the device: {booted}")
    check(min(counts[0x080], counts[0x185]) >= 20, f"{counts[0x080]} SYNCs crossed the wire, {counts[0x185]} TPDOs came back")


def main(binaries):
    binaries = pathlib.Path(binaries)
    judge_rights(binaries)
    for kbit in (125, 500):
        judge_change(binaries, kbit)
    judge_daemon(binaries)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
