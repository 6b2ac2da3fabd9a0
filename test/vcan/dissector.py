"""Checks the frames on vcan0 with Wireshark's CANopen dissector.

tshark is slow in user-mode-linux. So a judge that guest_tests.py has started leaves its recordings in a folder, and the
dissector reads them when the guest has ended.
"""
import collections
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from candump_to_pcap import frame_of, to_pcap

REMOTE = "Remote Transmission Request"


@contextlib.contextmanager
def recording(log):
    """Runs candump, which writes the frames on the bus to `log`."""
    with open(log, "w") as out:
        candump = subprocess.Popen(["candump", "-L", "-r", "8000000", "vcan0"], stdout=out)
        try:
            yield
        finally:
            candump.terminate()
            candump.wait()


def without(log, foreign, rest):
    """Writes `log` without one copy of each frame of `foreign` to `rest`; returns the number of these frames that were
    found."""
    left, taken = collections.Counter(foreign), 0
    with open(log) as lines, open(rest, "w") as out:
        for line in lines:
            frame = frame_of(line.split()[2])
            if left[frame] > 0:
                left[frame] -= 1
                taken += 1
            else:
                out.write(line)
    return taken


def judge_dissector(check, log, least, remote=(), foreign=(), unread=()):
    """At least `least` frames came, and each is well-formed CANopen of a kind that the dissector knows. The dissector
    treats a remote request as plain CAN: only requests for the identifiers in `remote` are right. `foreign`: the
    frames, as frame_of() has them, that the judge sent itself and that may be anything. `unread`: the words of the
    dissector for frames that are right but unknown to it."""
    case = {"least": least, "remote": list(remote), "unread": list(unread),
            "foreign": [(number, payload.hex()) for number, payload in foreign]}
    folder = os.environ.get("JUDGE_RECORDINGS")
    if folder is None:
        return dissect(check, log, **case)
    name = pathlib.Path(folder) / f"{len(list(pathlib.Path(folder).glob('*.json')))}"
    shutil.copyfile(log, name.with_suffix(".log"))
    name.with_suffix(".json").write_text(json.dumps(case))


def dissect_all(check, folder):
    """Reads what the judges have left in the folder. Returns the number of recordings."""
    cases = sorted(pathlib.Path(folder).glob("*.json"))
    for case in cases:
        dissect(check, case.with_suffix(".log"), **json.loads(case.read_text()))
    return len(cases)


def dissect(check, log, least, remote, foreign, unread):
    foreign = [(number, bytes.fromhex(payload)) for number, payload in foreign]
    with tempfile.TemporaryDirectory() as folder:
        rest, pcap = pathlib.Path(folder) / "rest.log", pathlib.Path(folder) / "bus.pcap"
        taken = without(log, foreign, rest)
        if foreign:
            check(taken == len(foreign), f"of {len(foreign)} frames of the judge {taken} are left out")
        to_pcap(rest, pcap)
        command = ["tshark", "-n", "-r", pcap, "-d", "can.subdissector,canopen"]
        told = subprocess.run(command, capture_output=True, text=True, check=True)
    lines = told.stdout.splitlines()
    requests = [line for line in lines if REMOTE in line and any(f"({number:#05x})" in line for number in remote)]
    strange = {line for line in lines if "CANopen" not in line or "alformed" in line or "nknown" in line}
    strange = sorted(line for line in strange.difference(requests) if not any(text in line for text in unread))
    check(len(lines) >= least and not strange, f"tshark reads {len(lines)} frames as CANopen, strange: {strange[:3]}")
    if remote:
        check(bool(requests), f"and leaves {len(requests)} remote requests to CAN")
