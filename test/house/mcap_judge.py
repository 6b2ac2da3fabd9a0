#!/usr/bin/env python3
"""mcap_judge.py BIN SOURCE - checks that the official reader of MCAP reads the files of `takt log`.

A simulated run of a demo is recorded as candump writes it and converted to .mcap and .csv. The reader finds the same
messages with the index and without it, all checksums are right, times and counts are those of the recording, and the
values are those of the CSV.
"""
import csv
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

from mcap.reader import NonSeekingReader, make_reader
from mcap.records import Chunk, MessageIndex
from mcap.stream_reader import StreamReader

failures = []


def check(name, good, told=""):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print("      " + str(told)[:500])


class Converted:
    def __init__(self, takt, source, folder):
        self.takt, self.folder = takt, folder
        self.net = source / "share/demo/two_axes.yaml"
        self.candump = folder / "demo.log"
        self.run("simulate", self.net, "--for", "15s", "--move", "--candump", self.candump)
        self.frames = self.candump.read_text().splitlines()

    def run(self, *words, code=0, **more):
        done = subprocess.run([self.takt, *(str(word) for word in words)], capture_output=True, text=True, timeout=600, **more)
        check(f"takt {words[0]} ends with {code}", done.returncode == code, f"{done.returncode}: {done.stderr}")
        return done

    def log(self, name, *words, **more):
        done = self.run("log", *words, "--from", self.candump, "-o", self.folder / name, **more)
        return self.folder / name, done.stderr


def messages(path, **wanted):
    with open(path, "rb") as file:
        return [(channel.topic, message.log_time, message.sequence, json.loads(message.data))
                for _, channel, message in make_reader(file, validate_crcs=True).iter_messages(**wanted)]


def without_index(path):
    with open(path, "rb") as file:
        return [(channel.topic, message.log_time, message.sequence, json.loads(message.data))
                for _, channel, message in NonSeekingReader(file, validate_crcs=True).iter_messages()]


def is_of_schema(schema, value):
    """The part of JSON schemas that takt uses."""
    if schema.get("type") == "object":
        return isinstance(value, dict) and all(is_of_schema(schema["properties"][key], value[key]) for key in value)
    if "oneOf" in schema:
        return value in [choice["const"] for choice in schema["oneOf"]]
    kinds = {"integer": int, "number": (int, float), "string": str}
    return isinstance(value, kinds[schema["type"]]) and not isinstance(value, bool)


def summary_is_right(path, all_messages):
    with open(path, "rb") as file:
        summary = make_reader(file).get_summary()
        file.seek(0)
        records = list(StreamReader(file, emit_chunks=True, validate_crcs=True).records)
    counts = {summary.channels[id].topic: count for id, count in summary.statistics.channel_message_counts.items()}
    found = {topic: sum(message[0] == topic for message in all_messages) for topic in counts}
    check("the statistics count the messages of each channel", counts == found, (counts, found))
    times = [message[1] for message in all_messages]
    check("they have the first and the last time", (min(times), max(times)) ==
          (summary.statistics.message_start_time, summary.statistics.message_end_time), summary.statistics)
    chunks = [record for record in records if isinstance(record, Chunk)]
    check("there are several chunks", len(chunks) > 2 and summary.statistics.chunk_count == len(chunks), len(chunks))
    check("each chunk has an index", [(index.message_start_time, index.message_end_time) for index in summary.chunk_indexes] ==
          [(chunk.message_start_time, chunk.message_end_time) for chunk in chunks])
    indexed = sum(len(record.records) for record in records if isinstance(record, MessageIndex))
    check("each message is in an index", indexed == len(all_messages), (indexed, len(all_messages)))
    for channel in summary.channels.values():
        schema = json.loads(summary.schemas[channel.schema_id].data)
        bad = [message[3] for message in all_messages if message[0] == channel.topic and not is_of_schema(schema, message[3])]
        check(f"the messages of {channel.topic} are of its schema", not bad and channel.message_encoding == "json", bad[:1])


