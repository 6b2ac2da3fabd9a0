"""Inputs and outputs of the nodes of a bus, by their names. Used by Axes."""
from __future__ import annotations

from .link import Link, Obstacle
from .messages import command_t
from .signals import decode, encode

ANSWER_TIME = 2.0  # seconds after which a value that taktd has not taken counts as refused
# The shortest time to live in cycles: a command needs some of them to arrive.
SHORTEST_LIFE = 3


class Outputs:
    """Raw values that are sent for each image, by their places in the layout. Their time to live is
    the timeout of the program. After a longer silence they are not sent again."""

    def __init__(self, link: Link):
        self._link, self._sent, self._lost = link, 0.0, ""
        self._has_nodes = False  # taktd may count nodes as held by this program
        self._values: dict[int, int] = {}
        link.in_each_cycle.append(self._send)

    def signal(self, name: str) -> float:
        link, place = self._link, self._place(name)
        if place not in link.values:
            raise Obstacle("blocked", f"{name}: no value has come")
        if place in link.stale:
            raise Obstacle("blocked", f"{name}: its newest value has not come in time")
        return decode(link.signals[place], link.values[place])

    def raw(self, name: str, value: float) -> dict[int, int]:
        """Returns {place: raw number} for a value of an output."""
        link, place = self._link, self._place(name)
        signal = link.signals[place]
        if not signal.output:
            raise Obstacle("wrong use", f"{name} is an input of the master: no program sets it")
        if any(place in axis.places.values() for axis in link.axes):
            raise Obstacle("wrong use", f"{name} commands an axis, so enable() and the motions "
                                        "set it")
        raw = encode(signal, value)
        if raw is None:
            raise Obstacle("wrong use", f"{name} can't hold {value} {signal.unit}".rstrip())
        return {place: raw}

    def confirm(self, values: dict[int, int]) -> None:
        """Holds these values, and waits until taktd sends them. If taktd refuses one of them, none
        of them is held any longer."""
        link = self._link
        nodes = {link.signals[place].node_id for place in values}
        link.events.clear()
        self.hold(values)

        def taken(place: int) -> bool:
            mask = (1 << link.signals[place].bits) - 1
            return (link.values.get(place, ~values[place]) ^ values[place]) & mask == 0

        link.wait(lambda: all(map(taken, values)) or self.refusal(nodes), ANSWER_TIME)
        late = [f"{link.signals[place].node}.{link.signals[place].name}" for place in values
                if not taken(place)]
        if late or self.refusal(nodes):
            for place in values:
                self._values.pop(place, None)
            raise Obstacle("refused", self.refusal(nodes) or link.refused_envelope("COMMAND") or
                           f"taktd has not taken {', '.join(late)}")

    def refusal(self, nodes: set[int]) -> str:
        """Returns why taktd has refused the newest values for these nodes, or an empty text."""
        limited = (event.text for event in self._link.events
                   if event.kind == "limit_exceeded" and event.node_id in nodes)
        return self._link.event("command_refused", self._link.sender) or next(limited, "")

    def hold(self, values: dict[int, int]) -> None:
        """Sends these values now and for each image."""
        self._drop_after_silence()
        self._values |= values
        self._has_nodes = True
        self._sent = self._link.now()
        self._send()

    def send_once(self, values: dict[int, int], cycles: int) -> None:
        """Sends these values once. They end after this number of cycles; 0: after the time in the
        network file."""
        self._has_nodes = True
        command(self._link, values, cycles)

    def drop(self) -> bool:
        """Stops sending values. Returns whether taktd may count nodes as held by this program."""
        had, self._has_nodes, self._values = self._has_nodes, False, {}
        return had

    def _place(self, name: str) -> int:
        node, _, part = name.partition(".")
        places = [place for place, signal in self._link.signals.items() if signal.node == node and
                  part in (signal.name, f"0x{signal.index:04X}:{signal.sub}")]
        if len(places) == 1:
            return places[0]
        known = [f"{signal.node}.{signal.name}" if not places else
                 f"{signal.node}.0x{signal.index:04X}:{signal.sub}"
                 for place, signal in self._link.signals.items()
                 if (place in places if places else signal.node == node)]
        what = "names several signals" if places else "names no signal of the PDOs"
        raise Obstacle("wrong use", f"'{name}' {what} of bus {self._link.bus}; there are: "
                                    f"{', '.join(known) or 'no signals of this node'}")

    def take_loss(self) -> str:
        """Returns, only once, a sentence if values were discarded after a silence; otherwise an
        empty text."""
        lost, self._lost = self._lost, ""
        return lost

    def _drop_after_silence(self) -> None:
        silence = self._link.now() - self._sent
        if any(self._values.values()) and silence > self._link.timeout:
            self._lost = (f"this program was silent for {silence * 1000:.0f} ms, so its set-points "
                          "were discarded")
        if silence > self._link.timeout:
            self._values = {}

    def _send(self) -> None:
        self._drop_after_silence()
        if not self._values:
            return
        link = self._link
        cycles = int(link.timeout / link.period) if link.period else 0
        command(link, self._values, max(SHORTEST_LIFE, cycles))
        self._sent = link.now()


def command(link: Link, values: dict[int, int], time_to_live: int = 0) -> None:
    """Sends raw values by their places in the layout. `time_to_live` is in cycles; 0: the time in
    the network file."""
    message = command_t()
    link.fill(message)
    message.signals, message.values = list(values), list(values.values())
    message.num_values, message.time_to_live = len(values), time_to_live
    link.publish("COMMAND", message)


def release(link: Link) -> None:
    """Gives up all nodes that this program holds."""
    message = command_t()
    link.fill(message)
    message.release = True
    link.publish("COMMAND", message)
