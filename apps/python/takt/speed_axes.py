"""The verbs of speed axes: enable, run, stop, disable, reset. Used by Axes."""
from __future__ import annotations

from .cia402 import Axis
from .drives import HELD_STATUSES
from .link import Link, Obstacle
from .outputs import command, release
from .speed import FAULT, OFF, READY, STANDING, SpeedAxis, SpeedDrives

WORDS_BEFORE_RELEASE = 3  # cycles in which the last words are sent


class SpeedAxes:
    """Sends the words of the speed axes for each image. `words` has their speed_axis_t."""

    def __init__(self, link: Link, words: list):
        self._link = link
        self._drives = SpeedDrives([SpeedAxis(one, link.signals) for one in words])
        self._enabled = False
        link.axes = [Axis(one.node, one.node, one.node_id, 1) for one in words]
        link.in_each_cycle.append(self._serve)
        link.when_abandoned.append(self._drives.stop)

    @property
    def units(self) -> list[str]:
        return [axis.words.unit for axis in self._drives.axes]

    @property
    def speeds(self) -> list[float]:
        return [axis.speed for axis in self._drives.axes]

    @property
    def moving(self) -> bool:
        return self._drives.moving

    def enable(self) -> str:
        """Returns why the axes are not enabled, or an empty text."""
        link, drives = self._link, self._drives
        link.events.clear()
        drives.stopped, drives.sent, link.commanding = "", link.now(), True
        drives.want(STANDING)

        def held() -> bool:
            return any(axis.held >= HELD_STATUSES for axis in link.axes)

        def ready() -> bool:
            own = all(link.holder(axis) == link.sender for axis in link.axes)
            return drives.all(READY) and own
        link.wait(lambda: ready() or drives.any(FAULT) or held(), link.longest)
        self._enabled = ready()
        return "" if self._enabled else (
            self._why() or f"the daemon does not show that this program holds {link.names}")

    def disable(self) -> None:
        self._enabled = False
        link = self._link
        try:
            self.stop()
        finally:
            self._drives.want(OFF)
            end = link.cycle + WORDS_BEFORE_RELEASE
            try:
                link.wait(lambda: link.cycle > end, link.longest)
            finally:
                link.commanding = False
                release(link)

    def reset(self) -> None:
        link, drives = self._link, self._drives
        for axis in drives.axes:
            if axis.state == FAULT:
                axis.reset_steps = 0
        if not link.commanding:
            drives.sent, link.commanding = link.now(), True
        if not link.wait(lambda: not drives.any(FAULT), link.longest):
            raise Obstacle("blocked", self._why())

    def jog(self, speeds, limits: dict) -> None:
        """Begins a run. If it fails, an older run does not go on either."""
        try:
            self._begin_run(speeds, **limits)
        except BaseException:
            self._drives.stop()
            raise

    def wait(self, seconds: float) -> None:
        if not self._link.wait(lambda: not self._drives.moving or self._ended(), seconds):
            raise Obstacle("time over", "the axes still run")
        if self._ended():
            raise Obstacle("stopped", self._ended())

    def stop(self) -> None:
        if not self._link.commanding:
            return
        drives = self._drives
        drives.stop()

        def stands() -> bool:
            return all(axis.stands for axis in drives.axes) or drives.any(FAULT)
        if not self._link.wait(stands, self._link.longest):
            raise Obstacle("time over", "the drives have not come to standstill")

    def _begin_run(self, speeds, *, acceleration=0.0) -> None:
        link, drives = self._link, self._drives
        many = isinstance(acceleration, (list, tuple))
        asked = acceleration if many else [acceleration] * len(speeds)
        for values in (speeds, asked):
            if len(values) != len(link.axes):
                raise Obstacle("wrong use", f"expected one value for each of {len(link.axes)} "
                                            f"axes, got {len(values)} values")
        speeds, asked = list(map(float, speeds)), list(map(float, asked))
        for axis, speed, acceleration in zip(drives.axes, speeds, asked):
            self._check_limits(axis, speed, acceleration)
        if not self._enabled:
            raise Obstacle("blocked", f"{link.names}: call enable() first")
        link.events.clear()
        drives.stopped = ""
        link.step()  # after a long silence, the waiting messages show that the drives stopped
        if self._ended():
            raise Obstacle("blocked", self._ended())
        drives.run(speeds, asked)

        def runs() -> bool:
            return all(axis.runs for axis in drives.axes)
        link.wait(lambda: runs() or self._ended(), link.longest)
        if not runs():
            raise Obstacle("blocked", self._ended() or "the drives do not begin to run")

    def _check_limits(self, axis: SpeedAxis, speed: float, acceleration: float) -> None:
        words, unit = axis.words, axis.words.unit
        if not axis.can_hold(speed):
            raise Obstacle("wrong use", f"{axis.name} can't be commanded to run at {speed} {unit}")
        if 0 < words.max_speed < abs(speed):
            raise Obstacle("refused", f"{speed} {unit} is above the limit of {axis.name}, "
                                      f"{words.max_speed} {unit}")
        if 0 < words.max_acceleration < acceleration:
            raise Obstacle("refused", f"an acceleration of {acceleration} {unit}/s is above the "
                                      f"limit of {axis.name}, {words.max_acceleration} {unit}/s")

    def _ended(self) -> str:
        """Returns what has ended the newest run, or an empty text."""
        nodes = {axis.node_id for axis in self._link.axes}
        fallback = next((event.text for event in self._link.events
                         if event.kind == "fallback_begun" and event.node_id in nodes), "")
        return self._drives.stopped or fallback or self._why()

    def _why(self) -> str:
        held = (f"{axis.name} belongs to '{self._link.holder(axis)}', and the commands of this "
                "program are refused" for axis in self._link.axes if axis.held)
        return "; ".join(filter(None, (self._drives.why(), *held)))

    def _serve(self) -> None:
        link = self._link
        self._drives.step(link.values, link.stale, link.cycle, link.period,
                          link.timeout if link.commanding else None, self._ended)
        if link.commanding:
            cycles = max(3, int(link.timeout / link.period)) if link.period else 0
            command(link, self._drives.values(), cycles)
