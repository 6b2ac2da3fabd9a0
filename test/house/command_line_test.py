#!/usr/bin/env python3
"""command_line_test.py BIN: checks the messages of takt and taktd to a user who makes a mistake, or who asks for
help."""
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DEMO = ROOT / "share/demo/two_axes.yaml"
failures = []


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print("      " + told.replace("\n", "\n      "))


class Tools:
    def __init__(self, binaries):
        self.binaries = pathlib.Path(binaries)

    def run(self, command, **options):
        words = [str(word) for word in command]
        return subprocess.run([self.binaries / words[0], *words[1:]], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=60, **options)

    def says(self, name, command, code, *parts):
        """`command` ends with `code`, and its output holds all `parts`."""
        done = self.run(command)
        told = done.stdout + done.stderr
        missing = [part for part in parts if part not in told]
        check(name, done.returncode == code and not missing, f"exit code {done.returncode}, without {missing}:\n{told}")

    def start(self, *command):
        words = [str(word) for word in command]
        return subprocess.Popen([self.binaries / words[0], *words[1:]], stderr=subprocess.DEVNULL)


def wrong_use(tools):
    tools.says("takt names the commands it has", ["takt", "plam"], 2, "no command 'plam'", " plan ")
    tools.says("takt eds names the commands it has", ["takt", "eds", "chek"], 2, "no command 'chek'", " check")
    tools.says("a wrong command has a guess", ["takt", "plam"], 2, "did you mean 'plan'?")
    tools.says("so has one of a command", ["takt", "eds", "chek"], 2, "did you mean 'check'?")
    tools.says("a wrong option has a guess", ["takt", "plan", "--jsn", DEMO], 2, "takt plan: no option '--jsn'", "did you mean '--json'?")
    tools.says("so has one with a value", ["takt", "simulate", DEMO, "--sead=3"], 2, "no option '--sead'", "did you mean '--seed'?")
    tools.says("so has one of taktd", ["taktd", DEMO, "--chek"], 2, "taktd: no option '--chek'", "did you mean '--check'?")
    tools.says("so has one of takt-move", ["takt-move", "--sin"], 2, "did you mean '--sine'?")
    tools.says("so has one of takt-jog", ["takt-jog", "--velocty", "1"], 2, "did you mean '--velocity'?")
    tools.says("takt-jog asks for the velocity", ["takt-jog"], 2, "--velocity is required")
    tools.says("takt-jog moves at no velocity of 0", ["takt-jog", "--velocity", "0"], 2, "0 is not a finite number other than 0")
    tools.says("so has one of takt-follow", ["takt-follow", "--leadr", "x"], 2, "did you mean '--leader'?")
    tools.says("takt-follow asks for the leader", ["takt-follow"], 2, "--leader is required")
    tools.says("takt-follow takes no ratio of 1/0", ["takt-follow", "--leader", "x", "--ratio", "1/0"], 2, "1/0 is neither a finite number nor a finite ratio")
    tools.says("so has one of takt-logic", ["takt-logic", "rules.yaml", "--chek"], 2, "did you mean '--check'?")
    tools.says("takt-logic prints its rules", ["takt-logic", ROOT / "share/demo/logic/rules.yaml", "--check"], 0, "count parts when")
    tools.says("so has one of takt-home", ["takt-home", "demo", "--togehter"], 2, "did you mean '--together'?")
    tools.says("takt-home asks for the bus", ["takt-home"], 2, "bus is required")
    tools.says("so has a word that an option takes", ["taktd", DEMO, "--rt", "enforc"], 2, "did you mean 'enforce'?")
    tools.says("so has one that a command takes", ["takt", "nmt", "strat", "5"], 2, "'strat' is not one of start, stop,", "did you mean 'start'?")
    tools.says("so has a change of what if", ["takt", "budget", DEMO, "--what-if", "perod=1ms"], 2, "did you mean 'period'?")
    tools.says("so has one of a PDO", ["takt", "budget", DEMO, "--what-if", "io.tpdo1.inhibt=1ms"], 2, "did you mean 'inhibit'?")
    tools.says("a far one has none", ["takt", "plan", "--zzzzzz", DEMO], 2, "no option '--zzzzzz'; takt plan --help lists the options")
    tools.says("behind -- are no options", ["takt", "plan", "--", "--jsn"], 2, "--jsn")
    tools.says("a recording without set-points has an advice", ["takt", "smooth", DEMO], 2, "holds no frame")
    tools.says("so has a PDO that takt can't read", ["takt", "smooth", DEMO, "--pdo", "205"], 2, "holds no frame")
    tools.says("takt log names its formats", ["takt", "log", "-o", "run.txt"], 2, "run.txt: the name has to end in .csv or .mcap")
    tools.says("takt log asks for the file", ["takt", "log"], 2, "--output is required")
    tools.says("takt log names a missing recording", ["takt", "log", "--from", "none.log", "-o", "run.mcap"], 2, "none.log: can't be read")
    tools.says("takt log --for is for a running bus", ["takt", "log", "--from", "none.log", "--for", "1s", "-o", "-"], 2, "--for is for a running bus")
    tools.says("a recording that is missing is named", ["takt", "smooth", "none.log"], 2, "none.log: can't be read")
    tools.says("takt without a command is wrong use", ["takt"], 2, "--help")
    for command in ([], ["dump"], ["eds"], ["import"], ["learn"], ["plan"], ["budget"], ["sim"], ["simulate"], ["demo"], ["status"],
                    ["top"], ["log"], ["spy"], ["sdo"], ["nmt"], ["trajectory"]):
        tools.says(" ".join(["takt", *command, "--help"]) + " has an example", ["takt", *command, "--help"], 0, "Example")


