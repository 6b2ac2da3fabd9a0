#!/usr/bin/env python3
"""axes.py BUS [SECONDS] - enables all axes of a bus, moves them in a soft sine over LCM, disables them."""
import math, sys
import lcm
from takt import command_t, image_t, layout_t  # made by lcm-gen -p

FORTH = {0x08: 0x80, 0x28: 0x80, 0x40: 0x06, 0x60: 0x06, 0x21: 0x07, 0x23: 0x0F, 0x27: 0x0F}  # statusword: controlword
BACK = {0x27: 0x07, 0x23: 0x06}
bus, seconds = sys.argv[1].upper(), 2 * math.ceil(float(sys.argv[2] if len(sys.argv) > 2 else 10) / 2)
signals, values, image, layout = {}, {}, None, None

def on_layout(channel, data):
    global layout
    layout = layout_t.decode(data)
    signals.update({layout.first_signal + i: signal for i, signal in enumerate(layout.signals)})

def on_image(channel, data):
    global image
    image = image_t.decode(data)
    values.update({image.first_signal + i: value for i, value in enumerate(image.values)})

link = lcm.LCM()
link.subscribe(f"{bus}_LAYOUT", on_layout)
link.subscribe(f"{bus}_IMAGE", on_image)
while image is None or layout is None or len(signals) < layout.total_signals or len(values) < len(signals):
    link.handle()
at = {(s.node_id, s.index): place for place, s in signals.items() if s.sub == 0}  # object -> place in the image
axes = sorted(node for node, index in at if index == 0x6040)
first, time, start = None, 0.0, {}
while True:
    link.handle()
    while link.handle_timeout(0): pass  # only the newest image counts
    states = {node: values[at[node, 0x6041]] & 0x6F for node in axes}
    first = image.cycle if first is None and set(states.values()) == {0x27} else first
    time = (image.cycle - first) * layout.period_ns * 1e-9 if first is not None else 0.0
    if time >= seconds and not set(states.values()) & set(BACK): break
    outputs = {}
    for node in axes:
        start[node] = values[at[node, 0x6064]] if first is None else start[node]
        actual = signals[at[node, 0x6064]]
        swing = (0.5 / actual.scale if actual.unit else 10000) * (1 - math.cos(math.pi * min(time, seconds))) / 2
        outputs[at[node, 0x6040]] = (FORTH if time < seconds else BACK).get(states[node], 0)
        outputs[at.get((node, 0x6060))] = 8  # cyclic synchronous position
        outputs[at[node, 0x607A]] = round(start[node] + swing)
    outputs.pop(None, None)  # where 6060 is not mapped
    command = command_t()
    command.schema, command.session, command.sender, command.cycle = 1, image.session, "axes.py", image.cycle
    command.time_to_live, command.num_values = 20, len(outputs)
    command.signals, command.values = list(outputs), list(outputs.values())
    link.publish(f"{bus}_COMMAND", command.encode())
print(f"{len(axes)} axes moved for {time:.1f} s, {image.cycle - first} cycles")
