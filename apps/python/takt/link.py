"""The messages of one bus: their newest content, and how a program waits for them. Used by Axes."""
from __future__ import annotations

import os
import random
import struct
import sys
import time
from collections.abc import Callable
from typing import Any

import lcm

from .cia402 import (AXIS_STEP, CONTROLWORD, FIRST_OBJECT, INTERPOLATION_TARGET, LAST_OBJECT,
                     OBJECTS, STATUSWORD, Axis)
from .envelopes import envelopes_of
from .messages import (event_t, image_t, layout_t, motion_t, signal_t, speed_axes_t,
                       status_t)

SCHEMA = 2  # of the LCM messages that this module knows
IMAGE_TIME = 2.0  # seconds without an image after which the bus is gone
FLOOD = 100  # most messages that are taken in sequence, so that the program is not blocked
MOST_EVENTS = 64  # number of events that are kept


class Obstacle(Exception):
    """What blocks a call, in words. `kind` is "wrong use", "no bus", "blocked", "refused",
    "stopped", "time over" or "restarted"."""

    def __init__(self, kind: str, text: str):
        super().__init__(text)
        self.kind = kind


class Link:
    """The newest messages of a bus, and the messages to it. The users of this class add their
    functions to in_each_cycle, in_each_step and when_abandoned."""

    def __init__(self, bus: str, timeout: float, longest: float, keys: str | None = None,
                 check_images: bool | None = None):
        """Waits until an image of the bus has come, for at most `longest` seconds. `keys` and
        `check_images` are those of Bus."""
        try:
            self._envelopes, self._checks = envelopes_of(keys, check_images)
        except ValueError as why:
            raise Obstacle("wrong use", str(why)) from None
        self._handlers: dict[str, list[Callable[[str, bytes], None]]] = {}  # by channel
        self.bus, self.timeout, self.longest = bus.upper(), timeout, longest
        # A random number distinguishes two senders, also in one process.
        self.instance = random.SystemRandom().randrange(1, 2**63)
        program = os.path.basename(sys.argv[0])[:32] or "python"
        self.sender = f"{program} {os.getpid()} {self.instance & 0xFFFF_FFFF:08x}"
        self.commanding = False  # this program commands nodes, and gives signs of life
        self.found_axes: list[Axis] = []  # all axes of the bus with their words in PDOs
        self.axes: list[Axis] = []  # those of them that this program commands
        self.session, self.period, self.cycle, self.image_time = None, 0.0, -1, self.now()
        # Data of the newest image that has come in full. The keys are places in the layout.
        self.values: dict[int, int] = {}
        self.stale: set[int] = set()
        self.signals: dict[int, signal_t] = {}
        self.places: dict[str, int] = {}  # of the signals, by their names: "io.digital_input_1"
        self.sync_time = 0.0  # of the newest image, seconds since 1970
        self.events, self.nodes = [], {}
        self.in_each_cycle, self.in_each_step, self.when_abandoned = [], [], []
        self._restarted, self._utime, self._hash = False, 0, None
        self._found, self._layout_parts, self._image_parts, self._speed_parts = {}, set(), {}, {}
        try:
            self._lcm = lcm.LCM()  # LCM_DEFAULT_URL, else LCM's default
        except RuntimeError as why:
            raise Obstacle("no bus", f"no connection to LCM: {why}") from None
        if self._checks:
            self._lcm.subscribe(f"{self.bus}_SIGNED", self._on_signed)
        self.subscribe("SPEED_AXES", speed_axes_t, self._on_speed_axes)
        self.subscribe("LAYOUT", layout_t, self._on_layout)
        self.subscribe("IMAGE", image_t, self._on_image)
        self.subscribe("MOTION", motion_t, self._on_motion)
        self.subscribe("EVENT", event_t, self._on_event)
        self.subscribe("STATUS", status_t, self._on_status)
        end = self.now() + longest
        while self.cycle < 0:
            self.serve(0.05)
            if self.now() > end:
                raise Obstacle("no bus", f"no image of bus {bus} has come: is taktd running, with "
                                         "the same LCM URL?")

    def now(self) -> float:
        return time.monotonic()

    @property
    def names(self) -> str:
        return ", ".join(axis.name for axis in self.axes)

    # The content of the newest messages.

    def raw(self, axis: Axis, index: int) -> int | None:
        return self.values.get(axis.places.get(index))

    def value(self, axis: Axis, index: int) -> float:
        """Returns a value in the unit of the object; 0 if no PDO carries the object."""
        raw, signal = self.raw(axis, index), axis.signals.get(index)
        return 0.0 if raw is None else raw * signal.scale + signal.offset

    def event(self, kind: str, part: str = "") -> str:
        """Returns the text of the newest event of this kind that contains `part`, or an empty
        text."""
        return next((event.text for event in reversed(self.events)
                     if event.kind == kind and part in event.text), "")

    def refused_envelope(self, channel: str) -> str:
        """Returns the event text of taktd about a message without the key of the bus, or an empty
        text."""
        return self.event("envelope_refused", f" {self.bus}_{channel} ")

    def holder(self, axis: Axis) -> str:
        """The name of the program that holds the node of the axis."""
        return self.nodes[axis.node_id].holder if axis.node_id in self.nodes else ""

    def speed_words(self) -> list:
        """The speed axes of the layout, as speed_axis_t; empty until all of them have come."""
        parts = [part for (session, _), part in self._speed_parts.items()
                 if session == self.session]
        if not parts or len(parts) < parts[0].parts:
            return []
        return [words for part in sorted(parts, key=lambda part: part.part) for words in part.axes]

    # How a program waits.

    def wait(self, reached: Callable[[], bool], seconds: float) -> bool:
        """Takes messages and sends what is due until `reached()` is true. Returns False if the time
        is over before that."""
        end = self.now() + seconds
        try:
            while True:
                self.step()
                if reached():
                    return True
                if self.now() >= end:
                    return False
        except BaseException:
            for abandon in self.when_abandoned:  # the program may catch this and wait again
                abandon()
            raise

    def step(self) -> None:
        """Waits for a message for a short time, takes those that have come, and sends what is
        due."""
        before = self.now()
        self.serve(0.005)
        if self._restarted:
            self.commanding = False
            raise Obstacle("restarted", "taktd has restarted")
        if before - self.image_time > max(IMAGE_TIME, self.timeout):
            raise Obstacle("no bus", f"no image of bus {self.bus} has come for "
                                     f"{before - self.image_time:.1f} s")
        for send in self.in_each_step:
            send()

    def serve(self, seconds: float) -> None:
        """Handles all messages that have come; waits for the first one at most for this time."""
        cycle = self.cycle
        if self._lcm.handle_timeout(max(1, int(seconds * 1000))):
            for _ in range(FLOOD):
                if not self._lcm.handle_timeout(0):
                    break
        if self.cycle != cycle:
            for send in self.in_each_cycle:
                send()

    # Messages.

    def subscribe(self, channel: str, kind: Any, handler: Callable[[Any], None]) -> None:
        """Passes each message of this type to `handler`. Incomplete messages and messages with
        other fields are ignored. A layout_t with other fields raises Obstacle until a layout has
        come."""
        def decode(name: str, data: bytes) -> None:
            try:
                message = kind.decode(data)
            except ValueError:  # the type has other fields
                if kind is layout_t and self.session is None:
                    raise Obstacle("wrong use", "taktd sends another layout_t than this package "
                                                "knows: install the package of that "
                                                "taktd") from None
            except struct.error:
                pass
            else:
                handler(message)
        name = f"{self.bus}_{channel}"
        self._handlers.setdefault(name, []).append(decode)
        if not self._checks:
            self._lcm.subscribe(name, decode)

    def publish(self, channel: str, message: Any) -> None:
        name, data = f"{self.bus}_{channel}", message.encode()
        if self._envelopes:
            data, name = self._envelopes.seal(name, self.session, data), f"{self.bus}_SECURED"
        self._lcm.publish(name, data)

    def fill(self, message) -> None:
        """Writes the fields that all commands have. Each utime is later than all before, because a
        move_by needs this."""
        self._utime = max(self._utime + 1, int(time.time() * 1e6))
        message.utime, message.schema = self._utime, SCHEMA
        message.session, message.cycle = self.session, self.cycle
        message.instance, message.sender = self.instance, self.sender

    def _on_signed(self, channel: str, data: bytes) -> None:
        envelope = self._envelopes.open(data)
        for handler in self._handlers.get(envelope.channel, []) if envelope else []:
            handler(envelope.channel, bytes(envelope.data))

    def _on_speed_axes(self, message: speed_axes_t) -> None:
        if message.schema == SCHEMA:
            self._speed_parts[message.session, message.part] = message

    def _on_layout(self, layout: layout_t) -> None:
        if layout.schema != SCHEMA:
            raise Obstacle("wrong use", f"taktd uses schema {layout.schema} of the messages, "
                                        f"and this program uses {SCHEMA}")
        if self.session is not None:
            self._restarted |= (layout.session, layout.hash) != (self.session, self._hash)
            return
        self._layout_parts.add(layout.part)
        for place, signal in enumerate(layout.signals, layout.first_signal):
            self._add(place, signal)
        if len(self._layout_parts) == layout.parts:
            self.session, self._hash = layout.session, layout.hash
            self.period = layout.period_ns * 1e-9
            self.found_axes = [axis for _, axis in sorted(self._found.items())
                               if CONTROLWORD in axis.places and STATUSWORD in axis.places]

    def _add(self, place: int, signal) -> None:
        self.signals[place] = signal
        self.places[f"{signal.node}.{signal.name}"] = place
        index = FIRST_OBJECT + signal.index % AXIS_STEP
        if (not FIRST_OBJECT <= signal.index <= LAST_OBJECT or
                (index, bool(signal.output)) not in OBJECTS or
                signal.sub != (1 if index == INTERPOLATION_TARGET else 0)):
            return
        number = (signal.index - FIRST_OBJECT) // AXIS_STEP + 1
        name = signal.node if number == 1 else f"{signal.node}.{number}"
        axis = self._found.setdefault((signal.node_id, number),
                                      Axis(name, signal.node, signal.node_id, number))
        axis.places[index], axis.signals[index] = place, signal

    def _on_image(self, image: image_t) -> None:
        if self.session is None or (image.session, image.layout_hash) != (self.session, self._hash):
            return
        if any(part.cycle != image.cycle for part in self._image_parts.values()):
            self._image_parts = {}
        self._image_parts[image.part] = image
        if len(self._image_parts) < image.parts:
            return
        for part in self._image_parts.values():
            self.values.update(enumerate(part.values, part.first_signal))
        self.stale = {place for part in self._image_parts.values() for place in part.stale}
        self.cycle, self.sync_time = image.cycle, image.utime * 1e-6
        self.image_time = self.now()
        for axis in self.found_axes:
            if STATUSWORD in axis.places:
                axis.statusword = self.values[axis.places[STATUSWORD]] & 0xFFFF

    def _on_motion(self, motion: motion_t) -> None:
        if motion.session != self.session:
            return
        reported = {(axis.node_id, axis.axis): axis for axis in motion.axes}
        for axis in self.found_axes:
            if (axis.node_id, axis.number) in reported:
                axis.motion, axis.motion_cycle = reported[axis.node_id, axis.number], motion.cycle

    def _on_event(self, event: event_t) -> None:
        if event.session != self.session:
            return
        # The event of a stop that a program has requested is only a note, but it is kept, because
        # it is the reason why a motion has ended.
        if event.severity > 0 or event.kind == "motion_stopped":
            self.events = self.events[1 - MOST_EVENTS:] + [event]

    def _on_status(self, status: status_t) -> None:
        if status.session != self.session:
            return
        self.nodes.update((node.node_id, node) for node in status.nodes)
        shown = {node.node_id for node in status.nodes}
        for axis in self.found_axes:
            if axis.node_id in shown:
                other = self.holder(axis) not in ("", self.sender)
                axis.held = axis.held + 1 if other else 0
