#!/usr/bin/env python3
"""dbc_judge.py BIN SOURCE - cantools loads what `takt export dbc` writes and decodes frames as takt does.

A simulated run of the demo is recorded; of each PDO the newest frames are decoded by both. The words of
`takt dump` and the signals of the DBC must have equal values, statuswords and controlwords bit by bit.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import cantools

WORDS = {"statusword": 16, "controlword": 16}
FRAMES = 400


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


def main(bin_dir, source):
    takt = str(pathlib.Path(bin_dir) / "takt")
    demos = pathlib.Path(source) / "share/demo"
    demo = str(demos / "two_axes.yaml")
    with tempfile.TemporaryDirectory() as folder:
        for network in sorted(demos.glob("*.yaml")):
            for more in ((), ("--whole-words",)):
                cantools.database.load_file(run(takt, "export", "dbc", str(network), "-o", folder, *more).strip())
        database = cantools.database.load_file(run(takt, "export", "dbc", demo, "-o", folder).strip())
        log = str(pathlib.Path(folder) / "demo.log")
        run(takt, "simulate", demo, "--for", "3s", "--move", "--candump", log)
        newest = pathlib.Path(log).read_text().splitlines()[-FRAMES:]
        lines = run(takt, "dump", demo, "-", "--json", input="\n".join(newest) + "\n").splitlines()

    compared = 0
    for line in lines:
        frame = json.loads(line)
        if frame["service"] not in ("TPDO", "RPDO"):
            continue
        message = database.get_message_by_frame_id(frame["id"])
        theirs = values_of_dbc(message, bytes.fromhex(frame["data"]))
        ours = values_of_takt(frame["text"])
        assert ours.keys() == theirs.keys(), (message.name, ours, theirs)
        for name, value in ours.items():
            # `takt dump` prints six digits
            assert abs(value - theirs[name]) <= 1e-5 * max(1.0, abs(value)), (message.name, name, value, theirs[name])
            compared += 1
    assert compared > 500, compared
    words = {signal.name for message in database.messages for signal in message.signals}
    assert "statusword_operation_enabled" in words and "controlword_fault_reset" in words, words
    print(f"{compared} values of {len(database.messages)} messages are equal")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
