#!/usr/bin/env python3
"""axes.py BUS [SECONDS] - enables all axes of a bus, moves them in a soft sine over LCM, disables them."""
import hashlib, lcm, math, os, random, sys, time as clock
from takt import command_t, envelope_t, image_t, layout_t  # made by lcm-gen -p

FORTH = {0x08: 0x80, 0x28: 0x80, 0x40: 0x06, 0x60: 0x06, 0x21: 0x07, 0x23: 0x0F, 0x27: 0x0F}  # statusword: controlword
BACK = {0x27: 0x07, 0x23: 0x06}
bus, seconds = sys.argv[1].upper(), 2 * math.ceil(float(sys.argv[2] if len(sys.argv) > 2 else 10) / 2)
signals, values, stale, newest = {}, {}, set(), {}  # by place in the image; the newest message by type

def on_layout(channel, data):
    layout = newest[layout_t] = layout_t.decode(data)  # a large layout or image comes in parts
    if layout.schema != 2: sys.exit(f"axes.py: the daemon has schema {layout.schema}, this program schema 2")
    signals.update(enumerate(layout.signals, layout.first_signal))
def on_image(channel, data):
    try: image = newest[image_t] = image_t.decode(data)
    except ValueError: return  # the schema of the layout tells why
    values.update(enumerate(image.values, image.first_signal))
    stale.difference_update(range(image.first_signal, image.first_signal + image.num_values))
    stale.update(image.stale)

envelope, file = envelope_t(), os.environ.get("TAKT_KEYS")
key = [words for line in open(file) if (words := line.partition("#")[0].split())][0] if file else None  # the first
envelope.schema, envelope.instance = 1, random.SystemRandom().getrandbits(63)
def publish(channel, message):  # in an envelope where there is a key, see share/doc/security.md
    if not key: return link.publish(channel, message.encode())
    envelope.key, envelope.channel, envelope.session, envelope.utime = key[0], channel, message.session, clock.time_ns() // 1000
    envelope.counter, envelope.data = envelope.counter + 1, message.encode()
    envelope.size, envelope.mac = len(envelope.data), bytes(32)
    sealed = envelope.encode()[:-32]
    link.publish(f"{bus}_SECURED", sealed + hashlib.blake2b(sealed, key=bytes.fromhex(key[1]), digest_size=32).digest())

link = lcm.LCM()
layouts, images = (link.subscribe(f"{bus}_{name}", call) for name, call in (("LAYOUT", on_layout), ("IMAGE", on_image)))
while len(newest) < 2 or not newest[layout_t].total_signals == len(signals) == len(values): link.handle()
link.unsubscribe(layouts)
at = {(s.node_id, s.index): place for place, s in signals.items() if s.sub == 0}  # object -> place in the image
axes = {node: signals[at[node, 0x6064]] for node, index in at if index == 0x6040}  # node -> signal of its position
size = {node: 0.5 / s.scale if s.unit else 10000 for node, s in axes.items()}  # rad or counts
layout, moving, time, last, unseen = newest[layout_t], False, 0.0, 0, 0
states, start, outputs, command = {}, {}, {}, command_t()
command.sender, command.instance = "axes.py", random.SystemRandom().randrange(1, 2**63)  # one sender each, whatever its name
while time < seconds or set(states.values()) & set(BACK):
    if not link.handle_timeout(1000): sys.exit("axes.py: no image for 1 s")
    while link.handle_timeout(0): pass  # only the newest image counts
    image, states = newest[image_t], {node: values[at[node, 0x6041]] & 0x6F for node in axes}
    if image.session != layout.session: sys.exit("axes.py: the daemon has restarted")
    missing = [s.node for node, s in axes.items() if stale & {at[node, 0x6041], at[node, 0x6064]}]
    unseen = unseen + 1 if missing else 0
    if moving and unseen > 50: sys.exit(f"axes.py: no PDOs of {missing}")
    if moving and time < seconds and set(states.values()) != {0x27}: sys.exit("axes.py: an axis left Operation enabled")
    time += min(image.cycle - last, 5) * layout.period_ns * 1e-9 if moving else 0.0  # a gap is no jump
    for node, signal in axes.items():
        if not moving and signal.node in missing: continue  # where is it?
        start[node] = start[node] if moving else values[at[node, 0x6064]]
        target = round(start[node] + size[node] * (1 - math.cos(math.pi * min(time, seconds))) / 2)
        wanted = {0x6040: (FORTH if time < seconds else BACK).get(states[node], 0), 0x6060: 8, 0x607A: target}
        outputs.update((at[node, index], value) for index, value in wanted.items() if (node, index) in at)
    moving, last = moving or not missing and set(states.values()) == {0x27}, image.cycle
    command.schema, command.session, command.cycle = 2, image.session, image.cycle
    command.num_values, command.signals, command.values = len(outputs), list(outputs), list(outputs.values())
    publish(f"{bus}_COMMAND", command)
command.release, command.num_values, command.signals, command.values = True, 0, [], []  # the outputs are free at once
publish(f"{bus}_COMMAND", command)
print(f"{len(axes)} axes moved for {time:.1f} s")
