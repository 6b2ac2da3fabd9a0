"""Homing of the axes of an Axes by the methods of their drives, CiA 402-2. Used by Axes."""
from __future__ import annotations

from .cia402 import (CONTROLWORD, CYCLIC_SYNCHRONOUS_POSITION, HOMING, HOMING_RESULT, KEEPING,
                     START_HOMING, TARGET_REACHED, Axis)
from .drives import NOT_ENABLED, WORD_CYCLES, Drives
from .link import Link, Obstacle

HOMED, HOMING_FAILED = 2, 3  # axis_motion_t::homing
START_TIME = 1.0  # seconds for which a drive may show that it has not begun
LONGEST_RUN = 60.0  # seconds, if taktd reports no time


def home(link: Link, drives: Drives, axes: list[Axis], seconds: float) -> None:
    """Homes these axes together. At the end, also after an obstacle, sets the mode in which taktd
    moves them."""
    try:
        _enter(link, drives, axes)
        _run(link, drives, axes, seconds)
    except BaseException:
        try:
            _leave(link, drives, axes)
        except Obstacle:
            pass  # the first obstacle is raised
        raise
    _leave(link, drives, axes)


def _enter(link: Link, drives: Drives, axes: list[Axis]) -> None:
    for axis in axes:
        axis.change_mode(HOMING)
    drives.words, begin = KEEPING, link.cycle

    def there() -> bool:
        shown = all(drives.shown_mode(axis) == HOMING for axis in axes)
        return shown and link.cycle >= begin + WORD_CYCLES

    def disabled() -> bool:
        return not all(axis.enabled for axis in axes)
    if not link.wait(lambda: there() or disabled(), link.longest) or disabled():
        raise Obstacle("blocked", "; ".join(filter(None, map(drives.why, axes))) or "; ".join(
            f"{axis.name}: it does not show homing mode (0x6061 is {drives.shown_mode(axis)}): is "
            "0x6060 in an RPDO, and does the drive support this mode (0x6502)?"
            for axis in axes if drives.shown_mode(axis) != HOMING))


def _run(link: Link, drives: Drives, axes: list[Axis], seconds: float) -> None:
    """Waits for the results that taktd reports. Reports from the first WORD_CYCLES cycles after the
    start are not used, because they may be about the state before this run."""
    for axis in axes:
        axis.mode_bits = START_HOMING
    started, moved = {}, {axis: link.now() for axis in axes}
    longest = seconds or max((axis.motion.homing_timeout_ms / 1000 or LONGEST_RUN) for axis in axes)

    def done(axis: Axis) -> bool:
        if not axis.enabled:
            raise Obstacle("stopped", f"the homing was interrupted: {drives.why(axis)}")
        if axis not in started and (link.raw(axis, CONTROLWORD) or 0) & START_HOMING:
            started[axis] = link.cycle
        if axis.motion_cycle < started.get(axis, link.cycle) + WORD_CYCLES:
            moved[axis] = link.now()
            return False
        if axis.motion.homing == HOMING_FAILED:
            told = link.event("homing_failed", f"{axis.name}:")
            raise Obstacle("stopped", f"{axis.name}: the drive reports a homing error: bit 13 of "
                                      f"its statusword 0x{axis.statusword:04X} is 1" +
                           (f" ({told})" if told else ""))
        if axis.statusword & (HOMING_RESULT | TARGET_REACHED) != TARGET_REACHED:
            moved[axis] = link.now()
        if link.now() - moved[axis] > START_TIME:
            raise Obstacle("stopped", f"{axis.name}: the drive has not begun the homing, or has "
                                      "interrupted it: bits 12 and 13 of its statusword "
                                      f"0x{axis.statusword:04X} are 0, and bit 10 is 1")
        return axis.motion.homing == HOMED
    if not link.wait(lambda: all([done(axis) for axis in axes]), longest):
        raise Obstacle("time over", "; ".join(
            f"{axis.name}: the homing has not ended after {longest:.1f} s: its statusword is "
            f"0x{axis.statusword:04X}" for axis in axes if not done(axis)))


def _leave(link: Link, drives: Drives, axes: list[Axis]) -> None:
    """Ends the runs, waits until the axes are at rest, and sets the mode in which taktd moves them.
    Until the drives follow target positions again, taktd lets the targets follow the actual
    positions."""
    for axis in axes:
        axis.mode_bits = 0
    if not drives.wait_for_rest(axes):
        raise Obstacle("time over", "the axes still move")
    for axis in axes:
        axis.change_mode(CYCLIC_SYNCHRONOUS_POSITION)
    drives.words = KEEPING
    link.wait(lambda: all(not axis.enabled or axis.motion.state != NOT_ENABLED for axis in axes),
              link.longest)
    drives.keep()
    if not drives.ready():
        raise Obstacle("blocked", drives.why_not_ready())
