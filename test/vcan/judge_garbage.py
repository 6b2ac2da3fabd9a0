#!/usr/bin/env python3
"""judge_garbage.py BIN [SEED]: thousands of random frames on vcan0 against a running taktd and its two nodes.

taktd continues to run. When the bus is quiet again, its nodes are operational and taktd stops in order. All frames that
takt's programs sent meanwhile are well formed. Runs inside with-vcan.
Exit code 1: a check failed.

Among the frames are NMT commands that stop or reset the nodes, and a second SYNC: taktd then boots or starts the nodes
again. Error frames are not among them, because they come from a driver, never from the bus.
"""
import json
import random
import socket
import struct
import subprocess
import sys
import time

from daemon_run import NMT, ROOT, SYNC, DaemonRun, check, soon, verdict

NETWORK = ROOT / "test/vcan/simulated_axes.yaml"
NODES, MASTER = (5, 6), 127
FRAMES, BATCH, PAUSE = 6000, 20, 0.02
ENOUGH = 100  # SYNCs
EDGE = 4  # answers under way
EXTENDED, REMOTE = 0x80000000, 0x40000000
NMT_COMMANDS = (1, 2, 128, 129, 130)
LSS_MASTER, LSS_SLAVE = 0x7E5, 0x7E4
LSS_WORDS = (0x04, 0x11, 0x13, 0x17, 0x40, 0x44, 0x4F, 0x50, 0x51, 0x5A, 0x5E)
STATES = (0, 4, 5, 127, 0x80, 0x84, 0x85, 0xFF)


def bytes_of(dice, first=None):
    """Random bytes of any length. `first` has the values of the first byte that have a meaning."""
    data = dice.randbytes(dice.choice((8, 8, 8, dice.randrange(9))))
    return bytes((dice.choice(first),)) + data[1:] if first and data else data


def garbage(dice):
    """Returns a random frame as (identifier with flags, data). Most of these frames are nearly valid."""
    node = dice.choice(NODES)
    kind = dice.randrange(13)
    if kind == 0:
        return dice.randrange(1 << 29) | EXTENDED, bytes_of(dice)
    if kind == 1:
        return dice.randrange(1 << 11) | dice.choice((0, EXTENDED)) | REMOTE, bytes(dice.randrange(9))
    if kind == 2:  # answers of the SDO server: toggled segments, aborts, uploads that nobody asked for
        return 0x580 + node, bytes_of(dice, (0x00, 0x10, 0x20, 0x41, 0x43, 0x4F, 0x60, 0x80, 0xA1, 0xA4, 0xC1))
    if kind == 3:
        return 0x080 + node, bytes_of(dice)
    if kind == 4:  # boot-up, stopped, operational, toggled; of the master, too
        return 0x700 + dice.choice((*NODES, *NODES, MASTER)), bytes_of(dice, STATES)
    if kind == 5:
        command = dice.choice((*NMT_COMMANDS, dice.randrange(256)))
        to = dice.choice((0, *NODES, MASTER, dice.randrange(256)))
        return NMT, (bytes((command, to)) + dice.randbytes(6))[: dice.choice((2, 2, dice.randrange(9)))]
    if kind == 6:
        return LSS_SLAVE, bytes_of(dice, LSS_WORDS)
    if kind == 7:
        return LSS_MASTER, bytes_of(dice)
    if kind == 8:  # the process data themselves
        return dice.choice((0x180, 0x200)) + node, bytes_of(dice)
    if kind == 9:
        return SYNC, bytes_of(dice)
    return dice.randrange(1 << 11), bytes_of(dice)


def pour(dice, count):
    """Sends the frame; returns it as a candump log has it."""
    sent = []
    with socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as bus:
        bus.bind(("vcan0",))
        for number in range(count):
            identifier, data = garbage(dice)
            bus.send(struct.pack("=IB3x8s", identifier, len(data), data))
            sent.append((identifier, b"" if identifier & REMOTE else data))
            if number % BATCH == 0:
                time.sleep(PAUSE)
    return sent


def states(run):
    """The states of the nodes that taktd reports, by name; empty if taktd does not answer."""
    status = subprocess.run([run.binaries / "takt", "status", "--json"], capture_output=True, text=True)
    buses = json.loads(status.stdout)["buses"] if status.returncode == 0 else []
    return {node["name"]: node["nmt_state"] for bus in buses for node in bus["nodes"]}


def exchange(run):
    """Returns the number of the last SYNCs, at most ENOUGH, and for each node the number of answers to them."""
    syncs = [frame.number for frame in run.frames() if frame.standard(SYNC)][-ENOUGH:]
    return len(syncs), [run.count(0x180 + node, syncs[0]) for node in NODES] if syncs else []


def settled(run):
    syncs, answers = exchange(run)
    well = syncs == ENOUGH and all(abs(count - syncs) <= EDGE for count in answers)
    return well and states(run) == {"left": "operational", "right": "operational"}


def main(binaries, seed="1"):
    with DaemonRun(binaries, NETWORK) as run:
        run.start_nodes()
        run.start_taktd()
        check(soon(lambda: settled(run)), "both nodes are operational and answer each SYNC")
        begin = run.place()
        sent = pour(random.Random(int(seed)), FRAMES)
        check(soon(lambda: run.place() - begin > FRAMES), f"garbage by seed {seed}: {run.place() - begin} frames")
        check(run.taktd.poll() is None, "taktd is alive")
        check(soon(lambda: settled(run)), f"its nodes are again what they were: {states(run)}, {exchange(run)}")
        kinds = ("emcy", "pdo_length", "foreign_nmt", "bootup_again", "duplicate_node", "duplicate_cob_id", "boot_done")
        told = {kind: len(run.events(kind)) for kind in kinds}
        check(told["emcy"] and told["foreign_nmt"], f"it has noticed: {told}")
        run.stop_taktd()
        run.dissect(1000, foreign=sent)
    return verdict()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
