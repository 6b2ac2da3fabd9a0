#!/usr/bin/env python3
"""judge_sync.py BIN: taktd follows the SYNC that python-canopen produces on vcan0, and sends TIME.

The cycle begins with that SYNC and follows its period, which differs from that of taktd. A defined reaction
follows when SYNC is missing, and the cycle continues when SYNC is back. The test reads the TIME frames with the figures
of python-canopen, and Wireshark's dissector reads all frames.
Runs inside with-vcan. Exit code 1: a check failed.
"""
import datetime
import json
import pathlib
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time

import can
import canopen
from canopen.timestamp import OFFSET, ONE_DAY

from dissector import judge_dissector, recording

NETWORK = pathlib.Path(__file__).resolve().parent / "followed_sync.yaml"
PERIOD, SLOWER = 0.020, 0.0205
TICK, STALL = 0.002, 0.004
LATE = 1.3  # periods; taktd regards SYNC as lost after 1.5
CALM = 12  # SYNCs until its node is surely back
STANDSTILL = 0.5  # s for which taktd may pause, too, and then read a SYNC that has waited
ENOUGH = 80  # steady SYNCs that are judged
PATIENCE = 180  # s for them
START, STOP = b"\x01\x05", b"\x02\x05"
NMT, SYNC, TIME, RPDO = 0x000, 0x080, 0x100, 0x205
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


class Ear:
    """Everything on the bus, with the kernel's times."""

    def __init__(self):
        self.frames, self.running = [], True
        self.bus = can.Bus(interface="socketcan", channel="vcan0", receive_own_messages=False)
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while self.running:
            message = self.bus.recv(0.1)
            if message is not None:
                self.frames.append((message.timestamp, message.arbitration_id, bytes(message.data)))

    def stop(self):
        self.running = False
        self.thread.join()
        self.bus.shutdown()

    def between(self, identifier, begin, end):
        return [f for f in list(self.frames) if f[1] == identifier and begin <= f[0] <= end]


class Ticks:
    """The times at which this machine paused, with every process on it, taktd too."""

    def __init__(self):
        self.stalls, self.running = [], True
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        last = time.time()
        while self.running:
            time.sleep(TICK)
            now = time.time()
            if now - last > TICK + STALL:
                self.stalls.append((last, now))
            last = now

    def stop(self):
        self.running = False
        self.thread.join()

    def stalled(self, begin, end):
        return any(last < end and now > begin for last, now in list(self.stalls))


def intervals(times):
    return [b - a for a, b in zip(times, times[1:])]


def steady(syncs, period, ticks):
    """Indices of the SYNCs before which no SYNC was missing for a while, and after which the machine did not pause
    until the next SYNC. What taktd does after a pause of the machine is not part of this check."""
    found, calm = [], 0
    for i, gap in enumerate(intervals(syncs)):
        calm = calm + 1 if gap < LATE * period else 0
        if calm >= CALM and i + 2 < len(syncs) and not ticks.stalled(syncs[i + 1], syncs[i + 2]):
            found.append(i + 1)
    return found


def losses(syncs, period):
    return sum(gap >= LATE * period for gap in intervals(syncs))


class Source:
    """The producer of python-canopen, which runs until enough of the following cycles were recorded."""

    def __init__(self, network, ear):
        self.network, self.ear = network, ear

    def times(self, begin, end):
        return [f[0] for f in self.ear.between(SYNC, begin, end)]

    def run(self, period, enough):
        begin = time.time()
        self.network.sync.start(period)
        while time.time() < begin + PATIENCE and not enough(begin):
            time.sleep(0.2)
        self.network.sync.stop()
        return begin, time.time()


