#!/usr/bin/env python3
"""log_test.py BIN: `takt log` beside a taktd with simulated devices: CSV and MCAP, the end by --for, by a signal and by the end of
taktd, and wrong arguments."""
import csv
import io
import json
import pathlib
import re
import signal
import sys
import tempfile
import time

from mcap.reader import make_reader

from running_daemon import NETWORK, PATIENCE, Bus, await_text, check, failures


def table(text):
    rows = list(csv.reader(io.StringIO(text)))
    return rows[0], [row for row in rows[1:] if any(row[3:-1])]


def told_lost(told):
    found = re.search(r" (\d+) cycles? missing in ", told)
    return int(found[1]) if found else 0


def begin_log(bus, *words):
    """Returns when it records."""
    process = bus.start("takt", "log", *words)
    await_text(bus.log_of("takt"), "recording", process)
    return process, bus.log_of("takt")


def as_csv(bus):
    done = bus.takt("log", "shoulder.*", "-o", "-", "--for", "2s")
    check("takt log -o - ends with 0", done.returncode == 0, done.stderr)
    head, rows = table(done.stdout)
    check("only this node is in the table", len(head) > 5 and all(name.startswith("shoulder.") for name in head[3:-1]), head)
    cycles = [int(row[2]) for row in rows]
    check("the cycles rise", all(a < b for a, b in zip(cycles, cycles[1:])))
    lost = sum(b - a - 1 for a, b in zip(cycles, cycles[1:]))
    check("each missing cycle is told", lost == told_lost(done.stderr), (lost, done.stderr))
    check("the log is 2 s long", abs(float(rows[-1][0]) - 2.0) < 0.3, rows[-1])
    check("stderr has the statistics", f"takt: stdout: {len(rows)} cycles in " in done.stderr and "ended by --for" in done.stderr, done.stderr)


def until_a_signal(bus):
    path = bus.folder / "run.csv"
    process, said = begin_log(bus, "*.statusword", "-o", path)
    time.sleep(1)
    check("an unfinished log has another name", not path.exists() and (bus.folder / ".part-run.csv").exists())
    process.send_signal(signal.SIGINT)
    check("Ctrl-C ends it with 0", process.wait(PATIENCE) == 0, said.read_text())
    head, rows = table(path.read_text())
    check("all that came is in the file", len(rows) > 10 and head[3:-1] == ["shoulder.statusword", "elbow.statusword"], head)
    check("the reason is told", "ended by a signal" in said.read_text(), said.read_text())


def wrong_use(bus):
    def says(words, code, *parts):
        done = bus.takt("log", *words)
        missing = [part for part in parts if part not in done.stderr]
        check(f"takt log {' '.join(map(str, words))}", done.returncode == code and not missing, f"{done.returncode}, no {missing}: {done.stderr}")
    csv_file = bus.folder / "wrong.csv"
    says(["sholder.*", "-o", csv_file], 2, "did you mean `shoulder.*`?")
    says(["shoulder.statuswrd", "-o", csv_file], 2, "did you mean `shoulder.statusword`?")
    says(["shoulder", "-o", csv_file], 2, "did you mean `shoulder.*`")
    says(["-o", bus.folder / "wrong.txt"], 2, "has to end in .csv or .mcap")
    says(["-o", bus.folder / "none/wrong.csv"], 2, "can't be written: No such file or directory")
    says(["-o", csv_file, "--bus", "lift"], 2, "there is no bus 'lift'")
    says(["-o", csv_file, "--network", NETWORK], 2, "--from")
    says(["-o", "/dev/full"], 2, "has to end in")
    check("nothing is left of them", not list(bus.folder.glob("*wrong*")), list(bus.folder.iterdir()))


def until_the_daemon_ends(bus):
    path = bus.folder / "run.mcap"
    process, said = begin_log(bus, "-o", path)
    time.sleep(1)
    bus.end_daemon()
    check("the end of taktd ends the log with 0", process.wait(PATIENCE) == 0, said.read_text())
    check("the reason is told", "ended because taktd has ended" in said.read_text(), said.read_text())
    with open(path, "rb") as file:
        found = [(channel.topic, message.log_time, json.loads(message.data)) for _, channel, message in
                 make_reader(file, validate_crcs=True).iter_messages()]
    images = [message for topic, _, message in found if topic == "/demo/image"]
    events = [message for topic, _, message in found if topic == "/demo/event" and message["file"] != "gap"]
    check("images and events have come", len(images) > 100 and len(events) > 0, (len(images), len(events)))
    check("they are on one time axis", abs(found[0][1] - found[-1][1]) < PATIENCE * 10**9 and found[0][1] > 0, found[0])
    check("all nodes are in the images", {"cycle", "shoulder", "elbow", "io"} == set(images[-1]), images[-1])


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        bus = Bus(binaries, folder)
        done = bus.takt("log", "-o", pathlib.Path(folder) / "none.csv")
        check("without a daemon the log says so", done.returncode == 3 and "Is taktd running?" in done.stderr, done.stderr)
        bus.start_daemon()
        try:
            as_csv(bus)
            until_a_signal(bus)
            wrong_use(bus)
            until_the_daemon_ends(bus)
        finally:
            bus.end_daemon()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
