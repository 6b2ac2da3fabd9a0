#!/usr/bin/env python3
"""judge_learn.py BIN: `takt learn` of a bus that python-canopen has booted and configured on vcan0.

`takt sim` plays two drives, candump records, python-canopen is the master. The learned file has the configuration that
python-canopen has written, and taktd boots the same devices by this file. Wireshark's dissector reads all frames.
Runs inside with-vcan. Exit code 1: a check failed.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import canopen

from dissector import judge_dissector, recording

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NETWORK = ROOT / "test/vcan/simulated_axes.yaml"
EDS = ROOT / "share/eds/takt_drive402.eds"
NODES = (5, 6)
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def map_pdo(pdo, objects, transmission):
    pdo.clear()
    for index in objects:
        pdo.add_variable(index)
    pdo.trans_type = transmission
    pdo.enabled = True
    pdo.save()


def boot_with_python_canopen():
    network = canopen.Network()
    network.connect(channel="vcan0", interface="socketcan")
    for node_id in NODES:
        node = network.add_node(node_id, str(EDS))
        node.nmt.state = "RESET"
        node.nmt.wait_for_bootup(10)
        for sub in (1, 2, 3):
            node.sdo[0x1018][sub].raw
        node.sdo[0x1000].raw
        node.sdo[0x1017].raw = 250
        node.tpdo.read()
        node.rpdo.read()
        map_pdo(node.tpdo[1], (0x6041, 0x606C), 1)
        map_pdo(node.tpdo[2], (0x6064, 0x6061), 2)
        map_pdo(node.rpdo[1], (0x6040, 0x60FF), 1)
        node.sdo[0x6083].raw = 12345 + node_id
        node.sdo[0x6060].raw = 9
        node.nmt.state = "OPERATIONAL"
    network.sync.start(0.02)
    time.sleep(1.5)
    network.sync.stop()
    network.disconnect()


def judge_plan(plan):
    cycle = plan["cycle"]
    check(abs(cycle["period_us"] - 20000) < 1, f"SYNC every {cycle['period_us']} us")
    check([node["id"] for node in plan["nodes"]] == list(NODES), "both nodes were found")
    for node in plan["nodes"]:
        pdos = {(kind, pdo["number"]): (pdo["cob_id"], pdo["transmission_type"], [f["index"] for f in pdo["fields"]])
                for kind in ("tpdos", "rpdos") for pdo in node[kind]}
        wanted = {("tpdos", 1): (0x180 + node["id"], 1, [0x6041, 0x606C]),
                  ("tpdos", 2): (0x280 + node["id"], 2, [0x6064, 0x6061]),
                  ("rpdos", 1): (0x200 + node["id"], 1, [0x6040, 0x60FF])}
        for name, pdo in wanted.items():
            check(pdos.get(name) == pdo, f"node {node['id']} {name[0]} {name[1]}: {pdos.get(name)}")
        writes = {step.get("index"): step.get("value") for step in node["boot_plan"] if step["action"].startswith("write")}
        check(int(writes.get(0x6083, "0"), 16) == 12345 + node["id"], f"node {node['id']} 6083 = {writes.get(0x6083)}")
        check(int(writes.get(0x6060, "0"), 16) == 9, f"node {node['id']} 6060 = {writes.get(0x6060)}")
        check(int(writes.get(0x1017, "0"), 16) == 250, f"node {node['id']} 1017 = {writes.get(0x1017)}")


def judge_all(programs, folder):
    log, learned, events = folder / "boot.log", folder / "learned.yaml", folder / "events"
    devices = subprocess.Popen([programs / "takt", "sim", NETWORK, "--bus", "vcan0"])
    with recording(log):
        time.sleep(1)
        boot_with_python_canopen()
    done = subprocess.run([programs / "takt", "learn", log, "--eds-dir", EDS.parent, "-o", learned],
                          capture_output=True, text=True, timeout=180)
    check(done.returncode == 0, f"takt learn ends with {done.returncode} {done.stderr}")
    plan = subprocess.run([programs / "takt", "plan", "--json", "--quiet", learned], capture_output=True, text=True)
    judge_plan(json.loads(plan.stdout))
    daemon = subprocess.run([programs / "taktd", learned, "--for", "8s", "--events", events,
                             "--lcm-url", "tcpq://127.0.0.1:7791"], capture_output=True, text=True, timeout=180)
    done = [json.loads(line) for line in events.read_text().splitlines()] if events.exists() else []
    ready = {event.get("node") for event in done if "boot_done" in json.dumps(event)}
    check(len(ready) == len(NODES), f"taktd boots by the learned file: {ready} {daemon.stderr[-800:]}")
    devices.terminate()
    devices.wait()
    if failures:
        print(learned.read_text())


def main(binaries):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with recording(folder / "bus.log"):
            judge_all(pathlib.Path(binaries), folder)
        judge_dissector(check, folder / "bus.log", 1000)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
