#!/usr/bin/env python3
"""mandatory_node_test.py BIN: a mandatory node that was ready, dies for longer than a boot takes and comes back."""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile

from running_daemon import PATIENCE, ROOT, await_true

NETWORK = f"""
bus: {{name: back}}
lcm: {{url: "memq://"}}
realtime: {{mode: off, spin_us: 0}}
master: {{node_id: 127, sync_period: 20000}}
nodes:
  io:
    node_id: 10
    dcf: {ROOT}/share/eds/takt_io401.eds
    mandatory: true
    boot_timeout_ms: 200
    reboot_delay_ms: 100
    heartbeat_producer: 100
"""


def heard(events, kind):
    if not events.exists():
        return 0
    return sum(json.loads(line)["kind"] == kind for line in events.read_text().splitlines())


def await_event(daemon, events, kind, count):
    await_true(f"{kind} number {count}", lambda: heard(events, kind) >= count, daemon)


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        network, events, bus = folder / "net.yaml", folder / "events", f"unix:{folder}/bus"
        network.write_text(NETWORK)
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        devices = [f"{binaries}/takt", "sim", network, "--bus", bus]
        node = subprocess.Popen(devices, **quiet)
        daemon = subprocess.Popen([f"{binaries}/taktd", network, "--bus", bus, "--events", events], **quiet)
        try:
            await_event(daemon, events, "boot_done", 1)
            node.kill()
            node.wait()
            await_event(daemon, events, "boot_failed", 1)
            node = subprocess.Popen(devices, **quiet)
            await_event(daemon, events, "boot_done", 2)
            daemon.send_signal(signal.SIGTERM)
            code = daemon.wait(PATIENCE)
        finally:
            node.kill()
            daemon.kill()
    print(f"it came back and was booted again; taktd ended with {code}")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
