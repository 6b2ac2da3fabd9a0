#!/usr/bin/env python3
"""python_axes_faults.py TYPES - apps/python/axes.py on a bus of two drives in this process, where things go wrong.
TYPES: folder of what `lcm-gen -p` made."""
import hashlib
import os
import pathlib
import runpy
import sys
import tempfile
import time

AXES = pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python/axes.py"
NEXT = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27, (0x27, 0x07): 0x23, (0x23, 0x06): 0x21,
        (0x08, 0x80): 0x40}  # statusword, controlword: next statusword
STATUSWORD, POSITION, CONTROLWORD, TARGET = 0, 2, 4, 6  # place of the first node's, the second's follows
failures = []


def layout(session):
    made = takt.layout_t()
    made.schema, made.parts, made.session, made.hash, made.period_ns = 2, 1, session, 7, 2_000_000
    for index in (0x6041, 0x6064, 0x6040, 0x607A):
        for node in (1, 2):
            signal = takt.signal_t()
            signal.node, signal.node_id, signal.index, signal.scale = f"axis{node}", node, index, 1.0
            made.signals.append(signal)
    made.num_signals = made.total_signals = len(made.signals)
    return made


class Bus:
    """In the place of module lcm; `fault(bus, cycle)` may change anything before an image."""

    def __init__(self, fault):
        self.fault, self.cycle, self.session, self.stale, self.silent = fault, 0, 5, [], False
        self.values, self.handlers, self.commands, self.held = [0x40, 0x40, 1000, -500, 0, 0, 0, 0], {}, [], {}
        self.due, self.released = ["LAYOUT"], False

    def LCM(self):
        return self

    def subscribe(self, channel, handler):
        self.handlers[channel.removeprefix("DEMO_")] = handler
        return channel

    def unsubscribe(self, channel):
        del self.handlers[channel.removeprefix("DEMO_")]

    def publish(self, channel, data):
        command = takt.command_t.decode(data)
        assert command.instance != 0, "a sender without an instance"
        if command.release:
            self.released = True
            return
        assert not self.released, "it commands what it has released"
        self.commands.append(dict(zip(command.signals, command.values)))
        self.values[CONTROLWORD:] = [self.commands[-1].get(place, self.values[place]) for place in range(4, 8)]

    def handle(self):
        assert self.handle_timeout(1)

    def handle_timeout(self, milliseconds):
        if milliseconds == 0 or self.silent:
            return 0
        if self.due:
            self.due.pop()
            self.handlers["LAYOUT"](None, layout(self.session).encode())
            return 1
        self.cycle += 1
        assert self.cycle < 5000, "it waits for ever"
        for axis in (0, 1):
            if axis in self.held: continue
            word = self.values[STATUSWORD + axis]
            self.values[STATUSWORD + axis] = NEXT.get((word, self.values[CONTROLWORD + axis]), word)
            if word == 0x27: self.values[POSITION + axis] = self.values[TARGET + axis]
        self.fault(self, self.cycle)
        image = takt.image_t()
        image.schema, image.parts, image.session, image.layout_hash, image.cycle = 2, 1, self.session, 7, self.cycle
        image.values, image.num_values, image.stale, image.num_stale = self.values, 8, self.stale, len(self.stale)
        self.handlers["IMAGE"](None, image.encode())
        return 1


def run(fault=lambda bus, cycle: None, kind=Bus):
    """The bus afterwards and the message that axes.py ended with; None: it came to its end."""
    bus = kind(fault)
    sys.modules["lcm"], sys.argv = bus, ["axes.py", "demo", "2"]
    try:
        runpy.run_path(str(AXES), run_name="__main__")
    except SystemExit as end:
        return bus, end.code
    except (AssertionError, KeyError, KeyboardInterrupt) as wrong:
        return bus, f"{type(wrong).__name__}: {wrong}"
    return bus, None


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print(f"      {told}")


def ends(name, message, fault, releases=True):
    bus, told = run(fault)
    check(name, told is not None and message in str(told) and bus.released == releases, (told, bus.released))


def at(cycle, change):
    return lambda bus, now: change(bus) if now == cycle else None


def trip(bus):
    bus.values[STATUSWORD] = 0x08


def restart(bus):
    bus.session += 1


def interrupt(bus):
    raise KeyboardInterrupt


def die(bus):
    bus.held, bus.stale = {0}, [STATUSWORD, POSITION]


def begin_enabled(bus):
    bus.values[STATUSWORD:POSITION], bus.values[TARGET:] = [0x27, 0x27], bus.values[POSITION:CONTROLWORD]


def boots_late(bus, cycle):
    bus.stale = [STATUSWORD, POSITION] if cycle < 100 else []
    if cycle <= 100:
        bus.values[STATUSWORD], bus.values[POSITION] = (0x00, 0) if bus.stale else (0x40, 1000)


sys.path.insert(0, sys.argv[1])
import takt  # noqa: E402  what lcm-gen made

bus, told = run()
check("two axes move there and back and are disabled", told is None and bus.values[:POSITION] == [0x21, 0x21], told)
check("and released", bus.released, told)
farthest = max(command.get(TARGET, 0) for command in bus.commands)
check("by 10000 counts from where they were", farthest == 11000 and bus.values[POSITION] == 1000, farthest)

