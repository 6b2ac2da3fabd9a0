#!/usr/bin/env python3
"""judge_loss.py BIN: one of two simulated nodes on vcan0 dies by SIGKILL under a running taktd and comes back.

taktd reports the loss, the other node answers every SYNC meanwhile, and taktd boots the dead node again by its plan.
The test counts recorded frames, because a pause of the machine delays frames but loses none. Runs inside with-vcan.
"""
import sys

from daemon_run import NMT, ROOT, SYNC, DaemonRun, check, verdict

NETWORK = ROOT / "test/vcan/simulated_axes.yaml"
LEFT, RIGHT = 5, 6
ENOUGH = 100  # SYNCs
EDGE = 2  # answers that may be under way


def writes(frames):
    """The SDO download requests of a boot to the node. A boot that is tried again may write again."""
    return {f.data.hex() for f in frames if f.standard(0x600 + RIGHT) and f.data[0] >> 5 == 1}


def first(frames, identifier, data):
    """The number of the first frame with this identifier and data, or None."""
    return next((f.number for f in frames if f.standard(identifier) and f.data == data), None)


def boot(frames):
    """The numbers of the first boot-up message of the node and of the first NMT start after it."""
    bootup = first(frames, 0x700 + RIGHT, b"\0")
    start = None if bootup is None else first(frames[bootup - frames[0].number :], NMT, bytes((1, RIGHT)))
    return bootup, start


def judge_boots(run, killed):
    frames = run.frames()
    (bootup, start), (again, restart) = boot(frames[:killed]), boot(frames[killed:])
    if not check(None not in (start, restart), f"boot-up and NMT start, twice: {bootup} {start} {again} {restart}"):
        return
    before, after = writes(frames[bootup:start]), writes(frames[again:restart])
    check(before and after == before, f"the second boot writes what the first wrote: {len(before)}, {len(after)}")
    return restart


def left_out(frames, node):
    """How many SYNCs the node has not answered. Answers that come late because the machine paused are answers: in each
    half, the smallest backlog counts."""
    behind, after_sync = 0, []
    for frame in frames:
        behind -= frame.standard(0x180 + node)
        if frame.standard(SYNC):
            behind += 1
            after_sync.append(behind)
    half = len(after_sync) // 2
    return min(after_sync[half:]) - min(after_sync[:half])


def judge_answers(run, node, begin, what):
    frames = run.frames()[begin:]
    syncs = sum(frame.standard(SYNC) for frame in frames)
    if check(syncs >= ENOUGH, f"{what}: {syncs} SYNCs"):
        missing = left_out(frames, node)
        check(abs(missing) <= EDGE, f"node {node} answers each of them: {missing} answers are missing")


def judge_beat(run):
    counters = [f.data for f in run.frames() if f.standard(SYNC)]
    gaps = [(a, b) for a, b in zip(counters, counters[1:]) if b[0] != a[0] % 10 + 1]
    check(not gaps, f"the counter of {len(counters)} SYNCs runs 1..10 without a gap: {gaps[:3]}")


def main(binaries):
    with DaemonRun(binaries, NETWORK) as run:
        run.start_nodes("left")
        victim = run.start_nodes("right")
        run.start_taktd()
        for node in (LEFT, RIGHT):
            run.await_event("boot_done", node)
        check(run.await_frames(0x180 + RIGHT, ENOUGH, run.place()), "both exchange PDOs")

        victim.kill()
        victim.wait()
        killed = run.place()
        run.await_event("pdo_missing", RIGHT)
        run.await_event("heartbeat_lost", RIGHT)
        silent = run.place()
        check(run.await_frames(SYNC, 2 * ENOUGH, killed), "SYNC goes on")
        judge_answers(run, LEFT, killed, "while a node is dead")
        check(run.count(0x180 + RIGHT, silent) == 0, f"node {RIGHT} sends nothing")

        run.start_nodes("right")
        run.await_event("boot_done", RIGHT, 2)
        back = judge_boots(run, killed)
        judge_answers(run, LEFT, killed, "until it is back")
        if back is not None:
            check(run.await_frames(0x180 + RIGHT, 2 * ENOUGH, back), "its TPDO comes again")
            begin = next((f.number for f in run.frames()[back:] if f.standard(0x180 + RIGHT)), back)
            judge_answers(run, RIGHT, begin, "since it is back")
            states = [f.data for f in run.frames()[back:] if f.standard(0x700 + RIGHT)]
            check(states[-1:] == [b"\5"], f"and its heartbeat says OPERATIONAL: {states[-1:]}")
        check(len(run.events("boot_done", LEFT)) == 1, f"node {LEFT} was booted once")
        run.stop_taktd()
        judge_beat(run)
        run.dissect(1000)
    return verdict()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
