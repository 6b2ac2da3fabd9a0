"""Speed axes: inverters, and CiA 402 drives in velocity mode. Axes uses this module for axes without a position.

A program computes the words of a speed axis from each image. taktd lets the drives stop along their ramps when no words come
for the timeout of the program, or for the time of `on_timeout` in the network file.
"""
from __future__ import annotations

import time

from .signals import raw_limits

CIA402 = 1  # speed_axis_t::sequence
LEVEL = 1  # speed_axis_t::fault_reset
OFF, STANDING, RUNNING = "off", "standing", "running"  # what the program wants
UNKNOWN, FAULT, NOT_READY, READY = "unknown", "fault", "not ready", "ready"  # what the status word shows
LONGEST_STEP = 0.05  # seconds for which the set speed changes in one step
STEPS_BEFORE_RESET = 3  # images for which the command before a fault reset is sent
SILENT_IMAGES = 3  # a status word that is missing in this number of images in a row is unknown
# The controlword of CiA 402 for each state (mask, pattern) on the way to Operation enabled, and on the way back.
ENABLING = ((0x4F, 0x40, 0x06), (0x6F, 0x21, 0x07), (0x6F, 0x23, 0x0F), (0x6F, 0x27, 0x0F))
DISABLING = ((0x6F, 0x27, 0x07), (0x6F, 0x23, 0x06))
FAULT_RESET = 0x80


def _shows(pattern, word: int) -> bool:
    return pattern.mask != 0 and word & pattern.mask in pattern.values


class SpeedAxis:
    """Turns each image into the control word and the set speed of one axis."""

    def __init__(self, words, signals: dict):
        self.words, self.name, self.node_id = words, words.node, words.node_id
        self.range = raw_limits(signals[words.set_speed])
        self.goal, self.state, self.control = OFF, UNKNOWN, words.off
        self.target = self.acceleration = self.commanded = self.actual = 0.0
        self.counts, self.status, self.cycle, self.reset_steps = 0, 0, None, None
        self.silent_images, self.was_enabled = 0, False  # was_enabled: Operation enabled (CiA 402) in the newest image

    def want(self, goal: str, speed: float = 0.0, acceleration: float = 0.0) -> None:
        self.goal, self.target, self.acceleration = goal, speed if goal == RUNNING else 0.0, acceleration
        if goal == OFF:
            self.commanded = 0.0

    def read(self, values: dict, stale: set) -> None:
        """Takes the status of the axis from an image. The goal becomes OFF after a fault, and if a CiA 402 drive has left
        Operation enabled by itself."""
        words = self.words
        if words.status in stale:
            self.silent_images += 1
            if self.silent_images >= SILENT_IMAGES:
                self.state = UNKNOWN
            return
        self.silent_images = 0
        self.status = values[words.status] & 0xFFFF
        if words.actual_speed >= 0:
            self.counts = values[words.actual_speed]
            self.actual = self.counts * words.actual_scale * (-1 if _shows(words.reverse, self.status) else 1)
        if _shows(words.fault, self.status):
            self.state = FAULT
            if self.reset_steps is None:
                self.want(OFF)
        else:
            self.reset_steps = None
            ready = words.ready.mask == 0 or _shows(words.ready, self.status)
            self.state = READY if ready else NOT_READY
            enabled = words.sequence == CIA402 and self.status & 0x6F == 0x27
            if self.was_enabled and not enabled:
                self.want(OFF)
            self.was_enabled = enabled

    def step(self, stale: set, cycle: int, period: float) -> None:
        """Computes the commands, once for each image, after read()."""
        cycles = 1 if self.cycle is None else cycle - self.cycle
        self.cycle = cycle
        if self.words.status in stale:
            return
        most = self.acceleration * min(LONGEST_STEP, cycles * period)
        change = self.target - self.commanded
        self.commanded = self.target if self.acceleration <= 0 else self.commanded + max(-most, min(most, change))
        self.control = self._control()

    def _control(self) -> int:
        words = self.words
        if self.reset_steps is not None:
            self.reset_steps += 1
            before = words.fault_reset != LEVEL and self.reset_steps <= STEPS_BEFORE_RESET
            reset = FAULT_RESET if words.sequence == CIA402 else words.reset
            return words.off if before or reset < 0 else reset
        if words.sequence == CIA402 and (self.goal == OFF or self.status & 0x6F != 0x27):
            table = DISABLING if self.goal == OFF else ENABLING
            return next((word for mask, bits, word in table if self.status & mask == bits), 0)
        if self.goal == OFF:
            return words.off
        if self.goal == STANDING and self.commanded == 0.0:
            return words.stop
        back = self.commanded / words.set_scale < 0
        return words.run_reverse if back and words.run_reverse >= 0 else words.run

    @property
    def raw(self) -> int:
        counts = round(self.commanded / self.words.set_scale)
        return abs(counts) if self.words.run_reverse >= 0 else counts

    def can_hold(self, speed: float) -> bool:
        counts = round(speed / self.words.set_scale)
        return self.range[0] <= (abs(counts) if self.words.run_reverse >= 0 else counts) <= self.range[1]

    @property
    def speed(self) -> float:
        return self.actual if self.words.actual_speed >= 0 else self.commanded

    @property
    def stands(self) -> bool:
        if self.commanded != 0.0 or self.goal == RUNNING:
            return False
        if self.words.standstill.mask:
            return _shows(self.words.standstill, self.status)
        if self.words.actual_speed >= 0:
            return abs(self.counts) <= 1
        return self.words.sequence == CIA402 or not _shows(self.words.running, self.status)

    @property
    def runs(self) -> bool:
        return self.goal == RUNNING and (self.words.running.mask == 0 or _shows(self.words.running, self.status))

    def why(self) -> str:
        word = f"its status word is 0x{self.status:04X}"
        return {UNKNOWN: f"{self.name}: its status word has not arrived", FAULT: f"{self.name} has a fault: {word}",
                NOT_READY: f"{self.name} is not ready to run: {word}"}.get(self.state, "")


