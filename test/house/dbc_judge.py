#!/usr/bin/env python3
"""dbc_judge.py BIN SOURCE - cantools loads what `takt export dbc` writes and decodes frames as takt does.

A simulated run of each demo is recorded; cantools and takt decode the newest frames of each PDO. The words of
`takt dump` and the signals of the DBC must have equal values, statuswords and controlwords bit by bit.
"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import cantools

WORDS = {"statusword": 16, "controlword": 16}
FRAMES = 100  # of each PDO


def run(*command, **more):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def values_of_takt(text):
    """'1 shoulder  statusword=0x1237  position_actual_value=0.25 rad' -> {name: number}"""
    return {name: float(int(value, 16) if value.startswith("0x") else float(value))
            for name, value in re.findall(r"(\w+)=(0x[0-9A-F]+|-?[0-9.e+-]+)", text)}


def values_of_dbc(message, data):
    values = {}
    for name, value in message.decode(data, decode_choices=False).items():
        word = next((word for word in WORDS if name.startswith(word + "_")), None)
        if word is None:
            values[name] = float(value)
        else:
            start = message.get_signal_by_name(name).start
            values[word] = values.get(word, 0.0) + (int(value) << start)
    return values


def recorded(takt, demo, folder):
    """The newest PDOs of each identifier in a simulated run, as `takt dump` prints them."""
    log = folder / "demo.log"
    run(takt, "simulate", demo, "--for", "3s", "--move", "--candump", str(log))
    newest = {}
    for line in log.read_text().splitlines():
        newest.setdefault(line.split()[2].split("#")[0], collections.deque(maxlen=FRAMES)).append(line)
    text = "\n".join(line for lines in newest.values() for line in lines) + "\n"
    frames = [json.loads(line) for line in run(takt, "dump", demo, "-", "--json", input=text).splitlines()]
    return [frame for frame in frames if frame["service"] in ("TPDO", "RPDO")]


def judge(takt, demo, folder):
    """Number of values that are equal, and the database."""
    for more in (("--whole-words",), ()):
        database = cantools.database.load_file(run(takt, "export", "dbc", demo, "-o", str(folder), *more).strip())
    compared = 0
    seen = set()
    for frame in recorded(takt, demo, folder):
        message = database.get_message_by_frame_id(frame["id"])
        theirs = values_of_dbc(message, bytes.fromhex(frame["data"].replace(" ", "")))
        ours = values_of_takt(frame["text"])
        assert ours.keys() == theirs.keys(), (message.name, ours, theirs)
        for name, value in ours.items():
            # `takt dump` prints six digits
            assert abs(value - theirs[name]) <= 1e-5 * max(1.0, abs(value)), (message.name, name, value, theirs[name])
            compared += 1
        seen.add(message.name)
    assert compared > 20, (demo, compared)
    print(f"{demo}: {compared} values of {len(seen)} messages of {len(database.messages)} are equal")
    return compared, database


def main(bin_dir, source):
    takt = str(pathlib.Path(bin_dir) / "takt")
    demos = sorted((pathlib.Path(source) / "share/demo").glob("*.yaml"))
    assert len(demos) >= 7, demos
    with tempfile.TemporaryDirectory() as folder:
        for demo in demos:
            compared, database = judge(takt, str(demo), pathlib.Path(folder))
            if demo.stem != "two_axes":
                continue
            assert compared > 500, compared
            words = {signal.name for message in database.messages for signal in message.signals}
            assert "statusword_operation_enabled" in words and "controlword_fault_reset" in words, words


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