def read_back(made):
    path, told = made.log("all.mcap", "--network", made.net)
    all_messages = messages(path)
    check("the reader finds as many frames as were recorded",
          sum(message[0] == "/demo/frame" for message in all_messages) == len(made.frames), len(all_messages))
    key = lambda message: (message[1], message[0], message[2])
    check("without the index it finds the same", sorted(all_messages, key=key) == sorted(without_index(path), key=key))
    check("the messages come in the order of their times", all(a[1] <= b[1] for a, b in zip(all_messages, all_messages[1:])))
    check("the times are those of the recording", [message[1] for message in all_messages if message[0] == "/demo/frame"] ==
          [int(line.split()[0].strip("()").replace(".", "")) * 1000 for line in made.frames])
    for topic in ("/demo/image", "/demo/frame"):
        check(f"no message of {topic} is missing",
              sorted(message[2] for message in all_messages if message[0] == topic) ==
              list(range(sum(message[0] == topic for message in all_messages))))
    middle = all_messages[len(all_messages) // 2][1]
    part = messages(path, topics=["/demo/image"], starting_at=middle, ending_before=middle + 100_000_000)
    check("a part by topic and time is the same part", part == [message for message in all_messages if
          message[0] == "/demo/image" and middle <= message[1] < middle + 100_000_000] and len(part) > 40, len(part))
    summary_is_right(path, all_messages)
    check("the line at the end counts", f" {sum(message[0] == '/demo/image' for message in all_messages)} cycles in " in told and
          f"{len(made.frames)} frames" in told, told)
    return all_messages


def csv_has_the_same(made, all_messages):
    path, _ = made.log("all.csv", "--network", made.net)
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    head = rows[0]
    check("the CSV has units", "shoulder.position_actual_value [rad]" in head, head)
    images = [message for message in all_messages if message[0] == "/demo/image"]
    check("it has one line for each image", len(rows) - 1 == len(images), (len(rows), len(images)))
    differences = []
    for row, (_, time, _, values) in zip(rows[1:], images):
        ours = {name.split(" ")[0]: float(cell) for name, cell in zip(head[3:-1], row[3:-1]) if cell}
        theirs = {f"{node}.{name}": float(value) for node, of_node in values.items() if node != "cycle"
                  for name, value in of_node.items()}
        if ours != theirs or int(row[1]) * 1000 != time or int(row[2]) != values["cycle"]:
            differences.append((row, values))
    check("its values are those of the images", not differences, differences[:1])
    moved = [values["shoulder"]["position_actual_value"] for *_, values in images if "position_actual_value" in values["shoulder"]]
    check("the axis has moved", max(moved) > min(moved), (min(moved), max(moved)))


def some_signals(made):
    path, _ = made.log("some.mcap", "elbow.*", "--network", made.net)
    nodes = {node for topic, _, _, values in messages(path) if topic == "/demo/image" for node in values}
    check("a pattern chooses signals", nodes == {"cycle", "elbow"}, nodes)
    done = made.run("log", "sholder.*", "--from", made.candump, "--network", made.net, "-o", made.folder / "none.mcap", code=2)
    check("a wrong pattern has a guess", "did you mean `shoulder.*`?" in done.stderr, done.stderr)
    path, _ = made.log("frames.mcap")
    check("without a network file there are the frames", {message[0].split("/")[-1] for message in messages(path)} == {"frame"})
    done = made.run("log", "--from", made.candump, "-o", made.folder / "none.csv", code=2)
    check("a CSV needs the network file", "--network NET.yaml" in done.stderr, done.stderr)


def full_disk(made, all_messages):
    """The limit of the size of files imitates a full disk."""
    for ending, most in ((".mcap", 10 << 20), (".csv", 1 << 20), (".mcap", 1 << 10)):
        name = f"full_{most}{ending}"
        limited = lambda most=most: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        path, told = made.log(name, "--network", made.net, code=1, preexec_fn=limited)
        if most < 2048:
            check("without room there is no file", not path.exists() and "no file is left" in told, told)
            continue
        check(f"{name} keeps within the disk", 0 < path.stat().st_size <= most, path.stat().st_size)
        check(f"{name}: takt says why it ends", "the log ends here: File too large" in told, told)
        if ending == ".mcap":
            known = {(topic, sequence): (time, data) for topic, time, sequence, data in all_messages}
            some = {(topic, sequence): (time, data) for topic, time, sequence, data in messages(path)}
            check("it is a whole file with less in it", 1000 < len(some) < len(known) and
                  all(known[key] == some[key] for key in some), len(some))
            continue
        lines = path.read_text().splitlines()
        check("its lines are whole", len({len(row) for row in csv.reader(lines)}) == 1 and len(lines) > 100, lines[-1])
    check("nothing unfinished is left", not list(made.folder.glob(".part-*")), list(made.folder.iterdir()))


def main(bin_dir, source):
    with tempfile.TemporaryDirectory() as folder:
        made = Converted(pathlib.Path(bin_dir) / "takt", pathlib.Path(source), pathlib.Path(folder))
        all_messages = read_back(made)
        csv_has_the_same(made, all_messages)
        some_signals(made)
        full_disk(made, all_messages)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
