#!/usr/bin/env python3
"""judge_lss.py BIN: LSS on vcan0. python-canopen's master against the devices of `takt sim`, `takt lss`
against slaves written here from the standard, and taktd, which gives ids to nodes that have none.
Wireshark's dissector reads all frames.

Runs inside with-vcan, with the interpreter of the judges' environment. Exit code 1: a check failed.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import canopen
from canopen.lss import LssError

from dissector import judge_dissector, recording
from scripted_slaves import Slave, Slaves

NETWORK = pathlib.Path(__file__).resolve().parent / "lss_devices.yaml"
VENDOR, PRODUCT, REVISION = 0xABCD, 0x401, 0x10000
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def comes(condition):
    """Waits for the condition, at most 20 s, because the machine may be busy."""
    until = time.monotonic() + 20
    while not condition() and time.monotonic() < until:
        time.sleep(0.02)


def refuses(call, *arguments):
    try:
        call(*arguments)
    except LssError as error:
        return str(error)
    return ""


def judge_devices(binaries):
    """python-canopen's LSS master and our devices."""
    simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    booted = []
    for node in range(1, 128):
        network.subscribe(0x700 + node, lambda cob_id, data, _: booted.append((cob_id - 0x700, data[0])))
    comes(lambda: booted)
    check(booted == [(7, 0)], f"only the device that has a node id booted: {booted}")
    lss = network.lss
    found, address = lss.fast_scan()
    check(found and address == [VENDOR, PRODUCT, REVISION, 18], f"fastscan finds the lowest serial number: {address}")
    check(lss.inquire_node_id() == 255, "it has no node id")
    check(refuses(lss.configure_node_id, 128) == "LSS Error: 1", "it refuses node id 128")
    lss.configure_node_id(21)
    lss.store_configuration()
    lss.send_switch_state_global(lss.WAITING_STATE)
    comes(lambda: booted[1:])
    check(booted[1:] == [(21, 0)], f"it boots with the id it got: {booted}")
    found, address = lss.fast_scan()
    check(found and address == [VENDOR, PRODUCT, REVISION, 0x80000001], f"the second fastscan finds the other: {address}")
    lss.configure_node_id(22)
    lss.send_switch_state_global(lss.WAITING_STATE)
    comes(lambda: booted[2:])
    check(booted[2:] == [(22, 0)], f"it boots too: {booted}")
    check(lss.fast_scan() == (False, None), "a third finds nobody")
    node = network.add_node(21, str(NETWORK.parent.parent.parent / "share/eds/takt_io401.eds"))
    check(node.sdo[0x1018][4].raw == 18, "the device answers SDO at its new id")
    judge_selected(network, lss, booted)
    simulation.terminate()
    simulation.wait()
    network.disconnect()


def judge_selected(network, lss, booted):
    """A device that has a node id, found by its LSS address."""
    check(lss.send_switch_state_selective(VENDOR, PRODUCT, REVISION, 19), "a device is selected by its LSS address")
    check(lss.inquire_node_id() == 7, "its node id is 7")
    numbers = [lss.inquire_lss_address(code) for code in (0x5A, 0x5B, 0x5C, 0x5D)]
    check(numbers == [VENDOR, PRODUCT, REVISION, 19], f"it tells its LSS address: {numbers}")
    check(refuses(lss.configure_bit_timing, 5) == "LSS Error: 1", "it refuses the reserved bit rate 5")
    lss.configure_bit_timing(3)
    lss.activate_bit_timing(200)
    lss.RESPONSE_TIMEOUT = 0.1
    check(refuses(lss.inquire_node_id) != "", "it is silent while the bit rate changes")
    time.sleep(0.6)
    lss.RESPONSE_TIMEOUT = 0.5
    check(lss.inquire_node_id() == 7, "and there again afterwards")
    lss.configure_node_id(23)
    lss.send_switch_state_global(lss.WAITING_STATE)
    time.sleep(0.3)
    check(booted[3:] == [], "a device with an id keeps it until it is reset")
    network.send_message(0, [130, 7])
    comes(lambda: booted[3:])
    check(booted[3:] == [(23, 0)], f"then it takes the new one: {booted}")


class Tool:
    def __init__(self, binaries):
        self.takt = binaries / "takt"

    def run(self, *words):
        done = subprocess.run([self.takt, "lss", *words, "--bus", "vcan0"], capture_output=True, text=True, timeout=300)
        return done.returncode, done.stdout, done.stderr

    def json(self, *words):
        code, out, err = self.run(*words, "--json")
        return json.loads(out) if code == 0 else {"error": err, "code": code}


