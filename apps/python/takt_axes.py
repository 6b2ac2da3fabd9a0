"""Axes of a bus whose motions taktd runs: enable, move, jog, gear, stream, stop. This program may be late.

    from takt_axes import Axes

    with Axes("demo", "shoulder", "elbow") as axes:
        axes.enable()
        axes.move(1.5, 0.5, velocity=3, acceleration=20)
        print(axes.positions)

Each call returns when it is done, or raises Obstacle, which says in words what blocks which axis. A
move is done when the commanded positions are at its target: the actual positions lag behind them by
the following error. While a call waits, it keeps the program alive for taktd. Between calls, motions
and drives outlive a silence of `timeout`; then the axes stop along their limits, and the drives take
the fallback of `on_timeout` in the network file. A program that has nothing to do calls run() instead
of time.sleep(). A jog goes on until stop(), until another motion, or until an exception ends a wait.

Inverters, and CiA 402 drives in velocity mode, are speed axes: they obey the same calls except those that need a position,
and taktd --no-motions runs them, too. All axes of an object are of one kind. See share/doc/speed.md.

How to try it on the simulated bus of share/demo/two_axes.yaml:

    python3 -m venv venv && venv/bin/pip install lcm
    lcm-gen -p --ppath venv/lib/python3*/site-packages share/lcm/*.lcm    # makes the module takt
    taktd share/demo/two_axes.yaml --bus sim &
    venv/bin/python apps/python/first_motion.py

share/doc/motion.md has the rules of motions. A bus with keys (share/doc/security.md) refuses this
module, because it sends no envelopes.
"""
from __future__ import annotations

import os
import random
import sys
import time
from collections.abc import Callable

import lcm
from takt import (command_t, event_t, image_t, layout_t, motion_command_t, motion_gear_t, motion_goal_t, motion_stream_t,
                  motion_t, speed_axes_t, status_t)

from takt_speed import FAULT, OFF, READY, STANDING, SpeedAxis, SpeedDrives
from takt_stream import StreamBuffer

SCHEMA = 2  # of the LCM messages that this module knows
CONTROLWORD, STATUSWORD, MODE, MODE_DISPLAY, POSITION, VELOCITY = 0x6040, 0x6041, 0x6060, 0x6061, 0x6064, 0x606C
TARGET = 0x607A
OBJECTS = {(CONTROLWORD, True), (MODE, True), (TARGET, True)} | {(index, False) for index in (STATUSWORD, MODE_DISPLAY, POSITION, VELOCITY)}
FIRST_OBJECT, LAST_OBJECT, AXIS_STEP = 0x6000, 0x9FFF, 0x800  # the objects of each further axis of a device are 0x800 higher
CYCLIC_SYNCHRONOUS_POSITION, HOMING = 8, 6  # modes of operation (0x6060)
START_HOMING = 0x10  # bit 4 of the controlword in homing mode
TARGET_REACHED, HOMING_RESULT = 0x0400, 0x3000  # bit 10, and bits 12 and 13, of the statusword
# The states of CiA 402: mask and pattern of the statusword, name, and the bit that shows why the drive is not enabled.
STATES = ((0x4F, 0x00, "not ready to switch on", "bit 0 (ready to switch on)", 0),
          (0x4F, 0x40, "switch on disabled", "bit 6 (switch on disabled)", 1),
          (0x6F, 0x21, "ready to switch on", "bit 1 (switched on)", 0),
          (0x6F, 0x23, "switched on", "bit 2 (operation enabled)", 0),
          (0x6F, 0x27, "operation enabled", "", 0),
          (0x6F, 0x07, "quick stop active", "bit 5 (quick stop)", 0),
          (0x4F, 0x0F, "fault reaction active", "bit 3 (fault)", 1),
          (0x4F, 0x08, "fault", "bit 3 (fault)", 1))
# The controlword for each state on the way to Operation enabled, and back. Disable voltage is 0.
ENABLING = {"switch on disabled": 0x06, "ready to switch on": 0x07, "switched on": 0x0F, "operation enabled": 0x0F}
DISABLING = {"operation enabled": 0x07, "switched on": 0x06}
KEEPING = {"ready to switch on": 0x06, "switched on": 0x07, "operation enabled": 0x0F}  # the state stays as it is
DISABLED = ("switch on disabled", "not ready to switch on", "fault")
FAULT_RESET = 0x80
FAULTS = ("fault", "fault reaction active")
NOT_ENABLED, MOVES, STOPS = 0, 2, 3  # axis_motion_t::state
LOCKED = 2  # axis_motion_t::gear
HOMED, HOMING_FAILED = 2, 3  # axis_motion_t::homing
DONE, STOPPED, REPLACED, REFUSED = 1, 2, 3, 4  # axis_motion_t::outcome
ANSWER_TIME, REASON_TIME, IMAGE_TIME = 2.0, 0.1, 2.0  # seconds
STOP_PAUSE, SILENCE = 0.05, 0.05  # seconds between two stops, and between two signs of life
# Cycles after the first stop. A motion begins three cycles after taktd has taken it, so one that is about to begin shows in
# the first number of cycles, also if messages take a few cycles. One that taktd has not answered in the second never begins.
SETTLED_CYCLES, UNANSWERED_CYCLES = 10, 100
HELD_STATUSES = 20  # status_t (10 in a second) in sequence in which another program holds an axis before enable() gives up
BOOT_READY = 2  # node_status_t::boot_state
LAYOUT_TIME = 1.5  # seconds for the speed axes of a layout, which come once a second
WORDS_BEFORE_RELEASE = 3  # cycles in which the last words of speed axes are sent
# Homing: cycles in which a drive may show words from before a command; seconds for which it may show that it has not begun;
# seconds of the longest run if taktd names none.
WORD_CYCLES, START_TIME, HOMING_TIME = 10, 1.0, 60.0


