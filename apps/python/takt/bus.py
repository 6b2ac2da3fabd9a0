"""One bus of a taktd: its image, events and nodes, set-points, and the objects of its devices."""
from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from types import TracebackType

from .dictionary import Value, code_of, find_object, from_bytes, to_bytes
from .image import Image, newest_image
from .link import Link, Obstacle
from .messages import event_t, status_t
from .nodes import Node, node_of
from .outputs import Outputs, release
from .services import Services

MOST_EVENTS = 1000  # events that wait for take_events(); if more come, the oldest are lost


class Bus:
    """One bus, by its name in the network file. Messages are taken only while a call waits: a
    program that has nothing to do calls run() instead of time.sleep(). The name of a signal
    consists of the name of its node and its own name: "io.digital_input_1". Values are in the units
    of the network file, or raw counts if the signal has no unit.

    Each call raises Obstacle if something blocks it."""

    def __init__(self, bus: str, *, timeout: float = 0.5, longest: float = 10.0,
                 keys: str | None = None, check_images: bool | None = None):
        """Waits until an image of the bus has come. `timeout`: seconds of silence of this program
        after which its set-points end, 1 ms to 10 s. `longest`: most seconds that a call waits,
        unless the call has an argument for this time. `keys`: file with the key of the bus; None:
        TAKT_KEYS of the environment. `check_images`: accept only messages that taktd has signed;
        None: TAKT_CHECK_IMAGES is "true". share/doc/security.md describes both."""
        if not 0.001 <= timeout <= 10.0:
            raise Obstacle("wrong use", f"a timeout of {timeout} s is outside 1 ms to 10 s")
        self._link = Link(bus, timeout, longest, keys, check_images)
        self._services, self._outputs = Services(self._link), Outputs(self._link)
        self._events: deque[event_t] = deque(maxlen=MOST_EVENTS)
        self._status: status_t | None = None
        self._link.subscribe("EVENT", event_t, self._on_event)
        self._link.subscribe("STATUS", status_t, self._on_status)

    def __enter__(self) -> Bus:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.release()

    @property
    def sender(self) -> str:
        """The name of this object in events and in status_t."""
        return self._link.sender

    @property
    def period(self) -> float:
        """Seconds between two SYNCs."""
        return self._link.period

    # The image.

    @property
    def signals(self) -> list[str]:
        """The names of all signals, inputs before outputs."""
        return list(self._link.places)

    def signal(self, name: str) -> float:
        """The newest value of an input or output of any node, in its unit. `name` consists of the
        node and the signal in layout_t, "io.digital_input_1", or of the node and the object,
        "io.0x6000:1"."""
        return self._outputs.signal(name)

    def next_image(self, seconds: float = 2.0) -> Image:
        """Waits for the next image of the bus. Images that have come before are skipped."""
        return newest_image(self._link, seconds)

    # Set-points.

    def set(self, name: str, value: float) -> None:
        """Sets an output of any node, and returns when taktd sends it. The value stays while this
        program is alive: calls that wait repeat it. After a silence of `timeout` the node takes the
        fallback of `on_timeout`, and the value is not sent again. The end of the program, or
        release(), also ends the value."""
        self._outputs.confirm(self._outputs.raw(name, value))

    def command(self, values: Mapping[str, float], life: float = 0.0) -> None:
        """Sends these set-points once, from the newest image, and returns at once. They end after
        `life` seconds, or earlier if the network file says so; 0: after the time in the network
        file. taktd reports refused set-points by the event "command_refused"."""
        raw: dict[int, int] = {}
        for name, value in values.items():
            raw |= self._outputs.raw(name, value)
        cycles = max(1, round(life / self._link.period)) if life and self._link.period else 0
        self._outputs.send_once(raw, cycles)

    def release(self) -> None:
        """Gives up all nodes that this object commands: they take their fallbacks at once. Returns
        after the next image, because taktd refuses commands that are not newer than a release."""
        if self._outputs.drop():
            cycle = self._link.cycle
            release(self._link)
            self._link.wait(lambda: self._link.cycle > cycle, self._link.longest)

    # Events and nodes.

    def take_events(self) -> list[event_t]:
        """The events since the last call, the oldest first. Programs use `kind`, `node` and
        `severity` (0 note, 1 warning, 2 error); `text` is for people."""
        events = list(self._events)
        self._events.clear()
        return events

    def wait_event(self, kind: str = "", node: str = "", seconds: float = float("inf")) -> event_t:
        """Waits for an event of this kind and node; an empty text means any. Events that have come
        since the last take_events() count. The call takes the event and all events before it."""
        found: list[event_t] = []

        def comes() -> bool:
            while self._events and not found:
                event = self._events.popleft()
                if kind in ("", event.kind) and node in ("", event.node):
                    found.append(event)
            return bool(found)
        if not self._link.wait(comes, seconds):
            what = " ".join(filter(None, (kind or "event", node and f"of {node}")))
            raise Obstacle("time over", f"no {what} has come in {seconds:g} s")
        return found[0]

    @property
    def nodes(self) -> dict[str, Node]:
        """The nodes by name, as taktd has reported them last; empty before its first report."""
        return {node.name: node_of(node) for node in self._link.nodes.values()}

    @property
    def status(self) -> status_t:
        """The newest status_t: load, errors and counters of the bus. It may have only a part of the
        nodes."""
        self._link.wait(lambda: self._status is not None, self._link.longest)
        if self._status is None:
            raise Obstacle("no bus", f"no status of bus {self._link.bus} has come")
        return self._status

    def nmt(self, command: str, node: str = "all") -> None:
        """Commands NMT: "start", "stop", "preop", "reset" or "reset-comm". Before "stop" and
        "preop", taktd stops the enabled axes in order, and the call lasts until then."""
        self._services.nmt(command, node)

    # Time.

    def run(self, seconds: float) -> None:
        """Waits for this time; set-points and motions go on. Raises Obstacle if set-points were
        discarded because this program was silent."""
        self._link.wait(lambda: False, seconds)
        lost = self._outputs.take_loss()
        if lost:
            raise Obstacle("stopped", lost)

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Takes messages until `condition()` is true. Returns False if the time is over before
        that."""
        return self._link.wait(condition, seconds)

    # Objects of the devices.

    def sdo_read(self, name: str, type: str | None = None) -> Value:
        """Reads an object by SDO: "shoulder.statusword", "shoulder.0x6041:00" (hexadecimal), or
        "shoulder.identity_object.vendor_id". The value is that of the device, without scale. `type`
        (u8 to u64, i8 to i64, r32, r64, b, vs) is for objects whose type is not known; without
        `type`, their values are bytes. taktd makes the transfer; motions go on. An abort is an
        obstacle."""
        node, index, sub, known = find_object(self._link, name)
        code = code_of(name, type, known)
        return from_bytes(name, code, self.read(node, index, sub))

    def sdo_write(self, name: str, value: Value, type: str | None = None) -> None:
        """Writes an object by SDO. Names and types are those of sdo_read()."""
        node, index, sub, known = find_object(self._link, name)
        self.write(node, index, sub, to_bytes(name, code_of(name, type, known), value))

    def read(self, node: str, index: int, sub: int = 0) -> bytes:
        """Reads an object of a node by SDO; its bytes are in little-endian order. taktd makes the
        transfer. Motions go on. An abort is an obstacle, with its code in words."""
        return self._services.read(node, index, sub)

    def read_number(self, node: str, index: int, sub: int = 0, signed: bool = False) -> int:
        """Like read(), for an object that is a whole number."""
        return int.from_bytes(self.read(node, index, sub), "little", signed=signed)

    def write(self, node: str, index: int, sub: int, data: bytes) -> None:
        """Writes an object of a node by SDO. The number of bytes has to be that of the object."""
        self._services.write(node, index, sub, data)

    def write_number(self, node: str, index: int, sub: int, value: int, size: int) -> None:
        """Like write(), for an object that is a whole number of `size` bytes."""
        try:
            data = value.to_bytes(size, "little", signed=value < 0)
        except OverflowError as why:
            raise Obstacle("wrong use", f"{value} needs more than {size} bytes") from why
        self.write(node, index, sub, data)

    def _on_event(self, event: event_t) -> None:
        if event.session == self._link.session:
            self._events.append(event)

    def _on_status(self, status: status_t) -> None:
        if status.session == self._link.session and status.part == 0:
            self._status = status
