#!/usr/bin/env python3
"""python_bus_test.py TYPES - tests takt.Bus on the bus of python_daemon.py (the image, set-points, events, nodes, SDO
by names, NMT, keys), and the pages about the package."""
import collections.abc
import pathlib
import re
import sys
import tempfile

from python_daemon import PERIOD, SHORT, Daemon, check, failures, obstacle, takt
import message_stubs
from takt import Bus, Envelopes, link, read_keys

TREE = pathlib.Path(__file__).resolve().parent.parent.parent


def on_a_bus(kind=Daemon, longest=SHORT, **options):
    daemon = link.lcm = link.time = kind()
    return daemon, Bus("lift", longest=longest, **options)


daemon, bus = on_a_bus()
daemon.io[0x6000] = 5
daemon.drives[0].position = 1.25
image = bus.next_image()
check("an image has values in units by names", (image["io.switches"], image["shoulder.position"]) == (5.0, 1.25), dict(image))
check("and raw numbers", image.raw("shoulder.position") == 1250 and not image.is_stale("shoulder.position"))
check("it has all signals", len(image) == len(bus.signals) == 16 and "elbow.target" in image, len(image))
daemon.drives[0].position = 2.0
later = bus.next_image()
check("it does not change", image["shoulder.position"] == 1.25 and later["shoulder.position"] == 2.0)
check("a later one has a later cycle", later.cycle > image.cycle)
check("a name that does not exist is no signal", "shoulder.nothing" not in image)
check("so says the bus", obstacle(bus.signal, "shoulder.nothing")[0] == "wrong use")
check("a program that only listens commands nothing", not daemon.sender)
with bus:
    pass
check("and gives nothing up", daemon.released == 0)



class InParts(Daemon):
    """A daemon whose images come in two parts; `drops` names the parts that are lost."""
    @staticmethod
    def drops(cycle, part):
        return False

    def image(self):
        parts = [super(InParts, self).image() for _ in range(2)]
        for part, image in enumerate(parts):
            image.parts, image.part, image.first_signal, image.values = 2, part, 8 * part, image.values[8 * part:8 * part + 8]
            image.num_values = len(image.values)
            if not self.drops(self.cycle, part):
                self.waiting.append(("IMAGE", image))
        return takt.event_t()  # no image, which changes nothing


daemon, bus = on_a_bus(InParts)
check("an image may come in parts", bus.next_image()["io.switches"] == 0.0)
daemon.drops = lambda cycle, part: (cycle + part) % 2
daemon.io[0x6000], daemon.drives[0].position = 1, 3.0
check("parts of two cycles are no image", obstacle(bus.next_image, 0.1)[0] == "time over" and
      bus.signal("shoulder.position") == 0.0 and bus.signal("io.switches") == 0.0)
daemon.drops = InParts.drops
check("the next whole one is", bus.next_image()["shoulder.position"] == 3.0)

daemon, bus = on_a_bus()
for channel, kind in (("IMAGE", takt.image_t), ("STATUS", takt.event_t), ("EVENT", takt.event_t)):
    for handler in daemon.handlers[channel]:
        handler(f"LIFT_{channel}", kind().encode()[:20])
        handler(f"LIFT_{channel}", b"what is this")
check("messages that are cut off change nothing", bus.next_image().cycle > 0)


class Newer(Daemon):
    def pass_cycle(self):
        self.waiting.append(("LAYOUT", takt.event_t()))


check("a taktd of another version is told", "another layout_t" in obstacle(on_a_bus, Newer)[1], obstacle(on_a_bus, Newer))

daemon, bus = on_a_bus()
bus.set("io.valve", -1.5)
check("an output is set in its unit", daemon.io[0x6411] == -1500)
bus.run(1.0)
check("it stays while a call waits", daemon.io_life > daemon.cycle)
bus.release()
life = daemon.io_life
bus.run(0.1)
check("until it is given up", daemon.released == 1 and daemon.io_life == life)
bus.command({"io.valve": 0.25}, life=0.02)
check("a command has its time to live", daemon.io[0x6411] == 250 and daemon.io_life - daemon.cycle == round(0.02 / PERIOD),
      daemon.io_life - daemon.cycle)
bus.run(0.1)
check("and is not repeated", daemon.io_life < daemon.cycle)
bus.command({"shoulder.controlword": 6.0})
bus.run(0.01)
check("a Bus commands words of drives, too", daemon.drives[0].statusword == 0x231, hex(daemon.drives[0].statusword))
with bus:
    pass
