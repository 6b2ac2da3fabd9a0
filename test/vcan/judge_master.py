#!/usr/bin/env python3
"""judge_master.py BIN: python-canopen as the master of our simulated devices on vcan0.

Every object that their EDS files list, NMT, heartbeat both ways, node and life guarding, PDOs that are
remapped and reconfigured with python-canopen's own sequence, SYNC, remote requests, EMCY, and its CiA 402
profile against our drive. Runs inside with-vcan. Exit code 1: a check failed.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

import canopen
from canopen.profiles.p402 import BaseNode402

from dissector import judge_dissector, recording

HERE = pathlib.Path(__file__).resolve().parent
NETWORK = HERE / "master_devices.yaml"
EDS = HERE.parent.parent / "share/eds"
IO, DRIVE, TERMINALS = 5, 6, 7
UNKNOWN_NMT = (0, bytes((0x42, IO)))
failures = []


def check(good, what):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)


def abort_of(call, *arguments):
    """The abort code; 0 if the device accepted the write, None if it did not answer."""
    try:
        call(*arguments)
    except canopen.SdoAbortedError as error:
        return error.code
    except canopen.SdoCommunicationError:
        return None
    return 0


def frames_of(network, identifier, seconds, action=lambda: None):
    """[(time, payload)] of the frames that come within `seconds` after `action`."""
    seen = []
    collect = lambda _, data, stamp: seen.append((stamp, bytes(data)))
    network.subscribe(identifier, collect)
    action()
    time.sleep(seconds)
    network.unsubscribe(identifier, collect)
    return seen


def states_of(network, node_id, seconds):
    return [data[0] for _, data in frames_of(network, 0x700 + node_id, seconds)]


def judge_dictionary(node):
    """The device has the objects that the EDS lists, with the widths and the access of the EDS."""
    wrong = []
    objects = [o for entry in node.object_dictionary.values() for o in ([entry] if isinstance(entry, canopen.objectdictionary.ODVariable) else entry.values())]
    for variable in objects:
        name = f"{variable.index:04X}:{variable.subindex:02X}"
        if variable.index < 0x1000 or not variable.readable or (variable.index == 0x1003 and variable.subindex):
            continue
        try:
            data = node.sdo.upload(variable.index, variable.subindex)
        except canopen.SdoAbortedError as error:
            wrong.append(f"{name} {error}")
            continue
        if variable.data_type not in canopen.objectdictionary.DATA_TYPES and variable.data_type != 0xF and len(data) != len(variable) // 8:
            wrong.append(f"{name} has {len(data)} bytes, not {len(variable) // 8}")
        if not variable.writable and abort_of(node.sdo.download, variable.index, variable.subindex, data) != 0x06010002:
            wrong.append(f"{name} is read-only and took a write")
    check(len(objects) > 50 and not wrong, f"node {node.id} has {len(objects)} objects as its EDS lists them: {wrong[:3]}")


def judge_nmt(network, node):
    node.sdo[0x1017].raw = 50
    check(set(states_of(network, IO, 0.3)) == {127}, "heartbeat: PRE-OPERATIONAL")
    for state, code in (("OPERATIONAL", 5), ("STOPPED", 4)):
        node.nmt.state = state
        time.sleep(0.05)
        check(set(states_of(network, IO, 0.3)) == {code}, f"heartbeat: {state}")
    node.sdo.RESPONSE_TIMEOUT, node.sdo.MAX_RETRIES = 0.2, 1
    check(abort_of(node.sdo.upload, 0x1000, 0) is None, "no SDO in STOPPED")
    node.sdo.RESPONSE_TIMEOUT, node.sdo.MAX_RETRIES = 1.0, 1
    node.nmt.state = "PRE-OPERATIONAL"
    check(abort_of(node.sdo.upload, 0x1000, 0) == 0, "SDO again in PRE-OPERATIONAL")
    for command in ("RESET COMMUNICATION", "RESET"):
        node.nmt.state = command
        try:
            node.nmt.wait_for_bootup(2)
            check(True, f"boot-up after {command}")
        except canopen.nmt.NmtError as error:
            check(False, f"boot-up after {command}: {error}")
    check(node.sdo[0x1017].raw == 0, "and 0x1017 has its default again")
    network.send_message(*UNKNOWN_NMT)
    check(abort_of(node.sdo.upload, 0x1000, 0) == 0, "an unknown NMT command does nothing")


def judge_watching(network, node, terminals):
    """The devices watch the master: heartbeat consumer, life guarding."""
    node.sdo[0x1016][1].raw = 127 << 16 | 200
    heart = network.send_periodic(0x77F, [5], 0.05)
    node.nmt.state = "OPERATIONAL"
    time.sleep(0.5)
    check(not node.emcy.active, "no EMCY while the master's heartbeat comes")
    heart.stop()
    time.sleep(0.6)
    check([e.code for e in node.emcy.active] == [0x8130], f"EMCY 8130 without it: {node.emcy.active}")
    node.sdo[0x1017].raw = 50
    check(set(states_of(network, IO, 0.2)) == {127}, "and by 0x1029 it left OPERATIONAL")
    check(node.sdo[0x1003][1].raw & 0xFFFF == 0x8130, "0x1003 has it")
    node.sdo[0x1003][0].raw = 0
    check(node.sdo[0x1003][0].raw == 0, "and can be cleared")
    check(abort_of(node.sdo.download, 0x1003, 0, b"\1") == 0x06090030, "by 0 only")

    terminals.sdo[0x100C].raw, terminals.sdo[0x100D].raw = 100, 4
    terminals.nmt.start_node_guarding(0.1)
    answers = states_of(network, TERMINALS, 1.0)
    terminals.nmt.stop_node_guarding()
    toggles = [a >> 7 for a in answers]
    check(len(answers) >= 8 and all(a != b for a, b in zip(toggles, toggles[1:])), f"each guarding request is answered, the bit toggles: {answers}")
    check(all(a & 0x7F == 127 for a in answers), "with PRE-OPERATIONAL")
    check(not terminals.emcy.active, "no EMCY while it is guarded")
    time.sleep(0.8)
    check(0x8130 in [e.code for e in terminals.emcy.active], f"life guarding: EMCY 8130 after that: {terminals.emcy.active}")


def judge_pdos(network, node):
    node.nmt.state = "PRE-OPERATIONAL"
    node.tpdo.read()
    node.rpdo.read()
    check([v.index for v in node.tpdo[1].map] == [0x6000, 0x6000], "the default mapping is read")
    output, back = node.rpdo[1], node.tpdo[1]
    output.clear()
    output.add_variable(0x6200, 2)
    output.add_variable(0x6200, 1)
    output.trans_type, output.enabled = 255, True
    output.save()
    back.clear()
    back.add_variable(0x6000, 2)
    back.add_variable(0x6000, 1)
    back.trans_type, back.event_timer, back.inhibit_time, back.enabled = 255, 0, 0, True
    back.save()
    node.nmt.state = "OPERATIONAL"
    time.sleep(0.1)
    output[0].raw, output[1].raw = 0x12, 0x34
    seen = frames_of(network, back.cob_id, 0.3, output.transmit)
    check([data for _, data in seen] == [b"\x12\x34"], f"mapped the other way round: {seen}")
    check(node.sdo[0x6200][1].raw == 0x34, "the outputs are where they belong")
    judge_sync(network, node, back)
    judge_remote(network, node, back, output)
    judge_length(network, node, output)


def judge_sync(network, node, pdo):
    for kind, syncs, expected in ((1, 10, 10), (5, 20, 4)):
        node.nmt.state = "PRE-OPERATIONAL"
        pdo.trans_type = kind
        pdo.save()
        node.nmt.state = "OPERATIONAL"
        time.sleep(0.1)
        seen = []
        collect = lambda _, data, stamp: seen.append(stamp)
        network.subscribe(pdo.cob_id, collect)
        for _ in range(syncs):
            network.sync.transmit()
            time.sleep(0.02)
        network.unsubscribe(pdo.cob_id, collect)
        check(len(seen) == expected, f"type {kind}: {len(seen)} frames of {syncs} SYNCs")
    node.nmt.state = "PRE-OPERATIONAL"
    node.sdo[0x1019].raw = 10
    pdo.trans_type, pdo.sync_start_value = 3, 2
    pdo.save()
    node.nmt.state = "OPERATIONAL"
    time.sleep(0.1)
    counts, count = [], 0
    collect = lambda *_: counts.append(count)
    network.subscribe(pdo.cob_id, collect)
    for count in [*range(8, 11), *range(1, 11)]:
        network.sync.transmit(count)
        time.sleep(0.02)
    network.unsubscribe(pdo.cob_id, collect)
    check(counts == [2, 5, 8], f"n = 3 from SYNC counter 2: {counts}")
    network.sync.transmit()
    time.sleep(0.1)
    check(0x8240 in [e.code for e in node.emcy.active], "a SYNC without its counter: EMCY 8240")
    node.nmt.state = "PRE-OPERATIONAL"
    node.sdo[0x1019].raw = 0
    pdo.sync_start_value = 0


def judge_remote(network, node, pdo, output):
    node.nmt.state = "PRE-OPERATIONAL"
    pdo.trans_type, pdo.rtr_allowed = 253, True
    pdo.save()
    node.nmt.state = "OPERATIONAL"
    output.transmit()
    check(not frames_of(network, pdo.cob_id, 0.3), "type 253: silent until it is asked")
    seen = frames_of(network, pdo.cob_id, 0.3, pdo.remote_request)
    check([data for _, data in seen] == [b"\x12\x34"], f"and answers a remote request: {seen}")


def judge_length(network, node, output):
    node.emcy.reset()
    network.send_message(output.cob_id, b"\x77")
    time.sleep(0.2)
    check([e.code for e in node.emcy.active] == [0x8210], f"a short RPDO: EMCY 8210 {node.emcy.active}")
    check(node.sdo[0x6200][2].raw == 0x12, f"and nothing of it is used: {node.sdo[0x6200][2].raw:#x}")
    node.nmt.state = "PRE-OPERATIONAL"
    write = lambda index, sub, value, size: abort_of(node.sdo.download, index, sub, value.to_bytes(size, "little"))
    check(write(0x1600, 1, 0x62000108, 4) not in (0, None), "no entry is changed while the mapping is on")
    check(write(0x1400, 1, 0x80000205, 4) == 0 and write(0x1600, 0, 0, 1) == 0, "the PDO and its mapping are off")
    check(write(0x1600, 1, 0x10080020, 4) == 0x06040041, "an object that can't be mapped is refused")
    check(write(0x1600, 1, 0x60000108, 4) == 0x06040041, "an input in an RPDO is refused")
    check(write(0x1600, 0, 9, 1) not in (0, None), "nine objects where eight fit are refused")
    check(write(0x1400, 1, 0x00000181 - 1, 4) == 0x06090030, "the restricted COB-ID 0x180 is refused")


def judge_drive(network, node):
    node.setup_402_state_machine()
    status, command = node.tpdo[1], node.rpdo[1]
    status.clear()
    for index in (0x6041, 0x6064):
        status.add_variable(index)
    status.trans_type, status.enabled = 1, True
    status.save()
    command.clear()
    for index in (0x6040, 0x607A):
        command.add_variable(index)
    command.trans_type, command.enabled = 255, True
    command.save()
    node.setup_pdos(upload=False)
    network.sync.start(0.01)
    node.nmt.state = "OPERATIONAL"
    node.op_mode = "PROFILED POSITION"
    check(node.op_mode == "PROFILED POSITION", f"mode: {node.op_mode}")
    for state in ("READY TO SWITCH ON", "SWITCHED ON", "OPERATION ENABLED"):
        node.state = state
        check(node.state == state, f"drive: {node.state}")
    node.sdo[0x6081].raw, node.sdo[0x6083].raw, node.sdo[0x6084].raw = 20000, 200000, 200000
    command[1].raw = 2000
    for word in (0x0F, 0x1F):
        command[0].raw = word
        command.transmit()
        time.sleep(0.05)
    end = time.monotonic() + 2
    while time.monotonic() < end and not (node.statusword & 0x400 and abs(status[1].raw - 2000) < 5):
        time.sleep(0.02)
    check(abs(status[1].raw - 2000) < 5, f"a profile position move arrives: {status[1].raw}")
    node.state = "SWITCH ON DISABLED"
    check(node.state == "SWITCH ON DISABLED", f"drive: {node.state}")
    network.sync.stop()


def judge_all(binaries):
    simulation = subprocess.Popen([pathlib.Path(binaries) / "takt", "sim", NETWORK, "--bus", "vcan0"])
    network = canopen.Network()
    network.connect(interface="socketcan", channel="vcan0")
    io = network.add_node(IO, str(EDS / "takt_io401.eds"))
    drive = network.add_node(BaseNode402(DRIVE, str(EDS / "takt_drive402.eds")))
    terminals = network.add_node(TERMINALS, str(EDS / "beckhoff_io.eds"))
    try:
        for node in (io, drive, terminals):
            node.nmt.wait_for_bootup(5) if node is io else time.sleep(0.1)
            node.sdo.RESPONSE_TIMEOUT = 1.0
        for node in (io, drive, terminals):
            judge_dictionary(node)
        judge_nmt(network, io)
        judge_watching(network, io, terminals)
        judge_pdos(network, io)
        judge_drive(network, drive)
    finally:
        network.disconnect()
        simulation.terminate()
        simulation.wait()


def main(binaries):
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        with recording(log):
            judge_all(binaries)
        judge_dissector(check, log, 1000, remote=[0x185, 0x700 + TERMINALS], foreign=[UNKNOWN_NMT])
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
