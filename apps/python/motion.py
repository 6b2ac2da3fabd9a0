#!/usr/bin/env python3
"""Moves one axis of a bus to a position, or jogs it. taktd runs the motion: this program may be late.

    motion.py BUS NODE POSITION
    motion.py BUS NODE --jog VELOCITY --for SECONDS

How to try it on the simulated bus of share/demo/two_axes.yaml:

    python3 -m venv venv && venv/bin/pip install lcm
    lcm-gen -p --ppath venv/lib/python3*/site-packages share/lcm/*.lcm    # makes the module takt
    taktd share/demo/two_axes.yaml --bus sim --motions &
    venv/bin/python apps/python/motion.py demo shoulder 1.5 --velocity 3 --acceleration 20

The program enables the drive, sends one motion_command_t, and then a sign of life each 50 ms. If it
dies, the axis stops along its limits after the timeout. Ctrl-C stops the axis. share/doc/motion.md
has the rules.

Exit codes: 0 the motion is done, 1 it was refused or has stopped, or the drive can't be enabled,
2 wrong use, 3 no message of a daemon came.
"""
import argparse
import os
import random
import sys
import time

import lcm
from takt import command_t, event_t, image_t, layout_t, motion_command_t, motion_goal_t, motion_t

SCHEMA = 2  # of the LCM messages that this program knows
STATUSWORD, CONTROLWORD, MODE = 0x6041, 0x6040, 0x6060
CYCLIC_SYNCHRONOUS_POSITION = 8  # mode of operation (0x6060)
# The state of the drive is seen in some bits of the statusword; the controlword leads one step on.
STEPS = ((0x4F, 0x08, 0x80), (0x4F, 0x40, 0x06), (0x6F, 0x21, 0x07), (0, 0, 0x0F))
ENABLE_TIME, LAYOUT_TIME = 10.0, 10.0  # seconds
ANSWER_TIME = 2.0
STOPPING = 3  # axis_motion_t::state
DONE = 1  # axis_motion_t::outcome
OUTCOMES = ("still runs", "is done", "has stopped", "was replaced by another one", "was refused")


