"""The image of a bus in one cycle. Used by Bus."""
from __future__ import annotations

from collections.abc import Iterator, Mapping

from .link import Link, Obstacle
from .signals import decode


class Image(Mapping[str, float]):
    """The values of all signals in one cycle, by their names ("shoulder.position_actual_value"), in
    their units, or in raw counts if they have no unit. A value is computed when the program reads
    it."""

    def __init__(self, link: Link):
        self.cycle = link.cycle  # number of the SYNC
        self.time = link.sync_time  # of the SYNC by the clock of taktd, seconds since 1970
        self._names, self._signals = link.places, link.signals
        self._values, self._stale = dict(link.values), link.stale

    def __getitem__(self, name: str) -> float:
        place = self._names[name]
        return decode(self._signals[place], self._values[place])

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def raw(self, name: str) -> int:
        """The raw number of the device, without scale; for a REAL, the number of its bits."""
        return self._values[self._names[name]]

    def is_stale(self, name: str) -> bool:
        """True if the PDO of the signal did not arrive when it was expected, so that the value is
        older."""
        return self._names[name] in self._stale


def newest_image(link: Link, seconds: float) -> Image:
    """Waits for the next image that comes in full."""
    cycle = link.cycle
    if not link.wait(lambda: link.cycle != cycle, seconds):
        raise Obstacle("time over", f"no image of bus {link.bus} has come for {seconds:g} s")
    return Image(link)
