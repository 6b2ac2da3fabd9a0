#!/usr/bin/env python3
"""An inverter runs at 20 Hz for 3 s. On the simulated bus: taktd share/demo/astraada_drv28.yaml --bus sim"""
from takt import Axes

with Axes("pump", "pump") as axes:
    axes.enable()
    axes.jog(20)  # Hz
    axes.run(3)
    print(axes.names, axes.velocities, axes.units)
    axes.stop()