class Bus:
    """Receives the images and the motions of one bus, and sends commands for one node."""

    def __init__(self, name, node):
        self.node, self.name = node, name.upper()
        self.link = lcm.LCM()  # LCM_DEFAULT_URL, else LCM's default
        self.signals, self.values, self.image, self.motion = {}, {}, None, None
        self.instance = random.SystemRandom().randrange(1, 2**63)  # tells two senders apart
        for channel, handler in (("LAYOUT", self.on_layout), ("IMAGE", self.on_image),
                                 ("MOTION", self.on_motion), ("EVENT", self.on_event)):
            self.link.subscribe(f"{self.name}_{channel}", handler)

    def on_layout(self, channel, data):
        layout = layout_t.decode(data)
        for place, signal in enumerate(layout.signals, layout.first_signal):
            if signal.node == self.node:
                self.signals[signal.index] = (place, signal)

    def on_image(self, channel, data):
        self.image = image_t.decode(data)
        self.values.update(enumerate(self.image.values, self.image.first_signal))

    def on_motion(self, channel, data):
        for axis in motion_t.decode(data).axes:
            if self.signals and axis.node_id == self.signals[STATUSWORD][1].node_id:
                self.motion = axis

    def on_event(self, channel, data):
        event = event_t.decode(data)
        if event.kind in ("motion_refused", "motion_stopped", "command_refused"):
            print(event.text, file=sys.stderr)

    def serve(self, seconds):
        """Handles the messages that come in this time."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.link.handle_timeout(int(left * 1000) + 1)

    def fill(self, message):
        message.schema, message.session, message.cycle = SCHEMA, self.image.session, self.image.cycle
        message.instance, message.sender = self.instance, f"motion.py {os.getpid()}"

    def set(self, outputs):
        command = command_t()
        self.fill(command)
        for index, value in outputs.items():
            command.signals.append(self.signals[index][0])
            command.values.append(value)
        command.num_values = len(command.values)
        self.link.publish(f"{self.name}_COMMAND", command.encode())

    def command(self, kind, goal=None, number=0):
        command = motion_command_t()
        self.fill(command)
        command.kind, command.id = kind, number
        command.goals = [goal] if goal else []
        command.num_goals = len(command.goals)
        self.link.publish(f"{self.name}_MOTION_COMMAND", command.encode())

    def knows(self, number):
        """The daemon has reported the motion."""
        return self.motion is not None and number in (self.motion.id, self.motion.ended_id)

    def has_ended(self, number):
        return self.knows(number) and self.motion.id != number and self.motion.state != STOPPING

    def word(self):
        return self.values[self.signals[STATUSWORD][0]]

    def enable(self):
        """Leads the drive to Operation enabled. Returns False if it does not come there."""
        end = time.monotonic() + ENABLE_TIME
        while self.word() & 0x6F != 0x27 and time.monotonic() < end:
            word = self.word()
            step = next(step for mask, bits, step in STEPS if word & mask == bits)
            outputs = {CONTROLWORD: step, MODE: CYCLIC_SYNCHRONOUS_POSITION}
            self.set({index: value for index, value in outputs.items() if index in self.signals})
            self.serve(0.02)
        return self.word() & 0x6F == 0x27


def arguments():
    parser = argparse.ArgumentParser(description="Moves one axis of a bus; taktd runs the motion.")
    parser.add_argument("bus", help="name of the bus, for example demo")
    parser.add_argument("node", help="name of the node, for example shoulder")
    parser.add_argument("position", type=float, nargs="?", help="where the axis comes to rest")
    parser.add_argument("--jog", type=float, metavar="VELOCITY", help="keep this velocity instead")
    parser.add_argument("--for", type=float, default=2.0, dest="seconds", help="time of the jog (2)")
    for limit in ("velocity", "acceleration", "jerk"):
        parser.add_argument(f"--{limit}", type=float, default=0.0, help=f"limit of {limit} (that of the network file)")
    given = parser.parse_args()
    if (given.position is None) == (given.jog is None):
        parser.error("give a position, or --jog VELOCITY")
    return given


def run(bus, given):
    number = random.randrange(1, 2**31)
    goal = motion_goal_t()
    goal.node, goal.position, goal.velocity = given.node, given.position or 0.0, given.jog or 0.0
    goal.max_velocity, goal.max_acceleration = given.velocity, given.acceleration
    goal.max_jerk = given.jerk
    bus.command("move" if given.jog is None else "jog", goal, number)
    begun = time.monotonic()
    end = float("inf") if given.jog is None else begun + given.seconds
    while not bus.has_ended(number):
        try:
            bus.serve(0.05)
        except KeyboardInterrupt:
            end = begun
        if not bus.knows(number) and time.monotonic() > begun + ANSWER_TIME:
            print("the motion does not begin", file=sys.stderr)
            return 1
        if time.monotonic() < end:
            bus.command("alive", goal)
        else:
            bus.command("stop", goal)
    outcome = OUTCOMES[bus.motion.outcome]
    print(f"the motion {outcome}: {given.node} is at {bus.motion.actual_position:.4f}")
    return 0 if bus.motion.outcome == DONE or time.monotonic() >= end > begun else 1


def main():
    given = arguments()
    bus = Bus(given.bus, given.node)
    end = time.monotonic() + LAYOUT_TIME
    while (bus.image is None or STATUSWORD not in bus.signals) and time.monotonic() < end:
        bus.serve(0.1)
    if bus.image is None:
        print(f"no image of bus {given.bus} has come: is taktd running?", file=sys.stderr)
        return 3
    if STATUSWORD not in bus.signals:
        print(f"bus {given.bus} has no drive '{given.node}'", file=sys.stderr)
        return 2
    if not bus.enable():
        print(f"{given.node} does not reach Operation enabled: statusword {bus.word() & 0xFFFF:04x}", file=sys.stderr)
        return 1
    return run(bus, given)


if __name__ == "__main__":
    sys.exit(main())
