#!/usr/bin/env python3
"""python_wheel_on_bus.py BUS [KEYS] - tests the installed package on a taktd with the simulated devices of
two_axes.yaml. With KEYS, the bus accepts only messages with the key, and this program accepts only signed messages."""
import os
import sys
import time

import takt
from takt_axes import Axes  # the name of earlier versions

failures = []
name, keys = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
options = {"longest": 30, "keys": keys, "check_images": keys is not None}


def check(what, good, told=""):
    print(f"{'ok' if good else 'FAIL'}    {what} {told if not good else ''}", flush=True)
    failures.extend([] if good else [what])


def refused(call, *values, **options):
    try:
        call(*values, **options)
    except takt.Obstacle as why:
        return str(why)
    return ""


def fresh(bus, signal):
    """Its value, as soon as one has come in time: on a busy machine a TPDO may miss its cycle."""
    bus.wait_until(lambda: not refused(bus.signal, signal), 30)
    return bus.signal(signal)


check("the old name is the same class", Axes is takt.Axes)
check("it is the installed package", "site-packages" in takt.__file__, takt.__file__)
with takt.Bus(name, **options) as bus:
    image = bus.next_image(10)
    check("the image has the position", image["shoulder.position_actual_value"] == fresh(bus, "shoulder.0x6064:0"))
    check("its time is that of the clock", abs(image.time - time.time()) < 60, image.time)
    bus.wait_until(lambda: "io" in bus.nodes and bus.nodes["io"].boot == "ready", 30)
    bus.set("io.outputs_1_to_8", 5.0)
    bus.set("io.outputs_9_to_16", 0.0)
    bus.run(0.2)
    check("outputs are set", bus.sdo_read("io.0x6200:1") == bus.read_number("io", 0x6200, 1) == 5)
    bus.release()
    bus.set("io.outputs_9_to_16", 0.0)
    bus.command({"io.outputs_1_to_8": 3.0}, life=0.5)
    bus.run(0.2)
    check("and commanded for a time", bus.sdo_read("io.0x6200:1") == 3)

    bus.sdo_write("shoulder.profile_acceleration", 400_000)
    check("objects by name", bus.sdo_read("shoulder.profile_acceleration") == bus.sdo_read("shoulder.0x6083:00") == 400_000)
    check("texts, too", "takt" in bus.sdo_read("shoulder.manufacturer_device_name"))
    check("an abort in words", "0x06020000" in refused(bus.sdo_read, "shoulder.0x5000:00"))
    bus.run(0.5)
    node = bus.nodes["shoulder"]
    check("nodes", (node.node_id, node.state, node.boot) == (1, "operational", "ready"), node)
    check("the status", bus.status.bus == name, bus.status.bus)
    bus.take_events()
    bus.nmt("reset", "io")
    event = bus.wait_event(node="io", seconds=30)
    check("events", event.node_id == 10, event.text)
    check("NMT", bus.wait_until(lambda: bus.nodes["io"].state == "operational" and bus.nodes["io"].boot == "ready", 30), bus.nodes)

with takt.Axes(name, "shoulder", "elbow", **options) as axes:
    axes.enable()
    axes.move(0.2, 0.1, velocity=3, acceleration=20)
    check("axes move", abs(axes.positions[0] - 0.2) < 0.02, axes.positions)
    check("and are a Bus", abs(axes.next_image(10)["elbow.position_actual_value"] - 0.1) < 0.02)

if keys:
    os.environ.pop("TAKT_KEYS", None)
    with takt.Bus(name, longest=2) as bus:
        check("without the key nothing is commanded", "keys" in refused(bus.set, "io.outputs_1_to_8", 1.0))
        check("and nothing is read from a device", "keys" in refused(bus.sdo_read, "io.0x6200:1"))
sys.exit(1 if failures else 0)