class SpeedDrives:
    """The speed axes of an Axes, in its order."""

    def __init__(self, axes: list[SpeedAxis]):
        self.axes, self.sent, self.stopped = axes, 0.0, ""

    def want(self, goal: str) -> None:
        for axis in self.axes:
            axis.want(goal)

    def stop(self) -> None:
        for axis in self.axes:
            if axis.goal != OFF:
                axis.want(STANDING, 0.0, axis.acceleration)

    def run(self, speeds: list[float], accelerations: list[float]) -> None:
        for axis, speed, asked in zip(self.axes, speeds, accelerations):
            axis.want(RUNNING, speed, asked if asked > 0 else axis.words.max_acceleration)

    def end_run(self, why: str) -> None:
        """Ends the run of all axes. They must not run again by themselves when the cause is gone."""
        self.stopped = why
        for axis in self.axes:
            if axis.goal == RUNNING:
                axis.want(STANDING)

    @property
    def wants_to_run(self) -> bool:
        return any(axis.goal == RUNNING for axis in self.axes)

    def step(self, values: dict, stale: set, cycle: int, period: float, timeout: float | None, why_ended) -> None:
        """Takes an image and computes the commands. The run ends if the program was silent for longer than `timeout`, or if
        `why_ended()` returns a reason. The drives then do not run again by themselves."""
        silence = time.monotonic() - self.sent
        if timeout is not None and silence > timeout and self.moving:
            self.end_run(f"this program was silent for {silence:.3f} s, so the drives were stopped")
        running = self.wants_to_run
        for axis in self.axes:
            axis.read(values, stale)
        if running and why_ended():
            self.end_run(why_ended())
        for axis in self.axes:
            axis.step(stale, cycle, period)
        self.sent = time.monotonic()

    def values(self) -> dict[int, int]:
        """Returns the outputs of the axes whose status word is known. The outputs of the other axes expire."""
        known = [axis for axis in self.axes if axis.state != UNKNOWN]
        return {place: value for axis in known
                for place, value in ((axis.words.control, axis.control), (axis.words.set_speed, axis.raw))}

    @property
    def moving(self) -> bool:
        return any(axis.goal == RUNNING or not axis.stands for axis in self.axes)

    def all(self, state: str) -> bool:
        return all(axis.state == state for axis in self.axes)

    def any(self, state: str) -> bool:
        return any(axis.state == state for axis in self.axes)

    def why(self) -> str:
        return "; ".join(filter(None, (axis.why() for axis in self.axes)))
