#!/usr/bin/env python3
"""Reads the includes and the types of the tree, and fails on violations of the rules for rooms.

check_rooms.py [ROOT]       checks ROOT (default: this checkout)
check_rooms.py --self-test  shows that each rule can fail
check_rooms.py --table      prints the rooms as Markdown tables, one for each library

Rules: a room includes only the rooms (or single headers) of its line, and no rooms form a circle; the pure rooms use C++ and
its standard library alone and read no clock; public headers include only C++, Eigen, the LCM types and each other; no two headers of one library have the same name; no two types have the same
qualified name; test/unit mirrors the rooms.
"""
import collections
import pathlib
import re
import sys
import tempfile

VALUES = "eds_parser/values"
TABLE = "eds_parser/table"
CORE = "master/core master/core/sdo master/core/pdo master/core/node master/core/network master/core/lss"
LINUX = "master/linux master/linux/can master/linux/bus"
SIM = "master/sim master/sim/bus"
LCM = "eds_parser/lcm master/lcm master/lcm/envelope master/lcm/link"
EDS = "eds_parser/report eds_parser/dictionary eds_parser/ini eds_parser/read"

# Each room with its subject, and what the room may include besides itself, `eds_parser/values` and
# `eds_parser/table`: rooms above it in this table, and single headers of any room.
ROOMS = {
    VALUES: ("values of CANopen: identifiers, data types, times, raw numbers", ""),
    TABLE: ("compiled tables: all that the master knows of a network", ""),
    "eds_parser/lcm": ("names, URLs and message types of a bus on LCM", ""),
    "eds_parser/report": ("findings with their positions, messages from parts, suggestions for misspelled words, differences of texts", ""),
    "eds_parser/dictionary": ("the object dictionary of one device", "eds_parser/report eds_parser/ini/number.hpp"),
    "eds_parser/ini": ("the notation of an EDS: sections, keys, numbers, $NODEID", "eds_parser/report eds_parser/dictionary"),
    "eds_parser/read": ("reads the text of an EDS or DCF into a dictionary",
                        "eds_parser/report eds_parser/dictionary eds_parser/ini"),
    "eds_parser/check": ("checks a dictionary against the rules for EDS files",
                         "eds_parser/report eds_parser/dictionary eds_parser/ini"),
    "eds_parser/write": ("writes DCF files, concise DCF files and corrected EDS files", EDS),
    "eds_parser/specification": ("the content of the network file and of the device data, as plain data",
                                 "eds_parser/report eds_parser/dictionary"),
    "eds_parser/plan/pdo": ("PDOs of a node: mapping, transmission, COB-IDs",
                            "eds_parser/report eds_parser/dictionary eds_parser/specification"),
    "eds_parser/plan/device": ("rules of the device data, and the start values of a simulated device",
                               "eds_parser/report eds_parser/dictionary eds_parser/specification eds_parser/plan/pdo"),
    "eds_parser/plan/boot": ("the boot of a node, step by step",
                             "eds_parser/report eds_parser/dictionary eds_parser/specification eds_parser/plan/pdo"),
    "eds_parser/plan/image": ("the process image: signals, units, fallbacks",
                              "eds_parser/report eds_parser/dictionary eds_parser/specification eds_parser/plan/pdo"),
    "eds_parser/plan/limits": ("limits of outputs",
                               "eds_parser/report eds_parser/dictionary eds_parser/plan/pdo eds_parser/plan/device"),
    "eds_parser/plan": ("compiles the specification and the dictionaries into the bus plan",
                        "eds_parser/report eds_parser/dictionary eds_parser/specification eds_parser/plan/pdo "
                        "eds_parser/plan/device eds_parser/plan/boot eds_parser/plan/image eds_parser/plan/limits"),
    "eds_parser/budget": ("response times of all frames", "eds_parser/report eds_parser/plan"),
    "eds_parser/network_file/yaml": ("reads maps of YAML by tables of keys", "eds_parser/report eds_parser/specification"),
    "eds_parser/network_file/keys": ("the keys of network files and of device data, and their readers",
                                     EDS + " eds_parser/lcm eds_parser/network_file/yaml eds_parser/specification "
                                     "eds_parser/plan"),
    "eds_parser/network_file": ("runs all steps from a network file to the plan",
                                EDS + " eds_parser/lcm eds_parser/network_file/keys eds_parser/network_file/yaml "
                                "eds_parser/check eds_parser/specification eds_parser/plan eds_parser/budget"),
    "eds_parser/export": ("writes the plan for other tools: DBC, C++ header, LCM types", "eds_parser/report eds_parser/lcm"),
    "eds_parser/print": ("dictionaries, budgets and findings as text and JSON",
                         "eds_parser/report eds_parser/dictionary eds_parser/plan eds_parser/budget"),
    "eds_parser/print/plan": ("plans and their differences as text and JSON",
                              "eds_parser/report eds_parser/lcm eds_parser/plan eds_parser/print"),

    "master/wire": ("the bytes of each CANopen service: one codec for each", ""),
    "master/core": ("what the protocol machines share: their interface, events, requests, states", "master/wire"),
    "master/core/sdo": ("SDO client and the master's own server", "master/wire master/core"),
    "master/core/lss": ("LSS", "master/wire master/core"),
    "master/core/pdo": ("process data: expected set, set-points, limits, PDOs on request", "master/wire master/core"),
    "master/core/node": ("one node: session, boot, heartbeat, guarding", "master/wire master/core master/core/sdo"),
    "master/core/network": ("all nodes: NMT, start, ordered stop, TIME",
                            "master/wire master/core master/core/sdo master/core/lss master/core/node"),
    "master/explain": ("turns events, boot failures and states into sentences", "master/wire " + CORE),
    "master/trace": ("recordings of candump, PCAN and Vector line by line, and the SDO transfers in them", "master/wire"),
    "master/explain/frame": ("describes the CANopen meaning of a frame in words", "master/wire master/explain master/trace"),
    "master/motion": ("trajectories of axes within their limits", ""),
    "master/motion/beat": ("runs the motions of all axes cycle by cycle", "master/motion"),
    "master/motion/planner": ("plans the orders of axes from the states that they will have", "master/motion master/motion/beat"),
    "master/rt/exchange": ("what crosses between the bus thread and the front thread",
                           "master/core master/motion/beat master/rt/port.hpp"),
    "master/rt/journal": ("records everything that determines a run, and plays it back",
                          "master/wire master/core master/motion/beat master/rt/exchange master/rt/port.hpp"),
    "master/rt/machines": ("the protocol machines of one bus, and what the cycle asks of them",
                           "master/wire master/core master/core/pdo master/core/network master/rt/exchange"),
    "master/rt/motion": ("motions of axes between the image and the outputs of a cycle",
                         "master/core master/core/pdo master/motion master/motion/beat master/rt/exchange master/rt/machines"),
    "master/rt/beat": ("when a cycle begins: by the clock of the master, or by the SYNC of another device",
                       "master/wire master/core master/rt/exchange master/rt/machines master/rt/port.hpp"),
    "master/rt/stop": ("everything that stops axes",
                       "master/core master/core/pdo master/core/network master/rt/exchange master/rt/machines "
                       "master/rt/port.hpp"),
    "master/rt": ("the cycle of the bus thread, and its parts",
                  "master/wire master/core master/core/pdo master/core/network master/rt/exchange master/rt/machines "
                  "master/rt/beat master/rt/motion master/rt/stop"),
    "master/linux": ("threads, clocks, files and sockets", "master/wire"),
    "master/linux/can": ("SocketCAN", "master/wire master/linux master/rt/port.hpp"),
    "master/linux/unix_bus": ("the bus between processes", "master/linux master/linux/can/can_frame.hpp master/rt/port.hpp"),
    "master/linux/bus": ("a bus by its name: who may open it, who talks on it",
                         "master/wire master/core master/linux master/linux/can master/linux/unix_bus"),
    "master": ("the class `MasterRun`: one run of the master on one bus", "master/rt master/rt/exchange master/rt/journal"),
    "master/sim": ("random numbers, clocks and deadlines of the simulation", ""),
    "master/sim/dictionary": ("the objects of a simulated device", ""),
    "master/sim/service": ("services of a simulated device: SDO, EMCY, heartbeat, guarding, SYNC, TIME, LSS",
                           "master/wire master/sim/dictionary"),
    "master/sim/pdo": ("PDOs of a simulated device", "master/wire master/sim/dictionary master/sim/service"),
    "master/sim/mechanics": ("the mechanics of a simulated axis: motor, load, brake, encoder, controllers", ""),
    "master/sim/axis": ("parts of a simulated axis: its objects, its way to the target, homing, switches, touch probes",
                        "master/sim master/sim/dictionary master/sim/mechanics"),
    "master/sim/model": ("applications of simulated devices: CiA 402, 401, 406",
                         "master/sim master/sim/dictionary master/sim/service master/sim/pdo master/sim/mechanics "
                         "master/sim/axis"),
    "master/sim/family": ("simulated devices of particular families", "master/sim/dictionary master/sim/model"),
    "master/sim/device": ("the simulated device as a whole",
                          "master/wire master/sim master/sim/dictionary master/sim/service master/sim/pdo master/sim/model"),
    "master/sim/bus": ("the wire, its faults, and the world of all devices",
                       "master/wire master/sim master/sim/device master/rt/port.hpp"),
    "master/units": ("raw values of the image, and SI units", ""),
    "master/lcm": ("messages of takt on LCM, and the transport", "eds_parser/lcm master/linux"),
    "master/lcm/envelope": ("signed messages and their keys", "eds_parser/lcm master/lcm master/linux"),
    "master/lcm/tcpq": ("LCM's tcpq:// protocol, both sides", "master/lcm master/linux"),
    "master/lcm/link": ("a connection to LCM, whatever the machine allows",
                        "eds_parser/lcm master/lcm master/lcm/envelope master/lcm/tcpq master/linux"),
    "master/gateway/notice": ("notices for people, and limits on their number", "master/wire master/core master/explain master/lcm"),
    "master/gateway/message": ("turns images and states into LCM messages",
                               "eds_parser/lcm master/wire master/units master/lcm master/rt/exchange master/gateway/notice"),
    "master/gateway/command": ("turns LCM messages into set-points, requests and transfers; leases",
                               "master/wire master/core master/core/lss master/units master/lcm master/gateway/notice "
                               "master/gateway/message"),
    "master/gateway/motion": ("turns LCM messages about motions into orders of the bus thread",
                              "master/motion master/motion/beat master/motion/planner master/rt/exchange master/lcm "
                              "master/explain/emcy_text.hpp master/gateway/notice master/gateway/command"),
    "master/gateway/ascii": ("text commands of CiA 309-3",
                             "master/wire master/core master/core/lss master/units master/lcm master/linux master/linux/unix_bus "
                             "master/gateway/message master/gateway/front_guest.hpp"),
    "master/gateway": ("the work of the front thread",
                       "master master/wire master/core master/explain master/lcm master/rt/exchange "
                       "master/gateway/notice master/gateway/message master/gateway/command master/gateway/motion"),
    "master/black_box": ("recordings of the master, and their replay",
                         "master/core master/explain master/trace master/linux master/rt master/rt/journal"),

    "apps/command_line": ("options, numbers, durations and suggestions of all command lines", "eds_parser/report master/lcm"),
    "apps/drive402": ("takes one CiA 402 drive through its states", ""),
    "apps/axis/stream": ("which points of a stream to send when", ""),
    "apps/axis/group": ("the messages of all axes of a bus as vectors: images in, set-points and motions out",
                        "apps/drive402 master/units master/lcm master/lcm/link master/lcm/envelope"),
    "apps/axis": ("the axes of a bus over LCM, for applications",
                  "apps/drive402 apps/axis/group apps/axis/stream master/explain master/lcm master/lcm/envelope"),
    "apps/master": ("the library for programs that contain a master; its bus and its thread are also those of taktd",
                    "eds_parser/report eds_parser/network_file master master/units master/wire master/core master/explain "
                    "master/rt master/rt/exchange master/rt/journal " + LINUX + " " + SIM),
    "apps/mcap": ("writes MCAP files: records, chunks, indexes", ""),
    "apps/plot": ("pictures of curves over the time, as SVG files", ""),
    "apps/plot/motion": ("pictures of motions, from what taktd reports", "apps/plot apps/axis apps/axis/group master/lcm"),
    "apps/move/set_points": ("set-points that takt-move computes itself, cycle by cycle", "master/motion"),
    "apps/move": ("takt-move", "apps/axis apps/axis/group apps/command_line apps/move/set_points apps/plot/motion master/motion "
                               "master/lcm"),
    "apps/follow": ("takt-follow", "apps/axis apps/command_line apps/plot/motion master/lcm"),
    "apps/jog": ("takt-jog", "apps/axis apps/command_line apps/plot/motion master/lcm"),
    "apps/home": ("takt-home", "apps/axis apps/command_line apps/plot/motion master/lcm"),
    "apps/logic": ("takt-logic", "apps/axis apps/command_line apps/plot eds_parser/network_file "
                                 "eds_parser/network_file/yaml eds_parser/report master/lcm"),
    "apps/takt/live/text": ("what pages consist of: coloured lines, tables, and the words for states and values",
                            "apps/axis/group master/core master/explain master/lcm"),
    "apps/takt/live/view": ("a running bus as text: pages of axes, values, PDOs, times and nodes, for each width of a terminal",
                            "apps/axis/group apps/takt/live/text master/core master/explain master/rt/exchange master/lcm "
                            "master/gateway/message master/gateway/notice"),
    "apps/takt/live": ("commands for a running daemon: status, top, timing, EMCY, record",
                       "apps/command_line apps/takt/live/text apps/takt/live/view master/explain master/gateway/message "
                       "master/gateway/notice master/rt/exchange master/linux " + LCM),
    "apps/takt/log": ("records signals, events and frames as CSV and MCAP, from a running bus and from recordings",
                      "apps/command_line apps/mcap apps/takt/live eds_parser/network_file eds_parser/report master/wire master/trace "
                      "master/black_box master/explain/frame master/gateway/message master/units master/lcm master/linux"),
    "apps/takt/objects": ("objects of devices by their names, from device files and from the daemon",
                          "apps/command_line apps/takt/live eds_parser/network_file master/gateway/message master/linux "
                          + EDS),
    "apps/takt/service/lss": ("takt lss: gives node-IDs and bit rates to devices, directly or through the daemon",
                              "apps/command_line apps/takt/live master/wire master/core/lss " + LINUX),
    "apps/takt/service": ("commands that talk to devices: SDO, LSS, NMT, parameters, scan",
                          "apps/command_line apps/takt/live apps/takt/live/text apps/takt/objects apps/takt/service/lss "
                          "apps/takt/learn/device_files.hpp master/wire master/core "
                          "master/core/sdo master/core/lss master/lcm master/gateway/message master/gateway/command " + LINUX),
    "apps/takt/od": ("lists the objects of a device with their values and meanings",
                     "apps/command_line apps/takt/live apps/takt/objects apps/takt/service eds_parser/dictionary "
                     "eds_parser/specification master/explain master/gateway/message master/lcm master/wire"),
    "apps/takt/init": ("makes network files from the devices on a bus",
                       "apps/command_line apps/takt/learn/device_files.hpp apps/takt/learn/yaml_text.hpp apps/takt/service "
                       "eds_parser/report eds_parser/dictionary eds_parser/specification eds_parser/budget "
                       "eds_parser/network_file eds_parser/network_file/keys master/linux/can master/wire"),
    "apps/takt/audit": ("finds out what each device does when the master dies",
                        "apps/command_line apps/takt/live apps/takt/service eds_parser/network_file"),
    "apps/takt/doctor": ("checks whether this machine is ready for a bus",
                         "apps/command_line apps/takt/live master/lcm/link " + LINUX),
    "apps/takt/demo": ("runs the demo machine of an installed takt",
                       "apps/command_line master/lcm/tcpq master/linux"),
    "apps/takt/complete": ("names of nodes, objects and signals for the completion of shells",
                           "apps/command_line apps/takt/live apps/takt/objects eds_parser/dictionary eds_parser/network_file "
                           "master/gateway/message master/linux"),
    "apps/takt/import": ("explains what takt makes of a bus.yml or a nodelist",
                         "apps/command_line master/lcm eds_parser/specification eds_parser/network_file eds_parser/network_file/keys "
                         "eds_parser/network_file/yaml " + EDS),
    "apps/takt/learn": ("makes network files from recordings",
                        "apps/command_line master/wire master/trace eds_parser/specification "
                        "eds_parser/network_file eds_parser/network_file/keys eds_parser/write " + EDS),
    "apps/takt/smooth/judge": ("finds what makes axes rough in the signals of a recording", "master/wire"),
    "apps/takt/smooth": ("gets these signals from recordings and from a running bus, and reports the result",
                         "apps/command_line apps/takt/live apps/takt/learn apps/takt/smooth/judge master/wire master/trace "
                         "master/black_box master/lcm master/linux master/linux/bus eds_parser/network_file " + EDS),
    "apps/takt/spy": ("shows the messages on LCM: all channels, and the values of one",
                      "apps/command_line apps/takt/live apps/takt/log/logged_signal.hpp eds_parser/network_file eds_parser/report "
                      "master/gateway/message master/linux " + LCM),
    "apps/takt/simulate/program": ("runs the daemon and applications in virtual time",
                                   "apps/axis master master/gateway master/lcm master/rt " + SIM),
    "apps/takt/simulate/motion": ("programs in virtual time that command motions by a script",
                                  "apps/axis apps/axis/group apps/takt/simulate/program eds_parser/report master/lcm "
                                  "master/rt/exchange " + SIM),
    "apps/takt/simulate": ("runs a whole network in virtual time, and reports the outcome",
                           "apps/command_line apps/axis apps/takt/simulate/motion apps/takt/simulate/program "
                           "eds_parser/network_file eds_parser/report "
                           "eds_parser/ini master/core master/explain master/gateway/command master/lcm master/rt "
                           "master/rt/exchange master/linux/bus " + SIM),
    "apps/takt/soak/evidence": ("what the judges compare: frames, images and the simulated drives",
                                "master/wire master/core master/rt/exchange master/sim/device " + SIM),
    "apps/takt/soak/judge/motion": ("checks the invariants of motions",
                                    "apps/takt/soak/evidence master/wire master/rt/exchange master/sim/device " + SIM),
    "apps/takt/soak/judge": ("checks the other invariants of a run",
                             "apps/takt/soak/evidence apps/takt/soak/judge/motion master/wire master/core "
                             "master/rt/exchange master/sim/device " + SIM),
    "apps/takt/soak": ("runs random sequences of faults",
                       "apps/command_line apps/axis/group apps/takt/simulate apps/takt/simulate/motion "
                       "apps/takt/simulate/program apps/takt/soak/evidence apps/takt/soak/judge "
                       "apps/takt/soak/judge/motion eds_parser/network_file master/explain "
                       "master/gateway master/lcm master/rt master/rt/exchange " + SIM),
    "apps/takt/trajectory": ("plans trajectories without a bus", "apps/command_line apps/plot master/motion"),
    "apps/takt": ("the tool: commands on files",
                  "apps/command_line eds_parser/check eds_parser/write eds_parser/export eds_parser/budget "
                  "eds_parser/network_file eds_parser/network_file/keys eds_parser/print eds_parser/print/plan master/lcm master/lcm/envelope "
                  "master/linux master/linux/bus master/explain/frame master/trace master/black_box " + EDS),
    "apps/taktd/process": ("a process of a service: stderr, signals, systemd, waiting",
                           "master/linux master/gateway master/gateway/notice"),
    "apps/taktd": ("the daemon",
                   "apps/command_line apps/master apps/taktd/process eds_parser/network_file eds_parser/budget "
                   "eds_parser/print/plan master master/wire master/rt master/rt/journal master/explain master/black_box "
                   "master/gateway master/gateway/ascii master/gateway/notice " + LINUX + " " + LCM + " " + SIM),
}

