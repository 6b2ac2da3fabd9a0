"""Axes of a bus whose motions taktd runs: enable, move, jog, gear, stream, stop. The program may be
late.

    from takt import Axes

    with Axes("demo", "shoulder", "elbow") as axes:
        axes.enable()
        axes.move(1.5, 0.5, velocity=3, acceleration=20)
        print(axes.positions)

Each call returns when it is done, or raises Obstacle, which says in words what blocks which axis. A
move is done when the commanded positions are at its target: the actual positions lag behind them by
the following error. While a call waits, it keeps the program alive for taktd. Between calls, the
program may be silent for `timeout`; after that the axes stop along their limits, and the drives
take the fallback of `on_timeout` in the network file. A program that has nothing to do calls run()
instead of time.sleep(). A jog goes on until stop(), until another motion, or until an exception
ends a wait.

Inverters, and CiA 402 drives in velocity mode, are speed axes: they have the same calls except
those that need a position, and they also run with taktd --no-motions. All axes of an object are of
one kind. See share/doc/speed.md.

An Axes is a Bus, too: it has the image and the events of the bus, set-points of other nodes, and
SDO.

share/doc/motion.md has the rules of motions.
"""
from __future__ import annotations

from .bus import Bus
from .cia402 import TARGET_TORQUE, TARGET_VELOCITY, Axis
from .drives import HALTED, IDLE, Drives
from .find import find_axes
from .homing import home
from .link import Obstacle
from .motions import Motions
from .outputs import release
from .probe import Probe
from .profiles import Profiles
from .speed_axes import SpeedAxes
from .view import View

__all__ = ["Axes", "Obstacle"]


