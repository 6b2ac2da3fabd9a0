#!/usr/bin/env python3
"""python_profiles_test.py TYPES - tests takt.Axes in the modes in which the drives themselves make the motions, on the
bus of python_daemon.py."""
import itertools
import sys

from python_daemon import LAYOUT, SHORT, check, failures, obstacle, on_a_bus

OBJECTS = {(5, index, 0): bytes(4) for index in (0x6081, 0x6083, 0x6084)}


def in_mode(mode, *names):
    daemon, axes = on_a_bus(*(names or ("shoulder",)))
    daemon.objects = dict(OBJECTS)
    axes.enable()
    axes.set_mode(mode)
    return daemon, axes, daemon.drives[0]


def stands(axes):
    before = axes.positions
    axes.run(1.0)
    return axes.positions == before


daemon, axes = on_a_bus("shoulder")
daemon.drives[0].targets[0x607A] = 5000
axes.run(0.0)
axes.enable()
check("a target of a program that has died does not enable", daemon.drives[0].targets[0x607A] == 0)
daemon, axes, drive = in_mode(1)
axes.profile_move(2.0, velocity=3.0, acceleration=[40.0])
check("a profile move ends at its target", axes.positions == [2.0] and not axes.moving)
check("its bounds are written in the unit of velocities",
      (daemon.objects[5, 0x6081, 0], daemon.objects[5, 0x6083, 0], daemon.objects[5, 0x6084, 0])
      == ((300).to_bytes(4, "little"), (4000).to_bytes(4, "little"), (4000).to_bytes(4, "little")), daemon.objects)
axes.profile_move(-0.5, relative=True)
check("a relative one goes its distance, as a position", axes.positions == [1.5] and drive.targets[0x607A] == 1500 and
      not drive.controlword & 0x50)
axes.profile_move(3.0, wait=False)
check("it can go on while the program does something else", axes.moving and axes.positions[0] < 3.0)
axes.profile_move(4.0, at_once=False, wait=False)
check("a set-point waits in the buffer", len(drive.way) == 2 and drive.statusword | drive.bits() & 0x1000)
axes.wait()
check("and comes after the one before", axes.positions == [4.0])
axes.profile_move(5.0, wait=False)
axes.profile_move(0.0, wait=False)
check("else it counts at once", drive.way == [0.0])
axes.stop()
check("a stop ends it for good", stands(axes) and 0.0 < axes.positions[0] < 5.0 and drive.controlword & 0x1FF == 0x2F)
axes.profile_move(0.0, wait=False)
axes.halt()
check("so does a Halt", stands(axes) and drive.controlword & 0x100)
check("a halted axis takes no set-point", "call resume() first" in obstacle(axes.profile_move, 1.0)[1])
axes.resume()
axes.wait()
check("it goes on after resume()", axes.positions == [0.0])
axes.profile_move(5.0, wait=False)
axes.halt()
axes.stop()
axes.resume()
check("but not if a stop has given it up", stands(axes) and not drive.controlword & 0x100)
axes.profile_move(-9.0, relative=True, wait=False)
axes.run(0.1)
halted = []
daemon.each_cycle = lambda daemon: halted.append(drive.mode == 1 and drive.controlword & 0x100 != 0)
axes.enable()
check("enable() stops it before it changes the mode", any(halted) and drive.mode == 8 and stands(axes) and
      axes.positions[0] > -9.0)
check("the target position does not jump there", drive.targets[0x607A] == round(drive.position * 1000), drive.targets)
check("another mode is named", "shoulder is in mode 8: call set_mode(1) first" in obstacle(axes.profile_move, 1.0)[1])

