#!/usr/bin/env python3
"""Enables all axes of a bus, moves each of them there and back in a sine, and disables them.

    axes.py BUS [SECONDS] [--following-limit LIMIT]

How to try it on the simulated bus of share/demo/two_axes.yaml:

    python3 -m venv venv && sh share/wheel.sh && venv/bin/pip install build/takt-*.whl
    taktd share/demo/two_axes.yaml --bus sim &
    venv/bin/python apps/python/axes.py demo

Each axis moves away from its actual position by a distance that depends on its unit (MOVES below), and
back. In each cycle of the bus, the daemon publishes an image of all inputs. From each image, this program
computes one set-point for each axis, and sends all set-points in one command.

If the following error of an axis exceeds its limit, or an axis leaves Operation enabled, or its PDOs
stop, all axes are disabled in order and the program ends with a message. The program does the same after
Ctrl-C, SIGTERM or SIGHUP (the terminal is closed), but first slows the motion down; a second signal other
than SIGHUP ends the program at once. In every case, the program releases its outputs at its end, and the
drives take the fallback of the network file.

If another program holds an axis, the daemon refuses the commands of this program. This program then names
the other program and ends, but first waits up to 2 s: a program that has died holds its axes until the
time to live of its last command has run out.

Exit codes: 0 the axes moved, 1 an axis did not follow, another program holds it, or the motion did not
come to its end, 2 wrong use, no axis to move or another schema, 3 no message of a daemon came.

If the bus has keys (share/doc/security.md): TAKT_KEYS=FILE, and TAKT_CHECK_IMAGES=true to accept
only images that the daemon has signed.
"""
import argparse
import collections
import math
import os
import random
import signal
import struct
import sys
import time

import lcm
from takt import command_t, event_t, image_t, layout_t, status_t  # types of LCM messages

SCHEMA = 2  # of the LCM messages that this program knows
GOOD, NOT_MOVED, WRONG_USE, NO_DAEMON = 0, 1, 2, 3  # exit codes

# Distance of the motion and largest following error by the unit of an axis. No unit: raw counts.
Move = collections.namedtuple("Move", "distance following_limit")
MOVES = {
    "rad": Move(0.5, 0.1),  # less than a twelfth of a turn
    "deg": Move(30.0, 6.0),
    "°": Move(30.0, 6.0),
    "m": Move(0.005, 0.001),  # five millimetres
    "mm": Move(5.0, 1.0),
    "": Move(1000.0, 200.0),
}
MOVE_TIME = 2.0  # seconds there and back

SLOW_DOWN_TIME = 0.5  # seconds from full speed to standstill after a signal
ENABLE_TIME = 30.0  # seconds until all axes have to be in Operation enabled
HELD_TIME = 2.0  # seconds until another program has to give up the axes
TAKEN_TIME = 0.5  # seconds for which another program may hold an axis during the motion
DISABLE_TIME = 2.0  # seconds until all axes have to be disabled
LAYOUT_TIME = 10.0  # seconds until the first layout and image have to come
IMAGE_TIME = 1  # seconds between two images
MOST_STALE_IMAGES = 50  # images in sequence without the PDOs of an axis
MOST_CYCLES = 5  # The motion advances by at most this many cycles, so missed cycles are no jump.
MOST_AHEAD = 16  # cycles between two images that follow each other
MOST_STRANGE = 3  # This number of images in sequence is accepted, whatever came before.

# The CiA 402 state machine: some bits of the statusword (0x6041) show the state. The controlword (0x6040)
# commands the next state on the way to Operation enabled, or on the way back.
State = collections.namedtuple("State", "name mask bits to_enable to_disable is_disabled")
OPERATION_ENABLED = State("Operation enabled", 0x6F, 0x27, 0x0F, 0x07, False)
STATES = (
    State("Not ready to switch on", 0x4F, 0x00, 0x00, 0x00, True),
    State("Switch on disabled", 0x4F, 0x40, 0x06, 0x00, True),
    State("Ready to switch on", 0x6F, 0x21, 0x07, 0x06, True),
    State("Switched on", 0x6F, 0x23, 0x0F, 0x06, False),
    OPERATION_ENABLED,
    State("Quick stop active", 0x6F, 0x07, 0x00, 0x00, False),
    State("Fault reaction active", 0x4F, 0x0F, 0x00, 0x00, False),
    State("Fault", 0x4F, 0x08, 0x80, 0x00, True),
)
UNKNOWN_STATE = State("an unknown state", 0, 0, 0x00, 0x00, False)
CYCLIC_SYNCHRONOUS_POSITION = 8  # mode of operation (0x6060)