class Axes(View, Bus):
    """Axes of one bus. All positions, velocities and limits are in the unit of each axis (rad, m;
    raw counts without one)."""

    def __init__(self, bus: str, *names: str, timeout: float = 0.5, longest: float = 10.0,
                 keys: str | None = None, check_images: bool | None = None):
        """Waits until an image of the bus has come. Without names, the object has all axes, in the
        order of their node-IDs. The second axis of a device is "gantry.2". `longest`: seconds that
        a call waits at most, except for move(), move_by(), wait() and run(). The other options are
        those of Bus."""
        super().__init__(bus, timeout=timeout, longest=longest, keys=keys,
                         check_images=check_images)
        words = find_axes(self._link, names)
        self._speed = SpeedAxes(self._link, words) if words else None
        self._drives = None if words else Drives(self._link)
        self._motions = None if words else Motions(self._link, self._drives)
        self._profiles = None if words else Profiles(self._link, self._drives, self._services,
                                                     self._outputs)

    def __enter__(self) -> Axes:
        return self

    # What the drives do.

    def enable(self) -> None:
        """Brings all axes to Operation enabled, or makes speed axes ready to run. A fault is an
        obstacle: see reset()."""
        if self._profiles:
            self._profiles.stop()
            self._profiles.hold_zeros()
        why = (self._speed or self._drives).enable()
        if why:
            self.disable()
            raise Obstacle("blocked", self._link.refused_envelope("COMMAND") or why)

    def disable(self) -> None:
        """Stops the axes, brings them to Switch on disabled, and releases their nodes and the nodes
        whose outputs set() or command() has set."""
        if not self._link.commanding:
            if self._outputs.drop():
                release(self._link)
            return
        try:
            self.stop()
        finally:
            self._outputs.drop()
            (self._speed or self._drives).disable()

    def release(self) -> None:
        """The same as disable()."""
        self.disable()

    def halt(self) -> None:
        """Sets the Halt bit (bit 8 of 0x6040) of all axes, and waits until they are at rest. taktd
        also ends their motions along their limits, because many drives ignore the bit in cyclic
        synchronous modes. No motion begins before resume() or enable()."""
        self._needs_position()
        self._motions.abandon()
        self._profiles.rest()
        self._drives.halt()
        self._drives.check_follow()

    def resume(self) -> None:
        """Ends the Halt. The axes stay at rest until the next motion. In profile position mode,
        they go on to their set-points, unless stop() has discarded these."""
        self._needs_position()
        if self._drives.readiness == HALTED:
            self._drives.end_halt()
            self._drives.check_follow()

    def quick_stop(self) -> None:
        """Commands a quick stop (bit 2 of 0x6040 is 0): the drives brake by themselves, along
        0x6085. Waits until the drives show the quick stop and are at rest. After that they are not
        enabled: see enable()."""
        self._needs_position()
        self._motions.abandon()
        self._profiles.rest()
        self._drives.quick_stop()

    def reset(self) -> None:
        """Resets the faults of all axes. Axes that move stop first; those without a fault keep
        their states."""
        if self._speed:
            return self._speed.reset()
        if self._drives.in_fault():
            self.stop()
            self._drives.reset()

    def set_mode(self, mode: int, axis: str | int | None = None) -> None:
        """Stops the axes, sets another mode of operation (0x6060) of all axes, or of one by its
        name or place, and waits until the drives show it. The drives keep their states. Velocities
        and torques begin with 0. enable() sets cyclic synchronous position again."""
        self._needs_position()
        axes = self._link.axes if axis is None else [self._axis(axis)]
        self.stop()
        self._drives.set_mode(mode, axes)

    def home(self, together: bool = False, seconds: float = 0.0) -> None:
        """Homes the axes: enables them if they are not enabled, starts the homing method that each
        drive has (0x6098, `homing:` of the network file), and waits for the result. At the end,
        also after an obstacle, the call ends the run, waits for standstill and sets cyclic
        synchronous position mode again. Homing makes the positions of the axes jump, because they
        then count from home. The axes are homed one after the other in the order of `names`, or all
        at once if `together` is true. `seconds`: longest time of a run; 0: the time of the network
        file, or else 60 s."""
        self._needs_position()
        self._drives.check_not_halted()
        if self._drives.readiness == IDLE or not self._drives.ready():
            self.enable()
        self.stop()
        axes = self._link.axes
        for chosen in [axes] if together else [[axis] for axis in axes]:
            home(self._link, self._drives, chosen, seconds)

    # Motions.

    def move(self, *positions: float, **limits: float | list[float]) -> None:
        """Moves the axes to these positions, and returns when the commanded positions are at rest
        there. The actual positions lag behind them by the following error. Limits: `velocity`,
        `acceleration`, `jerk` and `following_error`, one number for all axes or a list. If a limit
        is 0 or not given, the limit of the network file applies."""
        self.begin_move(*positions, **limits)
        self.wait()

    def move_by(self, *distances: float, **limits: float | list[float]) -> None:
        """Like move(), but the numbers are distances from the commanded positions in the cycle in
        which the motion begins."""
        self._needs_position()
        self._motions.begin("move_by", distances, limits)
        self.wait()

    def begin_move(self, *positions: float, **limits: float | list[float]) -> None:
        """Begins a move and returns at once. A call during a motion gives the axes a new target.
        See wait()."""
        self._needs_position()
        self._motions.begin("move", positions, limits)

    def jog(self, *velocities: float, **limits: float | list[float]) -> None:
        """Moves the axes at these velocities, until stop() or the end of the range of positions,
        and returns when the motion has begun. If the call raises an exception, the axes stop. A
        speed axis has only the limit `acceleration`; without it, the axis follows the ramps of its
        drive."""
        (self._speed or self._motions).jog(velocities, limits)

    def gear(self, leader: str, *, signal: str = "", ratio: float | list[float] = 1.0,
             phase: float | list[float] | None = None, modulo: float = 0.0,
             filter_time: float = 0.0, max_phase_error: float | list[float] = 0.0,
             **limits: float | list[float]) -> None:
        """Lets the axes follow the commanded position of the axis `leader`, or the input `signal`
        of the node `leader` ("position_value" of an encoder), and returns when taktd has begun the
        gear. The axes follow until stop() or until another motion; a move() takes over without a
        stop. `ratio`: units of an axis per unit of the leader. Without `phase`, only the velocities
        are matched; with `phase`, the positions become ratio * position of the leader + phase.
        `modulo`: value at which the signal begins again. `filter_time`: filter time for the
        velocity of the signal, 0 for 20 ms. `max_phase_error`: phase error above which the axes
        stop, once they are locked; 0: the axes fall behind and catch up. See `locked`."""
        self._needs_position()
        numbers = {"ratio": ratio, "phase": phase, "modulo": modulo, "filter_time": filter_time,
                   "max_phase_error": max_phase_error}
        self._motions.gear(leader, signal, numbers, limits)

    def wait_locked(self, seconds: float) -> None:
        """Waits until the gears of all axes are locked."""
        self._needs_position()
        self._motions.wait_locked(seconds)

    def begin_stream(self, **limits: float | list[float]) -> None:
        """Prepares a stream: a path of points that this program computes in advance. The axes must
        be at rest. This call moves nothing."""
        self._needs_position()
        self._motions.begin_stream(limits)

    def stream(self, *points: tuple) -> None:
        """Gives further points of the stream. A point is (time, positions, velocities,
        accelerations): the time is in seconds since the begin of the stream, and the others have
        one number for each axis. Without accelerations, the curve to the point is a cubic
        polynomial. Points are sent about 0.4 s, and at most 60 points, before the axes reach them;
        the call returns when there is room for more. The axes begin when there is no room for more,
        or with wait(). A point at time 0 states where the axes are; without such a point, point 0
        is their commanded position. Two points are at most 4 s apart. taktd checks the whole path
        against the limits, the range and the possibility of a stop. If the call fails, it stops the
        axes.

        wait() returns when the axes are at rest at the last point. If the points end while the axes
        move, or if this program is silent, the axes stop along their limits, and the next call
        reports this."""
        self._needs_position()
        self._motions.stream(points)

    def wait(self, seconds: float = float("inf")) -> None:
        """Waits until the newest motion has ended. A move has ended when the commanded positions
        are at its target, a profile_move() when the drives have reached the target. The motion goes
        on if `seconds` are over before that. Speed axes run until something stops them."""
        if self._profiles and self._profiles.moving:
            return self._profiles.wait(seconds)
        (self._speed or self._motions).wait(seconds)

    def stop(self) -> None:
        """Stops the axes along their limits, and returns when taktd reports that their commanded
        positions are at rest. Target velocities and torques become 0. Halt ends a profile_move(),
        and its set-point is discarded."""
        (self._speed or self._motions).stop()
        if self._profiles and self._link.commanding:
            self._profiles.stop()

    # Motions that the drives compute, in other modes.

    def profile_move(self, *positions: float, velocity: float | list[float] = 0.0,
                     acceleration: float | list[float] = 0.0,
                     deceleration: float | list[float] = 0.0, relative: bool = False,
                     at_once: bool = True, wait: bool = True) -> None:
        """Moves the axes in profile position mode, which set_mode(1) sets: the drives compute the
        motions. `velocity`, `acceleration` and `deceleration` are written to 0x6081, 0x6083 and
        0x6084 if they are given, in the unit of the velocity; `deceleration` is equal to
        `acceleration` unless it is given. `relative`: the numbers are distances from the previous
        set-points. The drives get positions in this case, too, because taktd can check only
        positions against the range. Without `at_once`, a set-point waits in the buffer of the drive
        until the previous one is reached. Returns when the drives have reached their set-points,
        or, with wait=False, when they have taken them: see wait() and stop()."""
        self._needs_position()
        bounds = {"velocity": velocity, "acceleration": acceleration,
                  "deceleration": deceleration or acceleration}
        self._profiles.move(positions, bounds, relative, at_once)
        if wait:
            self.wait()

    def command_velocities(self, *velocities: float) -> None:
        """Commands target velocities (0x60FF) in modes 3 or 9 (profile, cyclic synchronous
        velocity), and returns when taktd sends them. They stay in force while this program is
        alive, until stop(). In mode 9, drives follow each step at once: command steps that are
        small enough for the limit of acceleration of the network file."""
        self._needs_position()
        self._profiles.command(TARGET_VELOCITY, velocities)

    def command_torques(self, *torques: float) -> None:
        """Commands target torques (0x6071) in modes 4 or 10, as command_velocities() does for
        velocities. stop() commands a torque of 0, which does not brake."""
        self._needs_position()
        self._profiles.command(TARGET_TORQUE, torques)

    def touch_probe(self, axis: str | int, *, input: int = 1, edge: str = "rising",
                    index_pulse: bool = False, seconds: float = 10.0) -> float:
        """Arms a touch probe of an axis (0x60B8), waits for the edge (0x60B9), and returns the
        position that the drive has stored with it (0x60BA to 0x60BD), in the unit of the axis.
        Motions go on meanwhile: begin a motion before this call, and stop it afterwards.
        `index_pulse`: the index pulse of the encoder instead of the input."""
        self._needs_position()
        probe = Probe(self._link, self._services, self._outputs, self._axis(axis))
        return probe.wait(input, edge, index_pulse, seconds)

    def _axis(self, axis: str | int) -> Axis:
        names = self.names
        if axis in names:
            return self._link.axes[names.index(axis)]
        if isinstance(axis, int) and 0 <= axis < len(names):
            return self._link.axes[axis]
        raise Obstacle("wrong use", f"'{axis}' is not one of the axes {', '.join(names)}")

    def _needs_position(self) -> None:
        if self._speed:
            raise Obstacle("wrong use", f"{self.names[0]} is a speed axis and has no position: use "
                                        "jog()")