check("the end gives its nodes up", daemon.released == 2)
for name, value in (("io.valve", 40.0), ("io.switches", 1.0), ("io.lamp", 1.0)):
    check("a wrong set-point is named", obstacle(bus.command, {name: value})[0] == "wrong use", name)

daemon, bus = on_a_bus()
daemon.say("boot_failed", "node 10 failed to boot", 10)
daemon.say("emcy", "shoulder: 0x8611", 5)
event = bus.wait_event("emcy", seconds=1.0)
check("an event is waited for", event.text == "shoulder: 0x8611" and not bus.take_events())
daemon.say("emcy", "again", 5)
bus.run(0.01)
check("events wait for their program", [event.text for event in bus.take_events()] == ["again"])
check("one that does not come is named", obstacle(bus.wait_event, "emcy", "io", 0.1) ==
      ("time over", "no emcy of io has come in 0.1 s"), obstacle(bus.wait_event, "emcy", "io", 0.1))
bus.run(0.1)
check("nodes are known by name", {name: node.boot for name, node in bus.nodes.items()} ==
      {"shoulder": "ready", "elbow": "ready"}, bus.nodes)
check("with their states in words", bus.nodes["shoulder"].state == "operational" and bus.nodes["shoulder"].heartbeat_age == 0.04,
      bus.nodes["shoulder"])
check("the status is there", bus.status.session == 7)

daemon, bus = on_a_bus()
daemon.objects = {(5, 0x6041, 0): b"\x37\x02", (5, 0x6064, 0): (-5).to_bytes(4, "little", signed=True), (5, 0x1008, 0): b"drive",
                  (5, 0x1018, 1): b"\xCD\xAB\0\0", (5, 0x2000, 3): b"\xFE\xFF", (5, 0x6083, 0): bytes(4)}
check("SDO knows the signals of a node", bus.sdo_read("shoulder.statusword") == 0x237)
check("with their types", bus.sdo_read("shoulder.position") == -5)
check("and objects by index", bus.sdo_read("shoulder.0x6041:00") == bus.sdo_read("shoulder.6041") == 0x237)
check("and those of the standards", (bus.sdo_read("shoulder.identity_object.vendor_id"),
                                     bus.sdo_read("shoulder.manufacturer_device_name")) == (0xABCD, "drive"))
bus.sdo_write("shoulder.profile_acceleration", 1000)
check("SDO writes by name", daemon.objects[5, 0x6083, 0] == b"\xE8\x03\0\0", daemon.objects[5, 0x6083, 0])
check("an object of an unknown type is bytes", bus.sdo_read("shoulder.0x2000:3") == b"\xFE\xFF")
check("or of the type that is given", bus.sdo_read("shoulder.0x2000:3", "i16") == -2)
bus.sdo_write("shoulder.0x2000:3", 7, "u16")
check("also to write it", daemon.objects[5, 0x2000, 3] == b"\x07\0")
for call, words in (((bus.sdo_write, "shoulder.0x2000:3", 7), "give `type`"), ((bus.sdo_write, "shoulder.0x2000:3", 70000, "u16"), "can't hold"),
                    ((bus.sdo_read, "shoulder.0x2000:3", "u17"), "not one of the types"), ((bus.sdo_read, "shoulder.colour"), "give its index"),
                    ((bus.sdo_read, "wrist.0x2000:3"), "no node 'wrist'"), ((bus.sdo_write, "shoulder.statusword", 1.5), "does not fit 1.5")):
    kind, text = obstacle(*call)
    check(f"a wrong access is named: {words}", kind == "wrong use" and words in text, (kind, text))
kind, text = obstacle(bus.sdo_read, "shoulder.0x2000:3", "u32")
check("a value of another size is refused", kind == "refused" and "4 bytes, and the device has sent 2" in text, text)
check("and so is an abort", obstacle(bus.sdo_read, "shoulder.0x5000:0")[0] == "refused")
check("NMT reaches nodes", obstacle(bus.nmt, "preop", "elbow")[0] == "none" and daemon.nmt == [(128, 6)], daemon.nmt)
check("or all", obstacle(bus.nmt, "start")[0] == "none" and daemon.nmt[-1] == (1, 0))
check("a wrong command is named", obstacle(bus.nmt, "halt", "elbow")[0] == "wrong use")


