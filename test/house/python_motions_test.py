#!/usr/bin/env python3
"""python_motions_test.py TYPES - apps/python/takt_axes.py on a taktd of two simple drives in this process.
TYPES: folder of what `lcm-gen -p` made."""
import math
import pathlib
import sys

sys.path[:0] = [sys.argv[1], str(pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python")]
import takt

NEXT = {(0x250, 0x06): 0x231, (0x231, 0x07): 0x233, (0x233, 0x0F): 0x237, (0x237, 0x07): 0x233, (0x233, 0x06): 0x231,
        (0x231, 0x00): 0x250, (0x218, 0x80): 0x250}  # statusword, controlword: next statusword
LAYOUT = [(index, node, index == 0x6040) for index in (0x6041, 0x6064, 0x6040) for node in (5, 6)]
NAMES = {5: "shoulder", 6: "elbow"}
STEP = 0.5  # of a move in a cycle
SHORT, LONG = 0.3, 100.0  # seconds of calls that end by an obstacle, and of the others
failures = []


class Drive:
    def __init__(self, node):
        self.node, self.statusword, self.controlword, self.position, self.target, self.velocity = node, 0x250, 0, 0.0, 0.0, 0.0
        self.motion = takt.axis_motion_t()
        self.motion.node_id, self.motion.axis = node, 1

    def end(self, outcome):
        if self.motion.id:
            self.motion.ended_id, self.motion.id, self.motion.outcome = self.motion.id, 0, outcome


class Daemon:
    """In the place of module lcm: each wait for messages is a cycle."""

    def __init__(self):
        self.drives, self.handlers, self.waiting, self.cycle = [Drive(5), Drive(6)], {}, [], 0
        self.motions, self.active, self.refuses, self.holder, self.sender = True, False, "", "", ""
        self.commands, self.signs, self.released, self.emcy, self.each_cycle = [], 0, 0, 0, lambda daemon: None

    def LCM(self):
        return self

    def subscribe(self, channel, handler):
        self.handlers[channel.removeprefix("LIFT_")] = handler

    def publish(self, channel, data):
        if channel == "LIFT_COMMAND":
            command = takt.command_t.decode(data)
            self.sender, self.released = command.sender, self.released + command.release
            for place, value in zip(command.signals, command.values):
                if not self.holder:
                    self.drives[place - 4].controlword = value
        elif self.motions:
            self.take(takt.motion_command_t.decode(data))
        else:
            self.say("motion_refused", "taktd runs no motions: it was started without --motions")

    def take(self, command):
        self.active = True
        if command.kind == "alive":
            self.signs += command.num_goals > 0  # without goals it renews no jog
            return
        self.commands.append(command)
        for goal in command.goals:
            drive = self.drives[0 if goal.node == "shoulder" else 1]
            if command.kind == "stop":
                drive.end(2)
            elif self.refuses:
                drive.motion.ended_id, drive.motion.outcome = command.id, 4
                self.say("motion_refused", f"motion {command.id} of '{command.sender}' refused: {self.refuses}")
            else:
                drive.end(3)
                drive.motion.id, drive.target, drive.velocity = command.id, goal.position, goal.velocity

    def say(self, kind, text, node=0):
        event = takt.event_t()
        event.schema, event.session, event.kind, event.severity, event.text, event.node_id = 2, 7, kind, 1, text, node
        self.waiting.append(("EVENT", event))

    def handle_timeout(self, milliseconds):
        if not self.waiting and milliseconds == 0:
            return 0
        if not self.waiting:
            self.pass_cycle()
        channel, message = self.waiting.pop(0)
        self.handlers[channel](f"LIFT_{channel}", message.encode())
        return 1

    def pass_cycle(self):
        self.cycle += 1
        self.each_cycle(self)
        for drive in self.drives:
            self.advance(drive)
        if self.cycle % 10 == 0:
            self.waiting.append(("STATUS", self.status()))
        self.waiting += [("LAYOUT", layout())] if self.cycle % 50 == 1 else []
        self.waiting.append(("IMAGE", self.image()))
        if self.active:
            self.waiting.append(("MOTION", self.motion()))

    def advance(self, drive):
        drive.statusword = NEXT.get((drive.statusword, drive.controlword), drive.statusword)
        enabled, motion = drive.statusword == 0x237, drive.motion
        if motion.id and not enabled:
            self.say("motion_stopped", f"motion {motion.id} has stopped because of {NAMES[drive.node]}: the drive is in fault")
            drive.end(2)
        if motion.id:
            left = drive.target - drive.position
            drive.position += math.copysign(0.001 if drive.velocity else min(abs(left), STEP), drive.velocity or left)
            if not drive.velocity and drive.position == drive.target:
                drive.end(1)
        motion.state, motion.position = 0 if not enabled else 2 if motion.id else 1, drive.position

    def image(self):
        image = takt.image_t()
        image.schema, image.parts, image.session, image.layout_hash, image.cycle = 2, 1, 7, 1, self.cycle
        image.values = ([drive.statusword for drive in self.drives] + [round(drive.position * 1000) for drive in self.drives] +
                        [drive.controlword for drive in self.drives])
        image.num_values = len(image.values)
        return image

    def motion(self):
        motion = takt.motion_t()
        motion.schema, motion.parts, motion.session, motion.cycle = 2, 1, 7, self.cycle
        motion.axes, motion.num_axes = [drive.motion for drive in self.drives], 2
        return motion

    def status(self):
        status = takt.status_t()
        status.schema, status.session, status.num_nodes = 2, 7, 2
        status.diagnosis = takt.diagnosis_t()
        for drive in self.drives:
            node = takt.node_status_t()
            node.node_id, node.boot_state, node.holder = drive.node, 2, self.holder or self.sender
            node.emcys = [self.emcy] if self.emcy else []
            node.num_emcys = len(node.emcys)
            status.nodes.append(node)
        return status


def layout():
    made = takt.layout_t()
    made.schema, made.parts, made.session, made.hash, made.period_ns = 2, 1, 7, 1, 2_000_000
    for index, node, output in LAYOUT:
        signal = takt.signal_t()
        signal.node, signal.node_id, signal.index, signal.output = NAMES[node], node, index, output
        signal.scale = 1e-3 if index == 0x6064 else 1.0
        made.signals.append(signal)
    made.num_signals = made.total_signals = len(made.signals)
    return made


sys.modules["lcm"] = Daemon()
import takt_axes
from takt_axes import Axes, Obstacle


def on_a_bus(*names, longest=LONG):
    daemon = takt_axes.lcm = Daemon()
    return daemon, Axes("lift", *names, longest=longest)


def check(name, good, told=""):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print(f"      {told}")


def obstacle(call, *values, **limits):
    """The kind and the text of the obstacle that the call raises."""
    try:
        call(*values, **limits)
    except Obstacle as why:
        return why.kind, str(why)
    return "none", ""


daemon, axes = on_a_bus()
axes.enable()
axes.move(2.0, -1.0, velocity=3, acceleration=[4, 5])
goals = daemon.commands[0].goals
check("the axes move together to their targets", axes.positions == [2.0, -1.0] and len(goals) == 2, axes.positions)
check("a command has the limits", (goals[1].max_velocity, goals[1].max_acceleration, goals[1].max_jerk) == (3, 5, 0))
axes.move_by(-0.5, 0.5)
check("they move from where they are", axes.commanded_positions == [1.5, -0.5], axes.commanded_positions)
check("they want one value for each axis", obstacle(axes.move, 1.0)[0] == "wrong use")
daemon.refuses = "the axis would leave its range of positions"
kind, text = obstacle(axes.move, 200.0, 0.0)
check("a refusal has its reason", kind == "refused" and "would leave its range" in text, (kind, text))
axes.disable()
check("they are disabled and given up", {drive.statusword for drive in daemon.drives} == {0x250} and daemon.released == 1)

daemon, axes = on_a_bus("elbow")
with axes:
    axes.enable()
    check("the other axis is left alone", [drive.statusword for drive in daemon.drives] == [0x250, 0x237])
    axes.jog(-1.0)
    signs = daemon.signs
    axes.run(SHORT)
    check("the program stays alive while a call waits", axes.moving and daemon.signs > signs)
    axes.stop()
    check("a stop ends the jog", not axes.moving and axes.positions[0] < 0 and daemon.commands[-1].kind == "stop")
    axes.move(0.0)
    check("a move comes from an image after the stop", daemon.commands[-1].cycle > daemon.commands[-2].cycle)
check("the end of the block disables them", daemon.drives[1].statusword == 0x250 and daemon.released == 1)


def trip(daemon):
    if daemon.drives[0].position > 1.0:
        daemon.drives[0].statusword = 0x218


daemon, axes = on_a_bus()
daemon.emcy, daemon.each_cycle = 0x7305, trip
axes.enable()
kind, text = obstacle(axes.move, 5.0, 5.0)
check("a fault is named with its bit and its code", kind == "stopped" and "the drive is in fault" in text and
      "bit 3 (fault) of its statusword 0x0218 is 1" in text and "0x7305" in text, (kind, text))
daemon.each_cycle = lambda daemon: None
kind, text = obstacle(axes.enable)
check("a fault is not reset by enabling", kind == "blocked" and "shoulder: not enabled, fault" in text, (kind, text))
axes.reset()
axes.enable()
check("a reset ends it", daemon.drives[0].statusword == 0x237)

daemon, axes = on_a_bus("shoulder", longest=SHORT)
daemon.drives[0].statusword = 0x240
daemon.each_cycle = lambda daemon: setattr(daemon.drives[0], "statusword", 0x240)
kind, text = obstacle(axes.enable)
check("the bits are named that keep a drive from being enabled", kind == "blocked" and "bit 6 (switch on disabled)" in text and
      "bit 4 (voltage enabled) is 0" in text, (kind, text))
check("a drive that is not enabled does not move", obstacle(axes.move, 1.0)[0] == "blocked" and not daemon.commands)

daemon, axes = on_a_bus()
daemon.motions = False
check("a taktd without motions is named", "it was started without --motions" in obstacle(axes.enable)[1])
daemon, axes = on_a_bus()
daemon.holder = "another"
check("another program is named", "shoulder belongs to 'another'" in obstacle(axes.enable)[1])
kind, text = obstacle(on_a_bus, "wrist")
check("a wrong name is told the right ones", kind == "wrong use" and text.endswith("the axes are: shoulder, elbow"), text)
check("a timeout that taktd refuses is refused", obstacle(Axes, "lift", timeout=20.0)[0] == "wrong use")
sys.exit(1 if failures else 0)
