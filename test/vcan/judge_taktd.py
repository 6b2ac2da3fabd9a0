#!/usr/bin/env python3
"""judge_taktd.py BIN: taktd on vcan0 against devices made with python-canopen.

The devices, the LCM binding, candump and the dissector of this test are not from this project.
Runs inside with-vcan, with the interpreter of the judges' environment. Exit code 1: a check failed.
"""
import collections
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from dissector import judge_dissector, recording

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
NODES = (5, 6)
PERIOD = 0.010
SYNC_WINDOW = 0.005  # s; taktd reports TPDOs that come later
TPDOS, RPDOS = {0x185, 0x186}, {0x205, 0x206}
SYNC, NMT = 0x080, 0x000
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def next_controlword(statusword):
    """The word that brings a CiA 402 drive one step nearer to Operation enabled."""
    if statusword & 0x6F == 0x07:  # Quick stop active: the fallback, where this program was late
        return 0x00
    if statusword & 0x4F == 0x40:
        return 0x06
    return 0x07 if statusword & 0x6F == 0x21 else 0x0F


class Application:
    """Enables both axes over LCM and moves them along a ramp, one step an image."""

    def __init__(self, folder):
        subprocess.run(["lcm-gen", "--python", "--ppath", folder, *map(str, (ROOT / "share/lcm").glob("*.lcm"))], check=True)
        sys.path.insert(0, folder)
        import lcm
        import takt
        self.takt, self.bus = takt, lcm.LCM()
        self.layout, self.images, self.targets, self.positions = None, 0, {}, {}
        self.bus.subscribe("JUDGE_LAYOUT", self.on_layout)
        self.bus.subscribe("JUDGE_IMAGE", self.on_image)

    def on_layout(self, _, data):
        layout = self.takt.layout_t.decode(data)
        self.layout = {(s.node_id, s.index, s.output): layout.first_signal + i for i, s in enumerate(layout.signals)}

    def on_image(self, _, data):
        image = self.takt.image_t.decode(data)
        self.images += 1
        if self.layout is None:
            return
        command = self.takt.command_t()
        command.schema, command.session, command.sender, command.cycle = 2, image.session, "judge", image.cycle
        command.instance = 1
        command.time_to_live = 20
        for node in NODES:
            at = {index: self.layout[node, index, False] for index in (0x6041, 0x6064)}
            statusword, position = image.values[at[0x6041]], image.values[at[0x6064]]
            self.positions[node] = position
            if statusword & 0x6F == 0x27 and self.targets.get(node, 0) < 5000:
                self.targets[node] = self.targets.get(node, position) + 50
            word, target = next_controlword(statusword), self.targets.get(node, position)
            command.signals += [self.layout[node, 0x6040, True], self.layout[node, 0x607A, True]]
            command.values += [word, target]
        command.num_values = len(command.signals)
        self.bus.publish("JUDGE_COMMAND", command.encode())

    def there(self):
        return all(self.positions.get(node, 0) >= 5000 for node in NODES)

    def run_while(self, process):
        """Ends the daemon when the axes have arrived and have been watched for a while."""
        enough = None
        while process.poll() is None:
            self.bus.handle_timeout(50)
            if enough is None and self.there():
                enough = self.images + 300
            if self.images == enough:
                process.terminate()
                enough = 0  # once: a second signal would end it without the ordered stop


def read_log(path):
    """[(time, identifier, payload)] of a candump log."""
    frames = []
    for line in path.read_text().splitlines():
        stamp, _, text = line.split()[:3]
        identifier, payload = text.split("#")
        frames.append((float(stamp.strip("()")), int(identifier, 16), bytes.fromhex(payload)))
    return frames


def judge_boot(frames):
    for node in NODES:
        requests = [f for f in frames if f[1] == 0x600 + node]
        check(len(requests) > 10, f"node {node} was configured by SDO ({len(requests)} requests)")
        pending, refused = None, []
        for _, identifier, payload in frames:
            if identifier == 0x600 + node:
                pending = payload
            elif identifier == 0x580 + node and payload[0] == 0x80 and pending and pending[0] >> 5 == 1:
                refused.append(pending.hex())
        check(not refused, f"node {node} refused no download {refused}")
        starts = [f for f in frames if f[1] == NMT and f[2][0] == 1 and f[2][1] in (0, node)]
        check(bool(starts), f"node {node} was started")
    syncs = [f[0] for f in frames if f[1] == SYNC]
    starts = [f[0] for f in frames if f[1] == NMT and f[2][0] == 1]
    check(bool(syncs and starts) and syncs[0] < starts[0], "SYNC beats before the first NMT start")


