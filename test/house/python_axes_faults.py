#!/usr/bin/env python3
"""python_axes_faults.py TYPES - apps/python/axes.py on a bus of two drives in this process, where things go wrong.
TYPES: folder of what `lcm-gen -p` made."""
import pathlib
import runpy
import sys

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


def run(fault=lambda bus, cycle: None):
    """The bus afterwards and the message that axes.py ended with; None: it came to its end."""
    bus = Bus(fault)
    sys.modules["lcm"], sys.argv = bus, ["axes.py", "demo", "2"]
    try:
        runpy.run_path(str(AXES), run_name="__main__")
    except SystemExit as end:
        return bus, end.code
    except (AssertionError, KeyError) as wrong:
        return bus, f"{type(wrong).__name__}: {wrong}"
    return bus, None


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print(f"      {told}")


def ends(name, message, fault):
    bus, told = run(fault)
    check(name, told is not None and message in str(told), told)


def at(cycle, change):
    return lambda bus, now: change(bus) if now == cycle else None


def trip(bus):
    bus.values[STATUSWORD] = 0x08


def restart(bus):
    bus.session += 1


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
ends("another session ends it", "restarted", at(300, restart))
ends("a node that is silent in motion ends it", "no PDOs of ['axis1']", at(300, die))
ends("a node that is silent at the end ends it", "no PDOs of ['axis1']", at(1003, die))
ends("images that end end it", "no image", at(300, lambda bus: setattr(bus, "silent", True)))
sys.exit(1 if failures else 0)