class Obstacle(Exception):
    """What blocks a call, in words. `kind` is "wrong use", "no bus", "blocked", "refused", "stopped", "time over" or
    "restarted"."""

    def __init__(self, kind: str, text: str):
        super().__init__(text)
        self.kind = kind


class _Axis:
    """What the messages say about one axis."""

    def __init__(self, name: str, node: str, node_id: int, number: int):
        self.name, self.node, self.node_id, self.number = name, node, node_id, number
        self.places, self.signals = {}, {}  # of the objects of the first axis of a device
        self.statusword, self.motion, self.motion_cycle, self.held = None, None, -1, 0

    @property
    def state(self) -> str:
        if self.statusword is None:
            return "unknown"
        return next((name for mask, bits, name, _, _ in STATES if self.statusword & mask == bits), "unknown")

    def bits(self) -> str:
        """Names the bits of the statusword that show why the drive is not in Operation enabled."""
        if self.statusword is None:
            return "its statusword has not arrived"
        word = f"its statusword 0x{self.statusword:04X}"
        bit, value = next(((bit, value) for _, _, name, bit, value in STATES if name == self.state), ("", 0))
        text = f"{bit} of {word} is {value}" if bit else f"{word} shows no state of CiA 402"
        if not self.statusword & 0x0010:
            text += "; bit 4 (voltage enabled) is 0: is its power supply on?"
        if not self.statusword & 0x0200:
            text += "; bit 9 (remote) is 0: the drive does not obey the controlword from the bus"
        return text