def the_bus_is_named(tools):
    tools.says("taktd needs a bus", ["taktd", DEMO], 2, "two_axes.yaml names no bus", "interface: can0", "--bus can0", "--bus sim")
    tools.says("taktd --check needs none", ["taktd", DEMO, "--check"], 0)
    tools.says("takt plan needs none", ["takt", "plan", DEMO], 0)
    tools.says("takt simulate needs none", ["takt", "simulate", DEMO, "--for", "1s"], 0)


def budget_and_check_agree(tools):
    axis = ("{dcf: " + str(ROOT / "share/eds/takt_drive402.eds") + ", heartbeat_producer: 100, on_loss: report, "
            "tpdo: {1: {transmission: 1, mapping: [0x6041, 0x6064]}, 2: {transmission: 1, mapping: [0x606C, 0x6077, 0x6061]}, "
            "3: {enabled: false}, 4: {enabled: false}}, "
            "rpdo: {1: {transmission: 1, mapping: [0x6040, 0x607A]}, 2: {transmission: 1, mapping: [0x6060]}, "
            "3: {enabled: false}, 4: {enabled: false}}, node_id: ")
    with tempfile.TemporaryDirectory() as folder:
        for drives, period in ((120, 80000), (2, 80000)):
            net = pathlib.Path(folder) / f"{drives}.yaml"
            nodes = "".join(f"  a{i}: {axis}{i}}}\n" for i in range(1, drives + 1))
            net.write_text(f"bus: {{name: big}}\nmaster: {{sync_period: {period}, heartbeat_producer: 100}}\nnodes:\n{nodes}")
            budget, checked = tools.run(["takt", "budget", net]), tools.run(["taktd", net, "--check"])
            check(f"takt budget and taktd --check agree: {drives} drives at {period} us", budget.returncode == checked.returncode,
                  f"{budget.returncode} and {checked.returncode}: {checked.stderr[-600:]}")


