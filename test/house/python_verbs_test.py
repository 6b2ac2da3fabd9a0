#!/usr/bin/env python3
"""python_verbs_test.py TYPES - tests the functions of takt.Axes other than motions, on the bus of python_daemon.py:
Halt, quick stop, touch probe, SDO, inputs and outputs."""
import sys

from python_daemon import PERIOD, SHORT, check, failures, jogs, obstacle, on_a_bus

daemon, axes = jogs()
axes.halt()
stood = axes.positions
check("a Halt ends a motion", daemon.drives[0].controlword == 0x10F and not axes.moving and
      daemon.drives[0].statusword == 0x237)
check("a halted axis takes no motion", "the axes are halted: call resume() first" in obstacle(axes.jog, 1.0)[1] and
      "halted" in obstacle(axes.home)[1])
axes.run(1.0)
check("it stays halted", daemon.drives[0].controlword == 0x10F and axes.positions == stood)
axes.resume()
axes.run(0.1)
check("it stands after the Halt", daemon.drives[0].controlword == 0x0F and axes.positions == stood)
axes.move(stood[0] + 1.0)
axes.jog(1.0)
axes.quick_stop()
check("a quick stop is confirmed", daemon.drives[0].statusword == 0x217 and not axes.moving)
check("then the axis is not enabled", "call enable() first" in obstacle(axes.move, 1.0)[1])
axes.run(1.0)
axes.set_mode(1)
check("and stays so, also in another mode", daemon.drives[0].statusword == 0x217)
axes.enable()
axes.halt()
axes.enable()
check("it can be enabled again, which ends a Halt", daemon.drives[0].controlword == 0x0F)
axes.halt()
axes.disable()
check("a halted axis can be disabled", daemon.drives[0].statusword == 0x250)
daemon, axes = jogs()
axes._link.longest = SHORT
daemon.each_cycle = lambda daemon: setattr(daemon.drives[0], "position", daemon.drives[0].position + 0.01)
kind, text = obstacle(axes.halt)
check("a drive that goes on is named", kind == "time over" and "shoulder does not follow the Halt" in text, (kind, text))
daemon, axes = jogs()
axes._link.longest, daemon.stubborn = SHORT, True
kind, text = obstacle(axes.quick_stop)
check("so is one that ignores a quick stop", kind == "blocked" and
      "shoulder ignores the quick stop: it is in operation enabled" in text, text)
daemon, axes = on_a_bus("shoulder")
kinds = {obstacle(axes.halt)[0], obstacle(axes.quick_stop)[0]}
check("an axis that is not enabled is not halted", kinds == {"blocked"} and not daemon.sender, kinds)

daemon, axes = on_a_bus("shoulder")
axes.enable()
axes.run(1.0)
check("taktd needs controlwords until a motion has begun", daemon.word_cycle > daemon.cycle - 5)
axes.jog(0.1)
axes.run(1.0)
check("and signs of life after that", daemon.word_cycle < daemon.cycle - 50)

daemon, axes = on_a_bus("shoulder", longest=SHORT)
axes.run(0.1)
daemon.objects = {(5, 0x6081, 0): b"\x10\x27\0\0", (5, 0x2001, 3): b"\xFE\xFF"}
axes.write("shoulder", 0x6081, 0, b"\x20\x4E\0\0")
check("objects are written and read by SDO", axes.read("shoulder", 0x6081) == b"\x20\x4E\0\0")
axes.write_number("shoulder", 0x6081, 0, -2, 4)
check("also as numbers", (axes.read_number("shoulder", 0x6081), axes.read_number("shoulder", 0x6081, signed=True),
                          axes.read_number("shoulder", 0x2001, 3)) == (0xFFFF_FFFE, -2, 0xFFFE))
kind, text = obstacle(axes.write_number, "shoulder", 0x6081, 0, 256, 1)
check("a number that is too large is named", (kind, text) == ("wrong use", "256 needs more than 1 bytes"), text)
kind, text = obstacle(axes.read, "shoulder", 0x2000, 3)
check("a refused access is named", (kind, text) ==
      ("refused", "shoulder 0x2000:03: the device refused it: object does not exist"), (kind, text))
