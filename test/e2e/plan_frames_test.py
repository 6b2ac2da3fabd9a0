#!/usr/bin/env python3
"""The frames that `takt plan` prints are those that a boot sends, in that order, for each demo network.

usage: plan_frames_test.py FOLDER_OF_PROGRAMS FOLDER_OF_NETWORKS
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

COB_ID_OFF = 0x8000_0000


def frames_of(network, takt, folder):
    """(identifier, data) of all frames of the simulated start."""
    log = pathlib.Path(folder, "boot.log")
    subprocess.run([takt, "simulate", network, "--for", "5s", "--candump", log], check=True, capture_output=True)
    found = re.findall(r"^\([\d.]+\) \S+ ([0-9A-F]+)#([0-9A-F]*)$", log.read_text(), re.MULTILINE)
    return [(int(cob_id, 16), data) for cob_id, data in found]


def value_of(answer):
    """The value of an expedited upload, or None if the device refused it."""
    command = int(answer[:2], 16)
    if command >> 5 != 2:
        return None
    size = 4 - (command >> 2 & 3) if command & 1 else 4
    return int.from_bytes(bytes.fromhex(answer[8 : 8 + 2 * size]), "little")


class Boot:
    """One node's boot plan, followed through the frames of that node."""

    def __init__(self, node, frames):
        self.steps = node["boot_plan"]
        request, answer = 0x600 + node["id"], 0x580 + node["id"]
        self.frames = [f for f in frames if f[0] in (request, answer) or f[0] == 0 and f[1][2:] == f"{node['id']:02X}"]
        self.preoperational = (0, f"80{node['id']:02X}")
        self.at = 0
        self.same = True

    def take(self, pattern, step):
        """Compares the next frame with `pattern`. Returns the answer of an SDO request. NMT enter pre-operational,
        which a boot sends before its first write, is part of no step."""
        if self.frames[self.at] == self.preoperational and not re.fullmatch(pattern, "000#" + self.preoperational[1]):
            self.at += 1
        cob_id, data = self.frames[self.at]
        sent = f"{cob_id:03X}#{data}"
        assert re.fullmatch(pattern, sent), f"step {step}: plan has {pattern}, sent was {sent}"
        self.at += 1
        if cob_id == 0:
            return None
        self.at += 1
        return self.frames[self.at - 1][1]

    def sent_next(self, pattern):
        return re.fullmatch(pattern, "{0:03X}#{1}".format(*self.frames[self.at])) is not None

    def step(self, step):
        """Follows a step through the frames. Returns the number of the next step."""
        frame, write = step.get("frame"), step.get("write_frame")
        if step["action"] == "skip if same":
            same, self.same = self.same, True
            return step["target"] if same else step["step"] + 1
        if step["action"] == "disable PDO" and write is None and not self.sent_next(frame):
            return step["step"] + 1  # it is off already
        if frame is None:
            return step["step"] + 1
        got = self.take(frame, step)
        if "value" in step and frame[4:6] == "40":
            mask = step.get("mask", 0xFFFF_FFFF)
            value = value_of(got)
            differs = value is None or (value ^ int(step["value"], 16)) & mask != 0
            if step["action"] in ("expect", "verify"):
                assert not differs, f"step {step}: {got}"
            if step["action"] == "compare":
                self.same = self.same and not differs
            if write is not None and differs:
                self.take(write, step)
        elif write is not None and value_of(got) & COB_ID_OFF == 0:
            self.take(write, step)
        return step["step"] + 1

    def run(self):
        number = 1
        while number <= len(self.steps):
            number = self.step(self.steps[number - 1])


def main():
    takt = pathlib.Path(sys.argv[1], "takt")
    boots = 0
    for network in sorted(pathlib.Path(sys.argv[2]).glob("*.yaml")):
        plan = json.loads(subprocess.run([takt, "plan", network, "--json"], check=True, capture_output=True).stdout)
        with tempfile.TemporaryDirectory() as folder:
            frames = frames_of(network, takt, folder)
        for node in plan["nodes"]:
            try:
                Boot(node, frames).run()
            except AssertionError as error:
                sys.exit(f"{network.name}: node {node['id']}: {error}")
            boots += 1
    print(f"{boots} boots sent what their plans say")
    return 0 if boots > 10 else 1


if __name__ == "__main__":
    sys.exit(main())
