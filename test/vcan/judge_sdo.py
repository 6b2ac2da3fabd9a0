#!/usr/bin/env python3
"""judge_sdo.py BIN: SDO of takt against python-canopen on vcan0, in every mode that both have.

1. python-canopen is the server (expedited, segmented; it refuses block downloads and answers block uploads
   by segments), `takt sdo --bus vcan0` the client.
2. `takt sim` is the server, python-canopen the client: expedited, segmented and block, both ways.
3. `taktd` with the simulated device: files through the daemon; python-canopen reads the master's own
   dictionary and asks it for an NMT command.
`takt dump` and Wireshark's dissector read all frames. Runs inside with-vcan. Exit code 1: a check failed.
"""
import hashlib
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import time

import can
import canopen

from dissector import judge_dissector, recording

HERE = pathlib.Path(__file__).resolve().parent
EDS = HERE / "domain_device.eds"
NETWORK = HERE / "sdo_device.yaml"
DOMAIN, NUMBER, TEXT = 0x2000, 0x2001, 0x2002
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def some_bytes(size):
    return random.Random(size).randbytes(size)


class Takt:
    def __init__(self, binaries, folder):
        self.program, self.folder = pathlib.Path(binaries) / "takt", pathlib.Path(folder)

    def sdo(self, *arguments):
        done = subprocess.run([self.program, "sdo", *map(str, arguments)], capture_output=True, text=True, timeout=180)
        return done.returncode, done.stdout.strip(), done.stderr.strip()

    def download(self, content, *arguments):
        file = self.folder / "out.bin"
        file.write_bytes(content)
        return self.sdo("download", 5, "2000", file, *arguments)

    def upload(self, *arguments):
        file = self.folder / "in.bin"
        result = self.sdo("upload", 5, "2000", file, *arguments)
        return result, file.read_bytes() if file.exists() else None


def python_network():
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    return network


def judge_python_server(takt):
    network = python_network()
    node = canopen.LocalNode(5, str(EDS))
    network.add_node(node)
    bus = ("--bus", "vcan0")
    code, out, err = takt.sdo("read", 5, "2001", "u32", *bus)
    check(code == 0 and out == "305419896", f"python serves an expedited upload: {out} {err}")
    code, _, err = takt.sdo("write", 5, "2001", "u32", "0xCAFE0001", *bus)
    check(code == 0 and node.get_data(NUMBER, 0) == b"\x01\x00\xfe\xca", f"python takes an expedited download {err}")
    code, out, err = takt.sdo("read", 5, "1008", "string", *bus)
    check(code == 0 and "A device with a domain, and a long name" in out, f"python serves segments: {out} {err}")
    for size in (1, 4, 5, 7, 8, 127, 128, 1000, 5000):
        content = some_bytes(size)
        code, _, err = takt.download(content, *bus)
        check(code == 0 and node.get_data(DOMAIN, 0) == content, f"python takes a file of {size} bytes: {err}")
        (code, _, err), got = takt.upload(*bus)
        check(code == 0 and got == content, f"python serves a file of {size} bytes: {err}")
    code, _, err = takt.sdo("read", 5, "3000", *bus)
    check(code == 1 and "06020000" in err, f"its abort is told in words: {err}")
    network.disconnect()


def judge_endless(takt):
    """A server that never stops sending segments."""
    bus = can.Bus(interface="socketcan", channel="vcan0")
    ends = threading.Event()

    def serve():
        while not ends.is_set():
            frame = bus.recv(0.1)
            if frame is None or frame.arbitration_id != 0x605:
                continue
            command = frame.data[0]
            no_block = [0x80, *frame.data[1:4], 1, 0, 4, 5]
            answers = {2: [0x40, *frame.data[1:4], 0, 0, 0, 0], 3: [command & 0x10, *b"endless"], 5: no_block}
            if command >> 5 in answers:
                bus.send(can.Message(arbitration_id=0x585, is_extended_id=False, data=answers[command >> 5]))

    thread = threading.Thread(target=serve)
    thread.start()
    code, _, err = takt.sdo("read", 5, "1008", "string", "--bus", "vcan0")
    check(code == 1 and "longer than 1024 bytes" in err, f"an answer without end is ended: {err}")
    with tempfile.TemporaryDirectory() as folder:
        code, _, err = takt.sdo("upload", 5, "1021", f"{folder}/file", "--bus", "vcan0", "--limit", "4K")
        check(code == 1 and "longer than the limit of 4096 bytes" in err, f"a file without end is ended at its limit: {err}")
        check(not pathlib.Path(f"{folder}/file").exists(), "and nothing is written")
    ends.set()
    thread.join()
    bus.shutdown()


def python_write(node, content, **how):
    with node.sdo[DOMAIN].open("wb", size=len(content), **how) as stream:
        stream.write(content)


