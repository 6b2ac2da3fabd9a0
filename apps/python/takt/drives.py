"""The states and modes of the drives of an Axes: enable, disable, reset, mode, Halt, quick stop.
Used by Axes."""
from __future__ import annotations

from .cia402 import (CONTROLWORD, CYCLIC_SYNCHRONOUS_POSITION, DISABLED, DISABLING, ENABLED,
                     ENABLING, FAULTS, HALT, KEEPING, MODE, MODE_DISPLAY, POSITION, QUICK_STOP,
                     QUICK_STOPPING, RESETTING, VELOCITY, Axis)
from .link import Link, Obstacle
from .outputs import command, release

NOT_ENABLED, MOVES, STOPS = 0, 2, 3  # axis_motion_t::state
# The state to which this program has brought the drives, which decides whether it may move them.
IDLE, READY, HALTED = "not enabled", "enabled", "halted"
BOOT_READY = 2  # node_status_t::boot_state
# enable() gives up if another program holds an axis in this number of status_t in sequence. There
# are ten status_t in a second.
HELD_STATUSES = 20
WORD_CYCLES = 10  # cycles in which a drive may still show its words from before a command
# Counts by which the position of an axis at rest may vary, and the number of cycles. Both pairs
# mean the same speed; the second pair is for encoders with many counts.
REST_WINDOWS = ((2, WORD_CYCLES), (20, 10 * WORD_CYCLES))
MOST_COUNTS_APART = 100  # counts by which target and actual position may differ at enable()
LOW_TIME = 0.1  # seconds for which bit 7 of the controlword is low before its rising edge