# The objects of the first axis of a device, and whether they are outputs. Those of each further axis
# are 0x800 higher.
OBJECTS = {
    (0x6041, False): "statusword",
    (0x6064, False): "position",
    (0x6040, True): "controlword",
    (0x607A, True): "target",
    (0x6060, True): "mode",  # optional
}
FIRST_OBJECT, LAST_OBJECT, AXIS_STEP = 0x6000, 0x9FFF, 0x800


class Failure(Exception):
    """Ends the program with a message and an exit code."""

    def __init__(self, message, code=NOT_MOVED):
        super().__init__(message)
        self.code = code


class OrderedStop(Failure):
    """The motion ends early, but images still come: the axes are disabled in order."""


class StopSignals:
    """Remembers Ctrl-C, SIGTERM and SIGHUP until the motion has slowed down. A second signal ends the
    program at once, except SIGHUP, which may come several times when a terminal is closed."""

    def __init__(self):
        self.name = None
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self.on_signal)
        if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # It is ignored under nohup.
            signal.signal(signal.SIGHUP, self.on_signal)

    def on_signal(self, number, frame):
        if self.name and number == signal.SIGHUP:
            return
        if self.name:
            raise Failure("stopped by a second signal, without waiting for the axes")
        self.name = signal.Signals(number).name

    def received(self):
        return self.name is not None


