#!/usr/bin/env python3
"""The image, the devices and an output of the bus `demo`. share/doc/python.md says how to try it."""
from takt import Bus

with Bus("demo") as bus:
    image = bus.next_image()
    print("shoulder at", image["shoulder.position_actual_value"], "rad in cycle", image.cycle)
    print(f"vendor 0x{bus.sdo_read('shoulder.identity_object.vendor_id'):08X}")
    bus.set("io.outputs_1_to_8", 0b101)
    bus.set("io.outputs_9_to_16", 0)
    bus.run(1)  # seconds, in which the outputs keep their values
    for event in bus.take_events():
        print(event.kind, event.text)
