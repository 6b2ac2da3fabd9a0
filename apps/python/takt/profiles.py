"""Profile position mode, and the modes of velocities and torques, CiA 402-2. Used by Axes."""
from __future__ import annotations

from .cia402 import (AXIS_STEP, CONTROLWORD, KEEPING, POSITION, PROBE_FUNCTION,
                     PROFILE_POSITION, TARGET, TARGET_REACHED, TARGET_TORQUE, TARGET_VELOCITY,
                     VELOCITY, Axis)
from .drives import HALTED, READY, WORD_CYCLES, Drives
from .link import Link, Obstacle
from .outputs import Outputs
from .services import Services
from .signals import encode

# Modes of operation (0x6060): profile and cyclic synchronous velocity, and torque.
MODES_OF = {TARGET_VELOCITY: (3, 9), TARGET_TORQUE: (4, 10)}
CYCLIC_VELOCITY = 9
# Bits of the controlword and of the statusword in profile position mode.
NEW_SET_POINT, CHANGE_AT_ONCE = 0x10, 0x20
ACKNOWLEDGED = 0x1000
STANDING_TIME = 1.0  # seconds at standstill after which an axis has missed its target
BOUNDS = {"velocity": 0x6081, "acceleration": 0x6083, "deceleration": 0x6084}


