"""The motions of an Axes, which taktd runs: their begin, their state and their end. Used by
Axes."""
from __future__ import annotations

import random

from .drives import STOPS, Drives, moves
from .link import Link, Obstacle
from .messages import motion_command_t, motion_gear_t, motion_goal_t, motion_stream_t
from .stream import StreamBuffer

LOCKED = 2  # axis_motion_t::gear
DONE, STOPPED, REFUSED = 1, 2, 4  # axis_motion_t::outcome
ANSWER_TIME, REASON_TIME = 2.0, 0.1  # seconds
STOP_PAUSE, SILENCE = 0.05, 0.05  # seconds between two stops, and between two signs of life
# Numbers of cycles after the first stop. A motion begins three cycles after taktd has taken it. A
# motion that is about to begin is therefore seen within the first number of cycles, even if
# messages take a few cycles. A motion that taktd has not answered within the second number never
# begins.
SETTLED_CYCLES, UNANSWERED_CYCLES = 10, 100


class Motions:
    """The newest motion of this program, and its signs of life."""

    def __init__(self, link: Link, drives: Drives):
        self._link, self._drives = link, drives
        self._number = random.randrange(1, 2**30)  # of the newest motion
        self._has_motion, self._begun = False, 0.0
        # A motion was begun, and no stop since then has brought the axes to rest.
        self._may_move = False
        self._jog_wanted = False  # if true, signs of life name the axes, which renews the jog
        self._stream = None  # the StreamBuffer of a stream until it has ended
        self._stop_cycle, self._stop_sent, self._alive_sent = -1, 0.0, 0.0
        link.in_each_cycle.append(self._serve_stream)
        link.in_each_step.append(self._keep_alive)
        link.when_abandoned.append(self.abandon)

    def abandon(self) -> None:
        """Stops renewing a jog and sending points, so that the jog or the stream ends."""
        self._jog_wanted, self._stream = False, None

    @property
    def moving(self) -> bool:
        return any(map(moves, self._link.axes))

    @property
    def locked(self) -> bool:
        return all(axis.motion is not None and axis.motion.gear == LOCKED
                   for axis in self._link.axes)

    @property
    def stream_left(self) -> float:
        if not self._stream or not self._stream.begun:
            return 0.0
        return min(axis.motion.time_left if axis.motion and axis.motion.id == self._number else 0.0
                   for axis in self._link.axes)

    # How motions begin.

    def begin(self, kind: str, values, limits: dict) -> None:
        goals = self._ready_goals(kind, values, limits)
        self._note_begin()
        self._send(kind, goals, self._number)

    def jog(self, velocities, limits: dict) -> None:
        try:
            self.begin("jog", velocities, limits)
            self._jog_wanted = True
            self._wait_begun()
        except BaseException:
            self._jog_wanted = False
            self._stop_what_moves()  # an earlier jog may still run
            raise

    def gear(self, leader: str, signal: str, numbers: dict, limits: dict) -> None:
        """Begins a gear. `numbers` has ratio, phase, modulo, filter_time and max_phase_error."""
        message, phase = motion_gear_t(), numbers["phase"]
        message.numerator, message.denominator = self._each(numbers["ratio"]), self._each(1.0)
        message.max_phase_error = self._each(numbers["max_phase_error"])
        for values in (message.numerator, message.max_phase_error):
            self._check(values)
        message.goals = self._ready_goals("gear", self._each(0.0 if phase is None else phase),
                                          limits)
        message.num_goals = len(message.goals)
        node, _, number = leader.partition(".")
        is_axis_of_device = number.isdecimal() and not signal
        message.leader = node if is_axis_of_device else leader
        message.leader_axis = int(number) if is_axis_of_device else 0
        message.signal = signal
        message.modulo, message.filter_time = (float(numbers[name])
                                               for name in ("modulo", "filter_time"))
        message.phase = "here" if phase is None else "at"
        self._note_begin()
        message.id, message.timeout_ms = self._number, round(self._link.timeout * 1000)
        self._link.fill(message)
        self._link.publish("MOTION_GEAR", message)
        self._wait_begun()

    def begin_stream(self, limits: dict) -> None:
        goals = self._ready_goals("stream", [0.0] * len(self._link.axes), limits)
        if self.moving:
            raise Obstacle("blocked", "the axes move: a stream begins at rest")
        positions = [axis.motion.position for axis in self._link.axes]
        self._stream = StreamBuffer(positions, self._link.period, goals)

    def stream(self, points) -> None:
        try:
            if not self._stream:
                raise Obstacle("wrong use", "no stream has begun, or it has ended: call "
                                            "begin_stream() first")
            for point in points:
                wrong = self._stream.add(*point)
                if wrong:
                    raise Obstacle("wrong use", wrong)
            self._link.wait(lambda: not self._stream_goes_on() or self._stream.has_room(),
                            float("inf"))
            if not self._stream_goes_on():
                self._raise_end()
                raise Obstacle("stopped", "the stream has come to rest at its last point: "
                                          "begin_stream() begins another")
        except BaseException:
            self._stream = None
            self._stop_what_moves()
            raise

    # How they end.

    def wait(self, seconds: float) -> None:
        if self._stream:
            self._stream.starts = True  # with the points that are there
            self._serve_stream()
        if not self._link.wait(lambda: not self._is_under_way(), seconds):
            raise Obstacle("time over", "the axes still move")
        self._stream = None
        self._raise_end()

    def wait_locked(self, seconds: float) -> None:
        if not self._link.wait(lambda: self.locked or self._course() != "runs", seconds):
            raise Obstacle("time over", "the axes have not reached the state of their leader")
        if not self.locked:
            self._raise_end()

    def stop(self) -> None:
        link = self._link
        self.abandon()
        if not link.commanding:
            return
        link.serve(0)  # takes the newest image, because taktd may refuse a stop from an old image
        if not self._may_move and not self.moving:
            return
        self._stop_now()
        begin, pause = self._stop_cycle, 0.0  # the second stop comes with the next image

        def stands() -> bool:
            nonlocal pause
            if link.image_time > self._stop_sent and link.now() - self._stop_sent >= pause:
                self._stop_now()
                pause = STOP_PAUSE
            unclear = self._course() == "unanswered" and link.cycle <= begin + UNANSWERED_CYCLES
            heard = all(axis.motion is None or axis.motion_cycle >= begin + SETTLED_CYCLES
                        for axis in link.axes)
            return heard and not self.moving and not unclear
        if not link.wait(stands, link.longest):
            raise Obstacle("time over", "the axes still move")
        self._has_motion = self._may_move = False

    def _stop_what_moves(self) -> None:
        if self._link.commanding and self._may_move:
            self._stop_now()

    def _stop_now(self) -> None:
        self._stop_cycle, self._stop_sent = self._link.cycle, self._link.now()
        self._send("stop", self._goals())

    # What a motion needs.

    def _each(self, value) -> list[float]:
        """Returns one number for each axis, from a list or from one number for all axes."""
        many = isinstance(value, (list, tuple))
        return [float(one) for one in (value if many else [value] * len(self._link.axes))]

    def _check(self, values) -> None:
        if len(values) != len(self._link.axes):
            raise Obstacle("wrong use", f"expected one value for each of {len(self._link.axes)} "
                                        f"axes, got {len(values)} values")

    def _ready_goals(self, kind: str, values, limits: dict) -> list[motion_goal_t]:
        """Returns the goals of a motion. Raises Obstacle if a motion may not begin now."""
        link, drives = self._link, self._drives
        self._jog_wanted = False
        self._check(values)
        if self._stream and self._stream.begun and self._is_under_way():
            raise Obstacle("blocked", "the axes follow a stream: call wait() or stop()")
        self._stream = None
        drives.check_may_move()
        # taktd refuses a motion from an image that is not newer than the last stop.
        if not link.wait(lambda: link.cycle > self._stop_cycle, link.longest):
            raise Obstacle("time over", "no image has come since the stop")
        if not drives.ready():
            texts = (drives.why_not_ready(), link.event("fallback_begun"))
            raise Obstacle("blocked", "; ".join(filter(None, texts)))
        goals = self._goals()
        for place, (goal, value) in enumerate(zip(goals, values)):
            setattr(goal, "velocity" if kind == "jog" else "position", float(value))
            for name, limit in limits.items():
                if not hasattr(goal, f"max_{name}"):
                    raise TypeError(f"unknown limit {name}")
                one = limit[place] if isinstance(limit, (list, tuple)) else limit
                setattr(goal, f"max_{name}", float(one))
        return goals

    def _goals(self) -> list[motion_goal_t]:
        goals = []
        for axis in self._link.axes:
            goal = motion_goal_t()
            goal.node, goal.axis = axis.node, axis.number
            goals.append(goal)
        return goals

    def _note_begin(self) -> None:
        self._link.events.clear()
        self._number += 1
        self._has_motion, self._may_move, self._begun = True, True, self._link.now()

    # The state of the newest motion.

    def _wait_begun(self) -> None:
        self._link.wait(lambda: self._course() != "unanswered", ANSWER_TIME)
        if self._course() != "runs":
            self._raise_end()

    def _course(self) -> str:
        """Returns the state of the newest motion. A refusal counts only before the end of the
        motion: taktd also refuses points of a stream that runs, and repeated points after its
        end."""
        if not self._has_motion:
            return "none"
        courses = {self._course_of(axis.motion) for axis in self._link.axes}
        order = ("unanswered", "runs", "refused", "replaced", "stopped", "done")
        course = next(course for course in order if course in courses)
        refused = self._link.event("motion_refused",
                                   f"motion {self._number} of '{self._link.sender}'")
        return "refused" if refused and course in ("unanswered", "runs") else course

    def _course_of(self, motion) -> str:
        if motion is None or self._number not in (motion.id, motion.ended_id):
            return "unanswered"
        if motion.id == self._number or motion.state == STOPS:
            return "runs"
        ends = {DONE: "done", STOPPED: "stopped", REFUSED: "refused"}
        return ends.get(motion.outcome, "replaced")

    def _is_under_way(self) -> bool:
        """True if the newest motion runs, or if taktd may still answer it."""
        course = self._course()
        in_time = self._link.now() <= self._begun + ANSWER_TIME
        return course == "runs" or course == "unanswered" and in_time

    def _raise_end(self) -> None:
        """Raises the reason if the newest motion has not come to its target."""
        course = self._course()
        if course in ("none", "done"):
            return
        self._jog_wanted = False
        link, drives = self._link, self._drives

        def reason() -> str:
            kind = "motion_refused" if course == "refused" else "motion_stopped"
            told = (link.event(kind, f"motion {self._number} ") or
                    link.event("command_refused", link.sender))
            return "; ".join(filter(None, (told, "" if drives.ready() else drives.why_not_ready())))
        link.wait(lambda: reason() != "", REASON_TIME)
        usual = {"refused": "taktd has refused the motion", "stopped": "the motion has stopped",
                 "replaced": "a newer motion has replaced this one"}
        raise Obstacle("refused" if course in ("refused", "unanswered") else "stopped",
                       reason() or usual.get(course, "taktd has not answered the motion"))

    # What is sent.

    def _send(self, kind: str, goals: list[motion_goal_t], number: int = 0) -> None:
        """`number` is the number of a motion. It is 0 for a stop or a sign of life, so that their
        refusal is not taken for the refusal of a motion."""
        command = motion_command_t()
        self._link.fill(command)
        command.kind, command.id, command.goals, command.num_goals = kind, number, goals, len(goals)
        command.timeout_ms = round(self._link.timeout * 1000)
        self._link.publish("MOTION_COMMAND", command)

    def _keep_alive(self) -> None:
        now = self._link.now()
        if self._link.commanding and now - self._alive_sent > min(SILENCE, self._link.timeout / 4):
            self._alive_sent = now
            self._send("alive", self._goals() if self._jog_wanted else [])

    def _stream_goes_on(self) -> bool:
        return self._stream is not None and (not self._stream.begun or self._is_under_way())

    def _serve_stream(self) -> None:
        """Sends the points that are due."""
        stream, link = self._stream, self._link
        if not stream or stream.begun and not self._is_under_way():
            return
        axis = link.axes[0]
        if stream.begun and axis.motion and axis.motion.id == self._number:
            stream.observe(axis.motion_cycle, axis.motion.time_left)
        message = motion_stream_t()
        message.first_point, message.points = stream.points_due(link.cycle)
        if not message.points:
            return
        if not stream.begun:
            self._note_begin()
            stream.begun = True
        message.id, message.timeout_ms = self._number, round(link.timeout * 1000)
        message.goals, message.num_goals = stream.goals, len(stream.goals)
        message.num_points = len(message.points)
        link.fill(message)
        link.publish("MOTION_STREAM", message)
        self._alive_sent = link.now()