# The headers that are installed: all that an application includes.
PUBLIC = "share/include/takt"
ROOMS[PUBLIC] = ("the public headers, which are installed; their implementations are in `apps/axis/`, `apps/drive402/` and `apps/master/`", "")

MOST_LINES = 400
MOST_FILES = 25  # of a room; a note
LIBRARIES = ("eds_parser", "master", "apps", "share")
# Rooms that use C++ and its standard library alone.
PURE = tuple(room for room in ROOMS
             if room.startswith(("eds_parser/", "master/wire", "master/core", "master/rt", "master/motion"))
             and not room.startswith(("eds_parser/print", "eds_parser/network_file"))) + ("master/explain",)
WRITERS = ("nlohmann/", "fmt/")  # of text and JSON, for the rooms that write them
WRITING = ("eds_parser/print", "master/explain")
NOT_PURE = {"thread", "mutex", "shared_mutex", "condition_variable", "future", "iostream", "semaphore"}
CLOCK = re.compile(r"\b(steady_clock|system_clock|high_resolution_clock|clock_gettime|time\s*\(\s*nullptr)")
INCLUDE = re.compile(r'^\s*#\s*include\s*(<[^>]+>|"[^"]+")')
LCM_TYPES = re.compile(r"^(lcm/|takt/\w+_t\.hpp$)")  # LCM itself and the types generated by lcm-gen
KNOW_LCM = ("master/lcm", "master/gateway", "apps", PUBLIC)
PUBLIC_HEADER = re.compile(r"^takt/")