class Profiles:
    """Motions that the drives compute themselves, in modes other than cyclic synchronous
    position."""

    def __init__(self, link: Link, drives: Drives, services: Services, outputs: Outputs):
        self._link, self._drives = link, drives
        self._services, self._outputs = services, outputs
        # In profile position mode: the cycle of the newest set-points until they are reached, and
        # the newest set-points since the last stop.
        self._given, self._targets = None, None
        # Decelerations in counts of the velocity per second. stop() lowers a target velocity with
        # them if the drive follows it at once.
        self._decelerations: dict[Axis, int] = {}
        link.when_abandoned.append(self.rest)

    @property
    def moving(self) -> bool:
        """True if a set-point in profile position mode is not yet reached, as far as this program
        knows."""
        return self._given is not None

    def rest(self) -> None:
        """Ends the velocities and torques that are commanded, and disarms touch probes."""
        if self._link.commanding:
            self.hold_zeros()

    def hold_zeros(self) -> None:
        """Commands 0 for target velocities, target torques and touch probes, if they are in
        RPDOs."""
        self._outputs.hold({axis.places[index]: 0 for axis in self._link.axes
                            for index in (*MODES_OF, PROBE_FUNCTION) if index in axis.places})

    def command(self, index: int, values) -> None:
        """Commands the target velocities or torques of all axes."""
        link = self._link
        self._check(MODES_OF[index], values)
        self._check_mapped(index)
        raws = [self._raw(axis, index, value) for axis, value in zip(link.axes, values)]
        if index == TARGET_VELOCITY and not any(link.raw(axis, index) for axis in link.axes):
            self._learn_decelerations()
        try:
            self._outputs.confirm({axis.places[index]: raw for axis, raw in zip(link.axes, raws)})
        except Obstacle:
            self.rest()
            raise

    def move(self, positions, bounds: dict, relative: bool, at_once: bool) -> None:
        """Gives the drives a set-point in profile position mode."""
        axes = self._link.axes
        self._check((PROFILE_POSITION,), positions)
        self._check_mapped(TARGET)
        if self._targets is None:
            self._targets = [self._link.value(axis, POSITION) for axis in axes]
        wanted = [float(position) + (target if relative else 0.0)
                  for position, target in zip(positions, self._targets)]
        raws = {axis: self._raw(axis, TARGET, value) for axis, value in zip(axes, wanted)}
        for name, bound in bounds.items():
            many = isinstance(bound, (list, tuple))
            for axis, value in zip(axes, bound if many else [bound] * len(axes)):
                if value:
                    self._set_bound(axis, BOUNDS[name], float(value))
        self._hand_over(raws, CHANGE_AT_ONCE if at_once else 0)
        self._targets = wanted

    def wait(self, seconds: float) -> None:
        """Waits until the drives have reached their set-points, and have none in their buffers."""
        link, axes = self._link, self._link.axes
        moved, before = link.now(), None

        def late() -> list[Axis]:
            return [axis for axis in axes
                    if axis.statusword & (TARGET_REACHED | ACKNOWLEDGED) != TARGET_REACHED]

        def over() -> bool:
            nonlocal moved, before
            self._check_enabled("stopped", axes)
            now = [link.raw(axis, POSITION) for axis in axes]
            if now != before:
                moved, before = link.now(), now
            reached = not late() and link.cycle >= self._given + WORD_CYCLES
            return reached or link.now() - moved > STANDING_TIME
        if not link.wait(over, seconds):
            raise Obstacle("time over", "the axes still move")
        if late():
            raise Obstacle("stopped", "; ".join(
                f"{axis.name} is at standstill, but its drive has not reached its target: its "
                f"statusword is 0x{axis.statusword:04X}" for axis in late()))
        self._given = None

    def stop(self) -> None:
        """Brings the axes to rest in their modes."""
        axes = self._link.axes
        self._slow_down()
        self.rest()
        turning = [axis for axis in axes if axis.mode in MODES_OF[TARGET_VELOCITY]]
        if turning and not self._drives.wait_for_rest(turning):
            raise Obstacle("time over", "the axes still move")
        self._targets = None
        if self._given is None:
            return
        if self._drives.readiness == HALTED:
            self.discard()
        elif self._drives.readiness == READY:
            self._drives.halt()
            self.discard()
            self._drives.end_halt()
        self._given = None

    def _learn_decelerations(self) -> None:
        """Reads the decelerations with which _slow_down() lowers target velocities. A drive whose
        deceleration can't be read gets the target velocity 0 at once."""
        self._decelerations = {}
        for axis in self._link.axes:
            if axis.mode == CYCLIC_VELOCITY:
                index = BOUNDS["deceleration"] + AXIS_STEP * (axis.number - 1)
                try:
                    data = self._services.read(axis.node, index, 0)
                except Obstacle:
                    continue
                self._decelerations[axis] = int.from_bytes(data, "little")

    def _slow_down(self) -> None:
        """Lowers the target velocities that the drives follow at once."""
        link, begin = self._link, self._link.cycle
        speeds = {axis: link.raw(axis, TARGET_VELOCITY)
                  for axis, rate in self._decelerations.items() if rate and axis.enabled}
        if not any(speeds.values()) or link.longest <= 0:
            return
        sent = None

        def is_slow() -> bool:
            nonlocal sent
            if link.cycle == sent:
                return False
            sent, values = link.cycle, {}
            for axis, speed in speeds.items():
                rate = max(self._decelerations[axis], abs(speed) / link.longest)
                left = max(0, round(abs(speed) - rate * (link.cycle - begin) * link.period))
                values[axis.places[TARGET_VELOCITY]] = left if speed > 0 else -left
            self._outputs.hold(values)
            return not any(values.values())
        link.wait(is_slow, 2 * link.longest)

    def discard(self) -> None:
        """Makes halted axes forget their set-points: the actual positions become the set-points, so
        that the axes stay at rest when the Halt ends."""
        axes = [axis for axis in self._link.axes
                if axis.mode == PROFILE_POSITION and axis.enabled]
        if self._given is not None and axes:
            self._hand_over({axis: self._link.raw(axis, POSITION) for axis in axes}, CHANGE_AT_ONCE)
        self._given = None

    def _check(self, modes: tuple[int, ...], values) -> None:
        link = self._link
        if len(values) != len(link.axes):
            raise Obstacle("wrong use", f"expected one value for each of {len(link.axes)} axes, "
                                        f"got {len(values)} values")
        self._drives.check_may_move()
        link.step()  # after a long silence, the waiting messages show that the drives stopped
        self._check_enabled("blocked", link.axes)
        wrong = [axis for axis in link.axes if axis.mode not in modes]
        if wrong:
            names = " or ".join(f"set_mode({mode})" for mode in modes)
            raise Obstacle("blocked", "; ".join(f"{axis.name} is in mode {axis.mode}: call {names} "
                                                "first" for axis in wrong))

    def _check_enabled(self, kind: str, axes) -> None:
        off = [self._drives.why(axis) for axis in axes if not axis.enabled]
        if off:
            raise Obstacle(kind, "; ".join(off))

    def _check_mapped(self, index: int) -> None:
        for axis in self._link.axes:
            if index not in axis.places:
                raise Obstacle("blocked", f"{axis.name}: 0x{index:04X} is in no RPDO: map it in "
                                          "`rpdo:` of the network file")

    def _raw(self, axis: Axis, index: int, value: float) -> int:
        signal = axis.signals[index]
        raw = encode(signal, float(value))
        if raw is None:
            raise Obstacle("wrong use", f"{axis.name} can't be commanded {value} {signal.unit}")
        return raw

    def _set_bound(self, axis: Axis, index: int, value: float) -> None:
        """Writes a bound. It is in the unit of the velocity, or in this unit per second for
        accelerations."""
        known = (axis.signals.get(index) for index in (VELOCITY, TARGET_VELOCITY, TARGET))
        raw = round(value / abs(next(filter(None, known)).scale))
        if not 0 < raw < 1 << 32:
            raise Obstacle("wrong use", f"{axis.name}: 0x{index:04X} can't be {value}")
        index += AXIS_STEP * (axis.number - 1)
        place = next((place for place, signal in self._link.signals.items() if signal.output and
                      (signal.node_id, signal.index) == (axis.node_id, index)), None)
        if place is None:
            self._services.write(axis.node, index, 0, raw.to_bytes(4, "little"))
        else:
            self._outputs.confirm({place: raw})

    def _hand_over(self, targets: dict[Axis, int], bits: int) -> None:
        """Gives the drives a set-point by the handshake of CiA 402-2: bit 4 of the controlword
        rises while bit 12 of the statusword is 0, and falls when bit 12 is 1."""
        link, drives = self._link, self._drives
        nodes = {axis.node_id for axis in targets}
        for axis, target in targets.items():
            axis.target, axis.mode_bits, axis.has_own_target = target, bits, True
        drives.words = KEEPING
        link.events.clear()

        def sent(axis: Axis, bit: int) -> bool:
            word = link.raw(axis, CONTROLWORD) & (NEW_SET_POINT | CHANGE_AT_ONCE)
            return word == bits | bit and link.raw(axis, TARGET) == axis.target

        def phase(reached, words: str) -> None:
            def over() -> bool:
                refusal = self._outputs.refusal(nodes)
                if refusal:
                    raise Obstacle("refused", refusal)
                self._check_enabled("stopped", targets)
                return all(map(reached, targets))
            if not link.wait(over, link.longest):
                raise Obstacle("time over", "; ".join(f"{axis.name} {words} of its statusword "
                                                      f"0x{axis.statusword:04X}"
                                                      for axis in targets if not reached(axis)))
        try:
            phase(lambda axis: sent(axis, 0) and not axis.statusword & ACKNOWLEDGED,
                  "has no room for a set-point, or its set-point was not sent: see bit 12")
            for axis in targets:
                axis.mode_bits = bits | NEW_SET_POINT
            self._given = link.cycle
            phase(lambda axis: axis.statusword & ACKNOWLEDGED,
                  "does not acknowledge its set-point: see bit 12")
        finally:
            self._given = self._given and link.cycle
            for axis in targets:
                axis.mode_bits = bits
            link.wait(lambda: all(sent(axis, 0) for axis in targets), link.longest)
            if drives.readiness != HALTED:
                drives.keep()
