#!/usr/bin/env python3
"""judge_interface.py BIN: vcan0 goes down and comes up again under a running taktd and its two nodes.

taktd reports both events and boots the nodes again, and SYNC comes back in its raster: never two SYNCs in one period,
whatever waited meanwhile. Runs inside with-vcan. Exit code 1: a check failed.
"""
import subprocess
import sys
import time

from daemon_run import ROOT, SYNC, DaemonRun, check, verdict

NETWORK = ROOT / "test/vcan/simulated_axes.yaml"
NODES = (5, 6)
PERIOD = 0.010
ENOUGH = 100  # SYNCs
LONGER = 1  # s for which the interface stays down after both nodes are lost
ROW = 10


def set_link(state):
    subprocess.run(["ip", "link", "set", "vcan0", state], check=True)


def judge_beat(run, down):
    """taktd leaves out a SYNC that is late by more than half a period. The recording has a shorter distance only if the
    thread paused between reading the clock and sending: once, behind a gap."""
    times = [f.time for f in run.frames() if f.standard(SYNC)]
    steps = [b - a for a, b in zip(times, times[1:])]
    excused = lambda i: i > 0 and steps[i - 1] > 1.4 * PERIOD
    near = [i for i, step in enumerate(steps) if step < PERIOD / 2]
    wrong = [f"{steps[i] * 1e3:.2f} ms" for i in near if not excused(i)]
    check(not wrong, f"{len(times)} SYNCs, none within half a period of another: {wrong[:5]}")
    rows = [b - a for a, b in zip(times, times[ROW:])]
    shortest = min(rows)
    check(shortest > (ROW - 2) * PERIOD, f"the shortest {ROW} periods take {shortest * 1e3:.1f} ms")
    longest = max(steps)
    check(longest > down, f"and there was none while the interface was down: {longest:.1f} s")


def main(binaries):
    with DaemonRun(binaries, NETWORK) as run:
        run.start_nodes()
        run.start_taktd()
        for node in NODES:
            run.await_event("boot_done", node)
        check(run.await_frames(SYNC, ENOUGH, run.place()), "SYNC comes")

        set_link("down")
        went = time.monotonic()
        run.await_event("interface_down")
        for node in NODES:
            run.await_event("heartbeat_lost", node)
        time.sleep(LONGER)
        set_link("up")
        down = time.monotonic() - went
        run.await_event("interface_up")
        for node in NODES:
            run.await_event("boot_done", node, 2)
        again = run.place()
        check(run.await_frames(SYNC, ENOUGH, again), "SYNC comes again")
        for node in NODES:
            check(run.await_frames(0x180 + node, ENOUGH, again), f"and node {node} sends its TPDO")
            states = {f.data for f in run.frames()[again + ENOUGH :] if f.standard(0x700 + node)}
            check(states == {b"\5"}, f"and is OPERATIONAL: {states}")
        told = len(run.events("interface_down")), len(run.events("interface_up"))
        check(told == (1, 1), f"down and up are told once: {told}")
        run.stop_taktd()
        judge_beat(run, 0.9 * down)
        run.dissect(1000)
    return verdict()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
