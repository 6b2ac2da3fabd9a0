"""Imitates a taktd with two simple drives and an I/O node in this process, and replaces LCM. The first argument of the
program is the folder with the output of `lcm-gen -p`."""
import math
import pathlib
import sys
import types

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python"), sys.argv[1]]

NEXT = {(0x250, 0x06): 0x231, (0x231, 0x07): 0x233, (0x233, 0x0F): 0x237, (0x237, 0x07): 0x233, (0x233, 0x06): 0x231,
        (0x231, 0x00): 0x250, (0x233, 0x00): 0x250, (0x237, 0x00): 0x250,
        (0x218, 0x80): 0x250, (0x237, 0x02): 0x217, (0x217, 0x00): 0x250}  # statusword, controlword: next statusword
IO = 10  # node-ID of the I/O node
# Node, object, is an output, name, data type, bits, scale.
LAYOUT = [(node, *words) for words in ((0x6041, False, "statusword", 6, 16, 1.0), (0x6064, False, "position", 4, 32, 1e-3),
                                       (0x6040, True, "controlword", 6, 16, 1.0), (0x6060, True, "mode", 2, 8, 1.0),
                                       (0x607A, True, "target", 4, 32, 1e-3), (0x60FF, True, "target_velocity", 4, 32, 1e-2),
                                       (0x6071, True, "target_torque", 3, 16, 1e-3))
          for node in (5, 6)] + [(IO, 0x6000, False, "switches", 5, 8, 1.0), (IO, 0x6411, True, "valve", 3, 16, 1e-3)]
NAMES = {5: "shoulder", 6: "elbow", IO: "io"}
MOTION_MODES = (7, 8)  # interpolated and cyclic synchronous position
STEP = 0.5  # of a move in a cycle
PERIOD, LEAD, SLOWING = 0.002, 3, 4  # s; cycles before the begin of a motion, and those of a stop
SHORT, LONG = 0.3, 100.0  # seconds of calls that end by an obstacle, and of the others; the clock is that of the daemon
failures = []


class Drive:
    def __init__(self, node):
        self.node, self.statusword, self.controlword, self.position, self.target, self.velocity = node, 0x250, 0, 0.0, 0.0, 0.0
        self.motion, self.mode = takt.axis_motion_t(), 0
        self.motion.node_id, self.motion.axis = node, 1
        self.targets, self.way = {0x607A: 0, 0x60C1: 0, 0x60FF: 0, 0x6071: 0}, []  # way: set-points of profile position
        self.pending = None  # a motion that is about to begin: its first cycle, command and goal
        self.slowing, self.renewed, self.patience, self.stopped, self.newest = 0, 0, 0, -1, (-1, 0)

    def end(self, outcome):
        if self.motion.id:
            self.motion.ended_id, self.motion.id, self.motion.outcome = self.motion.id, 0, outcome
        self.slowing = 0

    def stop(self, command):
        self.stopped = command.cycle
        if self.pending:
            self.motion.ended_id, self.motion.outcome, self.pending = self.pending[1].id, 2, None
        if self.motion.id and not self.slowing:
            self.slowing = SLOWING

    def begin(self, command, goal, cycle):
        self.end(3)
        self.motion.id, self.velocity = command.id, goal.velocity
        self.target = goal.position + (self.position if command.kind == "move_by" else 0.0)
        self.renewed, self.patience = cycle, command.timeout_ms / 1000 / PERIOD

    def shows(self, index):
        return {0x6041: self.statusword | self.bits(), 0x6064: round(self.position * 1000), 0x6040: self.controlword,
                0x6060: self.mode, **self.targets}[index]

    def take_word(self, index, value):
        """A rising edge of bit 4 hands over a set-point in profile position mode."""
        before, self.controlword = self.controlword, value if index == 0x6040 else self.controlword
        self.mode = value if index == 0x6060 else self.mode
        if self.mode != 1 or self.controlword & ~before & 0x10 == 0 or len(self.way) > 1:
            return
        target = self.targets[0x607A] / 1000 + (self.position if self.controlword & 0x40 else 0.0)
        self.way = [target] if self.controlword & 0x20 else [*self.way, target]

    def bits(self):
        """The bits of the modes in the statusword while the drive is enabled."""
        if self.statusword != 0x237 or self.mode != 1:
            return 0
        return (0 if self.way else 0x400) | (0x1000 if self.controlword & 0x10 or len(self.way) > 1 else 0)

    def drive_itself(self):
        """One cycle in a mode in which the drive itself makes the motions."""
        self.way = self.way if self.statusword == 0x237 else []
        if self.statusword != 0x237 or self.controlword & 0x100:
            return
        if self.mode in (3, 9):
            self.position += self.targets[0x60FF] / 100 * PERIOD
        if self.mode == 1 and self.way:
            left = self.way[0] - self.position
            self.position += math.copysign(min(abs(left), 0.01), left)
            self.way = self.way[self.position == self.way[0]:]

    def objection(self, command):
        if command.cycle <= self.stopped:
            return "it is not newer than the stop of its sender"
        copy = command.kind == "move_by" and self.newest >= (command.cycle, command.utime)
        return "it may be a copy, which must not move the axis again" if copy else ""


