#!/usr/bin/env python3
"""black_box_test.py BIN: a node dies under taktd --black-box. The recording replays, but not with a changed log."""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile

from running_daemon import PATIENCE, ROOT, await_true, free_port

NETWORK = f"""
bus: {{name: box}}
lcm: {{url: "tcpq://127.0.0.1:PORT", broker: true}}
black_box: {{folder: box, keep: 10}}
realtime: {{mode: off, spin_us: 0}}
master: {{node_id: 127, sync_period: 20000}}
nodes:
  io:
    node_id: 10
    dcf: {ROOT}/share/eds/takt_io401.eds
    heartbeat_producer: 100
"""


def recordings_with(box, words):
    """The recordings that name `words` as their reason or in an event. Faults of a busy machine may be recorded as well."""
    files = sorted(box.glob("*.events.json"))
    return [file for file in files if words in file.read_text()]


def replay(binaries, file, *more):
    return subprocess.run([f"{binaries}/takt", "replay", file, *more], capture_output=True, text=True)


def demand(condition, what, result):
    if not condition:
        sys.exit(f"{what}: exit {result.returncode}\n{result.stdout}{result.stderr}")


def record(binaries, folder, network, url):
    bus, events, box = f"unix:{folder}/bus", folder / "events", folder / "box"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    daemon = subprocess.Popen([f"{binaries}/taktd", network, "--bus", bus, "--events", events], **quiet)
    await_true("bus", (folder / "bus").exists)  # of the daemon: it outlives the node
    node = subprocess.Popen([f"{binaries}/takt", "sim", network, "--bus", bus], **quiet)
    try:
        await_true("boot", lambda: events.exists() and "boot_done" in events.read_text())
        node.kill()
        node.wait()
        await_true("recording of the fault", lambda: recordings_with(box, "heartbeat lost"))
        daemon.send_signal(signal.SIGUSR1)
        await_true("recording on request", lambda: recordings_with(box, "requested by SIGUSR1"))
        asked = subprocess.run([f"{binaries}/takt", "record", "--lcm-url", url], capture_output=True, text=True, timeout=PATIENCE)
        named = pathlib.Path(asked.stdout.strip())
        demand(asked.returncode == 0 and named.exists() and named.parent == box, "takt record names the file", asked)
        if '"recorded"' not in events.read_text():
            sys.exit("recordings are no events")
        # Both signals are pending when taktd continues. It has to stop at once, and still writes its recording.
        daemon.send_signal(signal.SIGSTOP)
        daemon.send_signal(signal.SIGTERM)
        daemon.send_signal(signal.SIGINT)
        daemon.send_signal(signal.SIGCONT)
        if daemon.wait(PATIENCE) == 0 or not recordings_with(box, "the ordered stop did not end"):
            sys.exit(f"two signals: exit {daemon.returncode}, {sorted(box.iterdir())}")
    finally:
        node.kill()
        daemon.kill()
    return [pathlib.Path(str(recordings_with(box, words)[0]).replace(".events.json", ".log"))
            for words in ("heartbeat lost", "the ordered stop did not end")]


def check_foreign_texts(binaries, folder, log):
    """A recording of somebody else may contain anything. None of its control characters may be printed."""
    strange = "\x1b[31m\x07\x7f\x9b"  # ESC, BEL, DEL, CSI of C1
    events_file = log.with_suffix(".events.json")
    original = events_file.read_text()
    network = folder / f"{strange}.yaml"
    network.write_text((folder / "net.yaml").read_text().replace("period: 20000", "period: 10000"))
    for network_name in (str(network), f"missing{strange}.yaml"):
        events = json.loads(original)
        events["network"] = network_name
        for key in ("bus", "interface", "reason"):
            events[key] = key + strange
        for event in events["events"]:
            event["text"] += strange
        events_file.write_text(json.dumps(events))
        done = subprocess.run([f"{binaries}/takt", "replay", log], capture_output=True)
        told = (done.stdout + done.stderr).decode()
        if "[31m" not in told:
            sys.exit(f"replay quotes nothing of the recording: {told}")
        if any(c in told for c in "\x1b\x07\x7f\x9b"):
            sys.exit(f"replay prints control characters: {told!r}")
    events_file.write_text(original)


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        network = folder / "net.yaml"
        port = str(free_port())
        network.write_text(NETWORK.replace("PORT", port))
        first, last_one = record(binaries, folder, network, f"tcpq://127.0.0.1:{port}")
        last = replay(binaries, last_one, "--quiet")
        demand(last.returncode == 0 and "the ordered stop did not end" in last.stdout, "the end replays", last)

        good = replay(binaries, first)
        demand(good.returncode == 0 and "heartbeat" in good.stdout, "the same decisions", good)
        events = json.loads(first.with_suffix(".events.json").read_text())
        wanted = f"{len(events['events'])} of {len(events['events'])} decisions as recorded"
        demand(wanted in good.stdout, wanted, good)

        dump = subprocess.run([f"{binaries}/takt", "dump", network, first], capture_output=True, text=True)
        demand(dump.returncode == 0 and dump.stdout.count("\n") == events["frames"], "takt dump reads the log", dump)

        check_foreign_texts(binaries, folder, first)

        text = first.read_text()
        vendor = " 58A#43181001CDAB0000"
        demand(vendor in text, "the log has the vendor id", good)
        first.write_text(text.replace(vendor, " 58A#43181001CEAB0000"))
        changed = replay(binaries, first, "--quiet")
        demand(changed.returncode == 1, "a changed log differs", changed)
        demand("first difference: cycle " in changed.stdout and "vendor id" in changed.stdout, "named", changed)

        first.write_text(text[:1000])
        cut = replay(binaries, first)
        demand(cut.returncode == 2 and ".log" in cut.stderr, "a log that was cut is refused", cut)
        none = replay(binaries, folder / "none.log")
        demand(none.returncode == 2 and "none.events.json: cannot be read" in none.stderr, "no file", none)


if __name__ == "__main__":
    main(sys.argv[1])