def numbers_are_decimal_or_hex(tools):
    eds = ROOT / "share/eds/takt_drive402.eds"
    tools.says("010 is no number", ["takt", "eds", "show", eds, "--node", "010"], 2, "--node", "'010' begins with a zero: write 10 or 0x8")
    tools.says("nor is 08", ["takt", "eds", "show", eds, "--node", "08"], 2, "'08' begins with a zero: write 8\n")
    for number in ("10", "0xA"):
        shown = tools.run(["takt", "eds", "show", eds, "--node", number, "--json"]).stdout
        check(f"{number} is ten", '"node_id":10' in shown.replace(" ", ""), shown[:300])
    for command in (["lss", "set-id", "010"], ["lss", "set-bitrate", "0125"], ["simulate", DEMO, "--seed", "017"],
                    ["sdo", "upload", 5, 1021, "f", "--limit", "010K"], ["dump", "-n", "010"], ["scan", "--bus", "x", "--timeout", "0100"]):
        tools.says(f"takt {command[0]} takes no octal number", ["takt", *command], 2, "begins with a zero: write 1")


def times(tools):
    for time in ("1", "1s", "1000ms", "1000000us"):
        tools.says(f"takt simulate --for {time}", ["takt", "simulate", DEMO, "--for", time], 0, "simulated 1")
    for time in ("2", "2m", "2min", "1h", "10us"):
        tools.says(f"taktd --for {time}", ["taktd", DEMO, "--check", "--for", time], 0)
    for time in ("10 s", "10x", "-1s", "s"):
        tools.says(f"taktd --for '{time}'", ["taktd", DEMO, "--check", "--for=" + time], 2, "is not a time like 10s")
        tools.says(f"takt simulate --for '{time}'", ["takt", "simulate", DEMO, "--for=" + time], 2, "is not a time like")


