#!/usr/bin/env python3
"""judge_trajectories.py BIN [--cases N] [--seed S] - compares `takt trajectory` with ruckig, another planner.

N random tasks of one axis, in eight classes, go through `takt trajectory` as JSON lines. Each answer is integrated here, with
more digits where it lasts long, and must end at its target, keep its limits, and not be slower than ruckig where ruckig has a
result that keeps the limits and ends at the target.
"""
import argparse
import decimal
import json
import math
import multiprocessing
import os
import pathlib
import random
import subprocess
import sys

import ruckig

CLASSES = ("general", "rest to rest", "to rest", "near target", "at acceleration", "at velocity", "outside", "round numbers")
MAX_V, MIN_V, MAX_A, MIN_A, JERK = range(5)


def size(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def attempt(rng, which):
    limits = [size(rng, 0.1, 10), -size(rng, 0.1, 10), size(rng, 0.1, 10), -size(rng, 0.1, 10), size(rng, 0.1, 100)]
    if rng.random() < 0.5:
        limits[MIN_V] = -limits[MAX_V]
    if rng.random() < 0.5:
        limits[MIN_A] = -limits[MAX_A]
    way = size(rng, 1e-3, 100)
    start, target = ([rng.uniform(-way, way), rng.uniform(limits[MIN_V], limits[MAX_V]),
                      rng.uniform(limits[MIN_A], limits[MAX_A])] for _ in range(2))
    if which == "rest to rest":
        start[1] = start[2] = target[1] = target[2] = 0.0
    elif which == "to rest":
        target[2] = 0.0
        if rng.random() < 0.5:
            target[1] = 0.0
    elif which == "near target":
        difference = size(rng, 1e-16, 1e-10)
        for i in (1, 2):
            if rng.random() < 0.5:
                target[i] = 0.0
        start = [x + (rng.uniform(-difference, difference) if rng.random() < 0.5 else 0.0) for x in target]
    elif which == "at acceleration":
        start[2] = rng.choice(limits[MAX_A:JERK])
        if rng.random() < 0.5:
            target[2] = rng.choice(limits[MAX_A:JERK])
    elif which == "at velocity":
        if rng.random() < 0.5:
            start[1] = rng.choice(limits[:MAX_A])
        target[1], target[2] = rng.choice(limits[:MAX_A]), 0.0
    elif which == "outside":
        start[1] *= 3
        start[2] *= 3
    elif which == "round numbers":
        start, target = ([round(2 * x) / 2 for x in state] for state in (start, target))
        limits = [math.ceil(x) if x > 0 else math.floor(x) for x in limits]
    return start, target, [float(x) for x in limits]


def has_motion(target, limits):
    _, v, a = target
    before = v - a * abs(a) / 2 / limits[JERK]
    return (limits[MIN_V] <= min(v, before) and max(v, before) <= limits[MAX_V] and limits[MIN_A] <= a <= limits[MAX_A])


def task_of(rng, which):
    while True:
        start, target, limits = attempt(rng, which)
        if has_motion(target, limits):
            return start, target, limits


def request(task):
    start, target, limits = task

    def state(values):
        return dict(zip(("position", "velocity", "acceleration"), ([x] for x in values)))

    return json.dumps({"from": state(start), "to": state(target),
                       "limits": {"velocity": [limits[MAX_V]], "min_velocity": [limits[MIN_V]], "acceleration": [limits[MAX_A]],
                                  "min_acceleration": [limits[MIN_A]], "jerk": [limits[JERK]]}})


def is_inside(v, a, limits):
    tolerance = type(v)(1 + 1e-9)
    later = v + a * abs(a) / 2 / limits[JERK]
    return (limits[MIN_A] * tolerance <= a <= limits[MAX_A] * tolerance and
            limits[MIN_V] * tolerance <= min(v, later) and max(v, later) <= limits[MAX_V] * tolerance)


def followed(task, segments):
    """Returns the end error and the excess over the limits, both relative to their sizes."""
    number = decimal.Decimal if sum(t for t, _ in segments) > 1e3 else float
    (p, v, a), target, limits = (list(map(number, part)) for part in task)
    begin, way, excess = p, number(0), number(0)
    inside = is_inside(v, a, limits)

    def look(v, a):
        return max(v / limits[MAX_V], v / limits[MIN_V], a / limits[MAX_A], a / limits[MIN_A]) - 1

    for t, j in ((number(t), number(j)) for t, j in segments):
        if inside:
            excess = max(excess, abs(j) / limits[JERK] - 1)
            turn = -a / j if j else -1
            if 0 < turn < t:
                excess = max(excess, look(v + turn * (a + turn * j / 2), number(0)))
        way += t * abs(v)  # also where the axis comes back
        p, v, a = p + t * (v + t * (a / 2 + t * j / 6)), v + t * (a + t * j / 2), a + t * j
        if inside:
            excess = max(excess, look(v, a))
        inside = inside or is_inside(v, a, limits)
    positions = max(abs(begin), abs(target[0]))
    rests = target[1] == target[2] == 0
    # A moving axis counts as at its target if the difference is small beside its position.
    length = way + number(1e-4) * positions if rests else max(way, positions)
    error = max(abs(p - target[0]) / (length or 1), abs(v - target[1]) / max(limits[MAX_V], -limits[MIN_V]),
                abs(a - target[2]) / max(limits[MAX_A], -limits[MIN_A]))
    return float(error), float(excess)


def by_ruckig(planner, task):
    """Returns the duration, or None where ruckig has no result that keeps the limits and ends at the target."""
    start, target, limits = task
    given = ruckig.InputParameter(1)
    given.current_position, given.current_velocity, given.current_acceleration = ([x] for x in start)
    given.target_position, given.target_velocity, given.target_acceleration = ([x] for x in target)
    given.max_velocity, given.min_velocity = [limits[MAX_V]], [limits[MIN_V]]
    given.max_acceleration, given.min_acceleration = [limits[MAX_A]], [limits[MIN_A]]
    given.max_jerk = [limits[JERK]]
    trajectory = ruckig.Trajectory(1)
    try:
        if planner.calculate(given, trajectory) not in (ruckig.Result.Working, ruckig.Result.Finished):
            return None
    except ruckig.RuckigError:
        return None
    profile = trajectory.profiles[0][0]
    segments = list(zip(profile.brake.t, profile.brake.j)) + list(zip(profile.t, profile.j))
    error, excess = followed(task, segments)
    return trajectory.duration if error <= 1e-8 and excess <= 1e-9 else None


def all_by_ruckig(tasks):
    """Returns the durations of all tasks. ruckig runs in a process of its own, because it crashes at some tasks."""
    durations = []
    while len(durations) < len(tasks):
        reading, writing = os.pipe()
        if os.fork() == 0:
            planner = ruckig.Ruckig(1)
            with os.fdopen(writing, "w", buffering=1) as out:
                for task in tasks[len(durations):]:
                    print(json.dumps(by_ruckig(planner, task)), file=out)
            os._exit(0)
        os.close(writing)
        with os.fdopen(reading) as answers:
            durations += map(json.loads, answers)
        os.wait()
        durations += [None] * (len(durations) < len(tasks))  # of the task at which it has crashed
    return durations


def judge(job):
    takt, which, cases, seed = job
    rng = random.Random(f"{which} {seed}")
    tasks = [task_of(rng, which) for _ in range(cases)]
    result = subprocess.run([takt, "trajectory"], input="\n".join(map(request, tasks)), text=True, capture_output=True)
    answers = result.stdout.splitlines()
    wrong, compared = [], 0
    if result.returncode != 0 or len(answers) != cases:
        wrong.append(f"{which}: exit code {result.returncode}, {len(answers)} of {cases} answers: {result.stderr[:300]}")
    for task, line, other in zip(tasks, answers, all_by_ruckig(tasks)):
        answer = json.loads(line)
        if answer["error"]:
            wrong.append(f"{which}: {request(task)}: {answer['error']}")
            continue
        error, excess = followed(task, [(s["duration"], s["jerk"]) for s in answer["segments"][0]])
        # A start far outside its limits may need years of one cruise, which cost digits.
        allowed = 1e-15 * max(answer["duration"], 1e6)
        if error > max(1e-8, allowed):
            wrong.append(f"{which}: {request(task)}: ends {error:.2g} beside its target")
        if excess > max(1e-9, allowed):
            wrong.append(f"{which}: {request(task)}: exceeds a limit by {excess:.2g}")
        if other is None:
            continue
        compared += 1
        if answer["duration"] > other + 1e-9 + 1e-9 * other:
            wrong.append(f"{which}: {request(task)}: {answer['duration']} s, ruckig {other} s")
    return which, cases, compared, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    each = 12_500  # tasks of one run of the tool
    runs = max(1, options.cases // (len(CLASSES) * each))
    cases = min(each, max(1, options.cases // len(CLASSES)))
    jobs = [(str(options.bin / "takt"), which, cases, options.seed * 1000 + run) for run in range(runs) for which in CLASSES]
    totals, failures = {which: [0, 0, 0] for which in CLASSES}, 0
    with multiprocessing.Pool() as pool:
        for which, number, compared, wrong in pool.imap_unordered(judge, jobs):
            totals[which] = [a + b for a, b in zip(totals[which], (number, compared, len(wrong)))]
            failures += len(wrong)
            for line in wrong[:3]:
                print("FAILED", line)
    for which, (number, compared, wrong) in totals.items():
        print(f"{which:16} {number} trajectories, {compared} compared with ruckig, {wrong} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
