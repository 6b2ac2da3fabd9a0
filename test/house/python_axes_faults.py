#!/usr/bin/env python3
"""python_axes_faults.py TYPES - tests apps/python/axes.py with faults, on a bus of two drives in this process. TYPES:
folder with the output of `lcm-gen -p`."""
import contextlib
import hashlib
import io
import os
import pathlib
import runpy
import signal
import sys
import tempfile
import time

AXES = pathlib.Path(__file__).resolve().parent.parent.parent / "apps/python/axes.py"
NEXT = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27, (0x27, 0x07): 0x23, (0x23, 0x06): 0x21,
        (0x08, 0x80): 0x40}  # statusword, controlword: next statusword
STATUSWORD, POSITION, CONTROLWORD, TARGET = 0, 2, 4, 6  # place of the first node's, the second's follows
SCALE = {"": 1.0, "rad": 6.283185307179586e-4, "m": 1e-6}  # by unit
GOOD, NOT_MOVED, WRONG_USE = 0, 1, 2  # exit codes
failures = []


def layout(session, unit=""):
    made = takt.layout_t()
    made.schema, made.parts, made.session, made.hash, made.period_ns = 2, 1, session, 7, 2_000_000
    for index in (0x6041, 0x6064, 0x6040, 0x607A):
        for node in (1, 2):
            entry = takt.signal_t()
            entry.node, entry.node_id, entry.index, entry.output = f"axis{node}", node, index, index in (0x6040, 0x607A)
            entry.unit, entry.scale = unit, SCALE.get(unit, 1.0)
            made.signals.append(entry)
    made.num_signals = made.total_signals = len(made.signals)
    return made


def status(session, holders):
    made = takt.status_t()
    made.schema, made.session, made.num_nodes = 2, session, len(holders)
    for number, holder in enumerate(holders, 1):
        node = takt.node_status_t()
        node.node_id, node.holder = number, holder
        made.nodes.append(node)
    return made


class Bus:
    """Replaces the module lcm; `fault(bus, cycle)` may change anything before an image."""
    unit, schema, most_cycles = "", 2, 5000

    def __init__(self, fault):
        self.fault, self.cycle, self.session, self.stale, self.silent = fault, 0, 5, [], False
        self.values, self.handlers, self.commands, self.held = [0x40, 0x40, 1000, -500, 0, 0, 0, 0], {}, [], {}
        self.due, self.released, self.node_names = ["LAYOUT"], False, ("axis1", "axis2")
        self.sender, self.instance, self.other = "", 0, ""

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
        self.sender, self.instance = command.sender, command.instance
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
            made = layout(self.session, self.unit)
            made.schema = self.schema
            for entry in made.signals: entry.node = self.node_names[entry.node_id - 1]
            self.handlers["LAYOUT"](None, made.encode())
            return 1
        self.cycle += 1
        assert self.cycle < self.most_cycles, "it waits for ever"
        for axis in (0, 1):
            if axis in self.held: continue
            word = self.values[STATUSWORD + axis]
            self.values[STATUSWORD + axis] = NEXT.get((word, self.values[CONTROLWORD + axis]), word)
            if word == 0x27: self.values[POSITION + axis] = self.values[TARGET + axis]
        self.fault(self, self.cycle)
        if self.cycle % 50 == 0:
            holders = ["", ""] if self.other == "nobody" else [self.other or self.sender, self.sender]
            self.handlers["STATUS"](None, status(self.session, holders).encode())
        self.handlers["IMAGE"](None, self.image().encode())
        return 1

    def image(self):
        image = takt.image_t()
        image.schema, image.parts, image.session, image.layout_hash, image.cycle = 2, 1, self.session, 7, self.cycle
        image.values, image.num_values, image.stale, image.num_stale = self.values, 8, self.stale, len(self.stale)
        return image


def run(fault=lambda bus, cycle: None, kind=Bus, options=()):
    """Returns the bus after the run, the exit code of axes.py and its stderr."""
    bus, said = kind(fault), io.StringIO()
    sys.modules["lcm"], sys.argv = bus, ["axes.py", "demo", "2", *options]
    usual = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
            runpy.run_path(str(AXES), run_name="__main__")
        return bus, None, "it did not end with an exit code"
    except SystemExit as end:
        return bus, end.code, said.getvalue()
    except (AssertionError, KeyError, KeyboardInterrupt) as wrong:
        return bus, None, f"{type(wrong).__name__}: {wrong}"
    finally:
        for number, handler in usual.items():
            signal.signal(number, handler)


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print(f"      {told}")