def is_in(room, rooms):
    return any(room == other or room.startswith(other + "/") for other in rooms)


def room_of(path):
    """The folder, or None if it is no room."""
    folder = path.rsplit("/", 1)[0]
    return folder if folder in ROOMS else None


def arrow(path, target):
    """Why `path` may not include the project's header `target`, or None if it may."""
    here, there = room_of(path), room_of(target)
    if there is None:
        return f'"{target}" is in no room: includes start at the top of the tree'
    may = ROOMS[here][1].split()
    if there in (here, VALUES) or (there == TABLE and here != VALUES) or there in may or target in may:
        return None
    return f"{here} may not include {there}: {target}"


def foreign(path, header):
    """Why `path` may not include the foreign header, or None if it may."""
    here = room_of(path)
    if here == PUBLIC and "/" in header and not header.startswith(("takt/", "Eigen/")):
        return f"<{header}>: a public header needs only C++, Eigen, the LCM types and other public headers"
    if PUBLIC_HEADER.match(header) and not LCM_TYPES.match(header):
        fine = is_in(here, ("apps", PUBLIC)) or (header == "takt/lcm.hpp" and is_in(here, KNOW_LCM))
        return None if fine else f"<{header}>: below the apps, only takt/lcm.hpp is used, by the rooms that know LCM"
    if header.startswith("yaml-cpp/"):
        fine = is_in(here, ("eds_parser/network_file", "apps"))
        return None if fine else "below the apps, yaml-cpp is used only by eds_parser/network_file"
    if LCM_TYPES.match(header):
        return None if is_in(here, KNOW_LCM) else f"{here} knows nothing of LCM"
    if is_in(here, WRITING) and header.startswith(WRITERS):
        return None
    pure = here in PURE or here.startswith("eds_parser/")
    if pure and ("/" in header or header.endswith(".h") or header in NOT_PURE):
        return f"<{header}>: {here} is pure C++: no socket, thread, clock or other library"
    return None