class Locked(Daemon):
    """A taktd with a key, which signs what it publishes."""
    forged = False

    def __init__(self):
        super().__init__()
        self.envelopes = Envelopes(KEYS)
        self.own = Envelopes({"other": bytes(32)} if self.forged else KEYS)
        self.refused = 0

    def publish(self, channel, data):
        envelope = self.envelopes.open(data) if channel == "LIFT_SECURED" else None
        if envelope:
            return super().publish(envelope.channel, bytes(envelope.data))
        self.refused += 1
        self.say("envelope_refused", f"a message on {channel} was refused: this bus has `keys`")

    def handle_timeout(self, milliseconds):
        signed = self.handlers.get("SIGNED")
        if not signed:
            return super().handle_timeout(milliseconds)
        if not self.waiting and milliseconds == 0:
            return 0
        if not self.waiting:
            self.pass_cycle()
        channel, message = self.waiting.pop(0)
        for handler in signed:
            handler("LIFT_SIGNED", self.own.seal(f"LIFT_{channel}", 7, message.encode()))
        return 1


with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "lift.keys"
    path.write_text("plant " + "ab" * 32 + "\n")
    path.chmod(0o644)
    kind, text = obstacle(Bus, "lift", keys=str(path))
    check("a key file for all is refused", kind == "wrong use" and "chmod 600" in text, (kind, text))
    path.chmod(0o600)
    KEYS = read_keys(str(path))
    daemon, bus = on_a_bus(Locked, keys=str(path))
    daemon.objects = {(5, 0x6041, 0): b"\x37\x02"}
    bus.set("io.valve", 1.0)
    check("with the key, commands and requests are accepted", daemon.io[0x6411] == 1000 and not daemon.refused and
          bus.sdo_read("shoulder.statusword") == 0x237)
    daemon, bus = on_a_bus(Locked)
    kind, text = obstacle(bus.set, "io.valve", 1.0)
    check("without it, the refusal is told", kind == "refused" and "this bus has `keys`" in text, (kind, text))
    kind, text = obstacle(bus.sdo_read, "shoulder.statusword")
    check("also that of a request", kind == "refused" and "this bus has `keys`" in text, (kind, text))
    daemon, bus = on_a_bus(Locked, keys=str(path), check_images=True)
    check("signed images are read", bus.next_image().cycle > 0)
    Locked.forged = True
    check("forged ones are not", obstacle(on_a_bus, Locked, keys=str(path), check_images=True)[0] == "no bus")
check("signed images need a key", obstacle(Bus, "lift", check_images=True)[0] == "wrong use")

pages = {name: (TREE / f"share/doc/{name}.md").read_text() for name in ("python", "axis_library", "application", "motion", "speed")}
for kind in (Bus, takt.Axes, takt.Image):
    for name in (name for name in dir(kind) if not name.startswith("_") and name not in dir(collections.abc.Mapping)):
        told = any(re.search(rf"\b{name}\b", page) for page in pages.values())
        check(f"{kind.__name__}.{name} has a docstring and a place in the pages", getattr(kind, name).__doc__ and told)
for page, program in (("python", "first_motion"), ("python", "first_bus"), ("application", "first_motion"), ("motion", "first_motion"),
                      ("speed", "first_speed")):
    code = (TREE / f"apps/python/{program}.py").read_text().partition('"""\n')[2]
    check(f"{page}.md shows {program}.py", f"```python\n{code}```\n" in pages[page])

types = {path.stem for path in (TREE / "share/lcm").glob("*.lcm")}
for name in sorted(types):
    fields = [field for field, _ in message_stubs.fields_of((TREE / f"share/lcm/{name}.lcm").read_text())]
    check(f"the hints of {name} have its fields", fields == getattr(takt, name).__slots__, fields)
hints = dict(message_stubs.fields_of((TREE / "share/lcm/envelope_t.lcm").read_text()))
hints |= dict(message_stubs.fields_of((TREE / "share/lcm/layout_t.lcm").read_text()))
check("with types", (hints["utime"], hints["key"], hints["mac"], hints["signals"]) == ("int", "str", "bytes", "list[signal_t]"), hints)
check("the package has each type of share/lcm", types == set(takt.messages.__all__), types ^ set(takt.messages.__all__))
sys.exit(1 if failures else 0)
