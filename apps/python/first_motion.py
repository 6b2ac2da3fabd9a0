#!/usr/bin/env python3
"""A first motion: two axes of the bus `demo` move to a point and back. share/doc/python.md says how to try it."""
from takt import Axes

with Axes("demo", "shoulder", "elbow") as axes:
    axes.enable()
    axes.move(1.5, 0.5, velocity=3, acceleration=20)  # rad, rad/s, rad/s^2
    axes.move_by(-1.5, -0.5, velocity=3, acceleration=20)
    print(axes.names, axes.positions)