class Bus:
    """Receives the layout and the images of one bus, and sends set-points to it."""

    def __init__(self, name, stop, envelopes=None, check_images=False):
        self.name, self.stop = name.upper(), stop
        self.envelopes = envelopes  # None: the bus has no keys
        self.layout, self.image = None, None  # the newest part of each
        self.complete = False  # The layout and an image have come in full.
        self.fresh = False  # An image has come in full since the last call of next_image().
        self.signals, self.values, self.stale = {}, {}, set()  # by place in the image
        self.strange = []  # the newest images in sequence that do not follow self.image
        self.holders = {}  # {node id: name of the program that commands its outputs}
        self.refusal = ""  # message of the daemon about a command without a key
        self.command = command_t()
        self.command.schema = SCHEMA
        self.command.instance = random.SystemRandom().randrange(1, 2**63)  # tells two senders apart
        # The daemon shows the name as the holder of nodes. Process ids repeat in containers.
        self.command.sender = f"axes.py {os.getpid()} {self.command.instance & 0xFFFF:04x}"
        try:
            self.link = lcm.LCM()  # LCM_DEFAULT_URL, else LCM's default
        except RuntimeError as wrong:
            raise Failure(f"no connection to LCM: {wrong}", NO_DAEMON) from None
        self.handlers = {
            f"{self.name}_LAYOUT": self.on_layout,
            f"{self.name}_IMAGE": self.on_image,
            f"{self.name}_STATUS": self.on_status,
            f"{self.name}_EVENT": self.on_event,
        }
        if check_images:
            self.link.subscribe(f"{self.name}_SIGNED", self.on_signed)
        else:
            for channel, handler in self.handlers.items():
                self.link.subscribe(channel, handler)

    def on_layout(self, channel, data):
        if self.complete:
            return
        try:
            layout = layout_t.decode(data)
        except ValueError:
            raise Failure("the daemon sends another layout_t than this program knows: run lcm-gen "
                          "with the types of the daemon", WRONG_USE) from None
        except struct.error:
            return  # It is incomplete.
        refuse_unknown_schema(layout.schema)
        if self.layout is None or identity(layout) != identity(self.layout):
            self.signals, self.values, self.stale, self.image = {}, {}, set(), None
        for entry in layout.signals:
            entry.node, entry.unit = printable(entry.node), printable(entry.unit)
        self.layout = layout  # A large layout comes in parts.
        self.signals.update(enumerate(layout.signals, layout.first_signal))

    def on_image(self, channel, data):
        try:
            image = image_t.decode(data)
        except (ValueError, struct.error):
            return  # The message is incomplete, or of another schema, which the layout shows.
        if not self.believes(image):
            return
        self.strange = []
        self.image = image  # A large image comes in parts, too.
        self.values.update(enumerate(image.values, image.first_signal))
        places = range(image.first_signal, image.first_signal + image.num_values)
        self.stale.difference_update(places)
        self.stale.update(self.signals.keys() & image.stale)
        self.fresh = image.part + 1 == image.parts

    def believes(self, image):
        """Returns whether to use an image. A single forged or late image is not used. An image that does
        not follow the newest one is used only if it is the third in a sequence, as after a restart of the
        daemon."""
        if self.layout is None or image.schema != SCHEMA:
            return False
        if identity(image) == identity(self.layout):
            if not 0 <= image.first_signal <= self.layout.total_signals - image.num_values:
                return False
            if self.image is None or follows(image, self.image):
                return True
        if self.strange and image.cycle == self.strange[-1].cycle:
            return False  # It may be another part of the same image.
        in_sequence = self.strange and follows(image, self.strange[-1])
        self.strange = [*self.strange, image] if in_sequence else [image]
        return len(self.strange) == MOST_STRANGE
    def on_status(self, channel, data):
        try:
            status = status_t.decode(data)
        except (ValueError, struct.error):
            return
        if self.layout and status.session == self.layout.session:
            self.holders.update((node.node_id, printable(node.holder)) for node in status.nodes)

    def on_event(self, channel, data):
        try:
            event = event_t.decode(data)
        except (ValueError, struct.error):
            return
        if event.kind == "envelope_refused" and f" {self.name}_COMMAND " in event.text:
            self.refusal = printable(event.text)

    def on_signed(self, channel, data):
        envelope = self.envelopes.open(data)
        if envelope and envelope.channel in self.handlers:
            self.handlers[envelope.channel](envelope.channel, envelope.data)

    def holds(self, axis):
        return self.holders.get(axis.node_id) == self.command.sender

    def other_holder(self, axis):
        """Returns the name of another program that holds the axis; empty if there is none."""
        return "" if self.holds(axis) else self.holders.get(axis.node_id, "")

    def receive(self, seconds):
        """Handles one message; returns False if none came in time."""
        try:
            return self.link.handle_timeout(math.ceil(1000 * seconds)) > 0
        except OSError:
            if self.stop.received():  # A signal interrupts the wait.
                return False
            raise Failure("the connection to LCM has ended",
                          NOT_MOVED if self.complete else NO_DAEMON) from None

    def receive_until(self, condition, seconds, failure):
        deadline = time.monotonic() + seconds
        while not condition():
            left = deadline - time.monotonic()
            if left <= 0:
                raise failure
            self.receive(left)

    def wait_for_layout(self):
        def condition():
            if self.stop.received():
                raise Failure(f"stopped by {self.stop.name}")
            if not self.layout or not self.image or identity(self.layout) != identity(self.image):
                return False
            return self.layout.total_signals == len(self.signals) == len(self.values)

        self.receive_until(condition, LAYOUT_TIME, Failure(
            f"no layout and image of the bus {self.name} for {LAYOUT_TIME:g} s: is taktd running, "
            "with the same LCM_DEFAULT_URL?", NO_DAEMON))
        self.complete = True

    def next_image(self):
        """Waits for the next image. Returns the seconds by which the motion advances: more than 0 for
        each image, so that every time limit that counts these seconds ends."""
        last = self.image.cycle
        self.receive_until(lambda: self.fresh, IMAGE_TIME, Failure(f"no image for {IMAGE_TIME} s"))
        while self.receive(0):
            pass  # Only the newest image counts.
        self.fresh = False
        if self.restarted():
            raise Failure("the daemon has restarted")
        cycles = max(1, min(self.image.cycle - last, MOST_CYCLES))
        return cycles * self.layout.period_ns * 1e-9

    def restarted(self):
        return identity(self.image) != identity(self.layout)

    def send(self, set_points):
        """Sends {place in the image: raw value}."""
        self.command.num_values = len(set_points)
        self.command.signals, self.command.values = list(set_points), list(set_points.values())
        self.publish_command()

    def release(self):
        """Gives up all outputs; the drives take their fallback at once."""
        if self.command.session == 0 or self.restarted():
            return  # This program has commanded nothing in this session of the daemon.
        self.command.release = True
        try:
            self.send({})
        except OSError:
            pass  # The connection has ended: the daemon notices that no command comes.

    def publish_command(self):
        self.command.utime = time.time_ns() // 1000
        self.command.session, self.command.cycle = self.layout.session, self.image.cycle
        channel, data = f"{self.name}_COMMAND", self.command.encode()
        if self.envelopes:
            data = self.envelopes.seal(channel, self.command.session, data)
            channel = f"{self.name}_SECURED"
        self.link.publish(channel, data)


