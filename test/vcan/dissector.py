"""What Wireshark's CANopen dissector makes of the traffic on vcan0."""
import contextlib
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
REMOTE = "Remote Transmission Request"


@contextlib.contextmanager
def recording(log):
    """candump writes what is on the bus into `log`."""
    with open(log, "w") as out:
        candump = subprocess.Popen(["candump", "-L", "-r", "8000000", "vcan0"], stdout=out)
        try:
            yield
        finally:
            candump.terminate()
            candump.wait()


def judge_dissector(check, log, least, remote=()):
    """Each of at least so many frames is CANopen and well formed. The dissector leaves a remote request to
    plain CAN: only those for the identifiers in `remote` are right."""
    with tempfile.TemporaryDirectory() as folder:
        pcap = pathlib.Path(folder) / "bus.pcap"
        subprocess.run([sys.executable, HERE / "candump_to_pcap.py", log, pcap], check=True)
        command = ["tshark", "-r", pcap, "-d", "can.subdissector,canopen"]
        told = subprocess.run(command, capture_output=True, text=True, check=True)
    lines = told.stdout.splitlines()
    requests = [line for line in lines if REMOTE in line and any(f"({number:#05x})" in line for number in remote)]
    strange = [line for line in lines if "CANopen" not in line or "alformed" in line]
    strange = sorted(set(strange) - set(requests))
    check(len(lines) >= least and not strange, f"tshark reads {len(lines)} frames as CANopen, strange: {strange[:3]}")
    if remote:
        check(bool(requests), f"and leaves {len(requests)} remote requests to CAN")