kind, text = obstacle(axes.read, "wrist", 0x6081)
check("so is a node that does not exist", "the nodes are: shoulder, elbow, io" in text, text)
daemon.mute = True
check("and a missing answer", obstacle(axes.read, "shoulder", 0x6081)[0] == "time over")
check("SDO takes no node", not daemon.sender)


daemon, axes = on_a_bus("shoulder")
daemon.io[0x6000] = 5
axes.run(0.0)
check("an input of any node has its value", axes.signal("io.switches") == axes.signal("io.0x6000:1") == 5.0)
axes.set("io.valve", -1.5)
check("an output is set in its unit", daemon.io[0x6411] == -1500 and axes.signal("io.valve") == -1.5)
axes.run(2.0)
check("it is repeated while a call waits", daemon.io_life > daemon.cycle)
check("and the drives are left alone", daemon.drives[0].controlword == 0 and not daemon.signs)
for _ in range(300):
    daemon.pass_cycle()
check("it ends with a silence of the program", daemon.io_life < daemon.cycle)
check("and the next run() says so", "its set-points were discarded" in obstacle(axes.run, 0.1)[1])
axes.run(1.0)
check("and does not come again by itself", daemon.io_life < daemon.cycle)
axes.set("io.valve", 0.5)
axes.disable()
check("the end gives the node up", daemon.released == 1)
life = daemon.io_life
axes.run(0.1)
check("and ends the value", daemon.io_life == life)
for name, value, words in (("io.valve", 40.0, "can't hold 40.0"), ("io.valve", float("nan"), "can't hold nan"),
                           ("io.switches", 1.0, "is an input"), ("io.lamp", 1.0, "there are: io.switches, io.valve"),
                           ("shoulder.controlword", 0.0, "commands an axis")):
    kind, text = obstacle(axes.set, name, value)
    check("a wrong output is named", kind == "wrong use" and words in text and daemon.io_life == life, (kind, text))
daemon.holder = "another"
kind, text = obstacle(axes.set, "io.valve", 0.25)
check("a refused value is named", kind == "refused" and "'another' holds the node" in text, (kind, text))
daemon.holder = ""
axes.run(10 * PERIOD)
check("and not sent again", daemon.io[0x6411] == 500)


def probes(come=40):
    """A jogging axis whose drive sees a rising edge of input 1 some cycles after its probe was armed."""
    daemon, axes = jogs()
    daemon.objects = {(5, 0x60B8, 0): b"\0\x11", (5, 0x60B9, 0): b"\0\0", (5, 0x60BA, 0): b"\0\0\0\0"}
    daemon.armed = 0

    def each(daemon):
        armed = daemon.objects[5, 0x60B8, 0] == b"\x11\x11"
        daemon.armed = daemon.armed + 1 if armed else 0
        if daemon.armed == come:
            daemon.objects[5, 0x60BA, 0] = (-1500).to_bytes(4, "little", signed=True)
            daemon.objects[5, 0x60B9, 0] = b"\x03\0"
        if not armed:
            daemon.objects[5, 0x60B9, 0] = b"\0\0"
    daemon.each_cycle = each
    return daemon, axes


daemon, axes = probes()
check("a probe returns the position of its edge", axes.touch_probe("shoulder") == -1.5)
check("it is armed and disarmed while the axis moves", daemon.objects[5, 0x60B8, 0] == b"\0\x11" and axes.moving)
daemon, axes = probes()
daemon.objects[5, 0x60B8, 0], daemon.objects[5, 0x60B9, 0] = b"\x11\x11", b"\x03\0"
daemon.armed = 100
check("it is armed anew", axes.touch_probe("shoulder") == -1.5)
daemon, axes = probes(come=10**6)
kind, text = obstacle(lambda: axes.touch_probe(0, seconds=SHORT))
check("an edge that does not come is named", kind == "time over" and
      text == "shoulder: no rising edge of touch probe 1 has come in 0.3 s", (kind, text))
check("then the probe is disarmed", daemon.objects[5, 0x60B8, 0] == b"\0\x11")
daemon.each_cycle, daemon.objects[5, 0x60B9, 0] = lambda daemon: None, b"\x02\0"  # the drive does not clear it
check("an old edge is no edge", "still shows an edge from before" in obstacle(axes.touch_probe, "shoulder")[1])
check("a wrong input is named", obstacle(lambda: axes.touch_probe("shoulder", input=3))[0] == "wrong use")
sys.exit(1 if failures else 0)