daemon, axes, drive = in_mode(1)
drive.bits = lambda: 0x1000
axes._link.longest = SHORT
daemon.refuses_targets = "node 5: command to 607A is outside its limits"
kind, text = obstacle(axes.profile_move, 1.0)
check("a set-point that taktd refuses is named", (kind, text) == ("refused", daemon.refuses_targets), text)
daemon.refuses_targets = ""
check("a full buffer is named", "has no room for a set-point" in obstacle(axes.profile_move, 1.0)[1])
drive.bits = lambda: 0
kind, text = obstacle(axes.profile_move, 1.0)
check("so is a drive that does not acknowledge", kind == "time over" and "does not acknowledge" in text, (kind, text))
check("its bit 4 falls again", not drive.controlword & 0x10)
daemon, axes, drive = in_mode(1)
axes.profile_move(5.0, wait=False)
drive.drive_itself = lambda: None
kind, text = obstacle(axes.wait)
check("a drive that stands before its target is named", kind == "stopped" and
      "shoulder is at standstill, but its drive has not reached its target" in text, (kind, text))
daemon, axes, drive = in_mode(1)
axes.profile_move(5.0, wait=False)
check("a wait has its limit", obstacle(axes.wait, 0.1)[0] == "time over" and axes.moving)
drive.statusword = 0x218
kind, text = obstacle(axes.wait)
check("a fault in a profile move is named", kind == "stopped" and "bit 3 (fault)" in text, (kind, text))
axes.reset()
axes.enable()
check("and can be reset", drive.statusword == 0x237 and drive.mode == 8)
del daemon.objects[5, 0x6081, 0]
axes.set_mode(1)
kind, text = obstacle(axes.profile_move, 1.0, velocity=1)
check("bounds that the drive refuses are named", "shoulder 0x6081:00" in text, text)
check("nothing moves then", stands(axes))

daemon, axes, drive = in_mode(3)
check("velocities begin with 0", drive.targets[0x60FF] == 0 and stands(axes))
axes.command_velocities(2.0)
check("a velocity is commanded in its unit", drive.targets[0x60FF] == 200)
axes.run(1.0)
check("it stays while the program is alive", not stands(axes))
axes.halt()
axes.resume()
check("a Halt ends it", stands(axes))
axes.command_velocities(-1.0)
axes.stop()
check("so does a stop", drive.targets[0x60FF] == 0 and stands(axes))
check("its words are repeated, because a sign of life does not keep them", daemon.word_cycle > daemon.cycle - 5)
axes.command_velocities(1.0)
axes.set_mode(4)
check("and another mode", drive.targets[0x60FF] == 0 and drive.mode == 4 and stands(axes))
axes.command_torques(0.5)
check("a torque is commanded in its unit", drive.targets[0x6071] == 500)
kind, text = obstacle(axes.command_velocities, 1.0)
check("velocities have their modes", text == "shoulder is in mode 4: call set_mode(3) or set_mode(9) first", text)
axes.disable()
check("disable() ends a torque first", drive.targets[0x6071] == 0 and drive.statusword == 0x250)
daemon, axes, drive = in_mode(1)
axes.profile_move(2.0)
axes.set_mode(3)
axes.command_velocities(1.0)
axes.run(0.5)
far = []
daemon.each_cycle = lambda daemon: far.append(drive.mode == 8 and abs(drive.targets[0x607A] - 1e3 * drive.position) > 9)
axes.enable()
check("an old set-point is no target of the next mode", axes.positions[0] > 2.1 and not any(far) and stands(axes))
daemon, axes, drive = in_mode(3)
axes.command_velocities(1.0)
drive.bits, coasting = lambda: 0x400, iter(range(100))  # "target velocity reached" is not "at rest"
drive.drive_itself = lambda: setattr(drive, "position", drive.position + 0.01 * (next(coasting, None) is not None))
axes.stop()
check("a stop waits until the drive stands", stands(axes) and next(coasting, None) is None)
daemon, axes, drive = in_mode(9)
daemon.objects[5, 0x6084, 0] = (5000).to_bytes(4, "little")
axes.command_velocities(-10.0)
speeds = []
daemon.each_cycle = lambda daemon: speeds.append(drive.targets[0x60FF])
axes.stop()
steps = [after - before for before, after in zip(speeds, speeds[1:])]
check("a stop lowers a velocity that the drive follows at once", max(steps) <= 20 and min(steps) >= 0, max(steps))
check("along the deceleration of the drive", 90 <= speeds.index(0) <= 120 and stands(axes), speeds.index(0))
del daemon.objects[5, 0x6084, 0]
axes.command_velocities(10.0)
speeds.clear()
axes.stop()
check("without one it becomes 0 at once", set(speeds) <= {1000, 0} and stands(axes), set(speeds))
for name, counts, is_rest in (("flickers by a count", (0, 1), True), ("is fine and noisy", (-9, 0, 9, 4), True),
                              ("counts up", range(0, 10**6, 3), False)):
    daemon, axes, drive = in_mode(9)
    axes._link.longest = 2 * SHORT
    readings = itertools.cycle(counts)
    drive.drive_itself = lambda: setattr(drive, "position", next(readings) / 1000)
    began = daemon.cycle
    kind, _ = obstacle(axes.stop)
    check(f"an axis whose encoder {name} {'stands' if is_rest else 'still moves'}", (kind == "none") == is_rest, kind)
    check("which is seen soon", not is_rest or daemon.cycle - began < 150, daemon.cycle - began)
