"""The points of a stream on their way to taktd: which of them to send in a cycle. Used by Axes.

The time of the stream is known from the reports of taktd. Each message repeats the points that are not reached yet, so that the
loss of a message does no harm. The stream begins when it has points for LEAD seconds, or when `starts` is set.
"""
from .messages import motion_point_t

LEAD = 0.4  # seconds for which points are sent in advance
LONGEST_STEP = 4.0  # seconds between two points; taktd takes no point more than 5 s in advance
MOST_WAITING = 60  # points at taktd, which has room for 64
PAUSE = 0.02  # shortest time between two messages with new points in seconds, as long as enough points wait
# Seconds after which the newest message is repeated. Shortly before the points end, it is not repeated, because the stream would
# be over when the message arrives.
REPETITION, LAST_REPETITION, LAST_REPETITION_CYCLES = 0.05, 0.1, 10


class StreamBuffer:
    """The points of a stream, from the newest one that the axes have reached on. Times are in seconds; `period` is the period of
    SYNC."""

    def __init__(self, positions, period, goals):
        self.goals, self.begun, self.starts = goals, False, False
        self._period, self._points, self._first = period, [], 0  # _first: number of the first one of _points
        self._next, self._sent_cycle = 0, 0  # number of the first point that was never sent; cycle of the newest message
        self._passed, self._passed_cycle = 0.0, 0  # time of the stream in the cycle of the newest report
        zeros = [0.0] * len(positions)
        self._points.append(_message(0.0, positions, zeros, zeros))

    def add(self, time, position, velocity, acceleration=()) -> str:
        """Appends a point. Returns what is wrong with it, or an empty text. A point at time 0 replaces the point at which the
        stream begins."""
        last, time = self._points[-1], float(time)
        number = 0 if self._end() == 1 and time == 0.0 else self._end()
        if not len(position) == len(velocity) == last.num_axes or len(acceleration) not in (0, last.num_axes):
            return (f"point {number} of the stream needs one position and one velocity for each of {last.num_axes} axes, and "
                    "either one acceleration for each axis or no acceleration")
        if number and not last.time < time <= last.time + LONGEST_STEP:
            return (f"point {number} of the stream is at {time:g} s: it must be later than the point before, which is at "
                    f"{last.time:g} s, by {LONGEST_STEP:g} s at most")
        if not number:
            self._points.pop()
        self._points.append(_message(time, position, velocity, acceleration))
        return ""

    def has_room(self) -> bool:
        """True if all points are sent or are sent soon, so that further points may come."""
        return self._is_open(self._end())

    def observe(self, cycle, time_left) -> None:
        """Takes a report of this cycle that the stream runs and that its points end in `time_left`. The report does not say which
        points the bus thread has. The time of the stream is therefore the time of one of the sent points minus `time_left`, and
        it does not pass faster than the cycles."""
        latest = self._passed + (cycle - self._passed_cycle + 0.5) * self._period
        times = [point.time - time_left for point in self._points[:self._next - self._first]]
        times = [time for time in times if time <= latest]
        if times:
            self._passed, self._passed_cycle = max(times[-1], 0.0), cycle

    def points_due(self, cycle) -> tuple:
        """Returns the number of the first point, and the points, of the message that is due in this cycle. If no message is due,
        there are no points."""
        while self._first + 1 < self._next and self._points[1].time <= self._passed:
            self._points.pop(0)
            self._first += 1
        self.starts |= not self.has_room()
        if not self._is_due(cycle):
            return self._first, []
        if not self._next:
            self._passed_cycle = cycle
        while self._next < self._end() and self._is_open(self._next):
            self._next += 1
        self._sent_cycle = cycle
        return self._first, self._points[:self._next - self._first]

    def _end(self) -> int:
        return self._first + len(self._points)

    def _waiting_before(self, number) -> int:
        """Number of points before this one that are not reached yet."""
        return max(0, number - self._first - (self._points[0].time <= self._passed))

    def _left_before(self, number) -> float:
        return self._points[number - 1 - self._first].time - self._passed

    def _is_open(self, number) -> bool:
        """True if the point with this number may be sent after the points before it."""
        margin = self._period / 2  # more than the times lose by rounding
        return not number or (self._left_before(number) < LEAD - margin and
                              self._waiting_before(number) < MOST_WAITING)

    def _is_due(self, cycle) -> bool:
        if not self.starts or self._end() == 1:
            return False
        if not self._next:
            return True
        left, pause = self._left_before(self._next), (cycle - self._sent_cycle) * self._period
        few = left < LEAD / 2 and self._waiting_before(self._next) < MOST_WAITING / 2
        if self._next < self._end() and self._is_open(self._next) and (few or pause >= PAUSE):
            return True
        return left >= max(LAST_REPETITION, LAST_REPETITION_CYCLES * self._period) and pause >= REPETITION


def _message(time, position, velocity, acceleration) -> motion_point_t:
    point = motion_point_t()
    point.time = time
    point.position, point.velocity, point.acceleration = (list(map(float, values)) for values in (position, velocity, acceleration))
    point.num_axes, point.num_accelerations = len(point.position), len(point.acceleration)
    return point
