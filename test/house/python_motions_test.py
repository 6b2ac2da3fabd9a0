#!/usr/bin/env python3
"""python_motions_test.py TYPES - apps/python/takt_axes.py on a taktd of two simple drives in this process.
TYPES: folder of what `lcm-gen -p` made."""
import math
import pathlib
import sys

sys.path[:0] = [sys.argv[1], str(pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python")]
import takt

NEXT = {(0x250, 0x06): 0x231, (0x231, 0x07): 0x233, (0x233, 0x0F): 0x237, (0x237, 0x07): 0x233, (0x233, 0x06): 0x231,
        (0x231, 0x00): 0x250, (0x233, 0x00): 0x250, (0x237, 0x00): 0x250,
        (0x218, 0x80): 0x250}  # statusword, controlword: next statusword
LAYOUT = [(index, node, index in (0x6040, 0x6060)) for index in (0x6041, 0x6064, 0x6040, 0x6060) for node in (5, 6)]
NAMES = {5: "shoulder", 6: "elbow"}
STEP = 0.5  # of a move in a cycle
PERIOD, LEAD, SLOWING = 0.002, 3, 4  # s; cycles before the begin of a motion, and those of a stop
SHORT, LONG = 0.3, 100.0  # seconds of calls that end by an obstacle, and of the others; the clock is that of the daemon
failures = []


class Drive:
    def __init__(self, node):
        self.node, self.statusword, self.controlword, self.position, self.target, self.velocity = node, 0x250, 0, 0.0, 0.0, 0.0
        self.motion, self.mode = takt.axis_motion_t(), 0
        self.motion.node_id, self.motion.axis = node, 1
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
        """Returns why it takes not all of the points."""
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
    """In the place of the modules lcm and time: each wait for messages is a cycle."""

    def __init__(self):
        self.drives, self.handlers, self.waiting, self.cycle = [Drive(5), Drive(6)], {}, [], 0
        self.motions, self.active, self.refuses, self.holder, self.sender = True, False, "", "", ""
        self.commands, self.signs, self.released, self.emcy, self.each_cycle = [], 0, 0, 0, lambda daemon: None
        self.loses, self.mute_until, self.refuses_signs = lambda command: False, 0, False
        self.gears, self.streams, self.messages = [], [], 0  # messages of streams
        self.delay, self.late = 0, []  # of motion commands on their way here, in cycles

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
                if not self.holder:
                    setattr(self.drives[place % 2], "controlword" if place < 6 else "mode", value)
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
                self.refuse(command, "it is older than its timeout")
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
        drive.statusword = NEXT.get((drive.statusword, drive.controlword), drive.statusword)
        enabled, motion = drive.statusword == 0x237 and drive.mode == 8, drive.motion
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
        image.values = ([drive.statusword for drive in self.drives] + [round(drive.position * 1000) for drive in self.drives] +
                        [drive.controlword for drive in self.drives] + [drive.mode for drive in self.drives])
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
import takt_link
from takt_axes import Axes, Obstacle


def on_a_bus(*names, longest=LONG):
    daemon = takt_link.lcm = takt_link.time = Daemon()
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
daemon, axes = on_a_bus()
axes.enable()
axes.gear("wheel", signal="position_value", ratio=[0.5, -2], phase=3.0, modulo=4096, velocity=4)
axes.wait_locked(LONG)
gear = daemon.gears[0]
check("axes follow the input of a node", axes.locked and (gear.leader, gear.signal, gear.phase) == ("wheel", "position_value", "at"))
check("a gear has its numbers", (gear.numerator, gear.modulo, gear.goals[1].position, gear.goals[1].max_velocity)
      == ((0.5, -2.0), 4096.0, 3.0, 4.0), gear.numerator)
axes.stop()
check("a stop ends a gear", not axes.locked and not axes.moving)
axes.gear("gantry.2")
check("an axis of a device can lead", (daemon.gears[1].leader, daemon.gears[1].leader_axis, daemon.gears[1].phase)
      == ("gantry", 2, "here"))
axes.stop()
daemon.refuses = "its leader 'wheel' is no node of the bus"
check("a refused gear says why", obstacle(axes.gear, "wheel")[0] == "refused")
daemon.refuses = ""
daemon, axes = on_a_bus()
axes.enable()
axes.begin_move(3.0, -2.0)
axes.move_by(0.25, 0.25)
newest = daemon.commands[-2:]
check("taktd itself adds the distances", newest[1].kind == "move_by" and newest[1].goals[0].position == 0.25)
check("two motions have different times, also if the clock stands still", newest[0].utime < newest[1].utime)
daemon.mute_until = daemon.cycle + 50
axes.begin_move(2.0, 2.0)
axes.run(20 * PERIOD)
axes.move_by(0.25, 0.25)
check("they move from where they are, not from where they were", axes.positions == [2.25, 2.25], axes.positions)
daemon.refuses_signs = True
check("a sign of life that is refused refuses no motion", obstacle(axes.move, 200.0, 0.0)[0] == "none" and
      not daemon.signs)
daemon.refuses_signs = False
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




def jogs(velocity=1.0):
    daemon, axes = on_a_bus("shoulder")
    axes.enable()
    axes.jog(velocity)
    return daemon, axes


def loses_first(number, kind):
    """What loses the first messages of this kind."""
    left = [number]

    def loses(command):
        left[0] -= command.kind == kind
        return command.kind == kind and left[0] >= 0
    return loses


def stays(axes, after=0.0):
    """Whether the axes stand after so many seconds, and go on doing so."""
    axes.run(after)
    before = axes.positions
    axes.run(2.0)
    return not axes.moving and axes.positions == before


daemon, axes = jogs()
axes.run(5.0)
check("a jog outlives its timeout while a call waits", axes.moving and daemon.signs > 50, daemon.signs)
signs, daemon.loses = daemon.signs, loses_first(3, "stop")
axes.stop()
stops = [command for command in daemon.commands if command.kind == "stop"]
check("a stop is repeated until the axes stand", len(stops) == 4 and not axes.moving, len(stops))
check("with a pause, and from newer images", all(b.cycle > a.cycle for a, b in zip(stops, stops[1:])) and
      stops[-1].cycle >= stops[1].cycle + 50, [stop.cycle for stop in stops])
check("a stop renews no jog", daemon.signs == signs, daemon.signs - signs)
check("nor does anything after it", stays(axes) and daemon.signs == signs)
axes.jog(1.0)
signs, daemon.loses = daemon.signs, loses_first(3, "stop")
axes.disable()
check("the end renews no jog", daemon.signs == signs and daemon.drives[0].statusword == 0x250, daemon.signs - signs)

daemon, axes = jogs()
for _ in range(30):  # the program computes, while messages wait for it
    daemon.pass_cycle()
newest = daemon.cycle
axes.stop()
stop = next(command for command in daemon.commands if command.kind == "stop")
check("a stop is from the newest image", stop.cycle >= newest, (stop.cycle, newest))

daemon, axes = jogs()
signs, daemon.refuses = daemon.signs, "no"
check("a jog that is refused", obstacle(axes.jog, 2.0)[0] == "refused" and daemon.commands[-1].kind == "stop")
daemon.refuses = ""
check("ends the one before it", stays(axes, after=0.02) and daemon.signs == signs, daemon.signs - signs)
daemon, axes = jogs()
daemon.loses = lambda command: True
kind, text = obstacle(axes.jog, 2.0)
check("a jog without an answer", kind == "refused" and "not answered" in text and daemon.commands[-1].kind == "stop", text)
signs = daemon.signs
check("ends the one before it, also if the stop is lost", stays(axes, after=0.6) and daemon.signs == signs)
for wrong in (lambda axes: axes.jog(1.0, 2.0), lambda axes: axes.jog(1.0, speed=1)):
    daemon, axes = jogs()
    try:
        wrong(axes)
    except (Obstacle, TypeError):
        pass
    signs = daemon.signs
    check("so does a wrong use", daemon.commands[-1].kind == "stop" and stays(axes, after=0.02) and daemon.signs == signs)
daemon, axes = jogs()
daemon.loses = lambda command: command.kind == "move"
axes.begin_move(5.0)
signs = daemon.signs
axes.run(2.0)
check("another motion renews no jog", not axes.moving and daemon.signs == signs, daemon.signs - signs)


def interrupt(daemon):
    daemon.each_cycle = lambda daemon: None
    raise KeyboardInterrupt


daemon, axes = jogs()
daemon.each_cycle = interrupt
try:
    axes.run(1.0)
except KeyboardInterrupt:
    pass
signs = daemon.signs
axes.run(2.0)
check("after an exception nothing renews a jog", not axes.moving and daemon.signs == signs, daemon.signs - signs)

daemon, axes = jogs()
daemon.drives[0].statusword = 0x218
kind, text = obstacle(axes.wait)
signs = daemon.signs
axes.run(2.0)
check("nor after the end of the jog", kind == "stopped" and daemon.signs == signs, (kind, daemon.signs - signs))

daemon, axes = on_a_bus("shoulder")
axes.enable()
axes.begin_move(50.0)
daemon.refuses = "no"
axes.begin_move(60.0)
axes.run(0.0)
check("a motion is about to begin while a newer one is refused", not axes.moving and daemon.drives[0].pending)
daemon.loses, daemon.mute_until = loses_first(1, "stop"), daemon.cycle + 40
axes.stop()
check("a stop ends it", daemon.commands[-1].kind == "stop" and stays(axes) and axes.positions[0] < 5.0, axes.positions)
check("and returns when newer motions are reported", daemon.cycle >= daemon.mute_until)
daemon.refuses = ""
axes.begin_move(50.0)
daemon.refuses, daemon.loses = "no", loses_first(4, "stop")
axes.begin_move(60.0)
axes.run(0.0)
axes.stop()
check("also if it moves before a stop arrives", stays(axes) and 0.0 < axes.positions[0] < 50.0, axes.positions)
daemon.refuses, daemon.delay, daemon.loses = "", 30, loses_first(2, "stop")
axes.begin_move(500.0)
axes.stop()
check("also if taktd takes the motion late", stays(axes) and axes.positions[0] < 500.0, axes.positions)
daemon.delay, daemon.loses = 0, loses_first(1, "move")
axes.begin_move(-50.0)
axes.stop()
number = len(daemon.commands)
axes.stop()
check("a stop of axes that a stop has led to rest sends nothing", len(daemon.commands) == number and not axes.moving)

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

daemon, axes = on_a_bus()
seen = []
axes.enable()
axes.begin_move(0.0, 1000.0)
axes.run(0.1)
daemon.drives[0].statusword = 0x218
axes.run(0.0)
daemon.each_cycle = lambda daemon: seen.append((daemon.drives[0].controlword, daemon.drives[1].statusword,
                                                daemon.drives[1].motion.state))
axes.reset()
axes.run(0.0)
check("a reset leaves the other axis enabled", {word for _, word, _ in seen} == {0x237} and daemon.drives[0].statusword == 0x250)
check("and stops it first", {state for word, _, state in seen if word == 0x80} == {1})
daemon.drives[0].statusword = 0x218
axes.run(0.0)
seen.clear()
axes.set_mode(1)
axes.run(0.0)
check("another mode leaves it enabled", {word for _, word, _ in seen} == {0x237} and daemon.drives[1].mode == 1)

daemon, axes = on_a_bus("shoulder", longest=SHORT)
daemon.drives[0].statusword = 0x240
daemon.each_cycle = lambda daemon: setattr(daemon.drives[0], "statusword", 0x240)
kind, text = obstacle(axes.enable)
check("the bits are named that keep a drive from being enabled", kind == "blocked" and "bit 6 (switch on disabled)" in text and
      "bit 4 (voltage enabled) is 0" in text, (kind, text))
check("a drive that is not enabled does not move", obstacle(axes.move, 1.0)[0] == "blocked" and not daemon.commands)

daemon, axes = on_a_bus("shoulder")
axes.enable()
other = Axes("lift", "shoulder")
other.run(0.1)
kind, text = obstacle(other.move, 1.0)
check("a drive that another object has enabled does not move", (kind, text) == ("blocked", "shoulder: call enable() first"), text)
check("two objects of one program have different names", other.sender != axes.sender and
      other.sender.split()[:2] == axes.sender.split()[:2], other.sender)
axes.disable()
check("nor does one after disable()", "call enable() first" in obstacle(axes.jog, 1.0)[1])


def path(end, step):
    """Points of a path that is at rest at 0 s and at 1 s, 2 s ..."""
    for number in range(1, round(end / step) + 1):
        angle = 2 * math.pi * number * step
        velocity = 2 * math.pi * math.sin(angle)
        yield number * step, [1 - math.cos(angle)] * 2, [velocity if abs(velocity) > 1e-9 else 0.0] * 2


def streams(points, loses=None):
    """Enabled axes that are given points, two at a time."""
    daemon, axes = on_a_bus()
    daemon.loses = loses or daemon.loses
    axes.enable()
    axes.begin_stream(velocity=3)
    points = list(points)
    for place in range(0, len(points), 2):
        axes.stream(*points[place:place + 2])
    return daemon, axes


daemon, axes = streams(path(2.0, 0.02))
check("a program is ahead of its stream", 0.3 < axes.stream_left < 0.5 and axes.moving, axes.stream_left)
axes.wait()
check("a stream ends in order", axes.commanded_positions == [0.0, 0.0] and not axes.moving and axes.stream_left == 0.0)
check("all points have come once", len(daemon.streams[0].points) == 101 and daemon.messages < 2.2 / 0.02, daemon.messages)
check("nothing was refused", not axes._link.events, axes._link.events)
lost = iter(range(1000))
daemon, axes = streams(path(2.0, 0.02), lambda message: not isinstance(message, takt.motion_command_t) and next(lost) % 3 == 0)
axes.wait()
check("a stream outlives messages that are lost", len(daemon.streams[0].points) == 101 and not axes._link.events)
daemon, axes = streams(path(1.0, 0.004))
axes.wait()
check("many points do not flood taktd", len(daemon.streams[0].points) == 251 and not axes._link.events, axes._link.events)
daemon, axes = on_a_bus()
axes.enable()
axes.begin_stream()
axes.stream((0.3, [0.01, 0.02], [0, 0], [0, 0]))
axes.run(0.1)
check("few points wait for more", not daemon.messages)
axes.wait()
check("or for wait()", axes.commanded_positions == [0.01, 0.02])
daemon, axes = streams(path(0.8, 0.02))
for _ in range(500):
    daemon.pass_cycle()
kind, text = obstacle(axes.stream, (0.82, [0, 0], [0, 0]))
check("points that have ended are named", kind == "stopped" and "the points of its stream have ended while it moved" in text, (kind, text))
messages = daemon.messages
kind, text = obstacle(axes.stream, (0.84, [0, 0], [0, 0]))
check("then no points are taken", kind == "wrong use" and "begin_stream()" in text, (kind, text))
axes.run(0.5)
check("nor sent", daemon.messages == messages)
daemon, axes = streams(path(0.8, 0.02))
daemon.refuses = "its point 41: the axis would leave its range of positions"
kind, text = obstacle(lambda: (axes.stream((0.82, [9, 9], [0, 0])), axes.wait()))
check("a refused point is named", kind == "refused" and "its point 41" in text, (kind, text))
for wrong in ((0.1, [0], [0, 0]), (-1.0, [0, 0], [0, 0]), (5.0, [0, 0], [0, 0]), (math.nan, [0, 0], [0, 0])):
    daemon, axes = on_a_bus()
    axes.enable()
    axes.begin_stream()
    kind, text = obstacle(axes.stream, wrong)
    check("a wrong point is named", kind == "wrong use" and "point 1 of the stream" in text and not daemon.messages, (kind, text))
daemon, axes = streams(path(0.8, 0.02))
check("no other motion begins during a stream", "follow a stream: call wait() or stop()" in obstacle(axes.move, 0, 0)[1])
daemon.each_cycle = interrupt
try:
    axes.run(1.0)
except KeyboardInterrupt:
    pass
messages = daemon.messages
axes.run(2.0)
check("after an exception no points are sent", daemon.messages == messages and not axes.moving)
daemon.each_cycle = lambda daemon: None
axes.begin_move(50.0, 50.0)
axes.run(0.05)
check("a stream begins at rest", "a stream begins at rest" in obstacle(axes.begin_stream)[1])


class Homing:
    """Two drives that home in 20 cycles by the method of a device. `result`: the statusword at the end."""

    def __init__(self, result=0x1637):
        self.result, self.runs, self.both = result, {5: 0, 6: 0}, False

    def __call__(self, daemon):
        homing = [drive for drive in daemon.drives if drive.mode == 6 and drive.statusword & 0x6F == 0x27]
        self.both |= len(homing) == 2
        for drive in daemon.drives:
            if drive not in homing:
                drive.statusword = 0x237 if drive.statusword & 0x6F == 0x27 else drive.statusword
            elif not drive.controlword & 0x10:
                drive.statusword, self.runs[drive.node] = 0x637, 0
                drive.motion.homing = 0 if drive.motion.homing == 1 else drive.motion.homing
            else:
                self.run(drive)

    def run(self, drive):
        self.runs[drive.node] += 1
        if self.runs[drive.node] < 20 or not self.result:
            drive.statusword, drive.motion.homing, drive.position = 0x237, 1, drive.position + 0.1
        elif drive.statusword != self.result:
            drive.statusword, drive.motion.homing, drive.position = self.result, 2 if self.result == 0x1637 else 3, 0.0


daemon, axes = on_a_bus()
daemon.each_cycle = Homing()
axes.home()
check("axes are enabled and homed one after the other", axes.homed == [True, True] and not daemon.each_cycle.both and
      axes.positions == [0.0, 0.0], (axes.homed, axes.positions))
check("they are back in cyclic synchronous position", [drive.mode for drive in daemon.drives] == [8, 8] and
      not any(drive.controlword & 0x10 for drive in daemon.drives))
axes.move(1.0, 1.0)
axes.home(together=True)
check("or together", daemon.each_cycle.both and axes.homed == [True, True])
daemon.each_cycle.result, daemon.emcy = 0x2637, 0x7320
kind, text = obstacle(axes.home)
check("a homing error is named", kind == "stopped" and "shoulder: the drive reports a homing error: bit 13" in text, (kind, text))
check("the axis is back in its mode", daemon.drives[0].mode == 8 and not daemon.drives[0].controlword & 0x10 and
      axes.homed == [False, True])
daemon.each_cycle.result = 0
kind, text = obstacle(axes.home, seconds=SHORT)
check("a homing has a time limit", kind == "time over" and "shoulder: the homing has not ended after 0.3 s" in text, (kind, text))
check("and ends with it", daemon.drives[0].mode == 8 and not daemon.drives[0].controlword & 0x10)
daemon.each_cycle = lambda daemon: setattr(daemon.drives[0], "statusword", 0x637)
kind, text = obstacle(axes.home)
check("a drive that does not begin is named", kind == "stopped" and "has not begun the homing" in text, (kind, text))

daemon, axes = on_a_bus("shoulder")
homing = Homing(0)


def fault_in_run(daemon):
    homing(daemon)
    if homing.runs[5] > 10:
        daemon.drives[0].statusword = 0x218


daemon.each_cycle = fault_in_run
kind, text = obstacle(axes.home)
check("a fault ends the homing", kind == "stopped" and "the homing was interrupted" in text and "bit 3 (fault)" in text, (kind, text))

daemon, axes = on_a_bus()
daemon.motions = False
check("a taktd without motions is named", "it was started with --no-motions" in obstacle(axes.enable)[1])
daemon, axes = on_a_bus()
daemon.holder = "another"
check("another program is named", "shoulder belongs to 'another'" in obstacle(axes.enable)[1])
kind, text = obstacle(on_a_bus, "wrist")
check("a wrong name is told the right ones", kind == "wrong use" and text.endswith("the axes are: shoulder, elbow"), text)
check("a timeout that taktd refuses is refused", obstacle(Axes, "lift", timeout=20.0)[0] == "wrong use")
sys.exit(1 if failures else 0)
