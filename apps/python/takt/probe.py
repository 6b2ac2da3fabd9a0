"""Touch probes of drives, CiA 402-2, 0x60B8 to 0x60BD. Used by Axes."""
from __future__ import annotations

from .cia402 import AXIS_STEP, POSITION, PROBE_FUNCTION, PROBE_POSITION, PROBE_STATUS, Axis
from .drives import WORD_CYCLES
from .link import Link, Obstacle
from .outputs import Outputs
from .services import Services

EDGES = ("rising", "falling")
# Bits of 0x60B8 and 0x60B9 for input 1; those of input 2 are 8 bits above.
ENABLE, INDEX_PULSE, FIRST_EDGE, FIRST_STORED = 0x01, 0x04, 0x10, 0x02
PAUSE = 0.01  # seconds between two reads by SDO, so that they do not fill the bus


class Probe:
    """One edge of one input of a drive. Its objects are read and written in PDOs where they are
    mapped, else by SDO."""

    def __init__(self, link: Link, services: Services, outputs: Outputs, axis: Axis):
        self._link, self._services, self._outputs, self._axis = link, services, outputs, axis

    def wait(self, number: int, edge: str, index_pulse: bool, seconds: float) -> float:
        """Arms the input, and returns the position at the edge in the unit of the axis."""
        if number not in (1, 2) or edge not in EDGES:
            raise Obstacle("wrong use", "a touch probe is input 1 or 2 with the edge rising or "
                                        f"falling, not {number} and {edge}")
        if POSITION not in self._axis.signals:
            raise Obstacle("blocked", f"{self._axis.name}: 0x6064 is in no TPDO, so the unit of "
                                      "its positions is not known")
        place, shift = EDGES.index(edge), 8 * (number - 1)
        armed = (ENABLE | (INDEX_PULSE if index_pulse else 0) | FIRST_EDGE << place) << shift
        stored = FIRST_STORED << place << shift
        others = self._read(PROBE_FUNCTION) & (0xFF00 >> shift)  # the other input stays as it is
        try:
            self._write(others)
            self._await(lambda: not self._read(PROBE_STATUS) & stored, WORD_CYCLES,
                        "0x60B9 still shows an edge from before after 0x60B8 was cleared")
            self._write(others | armed)
            self._await(lambda: self._read(PROBE_STATUS) & stored, seconds / self._link.period,
                        f"no {edge} edge of touch probe {number} has come in {seconds:g} s")
            raw = self._read(PROBE_POSITION + 2 * (number - 1) + place)
        except BaseException:
            try:
                self._write(others)
            except Obstacle:
                pass  # the first obstacle is raised
            raise
        self._write(others)
        signal = self._axis.signals[POSITION]
        return (raw - (raw >> 31 << 32)) * signal.scale + signal.offset

    def _await(self, reached, cycles: float, words: str) -> None:
        """Waits until `reached()` is true. Tests it at least once after this number of cycles. The
        loss of the axis ends the wait."""
        begin, in_pdo = self._link.cycle, PROBE_STATUS in self._axis.places
        while True:
            late = self._link.cycle > begin + cycles
            if reached():
                return
            if late:
                raise Obstacle("time over", f"{self._axis.name}: {words}")
            self._link.wait(lambda: False, 0.0 if in_pdo else PAUSE)

    def _read(self, index: int) -> int:
        """Returns an object as an unsigned number."""
        raw = self._link.raw(self._axis, index)
        if raw is not None:
            return raw & 0xFFFF_FFFF
        data = self._services.read(self._axis.node, self._index(index), 0)
        return int.from_bytes(data, "little")

    def _write(self, function: int) -> None:
        if PROBE_FUNCTION in self._axis.places:
            self._outputs.confirm({self._axis.places[PROBE_FUNCTION]: function})
        else:
            self._services.write(self._axis.node, self._index(PROBE_FUNCTION), 0,
                                 function.to_bytes(2, "little"))

    def _index(self, index: int) -> int:
        return index + AXIS_STEP * (self._axis.number - 1)
