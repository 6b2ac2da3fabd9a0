#!/usr/bin/env python3
"""judge_simulation.py BIN: taktd on vcan0 against `takt sim` on vcan0, a node reset from outside.

candump records the bus, and the test checks the recording: boot, SYNC, a node that leaves and comes back
while the others keep cycling, and the ordered stop. Runs inside with-vcan. Exit code 1: a check failed.
"""
import collections
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from dissector import judge_dissector

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NETWORK = ROOT / "test/vcan/simulated_axes.yaml"
NODES = (5, 6)
PERIOD = 0.010
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def read_log(path):
    """[(time, identifier, payload)] of a candump log."""
    frames = []
    for line in path.read_text().splitlines():
        stamp, _, text = line.split()[:3]
        identifier, payload = text.split("#")
        frames.append((float(stamp.strip("()")), int(identifier, 16), bytes.fromhex(payload)))
    return frames


def times_of(frames, identifier, first=None):
    return [f[0] for f in frames if f[1] == identifier and (first is None or f[2][:1] == first)]


def judge_sync(frames):
    syncs = [f for f in frames if f[1] == 0x080]
    steps = [b[0] - a[0] for a, b in zip(syncs, syncs[1:])]
    median = statistics.median(steps)
    check(abs(median - PERIOD) < 0.0005, f"median SYNC period {median * 1e3:.3f} ms of {len(syncs)}")
    check(min(steps) > PERIOD / 4, f"no burst of SYNCs: shortest distance {min(steps) * 1e3:.2f} ms")
    counters = [f[2] for f in syncs]
    check(all(len(c) == 1 for c in counters), "each SYNC carries its counter")
    right = all(b[0] == a[0] % 10 + 1 for a, b in zip(counters, counters[1:]))
    check(right and counters[0] == b"\1", "the counter runs 1..10 without a gap")


def judge_node_that_came_back(frames):
    bootups = times_of(frames, 0x706, b"\0")
    resets = [f[0] for f in frames if f[1] == 0 and f[2] == bytes((0x81, 6))]
    check(len(resets) >= 1 and len(bootups) >= 2, f"node 6 was reset from outside and booted again")
    if not resets:
        return
    at = resets[-1]
    starts = [f[0] for f in frames if f[1] == 0 and f[2][0] == 1 and f[2][1] in (0, 6) and f[0] > at]
    check(bool(starts), "node 6 was started again")
    back = [t for t in times_of(frames, 0x186) if starts and t > starts[0]]
    check(len(back) > 20, f"node 6 sends its TPDO again ({len(back)})")
    others = [t for t in times_of(frames, 0x185) if at <= t <= (back[0] if back else at + 2)]
    gaps = [b - a for a, b in zip(others, others[1:])]
    check(bool(gaps) and statistics.median(gaps) < 1.5 * PERIOD, "node 5 kept cycling meanwhile")


def main(binaries):
    binaries = pathlib.Path(binaries)
    with tempfile.TemporaryDirectory() as folder:
        log, events = pathlib.Path(folder) / "bus.log", pathlib.Path(folder) / "events.jsonl"
        with open(log, "w") as out:
            candump = subprocess.Popen(["candump", "-L", "-r", "8000000", "vcan0"], stdout=out)
        simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
        time.sleep(0.5)
        taktd = subprocess.Popen([binaries / "taktd", NETWORK, "--for", "12s", "--events", events])
        time.sleep(6)
        subprocess.run(["cansend", "vcan0", "000#8106"], check=True)
        check(taktd.wait(timeout=180) == 0, f"taktd ended with exit code {taktd.returncode}")
        time.sleep(0.2)
        for process in (simulation, candump):
            process.terminate()
            process.wait()
        kinds = [json.loads(line)["kind"] for line in events.read_text().splitlines()]
        told = dict(collections.Counter(kinds))
        check(told.get("boot_done") == len(NODES) + 1, f"three boots: {told}")
        check("foreign_nmt" in kinds, "the reset from outside was told as a foreign NMT command")
        frames = read_log(log)
        judge_sync(frames)
        judge_node_that_came_back(frames)
        starts = [f[0] for f in frames if f[1] == 0 and f[2][0] == 1]
        ends = [f[0] for f in frames if f[1] == 0 and f[2][0] in (2, 128) and f[0] > starts[-1]]
        check(bool(ends), "the nodes were taken out of OPERATIONAL")
        check(times_of(frames, 0x080)[-1] < ends[-1] + 1 if ends else False, "and SYNC ended with that")
        read = subprocess.run([binaries / "takt", "dump", NETWORK, log], capture_output=True, text=True)
        strange = [line for line in read.stdout.splitlines() if " ?  " in line or "unknown" in line]
        check(read.returncode == 0 and not strange, f"takt dump reads every frame: {strange[:3]}")
        judge_dissector(check, log, 2000)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