def judge_following(ear, ticks, syncs, period):
    """Outputs have a constant distance from the SYNC of the other producer."""
    followed = steady(syncs, period, ticks)
    check(len(followed) >= ENOUGH, f"{len(followed)} steady SYNCs of {period * 1e3} ms, none of them ours")
    outputs = [f[0] for f in ear.between(RPDO, syncs[0], syncs[-1])]
    places = []
    for i in followed:
        behind = [out - syncs[i] for out in outputs if syncs[i] <= out < syncs[i + 1]]
        places += behind[:1]
    check(len(places) >= 0.9 * len(followed), f"an output to each of them: {len(places)}")
    if not places:
        return
    near = statistics.median(places)
    check(0.002 < near < period, f"outputs go out {near * 1e3:.1f} ms after SYNC")
    there = sum(abs(place - near) < 0.004 for place in places)
    check(there >= 0.9 * len(places), f"{there} of {len(places)} within 4 ms of that place (by chance: 40 %)")


def judge_time(frames):
    check(len(frames) >= 10, f"{len(frames)} TIME frames")
    wrong = []
    for stamp, _, data in frames:
        ms, days = struct.unpack("<LH", data)
        if abs(OFFSET + days * ONE_DAY + ms / 1000 - stamp) > 0.2:
            wrong.append((stamp, data.hex()))
    check(not wrong, f"TIME is the time of day, in UTC: {wrong[:2]}")
    steps = [b[0] - a[0] for a, b in zip(frames, frames[1:])]
    check(abs(statistics.median(steps) - 0.5) < 0.03, f"each {statistics.median(steps):.3f} s")


def judge_all(binaries, events):
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
    ear = Ear()
    source = Source(network, ear)
    ticks = Ticks()

    def commands(begin, end):
        return [f[2] for f in ear.between(NMT, begin, end)]

    def started(begin):
        return START in commands(begin, time.time()) and len(ear.between(RPDO, begin, time.time())) >= 10

    def followed(period):
        return lambda begin: len(steady(source.times(begin, time.time()), period, ticks)) >= ENOUGH

    time.sleep(0.5)
    taktd = subprocess.Popen([binaries / "taktd", NETWORK, "--events", events])
    first, _ = source.run(PERIOD, started)
    begin, end = source.run(SLOWER, followed(SLOWER))
    judge_following(ear, ticks, source.times(begin, end), SLOWER)
    time.sleep(2)
    last = source.times(begin, end + 2)[-1]
    check(last < end + 0.1, "nobody makes SYNC in the pause, taktd does not either")
    stopped = commands(last + 0.001, last + STANDSTILL)
    again = stopped.count(START) if ticks.stalled(last - PERIOD, last + STANDSTILL) else 0
    once = stopped.count(STOP) == again + 1
    check(stopped[-1:] == [STOP] and once, f"without SYNC the node is stopped: {stopped}")
    silence = commands(last + STANDSTILL, end + 1.9)
    check(not silence, f"and nothing else is commanded: {silence}")
    again, until = source.run(PERIOD, followed(PERIOD))
    back = source.times(again, until)
    judge_following(ear, ticks, back, PERIOD)
    restarts = commands(again, back[-1])
    check(restarts[:1] == [START], f"and started when it is back: {restarts}")
    check(restarts.count(STOP) <= losses(back, PERIOD), "and not stopped again as long as it comes")
    time.sleep(0.5)
    taktd.send_signal(signal.SIGINT)
    check(taktd.wait(timeout=180) == 0, f"taktd ended with exit code {taktd.returncode}")
    told = [json.loads(line) for line in events.read_text().splitlines()]
    kinds = [event["kind"] for event in told if event["kind"] in ("sync_lost", "sync_back")]
    stayed_away = losses(source.times(first, until), PERIOD)
    in_turn = all(kind == ("sync_lost" if i % 2 else "sync_back") for i, kind in enumerate(kinds))
    check(in_turn and kinds[-1:] == ["sync_lost"], f"lost and back are told in turn: {kinds}")
    check(2 <= kinds.count("sync_lost") <= stayed_away + 1, f"{stayed_away} times SYNC stayed away, and at the end")
    check(not [event for event in told if event["kind"] == "boot_failed"], "the node booted at once")
    judge_time([f for f in list(ear.frames) if f[1] == TIME])
    ear.stop()
    ticks.stop()
    network.disconnect()
    simulation.terminate()
    simulation.wait()


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        with recording(log):
            judge_all(pathlib.Path(binaries), pathlib.Path(folder) / "events.jsonl")
        judge_dissector(check, log, 500)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