def as_command(gear):
    """A gear is a jog whose axes are locked at once."""
    command = takt.motion_command_t()
    command.kind, command.id, command.cycle, command.utime = "gear", gear.id, gear.cycle, gear.utime
    command.sender, command.timeout_ms, command.goals = gear.sender, gear.timeout_ms, gear.goals
    for goal in command.goals:
        goal.velocity = 1.0
    return command


class Stream:
    """The points that taktd has; its axes begin LEAD cycles after the first ones, and go from point to point on straight lines."""

    def __init__(self, message, cycle):
        self.id, self.begin, self.points, self.waiting = message.id, cycle + LEAD, [], []
        self.nodes = [goal.node for goal in message.goals]

    def add(self, message, cycle):
        """Returns the reason why it does not accept all points."""
        if message.first_point > len(self.points):
            return f"its point {len(self.points)} is missing: the message begins with {message.first_point}"
        for point in message.points[len(self.points) - message.first_point:]:
            if sum(known.time > self.time(cycle) for known in self.points) >= 64:
                return f"its point {len(self.points)}: 64 points wait already"
            self.points.append(point)
        return ""

    def time(self, cycle):
        return max(0, cycle - self.begin) * PERIOD

    def left(self, cycle):
        return self.points[-1].time - self.time(cycle)

    def position(self, node, cycle):
        place, now = self.nodes.index(node), self.time(cycle)
        before = max((point for point in self.points if point.time <= now), key=lambda point: point.time)
        after = next((point for point in self.points if point.time > now), before)
        part = (now - before.time) / (after.time - before.time) if after is not before else 0.0
        return before.position[place] + part * (after.position[place] - before.position[place])


