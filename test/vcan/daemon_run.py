"""What the judges of a running taktd share: its events, a recording of vcan0, the programs they started."""
import json
import pathlib
import signal
import subprocess
import tempfile
import time

from dissector import judge_dissector

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NMT, SYNC = 0x000, 0x080
PATIENCE = 180  # s; an event that has not come within this time counts as missing
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)
    return good


def verdict():
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


def soon(condition):
    until = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > until:
            return False
        time.sleep(0.2)
    return True


class Frame:
    """A line of a candump log; `number` is its place in the recording."""

    def __init__(self, number, line):
        stamp, _, text = line.split()[:3]
        identifier, self.payload = text.split("#")
        self.number, self.time = number, float(stamp.strip("()"))
        self.identifier, self.extended = int(identifier, 16), len(identifier) == 8
        self.remote = self.payload.startswith("R")
        self.data = b"" if self.remote else bytes.fromhex(self.payload)

    def standard(self, identifier):
        return self.identifier == identifier and not self.extended and not self.remote


class DaemonRun:
    """taktd, simulated nodes and candump on vcan0. Whatever is left of them ends with the `with`."""

    def __init__(self, binaries, network):
        self.binaries, self.network = pathlib.Path(binaries), network
        self.started, self.recorded, self.read_to = [], [], 0

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.log = pathlib.Path(self.folder.name) / "bus.log"
        self.event_file = pathlib.Path(self.folder.name) / "events.jsonl"
        self.event_file.touch()
        with open(self.log, "w") as out:
            self.candump = self.start(["candump", "-D", "-L", "-r", "8000000", "vcan0"], stdout=out)
        time.sleep(0.5)  # candump listens; it has no way to tell
        return self

    def __exit__(self, *_):
        for process in self.started:
            process.kill()
            process.wait()
        self.folder.cleanup()

    def start(self, command, **options):
        self.started.append(subprocess.Popen(command, **options))
        return self.started[-1]

    def start_nodes(self, *only):
        chosen = [word for name in only for word in ("--only", name)]
        return self.start([self.binaries / "takt", "sim", self.network, "--bus", "vcan0", *chosen])

    def start_taktd(self):
        self.taktd = self.start([self.binaries / "taktd", self.network, "--events", self.event_file])

    def stop_taktd(self):
        """Sends SIGTERM. The ordered stop must end with exit code 0."""
        self.taktd.send_signal(signal.SIGTERM)
        try:
            code = self.taktd.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            code = "none: it hangs"
        check(code == 0, f"taktd ended with exit code {code}")

    def dissect(self, least, **known):
        """Ends the recording and gives it to Wireshark's dissector."""
        self.candump.terminate()
        self.candump.wait()
        judge_dissector(check, self.log, least, **known)

    def events(self, kind, node=None):
        lines = self.event_file.read_text().split("\n")[:-1]
        told = [json.loads(line) for line in lines]
        return [event for event in told if event["kind"] == kind and node in (None, event["node"])]

    def await_event(self, kind, node=None, count=1):
        """Waits for the `count`th such event. Returns False if taktd has ended, or after the time limit."""
        soon(lambda: len(self.events(kind, node)) >= count or self.taktd.poll() is not None)
        good = len(self.events(kind, node)) >= count
        return check(good, f"{kind}{f' of node {node}' if node else ''} is told, number {count}")

    def frames(self):
        """All that candump has recorded so far."""
        with open(self.log) as log:
            log.seek(self.read_to)
            while (line := log.readline()).endswith("\n"):
                self.recorded.append(Frame(len(self.recorded), line))
                self.read_to += len(line)
        return self.recorded

    def place(self):
        """The number that the next frame will have."""
        return len(self.frames())

    def count(self, identifier, begin, end=None):
        return sum(frame.standard(identifier) for frame in self.frames()[begin:end])

    def await_frames(self, identifier, count, begin):
        """Waits until `count` frames with this identifier have come from `begin` on. Returns False if taktd has ended,
        or if the frames do not come."""
        soon(lambda: self.count(identifier, begin) >= count or self.taktd.poll() is not None)
        return self.count(identifier, begin) >= count