daemon, axes, drive = in_mode(9)
axes.command_velocities(1.0)
for _ in range(300):
    daemon.pass_cycle()
kind, text = obstacle(axes.run, 0.1)
check("a silence gives a velocity up", kind == "stopped" and "so its set-points were discarded" in text, (kind, text))
commanded = []
recorder = type("Recorder", (dict,), {"__setitem__": lambda self, key, value: commanded.append(value)})
drive.targets = recorder(drive.targets)
axes.run(1.0)
check("after a silence no velocity is sent again", 100 not in commanded, commanded)


def interrupt(daemon):
    daemon.each_cycle = lambda daemon: None
    raise KeyboardInterrupt


daemon, axes, drive = in_mode(3)
axes.command_velocities(1.0)
daemon.each_cycle = interrupt
try:
    axes.run(1.0)
except KeyboardInterrupt:
    pass
check("an exception ends a velocity", drive.targets[0x60FF] == 0)
drive.statusword = 0x218
kind, text = obstacle(axes.command_velocities, 1.0)
check("a drive in fault gets none", kind == "blocked" and "bit 3 (fault)" in text and not drive.targets[0x60FF], text)
daemon, axes = on_a_bus()
axes.enable()
axes.set_mode(3, "elbow")
check("one axis can have another mode", [drive.mode for drive in daemon.drives] == [8, 3])
texts = obstacle(axes.command_velocities, 1, 1)[1], obstacle(axes.move, 1.0, 1.0)[1]
check("then neither kind of motion is for all axes", "shoulder is in mode 8" in texts[0] and
      "elbow: taktd does not treat the axis as enabled" in texts[1], texts)
axes.set_mode(8, 1)
axes.move(1.0, 1.0)
check("and come back", axes.positions == [1.0, 1.0])
check("a wrong axis is named", "'wrist' is not one of the axes" in obstacle(axes.set_mode, 3, "wrist")[1])

for place, (node, index, *words) in enumerate(LAYOUT):
    LAYOUT[place] = (node, 0x60C1 if index == 0x607A else index, *words)
daemon, axes = on_a_bus("shoulder")
daemon.drives[0].targets[0x60C1] = 5000
axes.run(0.0)
axes.enable()
check("a point of a program that has died does not enable", daemon.drives[0].targets[0x60C1] == 0)
daemon, axes = on_a_bus("shoulder")
drive = daemon.drives[0]
axes.enable()
check("an axis without 607A moves in interpolated position", drive.mode == 7 and drive.controlword == 0x1F)
axes.move(1.0)
axes.set_mode(3)
check("it can have another mode", drive.mode == 3 and drive.controlword == 0x0F, drive.controlword)
axes.set_mode(8)
axes.move(2.0)
check("and comes back", axes.positions == [2.0] and drive.mode == 7 and drive.controlword == 0x1F)
words = set()
daemon.each_cycle = lambda daemon: words.add(drive.controlword)
axes.disable()
check("bit 4 is for drives that stay enabled", words == {0x1F, 0x07, 0x06, 0x00}, words)
sys.exit(1 if failures else 0)