def ends(name, message, fault, releases=True, code=NOT_MOVED, **rest):
    bus, ended, told = run(fault, **rest)
    check(name, ended == code and message in told and bus.released == releases, (ended, told, bus.released))
    return bus


def is_disabled(name, bus, axes=(0, 1)):
    check(name, all(bus.values[STATUSWORD + axis] == 0x21 for axis in axes), bus.values)


def at(cycle, change):
    return lambda bus, now: change(bus) if now == cycle else None


def trip(bus):
    bus.values[STATUSWORD] = 0x08


def restart(bus):
    bus.session += 1


def forge(**fields):
    """Another program sends one image with these fields between two images of the bus."""
    def fault(bus):
        image = bus.image()
        for name, value in fields.items():
            setattr(image, name, value(image) if callable(value) else value)
        bus.handlers["IMAGE"](None, image.encode())
    return fault


def changes_nothing(name, fault):
    for cycle in (1, 100, 300, 1003):  # at the start, while it enables, in motion, while it disables
        bus, code, told = run(at(cycle, fault))
        targets = [command[TARGET] for command in bus.commands if TARGET in command]
        check(f"{name} changes nothing at image {cycle}",
              code == GOOD and steps(bus) < 20 and max(targets) == 2000 and bus.cycle < 1100,
              (code, told, steps(bus), max(targets, default=None), bus.cycle))


def interrupt(bus):
    raise KeyboardInterrupt


def another_holds(begin, end):
    """Another program holds the first axis from one cycle to another."""
    def fault(bus, cycle):
        bus.other = "axes.py 0" if begin <= cycle < end else ""
    return fault


def refuse_envelope(bus):
    event = takt.event_t()
    event.kind, event.text = "envelope_refused", "a message on DEMO_COMMAND was refused: this bus has `keys`"
    bus.handlers["EVENT"](None, event.encode())


def without_key(bus, cycle):
    bus.other = "nobody"
    if cycle % 50 == 0:
        refuse_envelope(bus)


def die(bus):
    bus.held, bus.stale = {0}, [STATUSWORD, POSITION]


def begin_enabled(bus):
    bus.values[STATUSWORD:POSITION], bus.values[TARGET:] = [0x27, 0x27], bus.values[POSITION:CONTROLWORD]


def boots_late(bus, cycle):
    bus.stale = [STATUSWORD, POSITION] if cycle < 100 else []
    if cycle <= 100:
        bus.values[STATUSWORD], bus.values[POSITION] = (0x00, 0) if bus.stale else (0x40, 1000)


def block(axis):
    """From cycle 100 on, the position of this axis stays where it is at that time."""
    stuck = []

    def fault(bus, cycle):
        if cycle >= 100:
            stuck.append(bus.values[POSITION + axis])
            bus.values[POSITION + axis] = stuck[0]
    return fault


def lag(bus, cycle):
    """The first axis is 150 counts behind its target while it moves forward."""
    bus.values[POSITION] = max(1000, bus.values[POSITION] - 150) if bus.values[POSITION] > 1000 else bus.values[POSITION]


def of_unit(name):
    return type("BusOfUnit", (Bus,), {"unit": name})


def terminate(bus):
    os.kill(os.getpid(), signal.SIGTERM)


def hang_up(bus):
    os.kill(os.getpid(), signal.SIGHUP)


def steps(bus):
    """The largest step between two target positions of the first axis."""
    targets = [command[TARGET] for command in bus.commands if TARGET in command]
    return max(abs(b - a) for a, b in zip(targets, targets[1:]))


def distance(unit):
    """Returns whether all went well, and how far the targets of the two axes are from their start, in this unit."""
    bus, code, told = run(kind=of_unit(unit))
    far = [max(abs(command[TARGET + axis] - start) for command in bus.commands) for axis, start in enumerate((1000, -500))]
    return code == GOOD, [raw * SCALE[unit] for raw in far]


sys.path[:0] = [str(AXES.parent), sys.argv[1]]
import takt  # noqa: E402  what lcm-gen made

bus, code, told = run()
check("two axes move there and back and are disabled", code == GOOD and bus.values[:POSITION] == [0x21, 0x21], told)
check("and released", bus.released, told)
check("its name has digits of its instance", bus.sender == f"axes.py {os.getpid()} {bus.instance & 0xFFFF:04x}", bus.sender)
farthest = max(command.get(TARGET, 0) for command in bus.commands)
check("by 1000 counts from where they were", farthest == 2000 and bus.values[POSITION] == 1000, farthest)
good, far = distance("m")
check("a linear axis moves by millimetres at most", good and all(0.001 <= metres <= 0.010 for metres in far), far)
good, far = distance("rad")
check("a rotary axis moves by a fraction of a turn", good and all(0.1 <= angle <= 1.6 for angle in far), far)
bus = ends("an axis of an unknown unit is not moved", "unit 'furlong'", lambda bus, cycle: None, releases=False,
           code=WRONG_USE, kind=of_unit("furlong"))
