"""The newest reported values of the axes of an Axes. Used by Axes."""
from __future__ import annotations

from .cia402 import POSITION, VELOCITY
from .homing import HOMED
from .link import Link
from .motions import Motions
from .profiles import Profiles
from .speed_axes import SpeedAxes


class View:
    """The properties of Axes. Each list has one element for each axis, in its unit."""

    _link: Link
    _speed: SpeedAxes | None  # None: axes with positions, which have the other two
    _motions: Motions | None
    _profiles: Profiles | None

    @property
    def names(self) -> list[str]:
        """The names of the axes, in the order of all values: "shoulder", "gantry.2"."""
        return [axis.name for axis in self._link.axes]

    @property
    def units(self) -> list[str]:
        """Units of the positions, or of the speeds of speed axes ("rpm", "Hz"). Empty: raw
        counts."""
        if self._speed:
            return self._speed.units
        return [axis.signals[POSITION].unit if POSITION in axis.signals else ""
                for axis in self._link.axes]

    @property
    def positions(self) -> list[float]:
        """Actual positions; 0 for speed axes."""
        return [self._link.value(axis, POSITION) for axis in self._link.axes]

    @property
    def velocities(self) -> list[float]:
        """Actual velocities; 0 where no PDO carries them."""
        if self._speed:
            return self._speed.speeds
        return [self._link.value(axis, VELOCITY) for axis in self._link.axes]

    @property
    def commanded_positions(self) -> list[float]:
        """Commanded positions; the actual ones before taktd reports motions."""
        return [axis.motion.position if axis.motion else self._link.value(axis, POSITION)
                for axis in self._link.axes]

    @property
    def following_errors(self) -> list[float]:
        """Commanded minus actual positions, as taktd has reported last."""
        return [axis.motion.following_error if axis.motion else 0.0 for axis in self._link.axes]

    @property
    def moving(self) -> bool:
        """True if at least one axis moves or is stopping, as taktd has reported last, or if a
        profile_move() is under way."""
        return self._speed.moving if self._speed else self._motions.moving or self._profiles.moving

    @property
    def homed(self) -> list[bool]:
        """True for an axis if taktd has seen a homing run of it end well since its node began to
        exchange PDOs."""
        return [axis.motion is not None and axis.motion.homing == HOMED
                for axis in self._link.axes]

    @property
    def locked(self) -> bool:
        """True if all axes have the positions that their gears prescribe."""
        return self._motions is not None and self._motions.locked

    @property
    def phase_errors(self) -> list[float]:
        """How far each axis is ahead of the position that its gear prescribes."""
        return [axis.motion.phase_error if axis.motion else 0.0 for axis in self._link.axes]

    @property
    def stream_left(self) -> float:
        """Seconds until the axes reach the newest point that the bus thread of taktd has, as taktd
        has reported last. 0 if no stream runs."""
        return self._motions.stream_left if self._motions else 0.0
