#!/usr/bin/env python3
"""axes.py BUS [SECONDS] - enables all axes of a bus, moves them in a soft sine over LCM, disables them."""
import hashlib, lcm, math, os, random, stat, sys, time as clock
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

def read_keys(path):  # of a file that nobody else can use, as taktd reads it
    bad = f"axes.py: key file {path}: "
    try: file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as wrong: sys.exit(bad + wrong.strerror)
    info = os.fstat(file)
    if not stat.S_ISREG(info.st_mode): sys.exit(bad + "it is not a regular file")
    if info.st_uid not in (0, os.geteuid()): sys.exit(bad + "it belongs to another user")
    if info.st_mode & 0o077: sys.exit(bad + f"others than its owner can use it: chmod 600 {path}")
    keys = [words for line in open(file) if (words := line.partition("#")[0].split())]
    return keys if keys else sys.exit(bad + "there is no key in it")

envelope, file = envelope_t(), os.environ.get("TAKT_KEYS")
keys = read_keys(file) if file else []
key = keys[0] if keys else None  # the first is ours
envelope.schema, envelope.instance = 1, random.SystemRandom().getrandbits(63)
def publish(channel, message):  # in an envelope where there is a key, see share/doc/security.md
    if not key: return link.publish(channel, message.encode())
    envelope.key, envelope.channel, envelope.session, envelope.utime = key[0], channel, message.session, clock.time_ns() // 1000
    envelope.counter, envelope.data = envelope.counter + 1, message.encode()
    envelope.size, envelope.mac = len(envelope.data), bytes(32)
    sealed = envelope.encode()[:-32]
    link.publish(f"{bus}_SECURED", sealed + hashlib.blake2b(sealed, key=bytes.fromhex(key[1]), digest_size=32).digest())

counters = {}  # of those who sign, by key and instance
def on_signed(channel, data):  # what is forged, altered, replayed, delayed or out of order changes nothing
    try: sealed = envelope_t.decode(data)
    except ValueError: return
    secret, sender = dict(keys).get(sealed.key), (sealed.key, sealed.instance)
    if not secret or hashlib.blake2b(data[:-32], key=bytes.fromhex(secret), digest_size=32).digest() != bytes(sealed.mac): return
    if abs(clock.time_ns() // 1000 - sealed.utime) > 1_000_000 or sealed.counter <= counters.get(sender, 0): return
    counters[sender] = sealed.counter
    if sealed.channel in (f"{bus}_LAYOUT", f"{bus}_IMAGE"):
        {f"{bus}_LAYOUT": on_layout, f"{bus}_IMAGE": on_image}[sealed.channel](sealed.channel, sealed.data)

link, checks = lcm.LCM(), os.environ.get("TAKT_CHECK_IMAGES") == "true"
if checks and not keys: sys.exit("axes.py: TAKT_CHECK_IMAGES needs a key file: TAKT_KEYS=FILE")
heard = {"SIGNED": on_signed} if checks else {"LAYOUT": on_layout, "IMAGE": on_image}
subscriptions = [link.subscribe(f"{bus}_{name}", call) for name, call in heard.items()]
while len(newest) < 2 or not newest[layout_t].total_signals == len(signals) == len(values): link.handle()
if not checks: link.unsubscribe(subscriptions[0])
at = {(s.node_id, s.index): place for place, s in signals.items() if s.sub == 0}  # object -> place in the image
axes = {node: signals[at[node, 0x6064]] for node, index in at if index == 0x6040}  # node -> signal of its position
size = {node: 0.5 / s.scale if s.unit else 10000 for node, s in axes.items()}  # rad or counts
layout, moving, time, last, unseen = newest[layout_t], False, 0.0, 0, 0
states, start, outputs, command = {}, {}, {}, command_t()
command.sender, command.instance = "axes.py", random.SystemRandom().randrange(1, 2**63)  # one sender each, whatever its name
try:
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
finally:  # however it ends, the outputs are free at once and take their fallback
    if command.num_values and newest[image_t].session == command.session:
        command.release, command.num_values, command.signals, command.values = True, 0, [], []
        publish(f"{bus}_COMMAND", command)
print(f"{len(axes)} axes moved for {time:.1f} s")