check("and nothing is commanded", not bus.commands, bus.commands[:1])

bus, code, told = run(at(1, trip))
check("a fault before the start is reset", code == GOOD and bus.values[STATUSWORD] == 0x21, told)
bus, code, told = run(at(1, begin_enabled))
check("axes that are enabled already do not jump", code == GOOD and bus.commands[0][TARGET] == 1000,
      (told, bus.commands[:1]))
bus, code, told = run(boots_late)
first = next(command for command in bus.commands if TARGET in command)
check("an axis that boots late is commanded from its position", code == GOOD and first[TARGET] == 1000, (told, first))
skip = at(300, lambda bus: setattr(bus, "cycle", bus.cycle + 200))
bus, code, told = run(skip)
check("missed cycles are no jump", code == GOOD and steps(bus) < 20, steps(bus))

skip_back = at(300, lambda bus: setattr(bus, "cycle", bus.cycle - 200))
bus, code, told = run(skip_back)
check("nor are cycles that begin again", code == GOOD and steps(bus) < 20, (code, told, steps(bus)))
for name, cycle in (("a negative cycle", -5), ("the lowest cycle", -2**63), ("a cycle of 2^62", 2**62), ("the highest cycle", 2**63 - 1),
                    ("a cycle far ahead", lambda image: image.cycle + 400), ("an old cycle", lambda image: image.cycle - 50)):
    changes_nothing(f"a forged image of {name}", forge(cycle=cycle))
changes_nothing("a forged image of another session", forge(session=99))
changes_nothing("a forged image of another layout", forge(layout_hash=99))
changes_nothing("a forged image of another schema", forge(schema=3))
changes_nothing("a forged image of places that do not exist", forge(first_signal=2**31 - 1))
changes_nothing("a forged image of negative places", forge(first_signal=-1))
changes_nothing("a forged part of an image", forge(parts=2, part=1, values=[0], num_values=1))
changes_nothing("an image that was cut off", lambda bus: bus.handlers["IMAGE"](None, bus.image().encode()[:60]))
changes_nothing("an image that claims to be longer", lambda bus: bus.handlers["IMAGE"](None, bus.image().encode()[:-4] + b"\x7f\xff\xff\xff"))

bus = ends("a fault in motion ends it", "axis1 left Operation enabled", at(300, trip))
is_disabled("and the other axis is disabled", bus, axes=[1])
ends("an axis that stays in Fault ends it", "axis1 does not reach Operation enabled: it is in Fault",
     lambda bus, cycle: trip(bus) if cycle < 15100 else None, kind=type("Patient", (Bus,), {"most_cycles": 17000}))
ends("an axis that another program holds is told with its name", "axis1 belongs to 'axes.py 0', and the commands of this "
     "program are refused", another_holds(0, 10000))
ends("and also where it is taken in motion", "axis1 belongs to 'axes.py 0'", another_holds(300, 10000))
bus, code, told = run(another_holds(0, 800))
check("an axis that becomes free within 2 s is moved", code == GOOD, told)
ends("commands without the key that the bus has end it", "this bus has `keys`; set TAKT_KEYS=FILE", without_key)
bus, code, told = run(at(50, refuse_envelope))
check("a program whose commands are taken does not mind the refusal of another one", code == GOOD, told)
bus, code, told = run(another_holds(300, 351))
check("one forged status changes nothing", code == GOOD, told)
ends("another session ends it", "restarted", at(300, restart), releases=False)
ends("a node that is silent in motion ends it", "no PDOs of axis1", at(300, die))
ends("a node that is silent at the end ends it", "no PDOs of axis1", at(1003, die))
ends("images that end end it", "no image", at(300, lambda bus: setattr(bus, "silent", True)))
bus, code, told = run(at(300, interrupt))
check("an exception in motion ends it", "KeyboardInterrupt" in told and bus.released, told)

bus = ends("a following error ends it with its exit code", "axis2 does not follow", block(1))
is_disabled("and both axes are disabled", bus)
bus, code, told = run(lag)
check("a following error within the limit is none", code == GOOD, told)
ends("--following-limit sets the limit", "the limit is 100", lag, options=["--following-limit", "100"])
ends("a limit that is no number is refused", "--following-limit", lambda bus, cycle: None, releases=False, code=WRONG_USE,
     options=["--following-limit", "nan"])

