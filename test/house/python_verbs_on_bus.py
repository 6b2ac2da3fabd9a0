#!/usr/bin/env python3
"""python_verbs_on_bus.py - tests the calls of takt_axes.Axes with taktd and the simulated devices of
python_verbs.yaml."""
import sys

from takt_axes import Axes, Obstacle

failures = []


def check(name, good, told=""):
    print(f"{'ok' if good else 'FAIL'}    {name} {told if not good else ''}", flush=True)
    failures.extend([] if good else [name])


def refused(call, *values, **options):
    try:
        call(*values, **options)
    except Obstacle as why:
        return str(why)
    return ""


def near(axes, position, most=0.01):
    return abs(axes.positions[0] - position) < most


with Axes("verbs", "slide", longest=30) as axes:
    axes.enable()
    axes.run(0.5)  # longer than the time in on_timeout
    axes.move(0.1, velocity=0.5, acceleration=5)
    axes.jog(0.1)
    axes.halt()
    check("halt", "call resume() first" in refused(axes.move, 0.0))
    axes.resume()
    axes.move(0.0, velocity=0.5, acceleration=5)
    check("resume", near(axes, 0.0), axes.positions)

    axes.move(0.0, velocity=0.5, acceleration=5)
    axes.begin_move(0.3, velocity=0.2, acceleration=5)
    position = axes.touch_probe("slide", edge="rising")
    check("touch_probe", abs(position - 0.2) < 0.002, position)
    position = axes.touch_probe("slide", edge="falling")
    check("touch_probe at the other edge", abs(position - 0.25) < 0.002, position)
    axes.wait()

    axes.write_number("slide", 0x6083, 0, 1_000_000, 4)
    check("read and write", axes.read_number("slide", 0x6083) == 1_000_000)
    check("an abort in words", "slide 0x5FFF:00" in refused(axes.read, "slide", 0x5FFF))

    axes.set("io.outputs_1_to_8", 5.0)
    axes.set("io.outputs_9_to_16", 0.0)  # a PDO is sent when all of its values are known
    axes.run(0.1)
    check("set and signal", axes.signal("io.0x6200:1") == 5.0 and axes.read_number("io", 0x6200, 1) == 5)

    axes.set_mode(1)
    axes.profile_move(0.3, velocity=0.5, acceleration=5, deceleration=5)
    check("profile_move", near(axes, 0.3), axes.positions)
    axes.profile_move(0.1, wait=False)
    axes.profile_move(0.2, at_once=False)
    check("profile_move with a buffer", near(axes, 0.2), axes.positions)
    axes.profile_move(-0.6, relative=True, wait=False)
    axes.run(0.2)
    axes.stop()
    stood = axes.positions[0]
    axes.run(0.5)
    check("stop in profile position", near(axes, stood) and -0.4 < stood < 0.2, (stood, axes.positions))
    axes.enable()
    axes.run(0.5)
    check("no jump into cyclic synchronous position", near(axes, stood), (stood, axes.positions))

    axes.set_mode(3)
    axes.command_velocities(0.2)
    axes.run(1.0)
    check("command_velocities", abs(axes.velocities[0] - 0.2) < 0.02, axes.velocities)
    axes.stop()
    check("stop in profile velocity", abs(axes.velocities[0]) < 0.01, axes.velocities)
    axes.set_mode(4)
    axes.command_torques(0.05)
    axes.run(0.1)
    check("command_torques", axes.velocities[0] > 0.0, axes.velocities)
    axes.set_mode(9, "slide")
    axes.command_velocities(0.02)
    axes.enable()
    axes.jog(0.2)
    axes.quick_stop()
    check("quick_stop", "call enable() first" in refused(axes.jog, 0.1))
    axes.enable()
    axes.move(0.0, velocity=0.5, acceleration=5)
    check("enable after it", near(axes, 0.0), axes.positions)
sys.exit(1 if failures else 0)