def judge_tool(binaries):
    """`takt lss` and slaves that were written without it."""
    serials = (0x80000000, 0x7FFFFFFF, 0xFFFFFFFF)
    slaves = [Slave(serial) for serial in serials] + [Slave(7, node_id=9, store_error=2)]
    bus, tool = Slaves("vcan0", slaves), Tool(binaries)
    slaves[0].configuring = True  # another LSS master has left it in configuration state
    begun = time.monotonic()
    devices = tool.json("find").get("devices", [])
    took = time.monotonic() - begun
    check([d["serial_number"] for d in devices] == sorted(serials), f"find: {devices} in {took:.1f} s")
    check(all(d["vendor_id"] == 0x15A and d["revision_number"] == 0x10003 for d in devices), "with their identities")
    check(not any(slave.configuring for slave in slaves), "and leaves them in waiting state")
    begun = len(bus.commands)
    check(tool.json("find", "--first", "--vendor", "0x15A", "--product", "2", "--revision", "0x10003").get("devices") == devices[:1],
          "find with known numbers")
    check(len(bus.commands) - begun == 1 + 1 + 3 + 33 + 1, f"asks only for the rest: {len(bus.commands) - begun} frames")
    check(tool.run("find", "--vendor", "77")[0] == 1, "find of another vendor: exit code 1")
    scanned = tool.json("scan", "--vendor", "0x15A", "--product", "2").get("devices", [])
    check([d["serial_number"] for d in scanned] == [7, *sorted(serials)], f"scan finds all four: {scanned}")
    check(tool.run("unconfigured")[0] == 0, "somebody is without node id")
    for node_id, slave in zip((31, 32, 33), sorted(slaves[:3], key=lambda one: one.identity[3])):
        answer = tool.json("set-id", str(node_id), "--store")
        check(answer.get("device", {}).get("serial_number") == slave.identity[3] and slave.active == slave.stored == node_id,
              f"set-id {node_id}: {answer}")
    check(tool.run("unconfigured")[0] == 1, "now nobody is")
    code, _, said = tool.run("set-id", "34")
    check(code == 1 and "no device is without node id" not in said and "node id" in said, f"set-id without a device: {said.strip()}")
    judge_addressed(bus, tool, slaves)
    bus.stop()
    judge_talkative(tool)


def judge_talkative(tool):
    """A device that answers fastscan in configuration state hides the others, and takt reports this."""
    bus = Slaves("vcan0", [Slave(3, always=True), Slave(4)])
    code, out, said = tool.run("find")
    check(code == 0 and out.count("vendor") == 1 and "0x00000003" in out, f"one device, no phantom: {out.strip()}")
    check("answers every further question" in said, f"and what hides others is told: {said.strip()}")
    for node_id in (41, 42):
        check(tool.run("set-id", str(node_id))[0] == 0, f"set-id {node_id}")
    check([slave.active for slave in bus.slaves] == [41, 42], "each of them gets an id of its own")
    bus.stop()


def judge_addressed(bus, tool, slaves):
    address = ("--vendor", "0x15A", "--product", "2", "--revision", "0x10003", "--serial", "7")
    answer = tool.json("inquire", *address)
    check(answer.get("node_id") == 9 and answer.get("serial_number") == 7, f"inquire: {answer}")
    code, _, said = tool.run("store", *address)
    check(code == 1 and "could not access its storage medium (error 2)" in said, f"store refused: {said.strip()}")
    check(not slaves[3].configuring, "after a refusal the device is in waiting state")
    code, _, said = tool.run("set-bitrate", "800", *address)
    check(code == 1 and "does not support this bit rate" in said, f"bit rate refused: {said.strip()}")
    code, _, said = tool.run("inquire", *address[:-1], "8")
    check(code == 1 and "no answer" in said, f"a device that is not there: {said.strip()}")
    code, out, said = tool.run("set-bitrate", "250", "--all", "--activate", "200")
    check(code == 0 and all(slave.bit_timing == 3 and slave.delay == 200 for slave in slaves), f"bit rate of all: {out.strip()} {said.strip()}")
    times = {frame[0]: stamp for stamp, frame in bus.commands}
    silent = bus.commands[-1][0] - times[0x15]
    check(bus.commands[-1][1][0] == 0x04 and silent >= 0.4, f"silent for two delays: {silent:.3f} s")
    check(not any(slave.configuring for slave in slaves), "and all are in waiting state")


def judge_daemon(binaries):
    """Nodes of the network file that have no node id get one from taktd, and are booted."""
    simulation = subprocess.Popen([binaries / "takt", "sim", NETWORK, "--bus", "vcan0"])
    with tempfile.TemporaryDirectory() as folder:
        events = pathlib.Path(folder) / "events.jsonl"
        time.sleep(0.5)
        done = subprocess.run([binaries / "taktd", NETWORK, "--for", "12s", "--events", events], timeout=180)
        told = [json.loads(line) for line in events.read_text().splitlines()]
    simulation.terminate()
    simulation.wait()
    check(done.returncode == 0, f"taktd ended with exit code {done.returncode}")
    assigned = sorted(event["node"] for event in told if event["kind"] == "lss_assigned")
    ready = sorted(event["node"] for event in told if event["kind"] == "boot_done")
    check(assigned == [5, 6], f"two nodes got their ids: {assigned}")
    check(ready == [5, 6, 7], f"all three booted: {ready}")


def main(binaries):
    binaries = pathlib.Path(binaries)
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        with recording(log):
            judge_devices(binaries)
            judge_tool(binaries)
            judge_daemon(binaries)
        judge_dissector(check, log, 1000)
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