def identity(message):
    """Identifies the run of the daemon and the order of the values: a layout and its images have the same
    identity."""
    return message.session, message.hash if isinstance(message, layout_t) else message.layout_hash


def follows(image, last):
    """Whether an image is the next part of `last`, or begins a newer image of the same run."""
    ahead = image.cycle - last.cycle
    is_next_part = ahead == 0 and image.part == last.part + 1
    begins = 0 < ahead <= MOST_AHEAD and image.part == 0
    return identity(image) == identity(last) and (is_next_part or begins)


def printable(text):
    """Makes a text of the bus safe for a terminal: without control characters."""
    return "".join(character if character.isprintable() else "?" for character in text)


def refuse_unknown_schema(schema):
    if schema != SCHEMA:
        raise Failure(f"the daemon has schema {schema}, this program schema {SCHEMA}", WRONG_USE)


class Axis:
    """One CiA 402 axis: its values in the image, and its set-points. Positions are raw."""

    def __init__(self, name, places, position_signal, following_limit=None):
        self.name = name
        self.places = places  # {"statusword": place in the image, ...}
        self.node_id = position_signal.node_id
        self.unit, self.scale = position_signal.unit, position_signal.scale
        if self.unit not in MOVES:
            raise Failure(f"{name} has the unit '{self.unit}'; this program knows distances only for "
                          + ", ".join(unit or "raw counts" for unit in MOVES), WRONG_USE)
        if self.unit == "":
            self.scale = 1.0
        self.move = MOVES[self.unit]
        if following_limit is not None:
            self.move = self.move._replace(following_limit=following_limit)
        self.state = UNKNOWN_STATE
        self.actual = None  # position; None until it was seen
        self.start = None  # position from which it moves
        self.target = None  # the newest target position
        self.controlword = 0
        self.stale_images = 0  # in sequence

    def read(self, bus):
        """Takes over statusword and position of the newest image, if both have arrived."""
        if bus.stale & {self.places["statusword"], self.places["position"]}:
            self.stale_images += 1
            return
        self.stale_images = 0
        self.state = decode_statusword(bus.values[self.places["statusword"]])
        self.actual = bus.values[self.places["position"]]

    def is_enabled(self):
        return self.state is OPERATION_ENABLED

    def is_silent(self):
        return self.stale_images > MOST_STALE_IMAGES

    def following_error(self):
        """Target minus actual position, in the unit of the axis."""
        return (self.target - self.actual) * self.scale

    def stay(self):
        """Holds the axis where it is. Until the axis is enabled, its target follows its actual
        position."""
        if self.start is None or not self.is_enabled():
            self.start = self.target = self.actual

    def go(self, seconds):
        """Sets the target for this time of the motion, which is a sine from the start position and
        back."""
        share = (1.0 - math.cos(2.0 * math.pi * seconds / MOVE_TIME)) / 2.0  # 0 .. 1 .. 0
        self.target = self.start + round(share * self.move.distance / self.scale)

    def set_points(self):
        """Returns {place in the image: raw value}; nothing until the position was seen."""
        if self.target is None:
            return {}
        wanted = {"controlword": self.controlword, "target": self.target,
                  "mode": CYCLIC_SYNCHRONOUS_POSITION}
        return {self.places[what]: value for what, value in wanted.items() if what in self.places}


