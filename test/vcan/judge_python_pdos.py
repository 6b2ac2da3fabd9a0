#!/usr/bin/env python3
"""judge_python_pdos.py BIN: taktd and a device whose PDOs python-canopen sends and receives, on vcan0.

TPDOs of type 5, of type 255 as an event and by its event timer; RPDOs of type 5 and 255. The device leaves out some
TPDOs. The frames that candump has recorded determine the expected image and counts of taktd.
Runs inside with-vcan, with the interpreter of the judges' environment. Exit code 1: a check failed.
"""
import itertools
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import canopen

from dissector import judge_dissector, recording
from judge_taktd import ROOT, check, failures, read_log
from python_pdos import START, Device

HERE = pathlib.Path(__file__).resolve().parent
NETWORK, NODE, N = HERE / "python_pdo_types.yaml", 7, 5
SYNC, NMT = 0x080, 0x000
IMAGES = 240
LEFT_OUT = (12, 20, 21)  # of the times that TPDO1 is due
PAUSE = (150, 0.6)  # SYNCs, s: TPDO3 rests
STAYED_AWAY = {1: len(LEFT_OUT), 2: 0, 3: 1}  # by number
INPUTS = {"position": 0x6064, "velocity": 0x606C, "count": 0x60FD}


class Application:
    """Sends new set-points with each image. Keeps the received values and the newest state of the PDOs."""

    def __init__(self, folder):
        subprocess.run(["lcm-gen", "--python", "--ppath", folder, *map(str, (ROOT / "share/lcm").glob("*.lcm"))], check=True)
        sys.path.insert(0, folder)
        import lcm
        import takt
        self.takt, self.bus = takt, lcm.LCM()
        self.layout, self.images, self.told_at, self.pdos = None, 0, 0, {}
        self.stopped_at = float("inf")  # wall clock of the order to stop
        self.seen = {name: [] for name in INPUTS}
        for channel, taker in (("LAYOUT", self.on_layout), ("IMAGE", self.on_image), ("PDOS", self.on_pdos)):
            self.bus.subscribe("JUDGE_" + channel, taker)

    def on_layout(self, _, data):
        layout = self.takt.layout_t.decode(data)
        self.layout = {s.index: layout.first_signal + i for i, s in enumerate(layout.signals)}

    def on_pdos(self, _, data):
        if self.stopped_at != float("inf"):
            return  # the ordered stop takes the device out of OPERATIONAL
        status = self.takt.pdo_status_t.decode(data)
        self.told_at, self.pdos = status.utime / 1e6, {(pdo.output, pdo.number): pdo for pdo in status.pdos}

    def on_image(self, _, data):
        image = self.takt.image_t.decode(data)
        if self.layout is None:
            return
        self.images += 1
        for name, index in INPUTS.items():
            self.seen[name].append(image.values[self.layout[index]])
        command = self.takt.command_t()
        command.schema, command.session, command.sender, command.cycle = 2, image.session, "judge", image.cycle
        command.instance = 1
        command.time_to_live = 40
        if self.images <= IMAGES:
            command.signals = [self.layout[0x60FF], self.layout[0x607A]]
            command.values = [1000 + self.images // 2, -1000 - self.images]
            command.num_values = 2
            self.bus.publish("JUDGE_COMMAND", command.encode())

    def run_while(self, process):
        until = time.monotonic() + 180
        while process.poll() is None:
            self.bus.handle_timeout(50)
            if self.stopped_at == float("inf") and (self.images >= IMAGES + 30 or time.monotonic() > until):
                self.stopped_at = time.time()
                process.terminate()


def numbers(frames, identifier):
    return [(when, int.from_bytes(data, "little", signed=True)) for when, can_id, data in frames if can_id == identifier]


def operational(frames):
    """The frames from the NMT start of the node to the next NMT command other than start."""
    begin = next(i for i, f in enumerate(frames) if f[1] == NMT and f[2][0] == START)
    ends = [i for i, f in enumerate(frames) if i > begin and f[1] == NMT and f[2][0] != START]
    return frames[begin:ends[0] if ends else len(frames)]


def due(frames, identifier, left_out=()):
    """[(number of the time at which the PDO was due, from 1; time at which it came; value)]"""
    times = (k for k in itertools.count(1) if k not in left_out)
    return [(k, when, value) for k, (when, value) in zip(times, numbers(frames, identifier))]


def in_order(seen, sent):
    """Every value of `seen` is in `sent`, and no value comes before the one that precedes it there."""
    rest = iter(sent)
    return all(value in rest for value in seen)


def without_repeats(values):
    return [value for i, value in enumerate(values) if i == 0 or value != values[i - 1]]


def judge_each_nth(frames, cob_ids):
    """Both directions of type 5, and the values that the device has taken from its RPDO."""
    syncs = [f[0] for f in frames if f[1] == SYNC]
    inputs, outputs = due(frames, cob_ids[False, 1], LEFT_OUT), due(frames, cob_ids[True, 2])
    for name, found in (("TPDO1", inputs), ("RPDO2", outputs)):
        places = [sum(sync < when for sync in syncs) - k * N for k, when, _ in found]
        steps = [N + b - a for a, b in zip(places, places[1:])]
        check(len(found) >= 30, f"{len(found)} frames of {name}")
        check(sum(step == N for step in steps) >= 0.9 * len(steps), f"{name} of type {N}: each {N} SYNCs: {sorted(set(steps))}")
    orders = numbers(frames, cob_ids[True, 2])
    wrong = []
    for k, when, value in inputs:
        sync = syncs[k * N - 1] if k * N <= len(syncs) else when
        valid = [order for sent, order in orders if sent < sync]
        if value != (valid[-1] if valid else 0):
            wrong.append((when, value, valid[-1:]))
    check(not wrong, f"it has the set-point that was valid with its SYNC: {wrong[:3]}")


def judge_events(frames, cob_ids):
    orders, answers = numbers(frames, cob_ids[True, 1]), numbers(frames, cob_ids[False, 2])
    check(len(orders) >= 100, f"{len(orders)} frames of RPDO1")
    check([v for _, v in answers] == [v for _, v in orders][:len(answers)] and len(orders) - len(answers) <= 1,
          f"RPDO1 of type 255 acts at once: each has its TPDO2: {len(answers)}")
    syncs = [f[0] for f in frames if f[1] == SYNC]
    quick = [not any(sent < sync < answer for sync in syncs) for (sent, _), (answer, _) in zip(orders, answers)]
    check(sum(quick) >= 0.5 * len(orders), f"{sum(quick)} of {len(orders)} before the next SYNC")


def judge_timer(frames, cob_ids):
    times = [when for when, _ in numbers(frames, cob_ids[False, 3])]
    check(len(times) >= 60, f"{len(times)} frames of TPDO3")
    period = statistics.median(b - a for a, b in zip(times, times[1:]))
    check(abs(period - 0.1) < 0.01, f"python-canopen repeats TPDO3 each {period * 1e3:.1f} ms")


def tardy(frames, cob_ids, key):
    """How often python-canopen, on a busy machine, has sent a TPDO too late. The intended pause does not count."""
    if key[1] == 1:
        syncs = [f[0] for f in frames if f[1] == SYNC]
        return sum(when - syncs[k * N - 1] > 0.020 for k, when, _ in due(frames, cob_ids[key], LEFT_OUT) if k * N <= len(syncs))
    times = [when for when, _ in numbers(frames, cob_ids[key])]
    return sum(b - a > 0.150 for a, b in zip(times, times[1:])) - STAYED_AWAY[3] if key[1] == 3 else 0


def judge_image(frames, application, cob_ids):
    pairs = (("position", (False, 1)), ("velocity", (False, 2)), ("count", (False, 3)))
    for name, key in pairs:
        seen = without_repeats(application.seen[name])
        sent = [0] + [value for _, value in numbers(frames, cob_ids[key])]
        check(len(set(seen)) >= 30 and in_order(seen, without_repeats(sent)), f"the image has {len(set(seen))} values of {name}")
        pdo = application.pdos[key]
        there = sum(when < application.told_at for when, _ in numbers(frames, cob_ids[key]))
        check(abs(there - pdo.count) <= 2, f"TPDO{key[1]}: {pdo.count} counted, {there} on the bus until then")
        late = tardy(frames, cob_ids, key)
        left = STAYED_AWAY[key[1]]
        check(left <= pdo.missing <= left + late, f"TPDO{key[1]}: {pdo.missing} missing, {left} left out, python was late {late} times")
        check(pdo.too_short == pdo.too_long == 0 and (late or not pdo.stale), f"TPDO{key[1]}: none of wrong length, not stale")


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log, events = pathlib.Path(folder) / "bus.log", pathlib.Path(folder) / "events.jsonl"
        application = Application(folder)
        with recording(log):
            network = canopen.Network()
            network.connect(interface="socketcan", channel="vcan0")
            device = Device(network, str(ROOT / "share/eds/takt_drive402.eds"), NODE, LEFT_OUT, PAUSE)
            taktd = subprocess.Popen([pathlib.Path(binaries) / "taktd", NETWORK, "--for", "90s", "--events", events])
            application.run_while(taktd)
            time.sleep(0.2)
            device.node.tpdo.stop()
            network.disconnect()
        check(taktd.returncode == 0, f"taktd ended with exit code {taktd.returncode}")
        told = [json.loads(line) for line in events.read_text().splitlines()]
        kinds = [event["kind"] for event in told]
        check(kinds.count("boot_done") == 1, f"the device booted once: {sorted(set(kinds))}")
        begun = [event["text"] for event in told if event["kind"] == "pdo_missing"]
        check(sum("TPDO1" in text for text in begun) >= 2 and any("TPDO3" in text for text in begun),
              f"what is missing is told when it begins: {begun}")
        frames = operational(read_log(log))
        cob_ids = {key: pdo.cob_id for key, pdo in application.pdos.items()}
        check(sorted(cob_ids) == [(False, 1), (False, 2), (False, 3), (True, 1), (True, 2)], f"taktd tells its PDOs: {cob_ids}")
        # The ordered stop sends every RPDO in each cycle.
        judge_each_nth([frame for frame in frames if frame[0] < application.stopped_at], cob_ids)
        for judge in (judge_events, judge_timer):
            judge(frames, cob_ids)
        judge_image(frames, application, cob_ids)
        judge_dissector(check, log, 500)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
