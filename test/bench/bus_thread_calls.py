#!/usr/bin/env python3
"""bus_thread_calls.py LOG - system calls a cycle of a bus thread, from `strace -xx -s 64 -p TID -o LOG` of a taktd
on a `unix:` bus. A cycle runs from one SYNC to the next. Exit code 1: more than 6, or 8 with a missing PDO."""
import collections
import re
import sys

SYNC = 0x080


def first_identifier(line):
    """COB-ID of the first frame of a batch, as the unix bus writes it: four bytes of head, then the identifier."""
    text = re.search(r'iov_base="((?:\\x[0-9a-f]{2})+)"', line)
    return int.from_bytes(bytes.fromhex(text[1].replace("\\x", ""))[4:8], "little") if text else None


def cycles_of(log):
    """Returns a list of (call, identifier of the first frame) for each cycle that the log has completely."""
    cycles = []
    for line in log:
        call = line.split("(")[0]
        identifier = first_identifier(line) if call == "sendmmsg" else None
        if identifier == SYNC:
            cycles.append([])
        if cycles and call.isidentifier():
            cycles[-1].append((call, identifier))
    return cycles[:-1]


def is_service(call, identifier):
    """Whether the call sends SDO, NMT or heartbeat, whose frames are not those of the cycle."""
    return call == "sendmmsg" and identifier is not None and (identifier == 0 or identifier >= 0x580)


def is_troubled(cycle):
    """Whether a cycle was skipped, or SYNC had to wait for the wire, because this machine was too busy."""
    calls = [call for call, _ in cycle]
    sleeps_again = any(a == b == "clock_nanosleep" for a, b in zip(calls, calls[1:]))
    return sleeps_again or calls[-1] == "recvmmsg" or calls.count("recvmmsg") > 2


def main(path):
    with open(path) as log:
        cycles = cycles_of(log)
    counts, worst = collections.Counter(), {1: 0, 2: 0}
    for cycle in cycles:
        if any(is_service(*call) for call in cycle):
            counts["with service frames"] += 1
            continue
        if is_troubled(cycle):
            counts["with a beat that was late or held"] += 1
            continue
        waits = sum(call == "recvmmsg" for call, _ in cycle)
        worst[waits] = max(worst.get(waits, 0), len(cycle))
        counts[f"{len(cycle)} calls, {waits} of them receive"] += 1
    for what, count in sorted(counts.items()):
        print(f"{count:6} cycles: {what}")
    others = {call for cycle in cycles for call, _ in cycle} - {"clock_nanosleep", "recvmmsg", "sendmmsg", "ppoll"}
    print(f"at most {worst[1]} calls in a complete cycle, {worst[2]} in one with a missing PDO; others than sleep, "
          f"receive, send, poll: {', '.join(others) or 'none'}")
    return 0 if cycles and worst[1] <= 6 and worst[2] <= 8 and not others else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
