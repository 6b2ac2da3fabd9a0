#!/usr/bin/env python3
"""axes.py BUS [SECONDS] - enables all axes of a bus, moves them in a soft sine over LCM, disables them."""
import lcm, math, sys
from takt import command_t, image_t, layout_t  # made by lcm-gen -p

FORTH = {0x08: 0x80, 0x28: 0x80, 0x40: 0x06, 0x60: 0x06, 0x21: 0x07, 0x23: 0x0F, 0x27: 0x0F}  # statusword: controlword
BACK = {0x27: 0x07, 0x23: 0x06}
bus, seconds = sys.argv[1].upper(), 2 * math.ceil(float(sys.argv[2] if len(sys.argv) > 2 else 10) / 2)
signals, values, newest = {}, {}, {}  # by place in the image; the newest message by type

def on_layout(channel, data):
    layout = newest[layout_t] = layout_t.decode(data)  # a large layout or image comes in parts
    signals.update(enumerate(layout.signals, layout.first_signal))
def on_image(channel, data):
    image = newest[image_t] = image_t.decode(data)
    values.update(enumerate(image.values, image.first_signal))

link = lcm.LCM()
for name, handler in (("LAYOUT", on_layout), ("IMAGE", on_image)): link.subscribe(f"{bus}_{name}", handler)
while len(newest) < 2 or not newest[layout_t].total_signals == len(signals) == len(values): link.handle()
at = {(s.node_id, s.index): place for place, s in signals.items() if s.sub == 0}  # object -> place in the image
axes = {node: signals[at[node, 0x6064]] for node, index in at if index == 0x6040}  # node -> signal of its position
size = {node: 0.5 / s.scale if s.unit else 10000 for node, s in axes.items()}  # rad or counts
first, time, states, start, outputs, command = None, 0.0, {}, {}, {}, command_t()
while time < seconds or set(states.values()) & set(BACK):
    link.handle()
    while link.handle_timeout(0): pass  # only the newest image counts
    image, states = newest[image_t], {node: values[at[node, 0x6041]] & 0x6F for node in axes}
    first = image.cycle if first is None and set(states.values()) == {0x27} else first
    time = (image.cycle - first) * newest[layout_t].period_ns * 1e-9 if first is not None else 0.0
    for node in axes:
        start[node] = values[at[node, 0x6064]] if first is None else start[node]
        target = round(start[node] + size[node] * (1 - math.cos(math.pi * min(time, seconds))) / 2)
        wanted = {0x6040: (FORTH if time < seconds else BACK).get(states[node], 0), 0x6060: 8, 0x607A: target}
        outputs.update((at[node, index], value) for index, value in wanted.items() if (node, index) in at)
    command.schema, command.session, command.sender, command.cycle = 1, image.session, "axes.py", image.cycle
    command.time_to_live, command.num_values = 20, len(outputs)
    command.signals, command.values = list(outputs), list(outputs.values())
    link.publish(f"{bus}_COMMAND", command.encode())
print(f"{len(axes)} axes moved for {time:.1f} s, {image.cycle - first} cycles")