def check_line(path, line):
    found = INCLUDE.match(line)
    if found is None:
        is_clock = room_of(path) in PURE and CLOCK.search(line.split("//")[0])
        return f"{room_of(path)} reads no clock" if is_clock else None
    header = found[1][1:-1]
    if room_of(path) == PUBLIC and found[1][0] == '"':
        return f'"{header}" is not installed: a public header includes <takt/...>'
    if found[1][0] == '"' and not LCM_TYPES.match(header):
        return arrow(path, header)
    return foreign(path, header)


TOKEN = re.compile(
    r"\b(?:inline\s+)?namespace\s+(?P<space>[\w:]*)\s*\{"
    r"|\b(?P<kind>class|struct|union|enum(?:\s+(?:class|struct))?)\s+(?:\[\[[^\]]*\]\]\s*|alignas\([^)]*\)\s*)*(?P<name>\w[\w:]*)"
    r"(?:\s+final)?\s*(?P<base>:[^;{}()]*)?\{"
    r"|(?P<open>\{)|(?P<close>\})")
NOISE = re.compile(  # raw strings, comments, strings, characters, lines of the preprocessor
    r'R"(\w*)\(.*?\)\1"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\''
    r"|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.S | re.M)


def types_of(text):
    """(qualified name, line, is anonymous) of each type that has its definition in `text`, outside of functions."""
    text = NOISE.sub(lambda found: "\n" * found[0].count("\n"), text)
    scopes = []  # None: a block
    for token in TOKEN.finditer(text):
        if token["close"]:
            if scopes:
                scopes.pop()
            continue
        name = token["space"] if token["space"] is not None else token["name"]
        if token["open"] or name is None:
            scopes.append(None)
            continue
        if token["kind"] and None not in scopes:
            qualified = "::".join([scope for scope in scopes if scope] + [name])
            yield qualified, text.count("\n", 0, token.start("kind")) + 1, "" in scopes
        scopes.append(name)


def doubles(types):
    """(path, line, what) of each type that has an earlier definition. `types` has (path, name, line, anonymous) of all
    files."""
    first = {}
    for path, name, line, anonymous in types:
        if anonymous:
            continue
        if name in first:
            yield path, line, f"{name} is defined in {first[name][0]}:{first[name][1]} too"
        first.setdefault(name, (path, line))


def equal_names(paths):
    """(path, 1, what) of each header whose library has another header of the same name."""
    first = {}
    for path in paths:
        library, name = path.split("/")[0], path.rsplit("/", 1)[1]
        if not name.endswith(".hpp"):
            continue
        if (library, name) in first:
            yield path, 1, f"{library} has two headers {name}: {first[library, name]}"
        first.setdefault((library, name), path)


def unmirrored(root):
    """(folder, 1, what) of each folder of test/unit with sources that is no room's."""
    for file in sorted(pathlib.Path(root, "test/unit").rglob("*.[hc]pp")):
        path = file.relative_to(root).as_posix()
        if path.removeprefix("test/unit/").rsplit("/", 1)[0] not in ROOMS:
            yield path, 1, "test/unit mirrors the rooms: there is no such room"


def upward(rooms):
    """(room, 1, what) of each room of the table that may include a room which is not above it. This rule excludes
    circles."""
    above = set()
    for room, (_, may) in rooms.items():
        for other in may.split():
            if other not in above and not other.endswith(".hpp"):
                yield room, 1, f"the table of rooms lets it include {other}, which is not above it in the table"
        above.add(room)


def sources(root, tops):
    for top in tops:
        for file in sorted(pathlib.Path(root, top).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".h") and "build" not in file.parts:
                yield file.relative_to(root).as_posix(), file.read_text(encoding="utf-8")


def check(root):
    """All violations of rules, and all notes, as (path, line, what)."""
    errors, notes, types, sizes = list(upward(ROOMS)), [], [], collections.Counter()
    for path, text in sources(root, (*LIBRARIES, "test")):
        lines = text.splitlines()
        if len(lines) > MOST_LINES:
            notes.append(f"{path}: {len(lines)} lines: is it really one idea?")
        if path.startswith("test/"):
            continue
        if room_of(path) is None:
            errors.append((path, 1, "is in no room"))
            continue
        sizes[room_of(path)] += 1
        types += [(path, *found) for found in types_of(text)]
        for number, line in enumerate(lines, 1):
            if what := check_line(path, line):
                errors.append((path, number, what))
    errors += doubles(types)
    errors += equal_names(path for path, _ in sources(root, LIBRARIES))
    errors += unmirrored(root)
    notes += [f"{room}: {count} files: is it one idea?" for room, count in sizes.items() if count > MOST_FILES]
    return errors, notes


BAD = {
    "eds_parser/a.hpp": "",
    "eds_parser/values/a.hpp": '#include "eds_parser/table/bus_plan.hpp"',
    "eds_parser/table/a.hpp": '#include "eds_parser/report/source.hpp"',
    "eds_parser/report/a.cpp": '#include "master/wire/frame.hpp"',
    "eds_parser/read/b.cpp": "#include <yaml-cpp/yaml.h>",
    "eds_parser/check/c.cpp": "#include <nlohmann/json.hpp>",
    "eds_parser/check/d.cpp": '#include "eds_parser/plan/cob_ids.hpp"',
    "eds_parser/plan/pdo/a.cpp": '#include "eds_parser/plan/network_compiler.hpp"',
    "eds_parser/dictionary/a.cpp": '#include "eds_parser/ini/ini.hpp"',
    "eds_parser/print/a.cpp": "#include <sys/socket.h>",
    "eds_parser/plan/a.cpp": "#include <takt/image_t.hpp>",
    "master/wire/a.hpp": '#include "master/core/machine.hpp"',
    "master/wire/b.hpp": '#include "eds_parser/report/source.hpp"',
    "master/core/a.hpp": '#include "master/rt/port.hpp"',
    "master/core/b.hpp": "#include <mutex>",
    "master/core/c.cpp": "auto now = std::chrono::steady_clock::now();",
    "master/core/d.cpp": '#include "machine.hpp"',
    "master/core/sdo/a.cpp": '#include "master/core/node/node_session.hpp"',
    "master/rt/a.hpp": '#include "master/linux/can/socket_can.hpp"',
    "master/rt/b.cpp": "#include <sys/socket.h>",
    "master/rt/exchange/a.hpp": '#include "master/rt/bus_loop.hpp"',
    "master/rt/exchange/b.hpp": '#include "master/core/network/ordered_stop.hpp"',
    "master/explain/a.cpp": '#include "master/rt/bus_loop.hpp"',
    "master/explain/frame/a.hpp": '#include "eds_parser/network_file/load_network.hpp"',
    "master/black_box/a.cpp": '#include "eds_parser/print/plan/plan_fingerprint.hpp"',
    "master/sim/bus/a.cpp": '#include "master/core/sdo/sdo_client.hpp"',
    "master/sim/bus/b.cpp": '#include "master/rt/bus_loop.hpp"',
    "master/sim/model/a.cpp": '#include "master/sim/device/device.hpp"',
    "master/linux/a.cpp": "#include <lcm/lcm-cpp.hpp>",
    "master/linux/b.cpp": '#include "takt/image_t.hpp"',
    "master/linux/can/a.cpp": '#include "master/gateway/bridge.hpp"',
    "master/lcm/a.cpp": '#include "master/gateway/notice/notice.hpp"',
    "master/gateway/a.cpp": '#include "apps/axis/group/axis_group.hpp"',
    "master/gateway/c.cpp": "#include <yaml-cpp/yaml.h>",
    "master/gateway/message/b.cpp": '#include "eds_parser/network_file/load_network.hpp"',
    "apps/axis/a.cpp": '#include "apps/move/set_points/sine.hpp"',
    "share/include/takt/a.hpp": '#include "eds_parser/values/ids.hpp"',
    "share/include/takt/b.hpp": "#include <fmt/format.h>",
    "share/include/takt/c.hpp": "#include <lcm/lcm-cpp.hpp>",
    "master/lcm/b.cpp": "#include <takt/master.hpp>",
    "master/rt/c.cpp": "#include <takt/lcm.hpp>",
    "apps/axis/b.cpp": '#include "master/lcm/tcpq/tcpq_client.hpp"',
    "apps/takt/learn/a.cpp": '#include "apps/takt/soak/soak_run.hpp"',
    "apps/taktd/twice.hpp": "namespace takt { struct Twice {}; }",
    "apps/takt/thrice.hpp": "namespace takt {\nclass Twice final : public Once {\n};\n}",
    "master/rt/inner.cpp": "namespace takt { void f() { struct Local {}; }\nenum class Inner : int { a }; }",
    "master/rt/journal/inner.hpp": "namespace takt { enum Inner { a }; }",
    "master/lcm/same.hpp": "",
    "master/sim/same.hpp": "",
    "test/unit/master/gone/a_test.cpp": "",
}
NOT_FOUND_HERE = ("apps/takt/thrice.hpp", "master/rt/inner.cpp", "master/lcm/same.hpp")  # the first of two
GOOD = {
    "eds_parser/network_file/a.cpp": "#include <yaml-cpp/yaml.h>",
    "apps/takt/simulate/a.cpp": "#include <yaml-cpp/yaml.h>",
    "eds_parser/report/a.hpp": '#include "eds_parser/values/ids.hpp"',
    "eds_parser/dictionary/b.cpp": '#include "eds_parser/ini/number.hpp"',
    "eds_parser/print/plan/b.cpp": "#include <nlohmann/json.hpp>\n#include <fmt/format.h>",
    "master/core/c.cpp": '#include "master/wire/frame.hpp"\n#include <chrono>\n// steady_clock is read elsewhere',
    "master/sim/bus/d.hpp": '#include "master/rt/port.hpp"\n#include "master/wire/frame.hpp"',
    "master/linux/can/e.hpp": '#include "master/rt/port.hpp"\n#include <sys/socket.h>',
    "master/gateway/f.hpp": '#include "master/master_run.hpp"\n#include <lcm/lcm-cpp.hpp>\n#include "takt/image_t.hpp"',
    "apps/takt/soak/g.cpp": '#include "apps/takt/soak/evidence/verdict.hpp"\n#include "master/sim/bus/world.hpp"',
    "share/include/takt/d.hpp": "#include <Eigen/Core>\n#include <poll.h>\n#include <takt/image_t.hpp>\n#include <takt/lcm.hpp>",
    "master/lcm/tcpq/l.hpp": "#include <takt/lcm.hpp>\n#include <span>",
    "apps/move/h.cpp": "namespace takt { namespace { struct Options {}; } }\nstruct Options;",
    "apps/taktd/i.cpp": "namespace takt::sim { struct Options {}; }\ntemplate <class Options> struct Box;",
    "apps/taktd/j.cpp": "namespace takt {\nstruct Options { // struct Text {\n  struct Text {};\n};\n// class Options {\n}",
    "apps/taktd/k.cpp": 'namespace takt { const char* brace = "{"; class Text {}; enum class Text2; }',
    "test/unit/master/core/sdo/a_test.cpp": '#include "master/core/network/network.hpp"',
}


def plant(root, files):
    for path, text in files.items():
        file = pathlib.Path(root, path)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text + "\n", encoding="utf-8")


