#!/usr/bin/env python3
"""instruction_bound.py PROGRAM SOURCES MOST MOST_IN_RANGE - a bound on the instructions that planning the motion of one axis
takes, without and with a range of positions. Exit code 1: a bound is above its limit, or there is none.

The bound follows from the machine code of PROGRAM, which is compiled with the options of a release: the longest path
through each function, where each loop has as many passes as PASSES permits. A loop of the sources in the folder SOURCES
that is not in PASSES is an error, and so are recursion, a jump through a table, and a call of an unknown function.
"""
import functools
import math
import pathlib
import re
import sys

from machine_code import functions_of

TRIES = 50  # most_tries in trajectory.cpp
# Passes of each loop of the planner: the file, the begin of the loop, and its greatest number of passes.
PASSES = {
    ("axis_motion.cpp", "for (int i = 0; i < 60; ++i) {"): 60,
    ("axis_motion.cpp", "for (int i = 0; i < 60 && high - low"): 60,
    ("axis_motion.cpp", "for (const double bend : motion.bends())"): 4,
    ("axis_motion.cpp", "while (i < up.size() && j < down.size())"): 13,  # each pass ends one of 7 + 7 phases
    ("axis_motion.cpp", "for (const TimeRange& range : times_.ranges())"): 3,
    ("cruise.cpp", "for (int i = 0; i < 60 && low.error"): 60,
    ("farthest_motion.cpp", "for (std::size_t i = 0; i < phases.size(); ++i)"): 7,
    ("farthest_motion.cpp", "for (const double phase : cruise_)"): 7,
    ("farthest_motion.cpp", "for (const auto& [low, high] : pairs)"): 5,
    ("position_range.cpp", "for (const Segment& segment : profile.segments())"): 16,
    ("position_range.cpp", "for (const double time : turning_times("): 2,
    ("precision.cpp", "for (const Segment& segment : profile.segments())"): 16,
    ("profile.hpp", "for (const Segment& segment : segments())"): 16,
    ("trajectory.cpp", "for (int i = 0; i < most_tries; ++i)"): TRIES,
    ("transfer_times.cpp", "for (const TimeRange& block : blocked)"): 2,
}
# Functions of the C library, with more instructions than they have.
LIBRARY = {"sqrt@plt": 200, "__stack_chk_fail@plt": 0}
# What the passes rest on. The sources must have these lines.
ASSUMED = (("trajectory.cpp", f"most_tries = {TRIES};"), ("profile.hpp", "capacity = 2 + 14;"),
           ("farthest_motion.hpp", "using Phases = std::array<double, 7>;"), ("farthest_motion.hpp", "std::array<double, 4> bends()"),
           ("farthest_motion.cpp", "std::array<std::array<std::size_t, 2>, 5> pairs{"),
           ("transfer_times.hpp", "std::array<TimeRange, 3> ranges_{};"),
           ("transfer_times.cpp", "std::array blocked{too_slow(transfer), too_slow(mirrored(transfer))};"),
           ("position_range.cpp", "std::array<double, 2> turning_times("))
LOOP = re.compile(r"^\s*(?:\}\s*)?(for|while|do)\b")


class Unbounded(Exception):
    """Something in the machine code has no bound."""


class SourceLoops:
    """The loops in the sources, by the lines that they consist of."""

    def __init__(self, folder, passes):
        self.loops, used = {}, set()  # file: [(first line, last line, passes)]
        for file in sorted(folder.glob("*.?pp")):
            lines = file.read_text().splitlines()
            for number, text in enumerate(lines):
                if not LOOP.match(text):
                    continue
                key = next((key for key in passes if key[0] == file.name and key[1] in text), None)
                used.add(key)
                loop = (number + 1, end_of(lines, number), passes.get(key))
                self.loops.setdefault(file.name, []).append(loop)
        if unused := set(passes) - used:
            raise Unbounded(f"the sources have no loop {unused}")

    def of(self, places):
        """Returns the loops of the sources that these lines belong to, the innermost one of each line, with their
        passes."""
        found = {}
        for file, line in places:
            name = pathlib.PurePath(file).name
            inside = [loop for loop in self.loops.get(name, []) if loop[0] <= line <= loop[1]]
            if inside:
                first, _, passes = max(inside)
                if passes is None:
                    raise Unbounded(f"{name}:{first}: PASSES does not have this loop")
                found[name, first] = passes
        return found


def end_of(lines, begin):
    """Returns the number of the last line of the loop that begins in this line."""
    depth = 0
    for number in range(begin, len(lines)):
        depth += lines[number].count("{") - lines[number].count("}")
        if depth <= 0 and lines[number].rstrip().endswith(("}", ";")):
            return number + 1
    return len(lines)


def blocks_of(function):
    """Returns the blocks, {first address: [instructions]}, and what can follow each of them."""
    code = list(function.code.values())
    starts = {function.entry}
    for place, instruction in enumerate(code):
        if instruction.is_jump:
            starts.add(instruction.target)
            starts.update(after.address for after in code[place + 1:place + 2])
    blocks, follow, current = {}, {}, None
    for place, instruction in enumerate(code):
        if instruction.address in starts or current is None:
            current = instruction.address
            blocks[current], follow[current] = [], set()
        blocks[current].append(instruction)
        after = code[place + 1].address if place + 1 < len(code) else None
        if instruction.is_jump and instruction.target in function.code:
            follow[current].add(instruction.target)
        if instruction.is_jump and instruction.target is None:
            raise Unbounded(f"{function.name}: a jump through a table: {instruction.words}")
        if not instruction.goes_on:
            current = None
        elif after is not None and (after in starts):
            follow[current].add(after)
    reached, waiting = set(), [function.entry]
    while waiting:
        block = waiting.pop()
        if block not in reached:
            reached.add(block)
            waiting += follow[block]
    return {b: blocks[b] for b in reached}, {b: follow[b] & reached for b in reached}