class Drives:
    """Sends controlwords and modes while a state or a mode changes, and until the first motion has
    begun. In the modes in which taktd moves axes, the values then stay valid while this program
    gives signs of life. In other modes, they are sent for each image."""

    def __init__(self, link: Link):
        self._link = link
        for axis in link.axes:
            axis.change_mode(CYCLIC_SYNCHRONOUS_POSITION)
        self.words = None  # the controlword for each state; None while no controlwords are sent
        self.readiness = IDLE
        self._has_begun = False  # taktd has begun a motion since the drives were enabled
        link.in_each_cycle.append(self._send)

    def enable(self) -> str:
        """Returns why the axes are not enabled, or an empty text."""
        link = self._link
        for axis in link.axes:
            axis.change_mode(CYCLIC_SYNCHRONOUS_POSITION)
            axis.has_own_target |= not axis.enabled and self._target_is_far(axis)
        self._has_begun &= link.commanding
        self.words, self.readiness, link.commanding = ENABLING, IDLE, True

        def no_motions() -> str:
            return link.event("motion_refused", "taktd runs no motions")

        def blocked() -> bool:
            return any(axis.state in FAULTS or axis.held >= HELD_STATUSES for axis in link.axes)
        link.wait(lambda: self.ready() or blocked() or no_motions(), link.longest)
        self.words = None
        if not self.ready():
            return no_motions() or self.why_not_ready()
        self.readiness = READY
        return ""

    def disable(self) -> None:
        link = self._link
        self.words, self.readiness = DISABLING, IDLE

        def over(axis: Axis) -> bool:
            return axis.state in DISABLED or axis.held > 0
        try:
            good = link.wait(lambda: all(map(over, link.axes)), link.longest)
        finally:
            self.words, link.commanding = None, False
            release(link)
        if not good:
            raise Obstacle("time over", "; ".join(
                f"{axis.name} does not confirm that it is disabled: {axis.bits()}"
                for axis in link.axes if not over(axis)))

    def keep(self) -> None:
        """From now on, the axes keep their states and modes."""
        obey = all(axis.obeys_motions for axis in self._link.axes)
        self.words = None if obey else KEEPING

    def in_fault(self) -> bool:
        return any(axis.state in FAULTS for axis in self._link.axes)

    def reset(self) -> None:
        """Resets faults. The axes without one keep their states."""
        link = self._link
        link.commanding, self.words = True, KEEPING
        link.wait(lambda: all(axis.state != "fault reaction active" for axis in link.axes),
                  link.longest)
        link.wait(lambda: False, LOW_TIME)
        self.words = RESETTING
        good = link.wait(lambda: not self.in_fault(), link.longest)
        self.keep()
        if not good:
            raise Obstacle("blocked", self.why_not_ready())

    def set_mode(self, mode: int, axes: list[Axis]) -> None:
        """Sets the mode of these axes. The other axes keep their modes."""
        link = self._link
        for axis in axes:
            axis.change_mode(mode)
        self.words, link.commanding = KEEPING, True

        def shown(axis: Axis) -> bool:
            return self.shown_mode(axis) == axis.mode
        good = link.wait(lambda: all(map(shown, axes)), link.longest)
        self.keep()
        if not good:
            raise Obstacle("blocked", "; ".join(
                f"{axis.name}: 0x6061 does not show mode {axis.mode}"
                for axis in axes if not shown(axis)))

    def halt(self) -> None:
        link = self._link
        self.check_enabled()
        self.words, self.readiness = KEEPING, HALTED
        if not self.wait_for_rest(link.axes):
            raise Obstacle("time over", "; ".join(
                f"{axis.name} does not follow the Halt, or does not come to rest: its statusword "
                f"is 0x{axis.statusword:04X}" for axis in link.axes))

    def end_halt(self) -> None:
        link = self._link
        self.words, self.readiness, begin = KEEPING, READY, link.cycle

        def over() -> bool:
            return self.follow() or any(not axis.enabled for axis in link.axes)
        link.wait(lambda: link.cycle >= begin + WORD_CYCLES and over(), link.longest)
        self.keep()

    def quick_stop(self) -> None:
        link = self._link
        if not link.commanding:
            self.check_enabled()
        self.words, self.readiness = QUICK_STOPPING, IDLE

        def obeys(axis: Axis) -> bool:
            return axis.state in (QUICK_STOP, *DISABLED)
        if not link.wait(lambda: all(map(obeys, link.axes)), link.longest):
            raise Obstacle("blocked", "; ".join(
                f"{axis.name} ignores the quick stop: it is in {axis.state}, its statusword is "
                f"0x{axis.statusword:04X}" for axis in link.axes if not obeys(axis)))
        if not self.wait_for_rest(link.axes):
            raise Obstacle("time over", "the axes still move")

    def wait_for_rest(self, axes: list[Axis]) -> bool:
        """Waits until taktd moves none of the axes, and each drive shows standstill or its position
        has stayed within a few counts (an encoder may flicker at standstill). Returns False if the
        axes still move."""
        link = self._link
        begin = [link.raw(axis, POSITION) for axis in axes]
        windows = [[counts, cycles, link.cycle, begin] for counts, cycles in REST_WINDOWS]

        def leaves(axis: Axis, counts: int, middle: int | None) -> bool:
            position = link.raw(axis, POSITION)
            if (axis.state not in (ENABLED, QUICK_STOP) or None in (position, middle) or
                    axis.says_rest(self.readiness == HALTED)):
                return False
            shows_rest = axis.places.get(VELOCITY) not in link.stale and (
                link.raw(axis, VELOCITY) == 0)
            return abs(position - middle) > (REST_WINDOWS[-1][0] if shows_rest else counts)

        def at_rest() -> bool:
            for window in windows:
                counts, _, _, middles = window
                if any(moves(axis) or leaves(axis, counts, middle)
                       for axis, middle in zip(axes, middles)):
                    window[2:] = link.cycle, [link.raw(axis, POSITION) for axis in axes]
            return any(link.cycle >= since + cycles for _, cycles, since, _ in windows)
        return link.wait(at_rest, link.longest)

    def shown_mode(self, axis: Axis) -> int | None:
        """The mode that the drive shows, or the commanded one if 0x6061 is in no TPDO."""
        return self._link.raw(axis, MODE_DISPLAY if MODE_DISPLAY in axis.places else MODE)

    def check_enabled(self) -> None:
        if self.readiness == IDLE:
            raise Obstacle("blocked", f"{self._link.names}: call enable() first")

    def check_may_move(self) -> None:
        self.check_enabled()
        self.check_not_halted()

    def check_not_halted(self) -> None:
        if self.readiness == HALTED:
            raise Obstacle("blocked", f"{self._link.names}: the axes are halted: call resume() "
                                      "first")

    def ready(self) -> bool:
        """True if taktd can move all axes."""
        return all(axis.enabled and can_move(axis) for axis in self._link.axes)

    def check_follow(self) -> None:
        if not self.follow():
            raise Obstacle("blocked", self.why_not_ready())

    def follow(self) -> bool:
        """True if all axes are enabled, and taktd can move those that are in the mode of its
        motions."""
        return all(axis.enabled and (not axis.obeys_motions or can_move(axis))
                   for axis in self._link.axes)

    def why_not_ready(self) -> str:
        return "; ".join(filter(None, map(self.why, self._link.axes)))

    def why(self, axis: Axis) -> str:
        """Returns why taktd can't move the axis, or an empty text."""
        node = self._link.nodes.get(axis.node_id)
        if axis.held:
            return (f"{axis.name} belongs to '{node.holder}', and the commands of this program are "
                    "refused")
        if node and node.boot_state != BOOT_READY:
            return f"{axis.name}: its device has not booted"
        if not axis.enabled:
            text = f"{axis.name}: not enabled, {axis.state}: {axis.bits()}"
            if axis.state in FAULTS and node and node.num_emcys:
                text += "; " + self._newest_error(node)
            return text
        if axis.motion is None:
            return (f"{axis.name}: taktd reports no motions of this axis: was taktd started with "
                    "--no-motions, and are 6041 and 6064 in TPDOs and 607A in an RPDO of the "
                    "drive?")
        return "" if axis.motion.state != NOT_ENABLED else (
            f"{axis.name}: taktd does not treat the axis as enabled: is its mode of operation "
            f"{axis.motion_mode}, and is its target position sent?")

    def _target(self, axis: Axis) -> int | None:
        """Returns the target position to send, or None if taktd commands it. In cyclic synchronous
        position mode, an axis must not jump to a target that this program has commanded before.
        Therefore the target follows the actual position until taktd moves the axis."""
        if not axis.has_own_target or axis.obeys_motions and can_move(axis):
            return None
        return self._link.raw(axis, POSITION) if axis.target is None else axis.target

    def _target_is_far(self, axis: Axis) -> bool:
        """True if the drive would jump to its target position. A program that has died may have
        left such a target."""
        target, position = (self._link.raw(axis, index)
                            for index in (axis.target_object, POSITION))
        return None not in (target, position) and abs(target - position) > MOST_COUNTS_APART

    def _newest_error(self, node) -> str:
        told = next((event.text for event in reversed(self._link.events)
                     if event.kind == "emcy" and event.node_id == node.node_id), "")
        return told or f"its newest error is 0x{node.emcys[0] & 0xFFFF:04X}"

    def _send(self) -> None:
        link = self._link
        self._has_begun |= any(map(moves, link.axes))
        waits = self.words is None and link.commanding and not self._has_begun
        if self.words is None and not waits:
            return
        values = {}
        for axis in self._link.axes:
            halt = HALT if self.readiness == HALTED and axis.enabled else 0
            word = axis.controlword(self.words or KEEPING) | halt
            for index, value in ((CONTROLWORD, word), (MODE, axis.mode),
                                 (axis.target_object, self._target(axis))):
                if index in axis.places and value is not None:
                    values[axis.places[index]] = value
        command(self._link, values)


def can_move(axis: Axis) -> bool:
    """True if taktd counts the axis as enabled."""
    return axis.motion is not None and axis.motion.state != NOT_ENABLED


def moves(axis: Axis) -> bool:
    """True if taktd moves or stops the axis."""
    return axis.motion is not None and axis.motion.state in (MOVES, STOPS)