class Axes:
    """Axes of one bus. All positions, velocities and limits are in the unit of each axis (rad, m; raw counts without one)."""

    def __init__(self, bus: str, *names: str, timeout: float = 0.5, longest: float = 10.0):
        """Waits until the bus is heard. Without names: all axes, in the order of their node-IDs. The second axis of a device
        is "gantry.2". `longest`: seconds that a call waits at most, except for move(), move_by(), wait()
        and run()."""
        if not 0.001 <= timeout <= 10.0:
            raise Obstacle("wrong use", f"a timeout of {timeout} s is not one of 1 ms to 10 s")
        self.bus, self.timeout, self.longest = bus.upper(), timeout, longest
        self.instance = random.SystemRandom().randrange(1, 2**63)  # tells two senders apart, also in one process
        program = os.path.basename(sys.argv[0])[:32] or "python"
        self.sender = f"{program} {os.getpid()} {self.instance & 0xFFFF_FFFF:08x}"
        self._number = random.randrange(1, 2**30)  # of the newest motion
        self._has_motion, self._begun = False, 0.0
        self._may_move = False  # something was begun, and no stop since then has led to standing axes
        self._jog_wanted = False  # only then signs of life name the axes, which renews a jog
        self._stream = None  # the StreamBuffer of a stream until it has ended
        self._stop_cycle, self._stop_sent = -1, 0.0
        self._axes, self._values, self._events, self._nodes = [], {}, [], {}
        self._session, self._hash, self._cycle, self._parts = None, None, -1, set()
        self._restarted, self._commanding, self._enabled = False, False, False
        self._alive_sent, self._utime = 0.0, 0
        self._mode, self._words = CYCLIC_SYNCHRONOUS_POSITION, None  # _words: the controlword for each state, while it changes
        self._homing, self._homing_runs = [], False  # the axes in homing mode, and whether their runs are started
        self._link = lcm.LCM()  # LCM_DEFAULT_URL, else LCM's default
        self._speed, self._speed_parts, self._signals, self._stale, self._period = None, {}, {}, set(), 0.0
        for channel, handler in (("SPEED_AXES", self._on_speed_axes), ("LAYOUT", self._on_layout), ("IMAGE", self._on_image), ("MOTION", self._on_motion),
                                 ("EVENT", self._on_event), ("STATUS", self._on_status)):
            self._link.subscribe(f"{self.bus}_{channel}", handler)
        self._found, self._layout_parts, self._image_time = {}, set(), time.monotonic()
        end = time.monotonic() + longest
        while self._cycle < 0:
            self._serve(0.05)
            if time.monotonic() > end:
                raise Obstacle("no bus", f"no image of bus {bus} has come: is taktd running, with the same LCM URL?")
        begin, with_position = time.monotonic(), {axis.name for axis in self._axes if TARGET in axis.places}
        wanted = set(names) - with_position if names else not with_position
        while wanted and not self._speed_words() and time.monotonic() < begin + LAYOUT_TIME:
            self._serve(0.05)
        inverters = {words.node: words for words in self._speed_words()}
        self._axes = [axis for axis in self._axes if axis.name not in inverters]
        if inverters and (set(names) & set(inverters) if names else not self._axes):
            chosen = list(names) or list(inverters)
            if len(set(chosen)) < len(chosen) or not set(chosen) <= set(inverters):
                raise Obstacle("wrong use", f"bus {bus} does not have all of these axes as speed axes, or one is named twice: "
                                            "use one Axes for speed axes and one for axes with positions")
            self._speed = SpeedDrives([SpeedAxis(inverters[name], self._signals) for name in chosen])
            self._axes = [_Axis(name, name, inverters[name].node_id, 1) for name in chosen]
            return
        known = {axis.name: axis for axis in self._axes}
        for name in names:
            if name not in known or names.count(name) > 1:
                raise Obstacle("wrong use", f"bus {bus} has no axis '{name}', or it is named twice; the axes are: "
                                            f"{', '.join([*known, *inverters]) or 'none'}")
        if names:
            self._axes = [known[name] for name in names]
        if not self._axes:
            raise Obstacle("wrong use", f"bus {bus} has no axis: no node has 6040 and 6041 in its PDOs, or the words of an "
                                        "inverter")

    def __enter__(self) -> Axes:
        return self

    def __exit__(self, *_) -> None:
        self.disable()

    # What the newest messages say.

    @property
    def names(self) -> list[str]:
        return [axis.name for axis in self._axes]

    @property
    def units(self) -> list[str]:
        """Units of the positions, or of the speeds of speed axes ("rpm", "Hz"). Empty: raw counts."""
        if self._speed:
            return [axis.words.unit for axis in self._speed.axes]
        return [axis.signals[POSITION].unit if POSITION in axis.signals else "" for axis in self._axes]

    @property
    def positions(self) -> list[float]:
        """Actual positions; 0 for speed axes."""
        return [self._read(axis, POSITION) for axis in self._axes]

    @property
    def velocities(self) -> list[float]:
        """Actual velocities; 0 where no PDO carries them."""
        if self._speed:
            return [axis.speed for axis in self._speed.axes]
        return [self._read(axis, VELOCITY) for axis in self._axes]

    @property
    def commanded_positions(self) -> list[float]:
        """Commanded positions; the actual ones before taktd reports motions."""
        return [axis.motion.position if axis.motion else self._read(axis, POSITION) for axis in self._axes]

    @property
    def following_errors(self) -> list[float]:
        """Commanded minus actual positions, as taktd has reported last."""
        return [axis.motion.following_error if axis.motion else 0.0 for axis in self._axes]

    @property
    def moving(self) -> bool:
        """At least one axis moves or stops, as taktd has reported last."""
        if self._speed:
            return self._speed.moving
        return any(axis.motion and axis.motion.state in (MOVES, STOPS) for axis in self._axes)

    # What the drives do.

    def enable(self) -> None:
        """Leads all axes to Operation enabled, or makes speed axes ready to run. A fault is an obstacle: see reset()."""
        if self._speed:
            return self._enable_speed()
        self._mode, self._words = CYCLIC_SYNCHRONOUS_POSITION, ENABLING
        self._commanding = True
        blocked = lambda axis: axis.state in FAULTS or axis.held >= HELD_STATUSES
        no_motions = lambda: self._event("motion_refused", "taktd runs no motions")
        self._wait(lambda: self._ready() or any(map(blocked, self._axes)) or no_motions(), self.longest)
        self._words = None
        if not self._ready():
            why = no_motions() or self._why_not_ready()
            self.disable()
            raise Obstacle("blocked", why)
        self._enabled = True

    def disable(self) -> None:
        """Stops the axes, leads them to Switch on disabled, and releases their nodes."""
        self._jog_wanted = self._enabled = False
        if not self._commanding:
            return
        if self._speed:
            return self._disable_speed()
        try:
            self.stop()
        finally:
            self._words = DISABLING
            over = lambda axis: axis.state in DISABLED or axis.held > 0
            try:
                good = self._wait(lambda: all(map(over, self._axes)), self.longest)
            finally:
                self._words, self._commanding = None, False
                self._command(release=True)
        if not good:
            raise Obstacle("time over", "; ".join(f"{axis.name} does not confirm that it is disabled: {axis.bits()}"
                                                  for axis in self._axes if not over(axis)))

    def reset(self) -> None:
        """Resets the faults of all axes. Axes that move stop first; those without a fault keep their states."""
        if self._speed:
            return self._reset_speed()
        in_fault = lambda: any(axis.state in FAULTS for axis in self._axes)
        if not in_fault():
            return
        self.stop()
        self._commanding, self._words = True, KEEPING  # bit 7 is low before its rising edge
        self._wait(lambda: all(axis.state != "fault reaction active" for axis in self._axes), self.longest)
        self._wait(lambda: False, 0.1)
        self._words = KEEPING | {"fault": FAULT_RESET}
        good = self._wait(lambda: not in_fault(), self.longest)
        self._words = None
        if not good:
            raise Obstacle("blocked", self._why_not_ready())

    def set_mode(self, mode: int) -> None:
        """Stops the axes, sets another mode of operation (0x6060), and waits until the drives show it. The drives keep their
        states. enable() sets cyclic synchronous position again."""
        self._needs_position()
        self.stop()
        self._mode, self._words, self._commanding = mode, KEEPING, True
        shown = lambda axis: self._raw(axis, MODE_DISPLAY if MODE_DISPLAY in axis.places else MODE) == mode
        good = self._wait(lambda: all(map(shown, self._axes)), self.longest)
        self._words = None
        if not good:
            raise Obstacle("blocked", "; ".join(f"{axis.name}: 0x6061 does not show mode {mode}" for axis in self._axes
                                                if not shown(axis)))

    @property
    def homed(self) -> list[bool]:
        """True: taktd has seen a homing run of this axis end well since its node began to exchange PDOs."""
        return [axis.motion is not None and axis.motion.homing == HOMED for axis in self._axes]

    def home(self, together: bool = False, seconds: float = 0.0) -> None:
        """Homes the axes: enables them if they are not enabled, starts the homing method that each drive has (0x6098,
        `homing:` of the network file), and waits for the result. Then, also after an obstacle, it ends the run, waits for
        standstill and goes back to cyclic synchronous position. The positions of the axes jump: they count from home then.
        One axis after the other in the order of their names, or all `together`. `seconds`: longest time of a run; 0: that of
        the network file, else 60 s."""
        self._needs_position()
        if not self._enabled or not self._ready():
            self.enable()
        self.stop()
        for axes in [self._axes] if together else [[axis] for axis in self._axes]:
            try:
                self._enter_homing(axes)
                self._run_homing(axes, seconds)
            except BaseException:
                try:
                    self._leave_homing(axes)
                except Obstacle:
                    pass  # the first obstacle is the one to tell
                raise
            self._leave_homing(axes)

    # Motions.

    def move(self, *positions: float, **limits: float | list[float]) -> None:
        """Moves the axes to these positions, and returns when the commanded positions are there, at rest. The actual ones
        lag behind them by the following error. Limits: `velocity`, `acceleration`, `jerk` and `following_error`, one for all
        axes or a list; where they are 0 or not given, those of the network file apply."""
        self.begin_move(*positions, **limits)
        self.wait()

    def move_by(self, *distances: float, **limits: float | list[float]) -> None:
        """Like move(), by distances from the commanded positions in the cycle in which the motion begins."""
        self._begin("move_by", distances, limits)
        self.wait()

    def begin_move(self, *positions: float, **limits: float | list[float]) -> None:
        """Begins a move and returns at once. A new target is possible during a motion. See wait()."""
        self._begin("move", positions, limits)

    def jog(self, *velocities: float, **limits: float | list[float]) -> None:
        """Begins to keep these velocities, until stop() or the end of the range of positions. If it raises an exception,
        the axes stop. Of the limits, a speed axis takes `acceleration`; without one it follows the ramps of its drive."""
        if self._speed:
            return self._run_speed(velocities, limits)
        try:
            self._begin("jog", velocities, limits)
            self._jog_wanted = True
            self._wait(lambda: self._course() != "unanswered", ANSWER_TIME)
            if self._course() != "runs":
                self._raise_end()
        except BaseException:
            self._jog_wanted = False
            if self._commanding and self._may_move:  # a jog before this one may go on
                self._stop_now()
            raise

    def gear(self, leader: str, *, signal: str = "", ratio: float | list[float] = 1.0,
             phase: float | list[float] | None = None, modulo: float = 0.0, filter_time: float = 0.0,
             max_phase_error: float | list[float] = 0.0, **limits: float | list[float]) -> None:
        """Begins to follow the commanded position of the axis `leader`, or the input `signal` of the node `leader`
        ("position_value" of an encoder), and returns when taktd has begun. The axes follow until stop() or until another
        motion; a move() takes over without a stop. `ratio`: units of an axis per unit of the leader. Without `phase`, the
        velocities are matched; with it, the positions become ratio * position of the leader + phase. `modulo`: value at
        which the signal begins again. `filter_time`: of the estimate of its velocity, 0 for 20 ms. `max_phase_error`: the
        axes stop above it, once they were locked; 0: they fall behind and catch up. See `locked`."""
        def each(value):
            return [float(one) for one in (value if isinstance(value, (list, tuple)) else [value] * len(self._axes))]
        message = motion_gear_t()
        message.numerator, message.denominator = each(ratio), each(1.0)
        message.max_phase_error = each(max_phase_error)
        for values in (message.numerator, message.max_phase_error):
            self._check(values)
        message.goals = self._ready_goals("gear", each(0.0 if phase is None else phase), limits)
        message.num_goals = len(message.goals)
        node, _, number = leader.partition(".")
        message.leader, message.leader_axis = (leader, 0) if signal or not number.isdecimal() else (node, int(number))
        message.signal, message.modulo, message.filter_time = signal, float(modulo), float(filter_time)
        message.phase = "here" if phase is None else "at"
        self._note_begin()
        message.id, message.timeout_ms = self._number, round(self.timeout * 1000)
        self._fill(message)
        self._link.publish(f"{self.bus}_MOTION_GEAR", message.encode())
        self._wait(lambda: self._course() != "unanswered", ANSWER_TIME)
        if self._course() != "runs":
            self._raise_end()

    @property
    def locked(self) -> bool:
        """True if all axes have the positions that their gears prescribe."""
        return all(axis.motion is not None and axis.motion.gear == LOCKED for axis in self._axes)

    @property
    def phase_errors(self) -> list[float]:
        """Of gears: how far each axis is ahead of the position that its gear prescribes."""
        return [axis.motion.phase_error if axis.motion else 0.0 for axis in self._axes]

    def wait_locked(self, seconds: float) -> None:
        """Waits until the gears of all axes are locked."""
        def over():
            return self.locked or self._course() != "runs"
        if not self._wait(over, seconds):
            raise Obstacle("time over", "the axes have not reached the state of their leader")
        if not self.locked:
            self._raise_end()

    def begin_stream(self, **limits: float | list[float]) -> None:
        """Prepares a stream: a path of points that this program computes in advance. The axes must be at rest, and nothing
        moves yet."""
        goals = self._ready_goals("stream", [0.0] * len(self._axes), limits)
        if self.moving:
            raise Obstacle("blocked", "the axes move: a stream begins at rest")
        self._stream = StreamBuffer(self.commanded_positions, self._period, goals)

    def stream(self, *points: tuple) -> None:
        """Gives further points of the stream: (time, positions, velocities, accelerations) with one number for each axis, and
        the time in seconds since the begin of the stream. Without accelerations the curve to the point is a cubic one. Points
        are sent about 0.4 s, and at most 60 points, before the axes reach them; the call returns when there is room for more.
        The axes begin when the room is full, or with wait(). A point at time 0 states where the axes stand; without one,
        point 0 is their commanded position. Two points are 4 s apart at most. taktd checks the whole path against the limits,
        the range and the possibility of a stop. If the call fails, it stops the axes.

        wait() returns when the axes are at rest at the last point. If the points end while the axes move, or if this program
        is silent, the axes stop along their limits, and the next call says so."""
        try:
            self._needs_position()
            if not self._stream:
                raise Obstacle("wrong use", "no stream has begun, or it has ended: call begin_stream() first")
            for point in points:
                wrong = self._stream.add(*point)
                if wrong:
                    raise Obstacle("wrong use", wrong)
            self._wait(lambda: not self._stream_goes_on() or self._stream.has_room(), float("inf"))
            if not self._stream_goes_on():
                self._raise_end()
                raise Obstacle("stopped", "the stream has come to rest at its last point: begin_stream() begins another")
        except BaseException:
            self._stream = None
            if self._commanding and self._may_move:
                self._stop_now()
            raise

    @property
    def stream_left(self) -> float:
        """Seconds until the axes reach the newest point that the bus thread of taktd has, as taktd has reported last. 0 if no
        stream runs."""
        if not self._stream or not self._stream.begun:
            return 0.0
        return min(axis.motion.time_left if axis.motion and axis.motion.id == self._number else 0.0 for axis in self._axes)

    def wait(self, seconds: float = float("inf")) -> None:
        """Waits until the newest motion has ended: a move, when the commanded positions are at its target. Does not stop it
        when `seconds` are over. Speed axes run until something stops them."""
        if self._speed:
            return self._wait_speed(seconds)
        if self._stream:
            self._stream.starts = True  # with the points that are there
            self._serve_stream()
        if not self._wait(lambda: not self._is_under_way(), seconds):
            raise Obstacle("time over", "the axes still move")
        self._stream = None
        self._raise_end()

    def run(self, seconds: float) -> None:
        """Waits for this time, in which motions go on."""
        self._wait(lambda: False, seconds)

    def stop(self) -> None:
        """Stops the axes along their limits, and returns when taktd reports that their commanded positions stand."""
        self._jog_wanted, self._stream = False, None
        if not self._commanding:
            return
        if self._speed:
            return self._stop_speed()
        self._serve(0)  # the stop is for the newest image: one of an old image may be refused
        if not self._may_move and not self.moving:
            return
        self._stop_now()
        begin, pause = self._stop_cycle, 0.0  # the second stop comes with the next image

        def stands():
            nonlocal pause
            if self._image_time > self._stop_sent and time.monotonic() - self._stop_sent >= pause:
                self._stop_now()
                pause = STOP_PAUSE
            unclear = self._course() == "unanswered" and self._cycle <= begin + UNANSWERED_CYCLES
            heard = all(axis.motion is None or axis.motion_cycle >= begin + SETTLED_CYCLES for axis in self._axes)
            return heard and not self.moving and not unclear
        if not self._wait(stands, self.longest):
            raise Obstacle("time over", "the axes still move")
        self._has_motion = self._may_move = False

    # The same for speed axes.

    def _needs_position(self) -> None:
        if self._speed:
            raise Obstacle("wrong use", f"{self.names[0]} is a speed axis and has no position: use jog()")

    def _speed_ended(self) -> str:
        """What has ended the newest run."""
        nodes = {axis.node_id for axis in self._axes}
        fallback = next((event.text for event in self._events if event.kind == "fallback_begun" and event.node_id in nodes), "")
        return self._speed.stopped or fallback or self._why_speed()

    def _why_speed(self) -> str:
        held = (f"{axis.name} belongs to '{self._nodes[axis.node_id].holder}', and the commands of this program are refused"
                for axis in self._axes if axis.held)
        return "; ".join(filter(None, (self._speed.why(), *held)))

    def _enable_speed(self) -> None:
        self._events.clear()
        self._speed.stopped, self._speed.sent, self._commanding = "", time.monotonic(), True
        self._speed.want(STANDING)
        held = lambda: any(axis.held >= HELD_STATUSES for axis in self._axes)
        own = lambda axis: axis.node_id in self._nodes and self._nodes[axis.node_id].holder == self.sender
        ready = lambda: self._speed.all(READY) and all(map(own, self._axes))
        self._wait(lambda: ready() or self._speed.any(FAULT) or held(), self.longest)
        if not ready():
            why = self._why_speed() or f"the daemon does not show that this program holds {', '.join(self.names)}"
            self.disable()
            raise Obstacle("blocked", why)
        self._enabled = True

    def _disable_speed(self) -> None:
        try:
            self._stop_speed()
        finally:
            self._speed.want(OFF)
            end = self._cycle + WORDS_BEFORE_RELEASE
            try:
                self._wait(lambda: self._cycle > end, self.longest)
            finally:
                self._commanding = False
                self._command(release=True)

    def _reset_speed(self) -> None:
        for axis in self._speed.axes:
            if axis.state == FAULT:
                axis.reset_steps = 0
        if not self._commanding:
            self._speed.sent, self._commanding = time.monotonic(), True
        if not self._wait(lambda: not self._speed.any(FAULT), self.longest):
            raise Obstacle("blocked", self._why_speed())

    def _run_speed(self, speeds, limits: dict) -> None:
        """An older run does not go on if the new one fails."""
        try:
            self._begin_run(speeds, **limits)
        except BaseException:
            self._speed.stop()
            raise

    def _begin_run(self, speeds, *, acceleration=0.0) -> None:
        self._check(speeds)
        asked = acceleration if isinstance(acceleration, (list, tuple)) else [acceleration] * len(speeds)
        self._check(asked)
        speeds, asked = list(map(float, speeds)), list(map(float, asked))
        for axis, speed in zip(self._speed.axes, speeds):
            most, unit = axis.words.max_speed, axis.words.unit
            if not axis.can_hold(speed):
                raise Obstacle("wrong use", f"{axis.name} can't be commanded to run at {speed} {unit}")
            if 0 < most < abs(speed):
                raise Obstacle("refused", f"{speed} {unit} is above the limit of {axis.name}, {most} {unit}")
        for axis, value in zip(self._speed.axes, asked):
            most, unit = axis.words.max_acceleration, axis.words.unit
            if 0 < most < value:
                raise Obstacle("refused", f"an acceleration of {value} {unit}/s is above the limit of {axis.name}, {most} {unit}/s")
        if not self._enabled:
            raise Obstacle("blocked", f"{', '.join(self.names)}: call enable() first")
        self._events.clear()
        self._speed.stopped = ""
        self._step()  # after a long silence, the messages that wait tell that the drives were stopped
        if self._speed_ended():
            raise Obstacle("blocked", self._speed_ended())
        self._speed.run(speeds, asked)
        runs = lambda: all(axis.runs for axis in self._speed.axes)
        self._wait(lambda: runs() or self._speed_ended(), self.longest)
        if not runs():
            raise Obstacle("blocked", self._speed_ended() or "the drives do not begin to run")

    def _wait_speed(self, seconds: float) -> None:
        if not self._wait(lambda: not self._speed.moving or self._speed_ended(), seconds):
            raise Obstacle("time over", "the axes still run")
        if self._speed_ended():
            raise Obstacle("stopped", self._speed_ended())

    def _stop_speed(self) -> None:
        self._speed.stop()
        stands = lambda: all(axis.stands for axis in self._speed.axes) or self._speed.any(FAULT)
        if not self._wait(stands, self.longest):
            raise Obstacle("time over", "the drives have not come to standstill")

    # Below here: homing.

    def _enter_homing(self, axes: list[_Axis]) -> None:
        self._homing, self._homing_runs, self._words = axes, False, KEEPING
        begin, shown = self._cycle, lambda axis: self._raw(axis, MODE_DISPLAY if MODE_DISPLAY in axis.places else MODE)
        there = lambda: self._cycle >= begin + WORD_CYCLES and all(shown(axis) == HOMING for axis in axes)
        disabled = lambda: any(axis.state != "operation enabled" for axis in axes)
        if not self._wait(lambda: there() or disabled(), self.longest) or disabled():
            raise Obstacle("blocked", "; ".join(filter(None, map(self._why, axes))) or
                           "; ".join(f"{axis.name}: it does not show homing mode (0x6061 is {shown(axis)}): is 0x6060 in an "
                                     "RPDO, and has the drive this mode (0x6502)?" for axis in axes if shown(axis) != HOMING))

    def _run_homing(self, axes: list[_Axis], seconds: float) -> None:
        """taktd reports how the runs stand. A report of the cycle in which the start was sent, or of a later one, is about
        this run."""
        self._homing_runs = True
        started, moved = {}, {axis: time.monotonic() for axis in axes}
        longest = seconds or max((axis.motion.homing_timeout_ms / 1000 or HOMING_TIME) for axis in axes)

        def done(axis: _Axis) -> bool:
            if axis.state != "operation enabled":
                raise Obstacle("stopped", f"the homing was interrupted: {self._why(axis)}")
            if axis not in started and (self._raw(axis, CONTROLWORD) or 0) & START_HOMING:
                started[axis] = self._cycle
            if axis.motion_cycle < started.get(axis, self._cycle) + WORD_CYCLES:
                moved[axis] = time.monotonic()
                return False
            if axis.motion.homing == HOMING_FAILED:
                told = self._event("homing_failed", f"{axis.name}:")
                raise Obstacle("stopped", f"{axis.name}: the drive reports a homing error: bit 13 of its statusword "
                                          f"0x{axis.statusword:04X} is 1" + (f" ({told})" if told else ""))
            if axis.statusword & (HOMING_RESULT | TARGET_REACHED) != TARGET_REACHED:
                moved[axis] = time.monotonic()
            if time.monotonic() - moved[axis] > START_TIME:
                raise Obstacle("stopped", f"{axis.name}: the drive has not begun the homing, or has interrupted it: bits 12 and "
                                          f"13 of its statusword 0x{axis.statusword:04X} are 0, and bit 10 is 1")
            return axis.motion.homing == HOMED
        if not self._wait(lambda: all([done(axis) for axis in axes]), longest):
            raise Obstacle("time over", "; ".join(f"{axis.name}: the homing has not ended after {longest:.1f} s: its statusword "
                                                  f"is 0x{axis.statusword:04X}" for axis in axes if not done(axis)))

    def _leave_homing(self, axes: list[_Axis]) -> None:
        """Ends the runs, waits until the axes are at rest, and goes back. taktd lets the target positions follow the actual
        ones until the drives obey them."""
        self._homing_runs = False
        moved, before = self._cycle, [self._raw(axis, POSITION) for axis in axes]

        def at_rest() -> bool:
            nonlocal moved, before
            now = [self._raw(axis, POSITION) for axis in axes]
            for axis, position, old in zip(axes, now, before):
                if position != old and axis.state == "operation enabled" and not axis.statusword & TARGET_REACHED:
                    moved = self._cycle
            before = now
            return self._cycle >= moved + WORD_CYCLES
        if not self._wait(at_rest, self.longest):
            raise Obstacle("time over", "the axes still move")
        self._homing, self._words = [], KEEPING
        over = lambda: all(axis.state != "operation enabled" or axis.motion.state != NOT_ENABLED for axis in axes)
        self._wait(over, self.longest)
        self._words = None
        if not self._ready():
            raise Obstacle("blocked", self._why_not_ready())

    # Below here: messages.

    def _begin(self, kind: str, values: tuple[float, ...], limits: dict) -> None:
        goals = self._ready_goals(kind, values, limits)
        self._note_begin()
        self._send(kind, goals, self._number)

    def _note_begin(self) -> None:
        self._events.clear()
        self._number += 1
        self._has_motion, self._may_move, self._begun = True, True, time.monotonic()

    def _ready_goals(self, kind: str, values, limits: dict) -> list[motion_goal_t]:
        """The goals of a motion, which may begin now."""
        self._needs_position()
        self._jog_wanted = False
        self._check(values)
        if self._stream and self._stream.begun and self._is_under_way():
            raise Obstacle("blocked", "the axes follow a stream: call wait() or stop()")
        self._stream = None
        if not self._enabled:
            raise Obstacle("blocked", f"{', '.join(self.names)}: call enable() first")
        if not self._wait(lambda: self._cycle > self._stop_cycle, self.longest):  # taktd refuses motions from before a stop
            raise Obstacle("time over", "no newer image has come")
        if not self._ready():
            texts = [self._why_not_ready()] + [event.text for event in self._events if event.kind == "fallback_begun"][-1:]
            raise Obstacle("blocked", "; ".join(texts))
        goals = self._goals()
        for place, (goal, value) in enumerate(zip(goals, values)):
            setattr(goal, "velocity" if kind == "jog" else "position", float(value))
            for name, limit in limits.items():
                if not hasattr(goal, f"max_{name}"):
                    raise TypeError(f"unknown limit {name}")
                setattr(goal, f"max_{name}", float(limit[place] if isinstance(limit, (list, tuple)) else limit))
        return goals

    def _check(self, values) -> None:
        if len(values) != len(self._axes):
            raise Obstacle("wrong use", f"{len(values)} values for {len(self._axes)} axes")

    def _goals(self) -> list[motion_goal_t]:
        goals = []
        for axis in self._axes:
            goal = motion_goal_t()
            goal.node, goal.axis = axis.node, axis.number
            goals.append(goal)
        return goals

    def _course(self) -> str:
        """How the newest motion stands. taktd also refuses points of a stream that runs, and copies of points when it is
        over."""
        if not self._has_motion:
            return "none"
        courses = {self._course_of(axis.motion) for axis in self._axes}
        order = ("unanswered", "runs", "refused", "replaced", "stopped", "done")
        course = next(course for course in order if course in courses)
        refused = self._event("motion_refused", f"motion {self._number} of '{self.sender}'")
        return "refused" if refused and course in ("unanswered", "runs") else course

    def _is_under_way(self) -> bool:
        """The newest motion runs, or taktd may still answer it."""
        course = self._course()
        return course == "runs" or course == "unanswered" and time.monotonic() <= self._begun + ANSWER_TIME

    def _stream_goes_on(self) -> bool:
        return self._stream is not None and (not self._stream.begun or self._is_under_way())

    def _serve_stream(self) -> None:
        """Sends the points that are due."""
        stream, axis = self._stream, self._axes[0]
        if stream.begun and not self._is_under_way():
            return
        if stream.begun and axis.motion and axis.motion.id == self._number:
            stream.observe(axis.motion_cycle, axis.motion.time_left)
        message = motion_stream_t()
        message.first_point, message.points = stream.points_due(self._cycle)
        if not message.points:
            return
        if not stream.begun:
            self._note_begin()
            stream.begun = True
        message.id, message.timeout_ms, message.goals = self._number, round(self.timeout * 1000), stream.goals
        message.num_goals, message.num_points = len(message.goals), len(message.points)
        self._fill(message)
        self._link.publish(f"{self.bus}_MOTION_STREAM", message.encode())
        self._alive_sent = time.monotonic()

    def _course_of(self, motion) -> str:
        if motion is None or self._number not in (motion.id, motion.ended_id):
            return "unanswered"
        if motion.id == self._number or motion.state == STOPS:
            return "runs"
        return {DONE: "done", STOPPED: "stopped", REFUSED: "refused"}.get(motion.outcome, "replaced")

    def _raise_end(self) -> None:
        """Raises the reason if the newest motion has not come to its target."""
        course = self._course()
        if course in ("none", "done"):
            return
        self._jog_wanted = False

        def reason():
            told = self._event("motion_refused" if course == "refused" else "motion_stopped", f"motion {self._number} ")
            told = told or self._event("command_refused", self.sender)
            return "; ".join(filter(None, (told, "" if self._ready() else self._why_not_ready())))
        self._wait(lambda: reason() != "", REASON_TIME)
        usual = {"refused": "taktd has refused the motion", "stopped": "the motion has stopped",
                 "replaced": "a newer motion has replaced this one"}.get(course, "taktd has not answered the motion")
        raise Obstacle("refused" if course in ("refused", "unanswered") else "stopped", reason() or usual)

    def _event(self, kind: str, part: str = "") -> str:
        return next((event.text for event in reversed(self._events) if event.kind == kind and part in event.text), "")

    def _ready(self) -> bool:
        return all(axis.state == "operation enabled" and axis.motion and axis.motion.state != NOT_ENABLED
                   for axis in self._axes)

    def _why_not_ready(self) -> str:
        return "; ".join(filter(None, map(self._why, self._axes)))

    def _why(self, axis: _Axis) -> str:
        node = self._nodes.get(axis.node_id)
        if axis.held:
            return f"{axis.name} belongs to '{node.holder}', and the commands of this program are refused"
        if node and node.boot_state != BOOT_READY:
            return f"{axis.name}: its device has not booted"
        if axis.state != "operation enabled":
            text = f"{axis.name}: not enabled, {axis.state}: {axis.bits()}"
            if axis.state in FAULTS and node and node.num_emcys:
                told = next((event.text for event in reversed(self._events)
                             if event.kind == "emcy" and event.node_id == axis.node_id), "")
                text += "; " + (told or f"its newest error is 0x{node.emcys[0] & 0xFFFF:04X}")
            return text
        if axis.motion is None:
            return (f"{axis.name}: taktd reports no motion of it: was taktd started with --no-motions, and are 6041 and 6064 in "
                    "TPDOs and 607A in an RPDO of the drive?")
        return "" if axis.motion.state != NOT_ENABLED else (
            f"{axis.name}: taktd does not count it as enabled: is its mode of operation 8, and is its target position sent?")

    def _raw(self, axis: _Axis, index: int) -> int | None:
        return self._values.get(axis.places.get(index))

    def _read(self, axis: _Axis, index: int) -> float:
        raw, signal = self._raw(axis, index), axis.signals.get(index)
        return 0.0 if raw is None else raw * signal.scale + signal.offset

    def _wait(self, reached: Callable[[], bool], seconds: float) -> bool:
        """Takes messages and sends what is due until `reached()`. False: the time is over before."""
        end = time.monotonic() + seconds
        try:
            while True:
                self._step()
                if reached():
                    return True
                if time.monotonic() >= end:
                    return False
        except BaseException:
            # Who catches it may wait again, which must not renew a jog, or send points.
            self._jog_wanted, self._stream = False, None
            if self._speed:
                self._speed.stop()
            raise

    def _step(self) -> None:
        """Waits for a message for a short time, takes those that have come, and sends what is due."""
        before = time.monotonic()
        self._serve(0.005)
        now = time.monotonic()
        if self._restarted:
            self._commanding = False
            raise Obstacle("restarted", "taktd has restarted")
        if before - self._image_time > max(IMAGE_TIME, self.timeout):
            raise Obstacle("no bus", f"no image of bus {self.bus} has come for {before - self._image_time:.1f} s")
        if self._commanding and not self._speed and now - self._alive_sent > min(SILENCE, self.timeout / 4):
            self._alive_sent = now
            self._send("alive", self._goals() if self._jog_wanted else [])

    def _serve(self, seconds: float) -> None:
        """Handles all messages that have come; waits for the first one at most for this time."""
        cycle = self._cycle
        if self._link.handle_timeout(max(1, int(seconds * 1000))):
            for _ in range(100):  # a flood of messages does not hold the program
                if not self._link.handle_timeout(0):
                    break
        if self._speed and self._cycle != cycle:
            self._speed.step(self._values, self._stale, self._cycle, self._period, self.timeout if self._commanding else None,
                             self._speed_ended)
            if self._commanding:
                self._command()
        elif self._words is not None and self._cycle != cycle:
            self._command()
        if self._stream and self._cycle != cycle:
            self._serve_stream()

    def _fill(self, message) -> None:
        self._utime = max(self._utime + 1, int(time.time() * 1e6))  # a move_by needs a later one than each motion before
        message.utime, message.schema = self._utime, SCHEMA
        message.session, message.cycle = self._session, self._cycle
        message.instance, message.sender = self.instance, self.sender

    def _command(self, release: bool = False) -> None:
        command = command_t()
        self._fill(command)
        command.release = release
        if self._speed and not release:
            outputs = self._speed.values()
            command.signals, command.values = list(outputs), list(outputs.values())
            command.time_to_live = max(3, int(self.timeout / self._period)) if self._period else 0
        for axis in () if release or self._speed else self._axes:
            homes = axis in self._homing
            start = START_HOMING if homes and self._homing_runs and axis.state == "operation enabled" else 0
            word = self._words.get(axis.state, 0) | start
            for index, value in ((CONTROLWORD, word), (MODE, HOMING if homes else self._mode)):
                if index in axis.places:
                    command.signals.append(axis.places[index])
                    command.values.append(value)
        command.num_values = len(command.values)
        self._link.publish(f"{self.bus}_COMMAND", command.encode())

    def _send(self, kind: str, goals: list[motion_goal_t], number: int = 0) -> None:
        """`number`: of a motion. That of a stop or sign of life is 0, so that its refusal is not taken for that of a motion."""
        command = motion_command_t()
        self._fill(command)
        command.kind, command.id, command.timeout_ms = kind, number, round(self.timeout * 1000)
        command.goals, command.num_goals = goals, len(goals)
        self._link.publish(f"{self.bus}_MOTION_COMMAND", command.encode())

    def _stop_now(self) -> None:
        self._stop_cycle, self._stop_sent = self._cycle, time.monotonic()
        self._send("stop", self._goals())

    def _on_speed_axes(self, channel: str, data: bytes) -> None:
        message = speed_axes_t.decode(data)
        if message.schema == SCHEMA:
            self._speed_parts[message.session, message.part] = message

    def _speed_words(self) -> list:
        """The words of the speed axes of the layout; empty until all of them have come."""
        parts = [part for (session, _), part in self._speed_parts.items() if session == self._session]
        if not parts or len(parts) < parts[0].parts:
            return []
        return [words for part in sorted(parts, key=lambda part: part.part) for words in part.axes]

    def _on_layout(self, channel: str, data: bytes) -> None:
        layout = layout_t.decode(data)
        if layout.schema != SCHEMA:
            raise Obstacle("wrong use", f"taktd speaks schema {layout.schema} of the messages, this program {SCHEMA}")
        if self._session is not None:
            self._restarted |= (layout.session, layout.hash) != (self._session, self._hash)
            return
        self._layout_parts.add(layout.part)
        for place, signal in enumerate(layout.signals, layout.first_signal):
            self._add(place, signal)
        if len(self._layout_parts) == layout.parts:
            self._session, self._hash, self._period = layout.session, layout.hash, layout.period_ns * 1e-9
            self._axes = [axis for _, axis in sorted(self._found.items())
                          if CONTROLWORD in axis.places and STATUSWORD in axis.places]

    def _add(self, place: int, signal) -> None:
        self._signals[place] = signal
        index = FIRST_OBJECT + signal.index % AXIS_STEP
        if not FIRST_OBJECT <= signal.index <= LAST_OBJECT or signal.sub or (index, bool(signal.output)) not in OBJECTS:
            return
        number = (signal.index - FIRST_OBJECT) // AXIS_STEP + 1
        name = signal.node if number == 1 else f"{signal.node}.{number}"
        axis = self._found.setdefault((signal.node_id, number), _Axis(name, signal.node, signal.node_id, number))
        axis.places[index], axis.signals[index] = place, signal

    def _on_image(self, channel: str, data: bytes) -> None:
        image = image_t.decode(data)
        if self._session is None or (image.session, image.layout_hash) != (self._session, self._hash):
            return
        self._values.update(enumerate(image.values, image.first_signal))
        if image.part == 0:
            self._parts, self._stale = set(), set()
        self._stale.update(image.stale)
        self._parts.add(image.part)
        if len(self._parts) < image.parts:
            return
        self._cycle, self._image_time = image.cycle, time.monotonic()
        for axis in () if self._speed else self._axes:
            axis.statusword = self._values[axis.places[STATUSWORD]] & 0xFFFF

    def _on_motion(self, channel: str, data: bytes) -> None:
        motion = motion_t.decode(data)
        reported = {(axis.node_id, axis.axis): axis for axis in motion.axes if motion.session == self._session}
        for axis in self._axes:
            if (axis.node_id, axis.number) in reported:
                axis.motion, axis.motion_cycle = reported[axis.node_id, axis.number], motion.cycle

    def _on_event(self, channel: str, data: bytes) -> None:
        event = event_t.decode(data)
        if event.session == self._session and event.severity > 0:
            self._events = self._events[-63:] + [event]

    def _on_status(self, channel: str, data: bytes) -> None:
        status = status_t.decode(data)
        if status.session != self._session:
            return
        self._nodes.update((node.node_id, node) for node in status.nodes)
        shown = {node.node_id for node in status.nodes}
        for axis in self._axes:
            if axis.node_id in shown:
                other = self._nodes[axis.node_id].holder not in ("", self.sender)
                axis.held = axis.held + 1 if other else 0