def loops_of(entry, follow):
    """Returns the natural loops, {header: blocks}, the innermost first."""
    before = {block: {b for b in follow if block in follow[b]} for block in follow}
    dominators = {block: set(follow) for block in follow} | {entry: {entry}}
    changed = True
    while changed:
        changed = False
        for block in follow:
            if block == entry:
                continue
            now = {block} | set.intersection(*(dominators[b] for b in before[block]))
            changed |= now != dominators[block]
            dominators[block] = now
    loops, back = {}, set()
    for block, nexts in follow.items():
        for header in nexts & dominators[block]:
            back.add((block, header))
            body, waiting = {header}, [block]
            while waiting:
                inside = waiting.pop()
                if inside not in body:
                    body.add(inside)
                    waiting += before[inside]
            loops.setdefault(header, set()).update(body)
    return dict(sorted(loops.items(), key=lambda loop: len(loop[1]))), back


class Bound:
    """Bounds on the instructions of the functions of one program."""

    def __init__(self, functions, sources):
        self.functions, self.sources, self.active = functions, sources, []

    @functools.cache
    def of(self, name):
        if name in LIBRARY:
            return LIBRARY[name]
        if name not in self.functions:
            raise Unbounded(f"a call of {name}, whose bound is not known")
        if name in self.active:
            raise Unbounded(f"{name} calls itself")
        self.active.append(name)
        bound = self.of_code(self.functions[name])
        self.active.pop()
        return bound

    def called(self, function, instruction):
        """The bound of the function that an instruction calls or jumps to, 0 if it does neither."""
        leaves = instruction.is_jump and instruction.target not in function.code
        if not instruction.is_call and not leaves:
            return 0
        if instruction.target is None:
            raise Unbounded(f"{function.name}: a call of a computed address: {instruction.words}")
        return self.of(re.sub(r" \[clone \.localalias\]", "", instruction.target_name))

    def of_code(self, function):
        blocks, follow = blocks_of(function)
        cost = {start: sum(1 + self.called(function, i) for i in block) for start, block in blocks.items()}
        loops, back = loops_of(function.entry, follow)
        own = {start: {i.line for i in block} for start, block in blocks.items()}
        within = {start: set() for start in blocks}  # loops of the sources that loops in this block come from
        for header, body in loops.items():  # the innermost loop first: it becomes part of the cost of its header
            sources = self.sources.of(set().union(*(own[b] for b in body)))
            # A loop of the machine code that has an inner one also has some lines of the inner one.
            inner = set().union(*(within[b] for b in body))
            sources = {s: p for s, p in sources.items() if s not in inner} or sources
            if not sources:
                raise Unbounded(f"{function.name}: a loop at {header:x} that is none of the sources")
            # Two loops of the sources, of which one contains the other, may begin in the same block. Each has its jump back.
            jumps_back = sum(1 for _, to in back if to == header)
            passes = math.prod(p + 1 for p in sources.values()) if jumps_back > 1 else max(sources.values())
            once = longest(header, body, follow, back, cost)
            for block in body:
                cost[block] = 0
            cost[header] = (passes + 1) * once
            within[header] = inner | set(sources)
        return longest(function.entry, set(blocks), follow, back, cost)


def longest(entry, inside, follow, back, cost):
    """Returns the cost of the longest path from `entry` through these blocks without the jumps back."""
    known, waiting = {}, [entry]
    while waiting:
        block = waiting[-1]
        nexts = [b for b in follow[block] if b in inside and (block, b) not in back]
        missing = [b for b in nexts if b not in known]
        if len(waiting) > len(inside) * len(inside) + 1:
            raise Unbounded("a loop with two entries")
        if missing:
            waiting += missing
            continue
        known[block] = cost[block] + max((known[b] for b in nexts), default=0)
        waiting.pop()
    return known[entry]


def function_named(functions, part):
    found = [name for name in functions if re.match(part, name)]
    if len(found) != 1:
        raise Unbounded(f"{len(found)} functions are called {part}")
    return found[0]


def main(program, sources, most, most_in_range):
    functions, folder = functions_of(program), pathlib.Path(sources)
    for file, line in ASSUMED:
        if line not in (folder / file).read_text():
            raise Unbounded(f"{file} does not have `{line}`: PASSES may be wrong")
    bound = Bound(functions, SourceLoops(folder, PASSES))

    def of(part):
        value = bound.of(function_named(functions, part + "$"))
        print(f"{value:12,}  {part.replace(chr(92), '')}")
        return value

    of(r"takt::motion::FarthestMotion::reach\(double\) const")
    begin = of(r"takt::motion::AxisMotion::AxisMotion\(.*\)")
    possible = of(r"takt::motion::AxisMotion::possible\(double\) const")
    profile = of(r"takt::motion::AxisMotion::profile\(double\) const")
    ends = of(r"takt::motion::defect_of\(.*\)") + of(r"takt::motion::is_precise\(.*\)")
    once = begin + possible + profile + ends
    tries = of(r"takt::motion::\(anonymous namespace\)::plan_axis\(.*\)") + ends
    print(f"{once:12,}  one axis without a range of positions: begin, possible, profile and the checks")
    print(f"{tries:12,}  one axis with a range of positions, in {TRIES} tries")
    for value, limit in ((once, most), (tries, most_in_range)):
        if value > int(limit):
            raise Unbounded(f"planning an axis may take {value:,} instructions, more than {int(limit):,}")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except Unbounded as why:
        sys.exit(f"FAILED: {why}")