def self_test():
    complaints = []
    with tempfile.TemporaryDirectory() as root:
        plant(root, BAD)
        found = collections.Counter(path for path, _, _ in check(root)[0])
    complaints += [f"not found: {path}: {text}" for path, text in BAD.items() if not found[path] and path not in NOT_FOUND_HERE]
    if any(found[first] and found[second] for first, second in (("apps/takt/thrice.hpp", "apps/taktd/twice.hpp"),)):
        complaints.append("both of two equal types are reported")
    with tempfile.TemporaryDirectory() as root:
        plant(root, GOOD)
        pathlib.Path(root, "test/long.cpp").write_text("\n" * (MOST_LINES + 1))
        plant(root, {f"master/motion_of_{number}.hpp": "" for number in range(MOST_FILES + 1)})
        refused, notes = check(root)
    complaints += [f"wrongly refused: {path}:{line}: {what}" for path, line, what in refused]
    if len(notes) != 2:
        complaints.append("a long file or a large room was not reported")
    if not list(upward({"a": ("", "b"), "b": ("", "")})) or list(upward({"a": ("", "b/c.hpp"), "b": ("", "a")})):
        complaints.append("a circle of rooms was not reported, or one where there is none")
    for what in complaints:
        print(f"self-test: {what}")
    return 1 if complaints else 0


def table(library):
    """The lines of the Markdown table of one library; share/doc/architecture.md has them."""
    yield "| room | content | may include |"
    yield "|---|---|---|"
    for room, (about, may) in ROOMS.items():
        if room.split("/")[0] == library:
            yield f"| `{room}/` | {about} | {', '.join(f'`{other}`' for other in may.split())} |"


def print_tables():
    print("\n\n".join("\n".join(table(library)) for library in LIBRARIES))
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1:] == ["--table"]:
        return print_tables()
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    errors, notes = check(root)
    for path, line, what in errors:
        print(f"{path}:{line}: {what}")
    for note in notes:
        print(f"{note} (note)")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