class Daemon:
    """Replaces the modules lcm and time: each wait for messages is a cycle."""

    def __init__(self):
        self.drives, self.handlers, self.waiting, self.cycle = [Drive(5), Drive(6)], {}, [], 0
        self.motions, self.active, self.refuses, self.holder, self.sender = True, False, "", "", ""
        self.commands, self.signs, self.released, self.emcy, self.each_cycle = [], 0, 0, 0, lambda daemon: None
        self.loses, self.mute_until, self.refuses_signs = lambda command: False, 0, False
        self.gears, self.streams, self.messages = [], [], 0  # messages of streams
        self.delay, self.late = 0, []  # of motion commands on their way here, in cycles
        self.nmt = []  # command and node-ID of each request
        self.objects, self.mute = {}, False  # of the devices, by SDO: node-ID, index, sub
        self.refuses_targets, self.word_cycle = "", 0  # word_cycle: the cycle of the newest controlword
        self.io, self.io_life, self.stubborn = {0x6000: 0, 0x6411: 0}, 0, False  # stubborn: drives ignore controlwords

    def LCM(self):
        return self

    def monotonic(self):
        return self.cycle * PERIOD

    def time(self):
        return 1.0  # a clock that stands still

    def subscribe(self, channel, handler):
        self.handlers.setdefault(channel.removeprefix("LIFT_"), []).append(handler)

    def publish(self, channel, data):
        if channel == "LIFT_COMMAND":
            command = takt.command_t.decode(data)
            self.sender, self.released = command.sender, self.released + command.release
            for place, value in zip(command.signals, command.values):
                self.take_value(command, *LAYOUT[place][:2], value)
        elif channel == "LIFT_REQUEST":
            self.answer(takt.request_t.decode(data))
        elif channel == "LIFT_MOTION_GEAR":
            self.gears.append(takt.motion_gear_t.decode(data))
            self.late.append((self.cycle + self.delay, as_command(self.gears[-1])))
            self.take_due()
        elif channel == "LIFT_MOTION_STREAM":
            self.messages += 1
            message = takt.motion_stream_t.decode(data)
            if not self.loses(message):
                self.take_points(message)
        elif self.motions:
            self.late.append((self.cycle + self.delay, takt.motion_command_t.decode(data)))
            self.take_due()
        else:
            self.say("motion_refused", "taktd runs no motions: it was started with --no-motions")

    def take_value(self, command, node, index, value):
        if self.holder:
            why = f"'{self.holder}' holds the node"
            return self.say("command_refused", f"command of '{command.sender}' refused: {why}", node)
        if node == IO:
            self.io[index], self.io_life = value, self.cycle + command.time_to_live
        elif index == 0x607A and self.refuses_targets:
            self.say("limit_exceeded", self.refuses_targets, node)
        elif index in self.drives[node - 5].targets:
            self.drives[node - 5].targets[index] = value
        else:
            self.word_cycle = self.cycle if index == 0x6040 else self.word_cycle
            self.drives[node - 5].take_word(index, value)

    def answer(self, request):
        reply, key = takt.reply_t(), (request.node_id, request.index, request.sub)
        reply.schema, reply.session, reply.id, reply.sender = 2, 7, request.id, request.sender
        reply.good = key in self.objects or request.service == "nmt"
        if request.service == "nmt":
            self.nmt.append((request.nmt_command, request.node_id))
        if reply.good and request.service == "sdo_download":
            self.objects[key] = bytes(request.data)
        reply.data = self.objects.get(key, b"")
        reply.size, reply.text = len(reply.data), "" if reply.good else "the device refused it: object does not exist"
        if not self.mute:
            self.waiting.append(("REPLY", reply))

    def take_points(self, message):
        stream = self.streams[-1] if self.streams and self.streams[-1].id == message.id else None
        if not stream and message.first_point:
            return self.refuse(message, "its stream does not run, and a new one begins with point 0")
        if not stream:
            stream = Stream(message, self.cycle)
            self.streams.append(stream)
            for drive in self.drives:
                drive.motion.id = message.id if NAMES[drive.node] in stream.nodes else drive.motion.id
        why = self.refuses or stream.add(message, self.cycle)
        if why:
            self.refuse(message, why)

    def take_due(self):
        while self.late and self.late[0][0] <= self.cycle:
            self.take(self.late.pop(0)[1])

    def take(self, command):
        self.active = True
        drives = [self.drives[0 if goal.node == "shoulder" else 1] for goal in command.goals]
        if command.kind == "alive":
            self.signs += command.num_goals > 0  # without goals it renews no jog
            for drive in drives:
                drive.renewed = self.cycle
            if self.refuses_signs:
                self.refuse(command, "the message is older than its timeout")
            return
        self.commands.append(command)
        if self.loses(command):
            return
        why = self.refuses or next(filter(None, (drive.objection(command) for drive in drives)), "")
        for drive, goal in zip(drives, command.goals):
            if command.kind == "stop":
                drive.stop(command)
            elif why:
                drive.motion.ended_id, drive.motion.outcome = command.id, 4
                self.refuse(command, why)
            else:
                drive.pending, drive.newest = (self.cycle + LEAD, command, goal), (command.cycle, command.utime)

    def refuse(self, command, why):
        self.say("motion_refused", f"motion {command.id} of '{command.sender}' refused: {why}")

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
        for handler in self.handlers[channel]:
            handler(f"LIFT_{channel}", message.encode())
        return 1

    def pass_cycle(self):
        self.cycle += 1
        self.each_cycle(self)
        self.take_due()
        for drive in self.drives:
            self.advance(drive)
        if self.cycle % 10 == 0:
            self.waiting.append(("STATUS", self.status()))
        self.waiting += [("LAYOUT", layout())] if self.cycle % 50 == 1 else []
        self.waiting.append(("IMAGE", self.image()))
        if self.active and self.cycle >= self.mute_until:
            self.waiting.append(("MOTION", self.motion()))

    def advance(self, drive):
        if not self.stubborn:
            drive.statusword = NEXT.get((drive.statusword, drive.controlword & 0x8F), drive.statusword)
        drive.drive_itself()
        if drive.controlword & 0x100 and drive.motion.id and not drive.slowing:
            drive.slowing = SLOWING
        enabled, motion = drive.statusword == 0x237 and drive.mode in MOTION_MODES, drive.motion
        if drive.pending and self.cycle >= drive.pending[0]:
            drive.begin(*drive.pending[1:], self.cycle)
            drive.pending = None
        if motion.id and not enabled:
            self.say("motion_stopped", f"motion {motion.id} has stopped because of {NAMES[drive.node]}: the drive is in fault")
            drive.end(2)
        if motion.id and drive.velocity and self.cycle > drive.renewed + drive.patience and not drive.slowing:
            drive.slowing = SLOWING
        if drive.slowing:
            drive.slowing -= 1
            if not drive.slowing:
                drive.end(2)
        motion.time_left = 0.0
        if motion.id and self.streams and self.streams[-1].id == motion.id:
            stream = self.streams[-1]
            drive.position, motion.time_left = stream.position(NAMES[drive.node], self.cycle), max(0.0, stream.left(self.cycle))
            if not motion.time_left and any(stream.points[-1].velocity):
                self.say("motion_stopped", f"motion {motion.id} has stopped because of {NAMES[drive.node]}: the points of its "
                                           "stream have ended while it moved")
            if not motion.time_left:
                drive.end(2 if any(stream.points[-1].velocity) else 1)
        elif motion.id:
            left = drive.target - drive.position
            drive.position += math.copysign(0.001 if drive.velocity else min(abs(left), STEP), drive.velocity or left)
            if not drive.velocity and drive.position == drive.target:
                drive.end(1)
        motion.state = 0 if not enabled else 3 if drive.slowing else 2 if motion.id else 1
        follows = motion.id and self.gears and self.gears[-1].id == motion.id
        motion.gear, motion.position = 2 if follows else 0, drive.position

    def image(self):
        image = takt.image_t()
        image.schema, image.parts, image.session, image.layout_hash, image.cycle = 2, 1, 7, 1, self.cycle
        image.values = [self.io[index] if node == IO else self.drives[node - 5].shows(index)
                        for node, index, *_ in LAYOUT]
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
            node.node_id, node.name, node.boot_state, node.holder = drive.node, NAMES[drive.node], 2, self.holder or self.sender
            node.nmt_state, node.heartbeat_age_ms = 5, 40
            node.emcys = [self.emcy] if self.emcy else []
            node.num_emcys = len(node.emcys)
            status.nodes.append(node)
        return status


def layout():
    made = takt.layout_t()
    made.schema, made.parts, made.session, made.hash, made.period_ns = 2, 1, 7, 1, 2_000_000
    for node, index, output, name, data_type, bits, scale in LAYOUT:
        signal = takt.signal_t()
        signal.node, signal.node_id, signal.index, signal.output, signal.name = NAMES[node], node, index, output, name
        signal.data_type, signal.bits, signal.scale = data_type, bits, scale
        signal.sub = int(node == IO or index == 0x60C1)
        made.signals.append(signal)
    made.num_signals = made.total_signals = len(made.signals)
    return made


sys.modules["lcm"] = types.ModuleType("lcm")
import takt
from takt import Axes, Obstacle, link


def on_a_bus(*names, longest=LONG):
    daemon = link.lcm = link.time = Daemon()
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


def jogs(velocity=1.0):
    """An axis that jogs."""
    daemon, axes = on_a_bus("shoulder")
    axes.enable()
    axes.jog(velocity)
    return daemon, axes