def decode_statusword(statusword):
    return next((state for state in STATES if statusword & state.mask == state.bits), UNKNOWN_STATE)


def find_axes(signals, following_limit=None):
    """Returns the axes of a layout whose PDOs have all objects that a motion needs."""
    found = {}  # {(node, number of the axis in its device): {"statusword": place, ...}}
    for place, entry in signals.items():
        if entry.sub != 0 or not FIRST_OBJECT <= entry.index <= LAST_OBJECT:
            continue
        number, offset = divmod(entry.index - FIRST_OBJECT, AXIS_STEP)
        what = OBJECTS.get((FIRST_OBJECT + offset, bool(entry.output)))
        if what:
            found.setdefault((entry.node_id, number), {})[what] = place
    axes = []
    for (_, number), places in sorted(found.items()):
        if not {"statusword", "controlword"} <= places.keys():
            continue  # It is no axis.
        node = signals[next(iter(places.values()))].node
        name = node if number == 0 else f"{node}.{number + 1}"
        if not {"position", "target"} <= places.keys():
            print(f"{name} is not moved: its actual or its target position is in no PDO")
        else:
            axes.append(Axis(name, places, signals[places["position"]], following_limit))
    if not axes:
        raise Failure("there is no axis to move", WRONG_USE)
    return axes


def names(axes):
    return ", ".join(axis.name for axis in axes)


def send_set_points(bus, axes):
    bus.send({place: value for axis in axes for place, value in axis.set_points().items()})


def held_by_others(bus, axes):
    """Returns a sentence for the axes that other programs hold; empty if there is none."""
    return "; ".join(f"{axis.name} belongs to '{bus.other_holder(axis)}', and the commands of this "
                     "program are refused" for axis in axes if bus.other_holder(axis))


def enable(bus, axes, stop):
    """Brings all axes to Operation enabled, each at its actual position, and holds them there."""
    waited, held = 0.0, 0.0
    while True:
        step = bus.next_image()
        waited += step
        for axis in axes:
            axis.read(bus)
            if axis.stale_images == 0:  # Otherwise its last set-points are held.
                axis.stay()
                axis.controlword = axis.state.to_enable
        send_set_points(bus, axes)
        if stop.received():
            raise OrderedStop(f"stopped by {stop.name}")
        held = held + step if held_by_others(bus, axes) else 0.0
        if held > HELD_TIME:
            raise Failure(held_by_others(bus, axes))
        if waited > HELD_TIME and bus.refusal and not any(bus.holds(axis) for axis in axes):
            raise Failure(f"{bus.refusal}; set TAKT_KEYS=FILE")
        waiting = [axis for axis in axes
                   if axis.stale_images or not axis.is_enabled() or not bus.holds(axis)]
        if not waiting:
            return
        if waited > ENABLE_TIME:
            raise OrderedStop("; ".join(why_not_enabled(axis) for axis in waiting))


def why_not_enabled(axis):
    if axis.is_silent():
        return f"no PDOs of {axis.name}"
    if axis.is_enabled():
        return f"the daemon does not show that this program holds {axis.name}"
    return f"{axis.name} does not reach Operation enabled: it is in {axis.state.name}"


def move(bus, axes, seconds, stop):
    """Moves all axes there and back in a sine for this number of seconds."""
    elapsed, speed, held = 0.0, 1.0, 0.0
    while elapsed < seconds:
        step = bus.next_image()
        for axis in axes:
            axis.read(bus)
        held = held + step if held_by_others(bus, axes) else 0.0
        if held > TAKEN_TIME:
            raise Failure(held_by_others(bus, axes))
        check_motion(axes)
        if stop.received():
            speed = max(0.0, speed - step / SLOW_DOWN_TIME)
        elapsed = min(elapsed + speed * step, seconds)
        for axis in axes:
            axis.go(elapsed)
            axis.controlword = axis.state.to_enable
        send_set_points(bus, axes)
        if speed == 0.0:
            raise OrderedStop(f"stopped by {stop.name} after {elapsed:.1f} s of motion")