bus, told = run(at(1, trip))
check("a fault before the start is reset", told is None and bus.values[STATUSWORD] == 0x21, told)
bus, told = run(at(1, begin_enabled))
check("axes that are enabled already do not jump", told is None and bus.commands[0][TARGET] == 1000,
      (told, bus.commands[:1]))
bus, told = run(boots_late)
first = next(command for command in bus.commands if TARGET in command)
check("an axis that boots late is commanded from its position", told is None and first[TARGET] == 1000, (told, first))
skip = at(300, lambda bus: setattr(bus, "cycle", bus.cycle + 200))
bus, told = run(skip)
jump = max(abs(b[TARGET] - a[TARGET]) for a, b in zip(bus.commands, bus.commands[1:]))
check("missed cycles are no jump", told is None and jump < 200, jump)

ends("a fault in motion ends it", "left Operation enabled", at(300, trip))
ends("another session ends it", "restarted", at(300, restart), releases=False)
ends("a node that is silent in motion ends it", "no PDOs of ['axis1']", at(300, die))
ends("a node that is silent at the end ends it", "no PDOs of ['axis1']", at(1003, die))
ends("images that end end it", "no image", at(300, lambda bus: setattr(bus, "silent", True)))
ends("an exception in motion ends it", "KeyboardInterrupt", at(300, interrupt))


def reads_keys(name, message, change):
    """What axes.py says to a key file that `change` has made of a good one."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "bus.keys"
        file.write_text("# of this plant\nplant " + "5a" * 32 + "\n")
        file.chmod(0o600)
        os.environ["TAKT_KEYS"] = str(change(file) or file)
        bus, told = run(lambda bus, cycle: None)
        del os.environ["TAKT_KEYS"]
        check(name, message in str(told) and not bus.commands, told)


def seal(daemon, channel, data, counter, secret="5a" * 32, age=0):
    made = takt.envelope_t()
    made.utime, made.schema, made.session, made.instance, made.counter = time.time_ns() // 1000 - age, 1, 5, daemon, counter
    made.key, made.channel, made.size, made.data, made.mac = "plant", channel, len(data), data, bytes(32)
    sealed = made.encode()[:-32]
    return sealed + hashlib.blake2b(sealed, key=bytes.fromhex(secret), digest_size=32).digest()


def checks_images(name, forge):
    """axes.py on a bus that signs, where `forge` makes what a stranger sends after each image; it comes to its end."""
    class Signing(Bus):
        def __init__(self, fault):
            super().__init__(fault)
            self.counter, self.signed = 0, {}

        def subscribe(self, channel, handler):
            if channel == "DEMO_SIGNED":
                self.signed = handler
                self.handlers = {kind: lambda _, data, kind=kind: self.sign(f"DEMO_{kind}", data) for kind in ("LAYOUT", "IMAGE")}
            else:
                self.unsigned = channel
            return channel

        def sign(self, channel, data):
            self.counter += 1
            good = seal(77, channel, data, self.counter)
            self.signed("DEMO_SIGNED", good)
            for bad in forge(self, channel, data, good):
                self.signed("DEMO_SIGNED", bad)

        def publish(self, channel, data):
            super().publish("DEMO_COMMAND", bytes(takt.envelope_t.decode(data).data))

    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "bus.keys"
        file.write_text("plant " + "5a" * 32 + "\n")
        file.chmod(0o600)
        os.environ.update(TAKT_KEYS=str(file), TAKT_CHECK_IMAGES="true")
        bus, told = run(kind=Signing)
        del os.environ["TAKT_KEYS"], os.environ["TAKT_CHECK_IMAGES"]
    check(name, told is None and not hasattr(bus, "unsigned") and bus.values[:POSITION] == [0x21, 0x21], told)


def restarted(data):
    """The same image or layout, but of another session: whoever believes it ends."""
    kind = takt.image_t if data[:8] == takt.image_t().encode()[:8] else takt.layout_t
    message = kind.decode(data)
    message.session += 1
    return message.encode()


def link(file):
    other = file.with_name("link")
    other.symlink_to(file)
    return other


reads_keys("a key file that the group reads is refused", "others than its owner can use it: chmod 600",
           lambda file: file.chmod(0o640))
reads_keys("a key file that others write is refused", "others than its owner can use it: chmod 600",
           lambda file: file.chmod(0o602))
reads_keys("a link to a key file is refused", "key file", link)
reads_keys("a folder is refused", "not a regular file", lambda file: file.parent)
reads_keys("a key file that is not there is refused", "key file", lambda file: file.with_name("none"))
reads_keys("a key file without a key is refused", "no key", lambda file: (file.write_text("# nothing\n"), None)[1])
checks_images("signed images move the axes", lambda bus, channel, data, good: [])
checks_images("an image signed with another secret changes nothing",
              lambda bus, channel, data, good: [seal(77, channel, restarted(data), bus.counter + 1, secret="00" * 32)])
checks_images("an altered image changes nothing",
              lambda bus, channel, data, good: [good[:-40] + bytes([good[-40] ^ 1]) + good[-39:]])
checks_images("a repeated image changes nothing",
              lambda bus, channel, data, good: [seal(77, channel, restarted(data), bus.counter)])
checks_images("an image that was kept back changes nothing",
              lambda bus, channel, data, good: [seal(78, channel, restarted(data), 1, age=2_000_000)])
sys.exit(1 if failures else 0)
