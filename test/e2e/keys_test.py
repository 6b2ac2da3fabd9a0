#!/usr/bin/env python3
"""keys_test.py BIN: with `keys`, taktd accepts requests only from programs with a key. The key file may change meanwhile."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from running_daemon import PATIENCE, ROOT, await_true

NETWORK = f"""
bus: {{name: keyed}}
lcm: {{url: "tcpq://127.0.0.1:0", broker: true, keys: bus.keys, authenticate: images}}
realtime: {{mode: off, spin_us: 0}}
master: {{node_id: 127, sync_period: 20000}}
nodes:
  io:
    node_id: 10
    dcf: {ROOT}/share/eds/takt_io401.eds
"""


def takt(binaries, *arguments):
    return subprocess.run([f"{binaries}/takt", *arguments], capture_output=True, text=True, timeout=PATIENCE)


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        network, keys, log = folder / "net.yaml", folder / "bus.keys", folder / "log"
        network.write_text(NETWORK)
        made = takt(binaries, "keys", "new", keys, "--name", "plant")
        assert made.returncode == 0, made.stderr
        assert takt(binaries, "keys", "check", keys).stdout == "plant\n"
        keys.chmod(0o640)
        refused = subprocess.run([f"{binaries}/taktd", network, "--bus", "sim"], capture_output=True, text=True, timeout=PATIENCE)
        assert refused.returncode == 2 and f"chmod 600 {keys}" in refused.stderr, refused
        checked = subprocess.run([f"{binaries}/taktd", network, "--check"], capture_output=True, text=True, timeout=PATIENCE)
        assert checked.returncode == 2 and f"chmod 600 {keys}" in checked.stderr, checked
        keys.chmod(0o600)
        checked = subprocess.run([f"{binaries}/taktd", network, "--check"], capture_output=True, text=True, timeout=PATIENCE)
        assert checked.returncode == 0, checked

        with log.open("w") as out:
            daemon = subprocess.Popen([f"{binaries}/taktd", network, "--bus", "sim"], stdout=out, stderr=out)
        try:
            await_true("a hub", lambda: re.search(r"LCM_DEFAULT_URL=(tcpq://\S+)", log.read_text()))
            url = re.search(r"LCM_DEFAULT_URL=(tcpq://\S+)", log.read_text())[1]
            read = ["sdo", "read", "io", "1000", "u32", "--lcm-url", url]
            await_true("an answer to who has the key", lambda: takt(binaries, *read, "--keys", keys).returncode == 0)
            for request in (read, ["sdo", "upload", "io", "1008", folder / "name", "--lcm-url", url],
                            ["nmt", "start", "io", "--lcm-url", url], ["record", "--lcm-url", url],
                            ["lss", "unconfigured", "--lcm-url", url], ["param", "read", "io", "P15.13", "--lcm-url", url]):
                unsigned = takt(binaries, *request)
                assert unsigned.returncode == 3, unsigned
                assert "accepts requests only from programs with a key" in unsigned.stderr, unsigned
            await_true("a word about it", lambda: "the message came without an envelope" in log.read_text())

            status = ["status", "--check-images", "--lcm-url", url]
            await_true("signed states", lambda: takt(binaries, *status, "--keys", keys).returncode == 0)
            stranger = folder / "stranger.keys"
            takt(binaries, "keys", "new", stranger, "--name", "plant")
            unknown = takt(binaries, *status, "--keys", stranger)
            assert unknown.returncode == 3 and "signed messages only" in unknown.stderr, unknown
            assert takt(binaries, *status).returncode == 2, "without a key nothing can be checked"

            mine = folder / "mine.keys"
            shutil.copy(keys, mine)
            replaced = folder / "next"
            takt(binaries, "keys", "new", replaced, "--name", "desk")
            replaced.rename(keys)
            await_true("new keys", lambda: takt(binaries, *read, "--keys", keys).returncode == 0)
            await_true("states signed anew", lambda: takt(binaries, *status, "--keys", keys).returncode == 0)
            old = takt(binaries, *read, "--keys", mine)
            assert old.returncode == 3 and "does it have this key" in old.stderr, old
        finally:
            daemon.kill()
            daemon.wait()
    print("only those with the key were answered")


if __name__ == "__main__":
    main(sys.argv[1])
