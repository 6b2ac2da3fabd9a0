#!/usr/bin/env python3
"""python_speed_test.py TYPES - tests the words that takt.speed computes for speed axes."""
import pathlib
import sys
import types

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python"), sys.argv[1]]
from takt import speed
from takt.speed import FAULT, OFF, READY, RUNNING, STANDING, SpeedAxis, SpeedDrives

PERIOD = 0.01
failures = []


def pattern(mask=0, *values):
    return types.SimpleNamespace(mask=mask, values=list(values))


def words(**changes):
    """The words of a DRV-28: signals 0 and 1 are its status word and frequency, 2 and 3 its control word and set
    frequency."""
    axis = types.SimpleNamespace(
        node="pump", node_id=4, sequence=0, fault_reset=0, status=0, actual_speed=1, control=2, set_speed=3, off=5, stop=5, run=1,
        run_reverse=2, quick_stop=6, reset=7, ready=pattern(0xFF, 1, 2, 3), running=pattern(0xFF, 1, 2), reverse=pattern(0xFF, 2),
        at_speed=pattern(), standstill=pattern(0xFF, 3), fault=pattern(0xFF, 4), unit="Hz", set_scale=0.01, actual_scale=0.01,
        max_speed=50.0, max_acceleration=0.0)
    vars(axis).update(changes)
    return axis


class Drive:
    """An axis, and the images that it gets."""

    def __init__(self, data_type=6, **changes):
        signal = types.SimpleNamespace(data_type=data_type, bits=16)
        self.axis, self.cycle = SpeedAxis(words(**changes), {3: signal}), 0

    def image(self, status, speed=0, stale=()):
        self.cycle += 1
        self.axis.read({0: status, 1: speed}, set(stale))
        self.axis.step(set(stale), self.cycle, PERIOD)
        return self.axis.control, self.axis.raw


def check(name, good, told=""):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print(f"      {told}")


drive = Drive()
check("an axis is off at first", drive.image(3) == (5, 0))
drive.axis.want(RUNNING, 20)
check("an axis runs forward", drive.image(3) == (1, 2000) and not drive.axis.runs)
check("the status word shows that it runs", drive.image(1, 2000) == (1, 2000) and drive.axis.runs and drive.axis.speed == 20)
drive.axis.want(RUNNING, -5)
check("an axis runs backward, with a set speed without a sign", drive.image(2, 500) == (2, 500) and drive.axis.speed == -5)
drive.axis.want(STANDING)
check("an axis stops", drive.image(2, 300) == (5, 0) and not drive.axis.stands)
drive.image(3)
check("an axis that stands says so", drive.axis.stands)

drive = Drive()
drive.axis.want(RUNNING, 20)
drive.image(4)
check("a fault turns the axis off", drive.axis.state == FAULT and drive.axis.goal == OFF and drive.axis.control == 5)
drive.axis.reset_steps = 0
sent = [drive.image(4)[0] for _ in range(5)]
check("a reset begins with another command", sent == [5, 5, 5, 7, 7], sent)
drive.image(3)
check("an axis is ready after a reset, and does not run", drive.axis.state == READY and drive.axis.control == 5)

drive = Drive()
drive.axis.want(RUNNING, 1, acceleration=10)
speeds = [drive.image(1)[1] for _ in range(12)]
check("the set speed keeps the acceleration", speeds == [10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 100, 100], speeds)

drive = Drive(data_type=3, run_reverse=-1, reverse=pattern())
drive.axis.want(RUNNING, -20)
check("a set speed with a sign needs no command for backward", drive.image(1) == (1, -2000))
check("a speed has to fit its object", drive.axis.can_hold(-300) and not drive.axis.can_hold(400) and not Drive().axis.can_hold(700))

drive = Drive(sequence=1, run=0x7F, stop=0x3F, off=0, run_reverse=-1, reverse=pattern(), ready=pattern(0x6F, 0x27),
              running=pattern(0x6F, 0x27), standstill=pattern(), fault=pattern(0x4F, 0x08, 0x0F), set_scale=1.0, data_type=3)
drive.axis.want(STANDING)
sent = [drive.image(status)[0] for status in (0x250, 0x231, 0x233, 0x237)]
check("a drive in velocity mode is led to operation enabled", sent == [0x06, 0x07, 0x0F, 0x3F], sent)
drive.axis.want(RUNNING, 100)
check("its ramp gets the set speed", drive.image(0x237) == (0x7F, 100))
drive.image(0x250)
check("a drive that has left operation enabled by itself is not led back", drive.axis.goal == OFF and drive.image(0x250)[0] == 0)

axes = SpeedDrives([SpeedAxis(words(), {3: types.SimpleNamespace(data_type=6, bits=16)})])
clock = types.SimpleNamespace(now=0.0)
speed.time = types.SimpleNamespace(monotonic=lambda: clock.now)
ended = ""
image = lambda cycle, stale=(): axes.step({0: 1, 1: 2000}, set(stale), cycle, PERIOD, 0.5, lambda: ended)
axes.run([20.0], [0.0])
image(1)
check("the words of an axis are its outputs", axes.values() == {2: 1, 3: 2000}, axes.values())
clock.now = 0.6
image(2)
check("an axis does not run again after a silence", axes.values() == {2: 5, 3: 0} and "was silent for" in axes.stopped, axes.values())
image(3, [0])
check("a single missing status word changes nothing", axes.values() == {2: 5, 3: 0})
image(4, [0])
image(5, [0])
check("without its status word, an axis gets no command", axes.values() == {})
axes.run([20.0], [0.0])
image(6)
ended = "its commands were too old"
image(7)
check("an axis whose run was ended gets the command to stop", axes.values() == {2: 5, 3: 0} and axes.stopped == ended, axes.values())
ended = ""
image(8)
check("it does not run again when the cause is gone", axes.values() == {2: 5, 3: 0})
sys.exit(1 if failures else 0)