bus = ends("SIGTERM in motion ends it", "stopped by SIGTERM", at(300, terminate))
is_disabled("and both axes are disabled then", bus)
check("after they have slowed down", steps(bus) < 5 and bus.commands[-1][TARGET] > 1100, (steps(bus), bus.commands[-1]))
ends("SIGTERM before the motion ends it", "stopped by SIGTERM", at(2, terminate))
ends("a second signal ends it at once", "a second signal", lambda bus, cycle: terminate(bus) if cycle in (300, 310) else None)
hangs_up_twice = lambda bus, cycle: hang_up(bus) if cycle in (300, 310) else None
bus = ends("SIGHUP in motion ends it, and may come twice", "stopped by SIGHUP", hangs_up_twice)
is_disabled("and both axes are disabled then", bus)
check("after they have slowed down", steps(bus) < 5 and bus.commands[-1][TARGET] > 1100, (steps(bus), bus.commands[-1]))
usual = signal.signal(signal.SIGHUP, signal.SIG_IGN)
bus, code, told = run(hangs_up_twice)
signal.signal(signal.SIGHUP, usual)
check("under nohup SIGHUP changes nothing", code == GOOD, told)
evil = type("BusOfEvilNames", (Bus,), {"unit": "fur\x1b[5mlong\u009b"})
bus, code, told = run(kind=evil)
check("control characters of the bus do not come to the terminal", "unit 'fur?[5mlong?'" in told, told)
bus = ends("another schema is refused", "schema 3, this program schema 2", lambda bus, cycle: None, releases=False,
           code=WRONG_USE, kind=type("BusOfSchema3", (Bus,), {"schema": 3}))
check("and nothing is commanded there", not bus.commands, bus.commands[:1])


def reads_keys(name, message, change):
    """The message of axes.py about a key file that `change` has made from a valid one."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "bus.keys"
        file.write_text("# of this plant\nplant " + "5a" * 32 + "\n")
        file.chmod(0o600)
        os.environ["TAKT_KEYS"] = str(change(file) or file)
        bus, code, told = run()
        del os.environ["TAKT_KEYS"]
        check(name, code == WRONG_USE and message in told and not bus.commands, (code, told))


def seal(daemon, channel, data, counter, secret="5a" * 32, age=0):
    made = takt.envelope_t()
    made.utime, made.schema, made.session, made.instance, made.counter = time.time_ns() // 1000 - age, 1, 5, daemon, counter
    made.key, made.channel, made.size, made.data, made.mac = "plant", channel, len(data), data, bytes(32)
    sealed = made.encode()[:-32]
    return sealed + hashlib.blake2b(sealed, key=bytes.fromhex(secret), digest_size=32).digest()


def checks_images(name, forge):
    """Runs axes.py on a bus that signs its messages. `forge` makes what a stranger sends after each image. axes.py must
    come to its end."""
    class Signing(Bus):
        def __init__(self, fault):
            super().__init__(fault)
            self.counter, self.signed = 0, {}

        def subscribe(self, channel, handler):
            if channel == "DEMO_SIGNED":
                self.signed = handler
                self.handlers = {kind: lambda _, data, kind=kind: self.sign(f"DEMO_{kind}", data) for kind in ("LAYOUT", "IMAGE", "STATUS")}
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
        bus, code, told = run(kind=Signing)
        del os.environ["TAKT_KEYS"], os.environ["TAKT_CHECK_IMAGES"]
    check(name, code == GOOD and not hasattr(bus, "unsigned") and bus.values[:POSITION] == [0x21, 0x21], told)


def restarted(data):
    """The same message of another session: a program that accepts it ends."""
    kind = next(kind for kind in (takt.image_t, takt.layout_t, takt.status_t) if data[:8] == kind().encode()[:8])
    message = kind.decode(data)
    message.session += 1
    return message.encode()


def link(file):
    other = file.with_name("link")
    other.symlink_to(file)
    return other


reads_keys("a key file that the group reads is refused", "users other than its owner can access it: chmod 600",
           lambda file: file.chmod(0o640))
reads_keys("a key file that others write is refused", "users other than its owner can access it: chmod 600",
           lambda file: file.chmod(0o602))
reads_keys("a link to a key file is refused", "key file", link)
reads_keys("a folder is refused", "not a regular file", lambda file: file.parent)
reads_keys("a key file that is not there is refused", "key file", lambda file: file.with_name("none"))
reads_keys("a key that is too short is refused", "64 hexadecimal digits", lambda file: (file.write_text("plant 5a5a\n"), None)[1])
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
