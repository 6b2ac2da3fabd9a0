#!/usr/bin/env python3
"""Moves one axis of a bus to a position, or jogs it. taktd runs the motion: this program may be late.

    motion.py BUS AXIS POSITION
    motion.py BUS AXIS --jog VELOCITY --for SECONDS

share/doc/python.md says how to try it. Ctrl-C stops the axis.

Exit codes: 0 the motion is done, 1 it was refused or has stopped, or the drive can't be enabled,
2 wrong use, 3 no message of a daemon came.
"""
import argparse
import sys

from takt import Axes, Obstacle

EXIT_CODES = {"wrong use": 2, "no bus": 3}
LIMITS = ("velocity", "acceleration", "jerk")


def arguments():
    parser = argparse.ArgumentParser(description="Moves one axis of a bus; taktd runs the motion.")
    parser.add_argument("bus", help="name of the bus, for example demo")
    parser.add_argument("axis", help="name of the axis, for example shoulder")
    parser.add_argument("position", type=float, nargs="?", help="where the axis comes to rest")
    parser.add_argument("--jog", type=float, metavar="VELOCITY", help="keep this velocity instead")
    parser.add_argument("--for", type=float, default=2.0, dest="seconds", help="time of the jog (2)")
    for limit in LIMITS:
        parser.add_argument(f"--{limit}", type=float, default=0.0, help=f"limit of {limit} (default: from the network file)")
    given = parser.parse_args()
    if (given.position is None) == (given.jog is None):
        parser.error("give a position, or --jog VELOCITY")
    return given


def main():
    given = arguments()
    limits = {name: getattr(given, name) for name in LIMITS}
    try:
        with Axes(given.bus, given.axis) as axes:
            axes.enable()
            if given.jog is None:
                axes.move(given.position, **limits)
            else:
                axes.jog(given.jog, **limits)
                axes.run(given.seconds)
                axes.stop()
            end = "is done" if given.jog is None else "has stopped"
            print(f"the motion {end}: {given.axis} is at {axes.positions[0]:.4f}")
    except Obstacle as why:
        print(why, file=sys.stderr)
        return EXIT_CODES.get(why.kind, 1)
    except KeyboardInterrupt:
        print("the axis was stopped", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