def judge_cycles(frames):
    syncs = [f[0] for f in frames if f[1] == SYNC]
    steps = [b - a for a, b in zip(syncs, syncs[1:])]
    median = statistics.median(steps)
    check(abs(median - PERIOD) < 0.0005, f"median SYNC period {median * 1e3:.3f} ms of {len(syncs)}")
    mean = (syncs[-1] - syncs[0]) / round((syncs[-1] - syncs[0]) / PERIOD)
    check(abs(mean - PERIOD) < 20e-6, f"SYNC does not drift: mean period {mean * 1e3:.4f} ms")
    judge_order(frames)


def judge_order(frames):
    """Python's devices may answer late, so the test judges the master only in cycles in which they answered in time."""
    cycles, sync = [], None
    for when, identifier, _ in frames:
        if identifier == SYNC:
            sync = when
            cycles.append([])
        elif identifier in TPDOS | RPDOS and cycles:
            cycles[-1].append((when - sync, identifier))
    full = [cycle for cycle in cycles if len(cycle) == 4]
    punctual = [c for c in full if all(at < SYNC_WINDOW for at, identifier in c if identifier in TPDOS)]
    check(len(full) > 200, f"{len(full)} cycles with all four PDOs")
    check(len(punctual) > 100, f"{len(punctual)} of them with punctual TPDOs")
    order = [[identifier for _, identifier in cycle] for cycle in punctual]
    good = [ids for ids in order if set(ids[:2]) == TPDOS and set(ids[2:]) == RPDOS]
    check(len(good) >= 0.98 * len(punctual), f"{len(good)} of those: TPDOs after SYNC, RPDOs before the next")


def judge_dump(binaries, log, frames):
    dump = subprocess.run([pathlib.Path(binaries) / "takt", "dump", HERE / "python_axes.yaml", log], capture_output=True, text=True)
    lines = dump.stdout.splitlines()
    strange = [line for line in lines if "  ?  " in line or "unknown" in line]
    check(dump.returncode == 0 and len(lines) == len(frames) and not strange, f"takt dump reads every frame: {strange[:3]}")
    check(sum("EMCY" in line and "4210 device temperature too high" in line for line in lines) == len(NODES), "EMCYs too")


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log, events = pathlib.Path(folder) / "bus.log", pathlib.Path(folder) / "events.jsonl"
        application = Application(folder)
        eds = ROOT / "share/eds/takt_drive402.eds"
        with recording(log):
            nodes = subprocess.Popen([sys.executable, HERE / "python_nodes.py", "vcan0", eds, *map(str, NODES)],
                                     stdout=subprocess.PIPE, text=True)
            nodes.stdout.readline()
            taktd = subprocess.Popen([pathlib.Path(binaries) / "taktd", HERE / "python_axes.yaml", "--for", "60s", "--events", events])
            application.run_while(taktd)
            time.sleep(0.2)
            nodes.terminate()
            nodes.wait()
        check(taktd.returncode == 0, f"taktd ended with exit code {taktd.returncode}")
        lines = [json.loads(line) for line in events.read_text().splitlines()]
        told = dict(collections.Counter(line["kind"] for line in lines))
        check(told.get("boot_done") == len(NODES), f"each node booted once: {told}")
        emcys = [line["text"] for line in lines if line["kind"] == "emcy"]
        hot = [text for text in emcys if "0x4210: device temperature too high" in text and "10 42 08 01 02 00 00 00" in text]
        check(len(hot) == len(NODES) and len(emcys) == 2 * len(NODES), f"each node's EMCY and its end are told: {emcys}")
        frames = read_log(log)
        judge_dump(binaries, log, frames)
        judge_boot(frames)
        judge_cycles(frames)
        judge_dissector(check, log, 1000)
        check(application.images > 400, f"LCM's Python binding decoded {application.images} images")
        moved = {n: application.positions.get(n, 0) for n in NODES}
        check(all(position >= 5000 for position in moved.values()), f"the axes followed: {moved}")
        words = {n: [f[2][0] | f[2][1] << 8 for f in frames if f[1] == 0x200 + n] for n in NODES}
        check(all(w and not w[-1] & 0x08 for w in words.values()), "the last controlwords do not enable operation")
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
