#!/usr/bin/env python3
"""memory_test.py BIN: a taktd with sixteen nodes has at most 10 MB of private memory, even if its memory is locked."""
import pathlib
import re
import subprocess
import sys
import tempfile

from running_daemon import ROOT, await_text

LIMIT_KB = 10_000


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        log = pathlib.Path(name) / "log"
        command = [f"{binaries}/taktd", ROOT / "share/demo/sixteen_nodes.yaml", "--bus", "sim", "--lcm-url", "memq://"]
        with log.open("w") as out:
            daemon = subprocess.Popen(command, stdout=out, stderr=out)
        try:
            await_text(log, "the network is ready", daemon)
            locked = "memory locked" in log.read_text()
            status = pathlib.Path(f"/proc/{daemon.pid}/status").read_text()
        finally:
            daemon.kill()
            daemon.wait()
    private = int(re.search(r"RssAnon:\s+(\d+) kB", status)[1])
    print(f"taktd has {private} kB of private memory, at most {LIMIT_KB} are permitted; memory locked: {locked}")
    return private > LIMIT_KB


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