def python_read(node, **how):
    with node.sdo[DOMAIN].open("rb", **how) as stream:
        return stream.read()


def judge_python_client(binaries):
    simulation = subprocess.Popen([pathlib.Path(binaries) / "takt", "sim", NETWORK, "--bus", "vcan0"])
    time.sleep(0.5)
    network = python_network()
    node = network.add_node(5, str(EDS))
    node.sdo.RESPONSE_TIMEOUT = 2.0
    check(node.sdo[NUMBER].raw == 0x12345678, "the simulated device serves an expedited upload")
    node.sdo[NUMBER].raw = 77
    check(node.sdo[NUMBER].raw == 77, "and takes an expedited download")
    check(node.sdo[0x1008].raw == "A device with a domain, and a long name", "and serves segments")
    for size in (1, 7, 8, 888, 889, 890, 5000):
        for block in (False, True):
            content = some_bytes(size + block)
            mode = "a block" if block else "segments"
            python_write(node, content, block_transfer=block)
            check(python_read(node) == content, f"the simulated device takes {size} bytes as {mode}")
            check(python_read(node, block_transfer=block) == content, f"and serves them as {mode}")
    try:
        node.sdo.upload(0x3000, 0)
        check(False, "an object that does not exist is refused")
    except canopen.SdoAbortedError as error:
        check(error.code == 0x06020000, f"an object that does not exist is refused: {error}")
    network.disconnect()
    return simulation


def judge_daemon(binaries, takt):
    taktd = subprocess.Popen([pathlib.Path(binaries) / "taktd", NETWORK, "--for", "40s"])
    time.sleep(3)
    for size in (0, 3, 127, 1024, 1025, 30000):
        content = some_bytes(size)
        code, _, err = takt.download(content)
        check(code == 0, f"the daemon downloads a file of {size} bytes: {err}")
        (code, _, err), got = takt.upload()
        same = got is not None and hashlib.sha256(got).digest() == hashlib.sha256(content).digest()
        check(code == 0 and same, f"and uploads it again: {err}")
    code, _, err = takt.sdo("upload", 5, "3000", "/dev/null")
    check(code == 1 and "06020000" in err, f"a refusal comes through the daemon: {err}")

    network = python_network()
    master = network.add_node(127, canopen.ObjectDictionary())
    master.sdo.RESPONSE_TIMEOUT = 2.0
    read = lambda index, sub: int.from_bytes(master.sdo.upload(index, sub), "little")
    check(master.sdo.upload(0x1008, 0) == b"takt CANopen master", "python reads the master's name in segments")
    check(read(0x1006, 0) == 10000, "and its SYNC period")
    check(read(0x1F81, 5) == 0x0D and read(0x1F85, 5) == 0xABCD, "and what it expects of node 5")
    check(read(0x1F82, 5) == 5, "and that node 5 is operational")
    with master.sdo.open(0x1008, 0, "rb", block_transfer=True) as stream:
        check(stream.read() == b"takt CANopen master", "and its name as a block")
    try:
        master.sdo.download(0x1006, 0, b"\1\0\0\0")
        check(False, "the SYNC period can't be written")
    except canopen.SdoAbortedError as error:
        check(error.code == 0x06010002, f"the SYNC period can't be written: {error}")
    master.sdo.download(0x1F82, 5, b"\x7f")
    time.sleep(0.3)
    check(read(0x1F82, 5) in (1, 127), f"node 5 left OPERATIONAL when 0x1F82 asked for it")
    network.disconnect()
    taktd.terminate()
    check(taktd.wait(timeout=180) == 0, f"taktd ended with exit code {taktd.returncode}")


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        takt = Takt(binaries, folder)
        with recording(log):
            judge_python_server(takt)
            judge_endless(takt)
            simulation = judge_python_client(binaries)
            judge_daemon(binaries, takt)
            time.sleep(0.2)
            simulation.terminate()
            simulation.wait()
        # The dissector keeps no state: it regards the last segment of a block, with a number of 96 or more, as no SDO
        # command.
        last_segment = [f"Default-SDO ({way}): Unknown (0x7)" for way in ("rx", "tx")]
        judge_dissector(check, log, 10000, unread=last_segment)
        read = subprocess.run([takt.program, "dump", NETWORK, log], capture_output=True, text=True)
        text = read.stdout
        check(read.returncode == 0 and "block segment 127" in text, "takt dump reads block transfers")
        lines = text.splitlines()
        strange = [i for i, line in enumerate(lines) if "unknown command" in line or "is wrong" in line or " ?  " in line]
        around = [line for line in lines[:strange[0] + 1] if "SDO" in line][-80:] if strange else []
        check(not strange, "and every frame" + "".join("\n      " + line for line in around))
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