def check_motion(axes):
    """Compares the newest image with the targets that were sent before it."""
    silent = [axis for axis in axes if axis.is_silent()]
    if silent:
        raise OrderedStop(f"no PDOs of {names(silent)}")
    for axis in axes:
        if not axis.is_enabled():
            raise OrderedStop(f"{axis.name} left Operation enabled: it is in {axis.state.name}")
        error, limit = axis.following_error(), axis.move.following_limit
        if axis.stale_images == 0 and abs(error) > limit:
            raise OrderedStop(f"{axis.name} does not follow: its following error is {error:.4g} "
                              f"{axis.unit or 'counts'}, the limit is {limit:g}")


def disable(bus, axes):
    """Disables all axes in order. Returns a line for each axis that did not confirm this."""
    waited = 0.0
    while True:
        waited += bus.next_image()
        for axis in axes:
            axis.read(bus)
            axis.controlword = axis.state.to_disable
        send_set_points(bus, axes)
        left = [axis for axis in axes if axis.target is not None and not axis.state.is_disabled]
        if not left:
            return []
        if waited > DISABLE_TIME:
            return [f"no PDOs of {axis.name}" if axis.is_silent() else
                    f"{axis.name} does not confirm that it is disabled" for axis in left]


def enable_move_disable(bus, axes, seconds, stop):
    problems = []
    try:
        enable(bus, axes, stop)
        move(bus, axes, seconds, stop)
    except OrderedStop as why:
        problems.append(str(why))
    problems += [line for line in disable(bus, axes) if line not in problems]
    if problems:
        raise Failure("; ".join(problems))


def connect(options, stop):
    """Returns the bus, with signed envelopes if there is a key file."""
    envelopes, path = None, os.environ.get("TAKT_KEYS")
    check_images = os.environ.get("TAKT_CHECK_IMAGES") == "true"
    if path:
        from takt import Envelopes, read_keys
        try:
            envelopes = Envelopes(read_keys(path))
        except ValueError as wrong:
            raise Failure(str(wrong), WRONG_USE) from None
    elif check_images:
        raise Failure("TAKT_CHECK_IMAGES needs a key file: TAKT_KEYS=FILE", WRONG_USE)
    return Bus(options.bus, stop, envelopes, check_images)


def run(options):
    stop = StopSignals()
    bus = connect(options, stop)
    bus.wait_for_layout()
    axes = find_axes(bus.signals, options.following_limit)
    for axis in axes:
        unit = axis.unit or "counts"
        print(f"{axis.name} moves by {axis.move.distance:g} {unit} and back; its following error may "
              f"be up to {axis.move.following_limit:g} {unit}")
    seconds = MOVE_TIME * math.ceil(options.seconds / MOVE_TIME)  # The motion ends where it began.
    try:
        enable_move_disable(bus, axes, seconds, stop)
    finally:
        bus.release()
    print(f"{len(axes)} {'axis' if len(axes) == 1 else 'axes'} moved for {seconds:.1f} s")


def positive(text):
    value = float(text)
    if not 0.0 < value < math.inf:
        raise ValueError
    return value


def parse_command_line():
    parser = argparse.ArgumentParser(prog="axes.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bus", metavar="BUS", help="name of the bus in the network file")
    parser.add_argument("seconds", metavar="SECONDS", nargs="?", type=positive, default=10.0,
                        help="time of the motion, rounded up to whole moves (default: 10)")
    parser.add_argument("--following-limit", metavar="LIMIT", type=positive,
                        help="largest following error, in the unit of each axis (default: by unit)")
    return parser.parse_args()


def main():
    try:
        run(parse_command_line())
    except Failure as why:
        print(f"axes.py: {why}", file=sys.stderr)
        return why.code
    return GOOD


if __name__ == "__main__":
    sys.exit(main())