def full_disk(tools):
    """/dev/full refuses each byte, as a full disk does."""
    told = "takt: can't write to stdout: No space left on device\n"
    for command in (["plan", DEMO], ["import", DEMO], ["import", DEMO, "--json"], ["budget", DEMO], ["--help"],
                    ["simulate", DEMO, "--for", "1s"], ["eds", "show", ROOT / "share/eds/takt_drive402.eds", "--json"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([tools.binaries / "takt", *command], stdout=full, stderr=subprocess.PIPE, text=True)
        check(f"takt {command[0]} onto a full disk", done.returncode == 1 and done.stderr.endswith(told),
              f"exit code {done.returncode}: {done.stderr}")
    with open("/dev/full", "w") as full:
        done = subprocess.run([tools.binaries / "taktd", DEMO, "--check"], stdout=full, stderr=subprocess.PIPE, text=True)
    check("taktd --check onto a full disk", done.returncode == 1 and "can't write to stdout" in done.stderr, done.stderr)
    reader = subprocess.run(f"{tools.binaries}/takt eds show {ROOT}/share/eds/takt_drive402.eds --json | head -n 1",
                            shell=True, capture_output=True, text=True)
    check("a reader that has enough is no trouble", reader.stderr == "" and reader.stdout != "", reader.stderr)


def dump_chooses(tools, folder):
    log = folder / "trace.log"
    log.write_text("(1.0) can0 601#4000100000000000\n(1.1) can0 581#4300100092010200\n(1.2) can0 000#0100\n"
                   "(1.3) can0 602#4000100000000000\n(1.4) can0 082#3081110000000000\n(1.5) can0 20000040#0000000000000000\n")
    lines = lambda *options: tools.run(["takt", "dump", DEMO, log, *options]).stdout.splitlines()
    check("takt dump shows all six", len(lines()) == 6, str(lines()))
    check("--only EMCY,ERROR shows two", len(lines("--only", "emcy,ERROR")) == 2, str(lines("--only", "emcy,ERROR")))
    check("--node by name shows its frames and commands to all", len(lines("--node", "shoulder")) == 3, str(lines("--node", "shoulder")))
    check("--node by id", len(lines("--node", "2", "--only", "SDO")) == 1, str(lines("--node", "2", "--only", "SDO")))
    tools.says("--only wants services", ["takt", "dump", log, "--only", "SDOO"], 2, "no service 'SDOO'; there are NMT, ", ", GFC, ERROR, ?")
    tools.says("a folder is no recording", ["takt", "dump", folder], 2, f"{folder}: cannot be read: Is a directory")
    pcan = folder / "trace.trc"
    pcan.write_text(";$FILEVERSION=1.1\n;\n     1)     10.2  Rx         0701  1  00\n     2)     11.2  Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY\n     3)     12.2  Rx\n")
    done = tools.run(["takt", "dump", pcan])
    check("a PCAN trace", done.returncode == 0 and done.stdout.startswith("(0.010200)  can0  701   [1]  00"), done.stdout)
    check("what is no frame in it is told", f"{pcan}:5: not a frame" in done.stderr and ":1:" not in done.stderr, done.stderr)
    check("a state of the controller is no frame, and no fault", ":4:" not in done.stderr, done.stderr)
    pcan.write_text("nothing\nof the kind\n")
    tools.says("nothing to learn from", ["takt", "learn", pcan, "-o", folder / "x.yaml"], 2, "holds no frame", ".trc")
    tools.says("nothing to learn from on that interface", ["takt", "learn", log, "--bus", "can7", "-o", folder / "x.yaml"], 2,
               "no frame of interface can7", "--bus can0")
    tools.says("no recording at all", ["takt", "dump", pcan], 2, "holds no frame; `candump -L can0 > FILE`")
    tools.says("--node wants a node", ["takt", "dump", log, "--node", "nobody"], 2, "'nobody' is not a node id 1..127")


def folders_for_files(tools, folder):
    bus = ["--bus", f"unix:{folder}/nobody"]
    tools.says("a folder is nothing to download", ["takt", "sdo", "download", 5, "1F50:1", folder, *bus], 2, f"{folder}: is a directory")
    tools.says("nor what there is not", ["takt", "sdo", "download", 5, "1F50:1", folder / "none", *bus], 2, "none: cannot be read")
    tools.says("a folder of faults", ["takt", "sim", DEMO, "--faults", folder, *bus], 2, "is a folder")
    tools.says("and for takt simulate", ["takt", "simulate", DEMO, "--faults", folder], 2, "is a folder")
    log = folder / "boot.log"
    log.write_text("(1.0) can0 703#00\n")
    tools.says("a folder of device files", ["takt", "learn", log, "--eds", folder, "-o", "-"], 2, f"{folder}: error: is a folder", "--eds-dir")


def imports(tools, folder):
    tools.says("nothing to import", ["takt", "import", "/nonexist.yml"], 2, "there is no such file")
    tools.says("a folder to import", ["takt", "import", folder], 2, "is a folder")
    tools.says("a nodelist that there is not", ["takt", "import", folder / "none.cpj"], 2, "can't be read")
    wrong = folder / "wrong.yml"
    wrong.write_text("master: {node_id: 127}\nnodes:\n  a: {nod_id: 5}\n")
    tools.says("a file that can't run", ["takt", "import", wrong], 1, "taktd does not accept this file")
    tabs = folder / "tabs.yml"
    tabs.write_text("master:\n\tnode_id: 1\n")
    tools.says("a bus.yml that is no YAML", ["takt", "import", tabs], 2, "invalid YAML")
    nodes = folder / "nodelist.cpj"
    nodes.write_text(f"[Topology]\nNodes=1\nNode5Present=1\nNode5DCFName={ROOT}/share/eds/takt_io401.eds\n")
    tools.says("a network file that is written and does not load", ["takt", "import", nodes, "-o", "/dev/null"], 1,
               "/dev/null was written, but taktd does not accept it")


def plan(tools):
    tools.says("a node by its id in hex", ["takt", "plan", DEMO, "--node", "0x0A"], 0, "node 10 io")
    brief = tools.run(["takt", "plan", DEMO, "--brief"]).stdout
    check("a plan on one screen", len(brief.splitlines()) <= 24 and all(len(line) <= 80 for line in brief.splitlines())
          and all(part in brief for part in ("3 nodes, 2 axes", "shoulder", "file: position", "findings: ")), brief)
    tools.says("a screen is no document", ["takt", "plan", DEMO, "--brief", "--json"], 2, "--json")
    tools.says("a node that there is not", ["takt", "plan", DEMO, "--node", "9"], 2, "no node `9`; there is shoulder (1)")


def budget(tools):
    tools.says("the demo fits its bus", ["takt", "budget", DEMO], 0, "TPDO2 elbow", "It fits")
    first = ("It fits. SYNC can be 95 us late if all these frames come at once, and 200 us are permitted:\n"
             "  RPDO2 io ends at 2095 us, the next SYNC comes at 2000 us\n")
    told = tools.run(["takt", "budget", DEMO]).stdout
    check("the verdict comes first", told.startswith(first), told)
    tools.says("the picture shows what ends behind SYNC", ["takt", "budget", DEMO, "--timeline"], 0, "+", "  behind SYNC\n")
    tools.says("it does not fit a quarter of its bit rate", ["takt", "budget", DEMO, "--what-if", "bitrate=250"], 1,
               "It does not fit", "TOO LATE", "1000 kbit/s instead of 250", "--what-if period=")
    tools.says("a PDO of a node that there is not", ["takt", "budget", DEMO, "--what-if", "wrist.tpdo1=2"], 2, "wrist", "elbow")
    tools.says("a PDO less", ["takt", "budget", DEMO, "--what-if", "io.tpdo2=off", "--timeline"], 0, "It fits", "receive window ends 1")
    tools.says("a bit rate that there is not", ["takt", "budget", DEMO, "--what-if", "bitrate=300"], 2, "bitrate=300",
               "125, 250, 500")
    tools.says("a type that is reserved", ["takt", "budget", DEMO, "--what-if", "io.rpdo2=252"], 2, "0 to 240, 254 or 255")
    tools.says("a time without a unit", ["takt", "budget", DEMO, "--what-if", "period=1000"], 2, "us, ms or s")


def trajectory(tools):
    way = '"from":{"position":[0]},"to":{"position":[1]}'
    limits = '"limits":{"velocity":[1],"acceleration":[5],"jerk":[50]}'
    with tempfile.TemporaryDirectory() as folder:
        lines, picture = pathlib.Path(folder, "lines.json"), pathlib.Path(folder, "move.svg")
        lines.write_text("{%s,%s}\n" % (way, limits))
        tools.says("a trajectory has a duration", ["takt", "trajectory", str(lines), "--plot", str(picture)], 0, '"duration":1.2999999', '"error":null')
        drawn = picture.read_text()
        check("its picture is an SVG file", drawn.startswith("<svg"), drawn[:100])
        lines.write_text("{%s,%s}\n\n{%s}\n" % (way, limits.replace("[1]", "[-1]"), way))
        tools.says("a wrong line is named, and the others are answered", ["takt", "trajectory", str(lines)], 2,
                   "lines.json:3: `limits` is missing", "axis 0: the velocity limits do not enclose 0")
        lines.write_text("{%s,%s}\n" % (way, limits.replace("[1]", "[-1]")))
        tools.says("what has no solution is the answer no", ["takt", "trajectory", str(lines)], 1, '"duration":null')
    tools.says("a file that is not there", ["takt", "trajectory", "missing.json"], 2, "can't read missing.json")
    tools.says("an interval without sense", ["takt", "trajectory", "--sample", "0s"], 2, "expected a time such as 1ms")


def babble(path, stop):
    """Eight bytes that an SDO client could take for an answer, on many other identifiers."""
    bus = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    bus.connect(str(path))
    while not stop.wait(0.002):
        for identifier in (0x181, 0x281, 0x5B6):
            bus.send(struct.pack("<IIBBHI8sq", 0x544B0001, identifier, 8, 0, 0, 0, b"\xe0" * 8, 0))
    bus.close()


def sdo_without_daemon(tools, folder):
    path = folder / "bus"
    devices = tools.start("takt", "sim", DEMO, "--bus", f"unix:{path}")
    while not path.exists():
        time.sleep(0.02)
    stop = threading.Event()
    babbler = threading.Thread(target=babble, args=(path, stop))
    babbler.start()
    bus = ["--bus", f"unix:{path}"]
    try:
        tools.says("an absent node does not answer, whatever else is on the bus",
                   ["takt", "sdo", "read", 55, "1000", *bus, "--timeout", 300], 1, "did not answer")
        tools.says("a present one does", ["takt", "sdo", "read", 1, "1018:1", "u32", *bus], 0, "43981\n")
        tools.says("a value of another size is not shown in a type that it has not",
                   ["takt", "sdo", "read", 1, "1018:1", "u8", *bus], 1, "4 bytes (CDAB0000), u8 takes 1")
        tools.says("names of nodes need a file without a daemon", ["takt", "sdo", "read", "io", "1000", *bus], 2, "--network FILE")
        objects_by_name(tools, bus)
    finally:
        stop.set()
        babbler.join()
        devices.terminate()
        devices.wait()


def objects_by_name(tools, bus):
    drive = [*bus, "--eds", ROOT / "share/eds/takt_drive402.eds"]
    demo = [*bus, "--network", DEMO]
    tools.says("an object is known by its name in the EDS", ["takt", "sdo", "read", 1, "vendor_id", *drive], 0, "43981\n")
    tools.says("so is a node by that in the network file", ["takt", "sdo", "read", "elbow", "identity_object.vendor_id", *demo], 0, "43981\n")
    tools.says("its type is known", ["takt", "sdo", "write", "elbow", "profile_velocity", "4711", *demo], 0)
    tools.says("also for its index", ["takt", "sdo", "write", "elbow", "6083", "4712", *demo], 0)
    tools.says("and the value arrives", ["takt", "sdo", "read", 2, "6081", "u32", *bus], 0, "4711\n")
    tools.says("a type may be given", ["takt", "sdo", "read", 2, "6081", "hex", *drive], 0, "67120000\n")
    tools.says("an unknown name has a guess", ["takt", "sdo", "read", 1, "statuswrd", *drive], 2, "did you mean 'statusword'?")
    tools.says("an ambiguous one lists the objects", ["takt", "sdo", "read", 1, "transmission_type", *drive], 2, "several objects", "1400:02")
    tools.says("a name without a file says what to give", ["takt", "sdo", "read", 1, "statusword", *bus], 2, "--eds FILE")
    tools.says("so does a value without a type", ["takt", "sdo", "write", 1, "6081", "1", *bus], 2, "--eds FILE")
    tools.says("an unknown node lists the nodes", ["takt", "sdo", "read", "elbw", "statusword", *demo], 2, "did you mean `elbow`?", "10 io")


def main(binaries):
    tools = Tools(binaries)
    with tempfile.TemporaryDirectory() as folder:
        wrong_use(tools)
        the_bus_is_named(tools)
        budget_and_check_agree(tools)
        numbers_are_decimal_or_hex(tools)
        times(tools)
        full_disk(tools)
        dump_chooses(tools, pathlib.Path(folder))
        folders_for_files(tools, pathlib.Path(folder))
        imports(tools, pathlib.Path(folder))
        plan(tools)
        budget(tools)
        trajectory(tools)
        sdo_without_daemon(tools, pathlib.Path(folder))
    print(f"{len(failures)} checks failed" if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
