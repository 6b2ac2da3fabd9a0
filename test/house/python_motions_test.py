#!/usr/bin/env python3
"""python_motions_test.py TYPES - tests the motions of takt.Axes on the bus of python_daemon.py."""
import math
import sys

from python_daemon import LONG, PERIOD, SHORT, check, failures, jogs, obstacle, on_a_bus, takt
from takt import Axes, Obstacle
from takt.stream import LEAD, StreamBuffer


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



def loses_first(number, kind):
    """A daemon that loses the first messages of this kind."""
    left = [number]

    def loses(command):
        left[0] -= command.kind == kind
        return command.kind == kind and left[0] >= 0
    return loses


def stays(axes, after=0.0):
    """Whether the axes are at standstill `after` this number of seconds, and stay there."""
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
    """Enabled axes that get two points at a time."""
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

buffer = StreamBuffer([0.0], PERIOD, [])
buffer.add(LEAD - 1e-12, [0.0], [0.0])
check("a point is not early because its time was rounded", not buffer.has_room())


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
