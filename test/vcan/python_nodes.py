#!/usr/bin/env python3
"""python_nodes.py INTERFACE EDS NODE...: CiA 402 axes on a CAN interface, made with python-canopen.

python-canopen has the SDO server, the NMT slave, heartbeat and EMCY. This file has only the PDOs, which python-canopen
leaves to the application, and a drive that reaches each set-point within one SYNC.
"""
import struct
import sys
import threading

import canopen

SWITCH_ON_DISABLED, READY, SWITCHED_ON, ENABLED, QUICK_STOP = 0x0240, 0x0221, 0x0223, 0x0227, 0x0207
RESET_NODE, RESET_COMMUNICATION, ENTER_PREOPERATIONAL = 129, 130, 128


class Axis:
    def __init__(self, network, eds, node_id):
        self.network = network
        self.node = canopen.LocalNode(node_id, eds)
        self.node.add_write_callback(self.on_write)
        network.add_node(self.node)
        self.receivers = {}
        self.rpdo_frames = {}
        self.was_warm = False
        network.subscribe(0x000, self.on_nmt)
        network.subscribe(0x080, self.on_sync)
        self.restart()

    def restart(self):
        """Power-on values, no PDO received yet, boot-up message, pre-operational."""
        self.node.nmt.stop_heartbeat()
        self.node.data_store.clear()
        for cob_id, receiver in self.receivers.values():
            self.network.unsubscribe(cob_id, receiver)
        self.receivers.clear()
        self.rpdo_frames.clear()
        self.statusword = SWITCH_ON_DISABLED
        self.store(0x6041, 0, "<H", self.statusword)
        for number in range(4):
            self.listen(number, self.get(0x1400 + number, 1, "<I"))
        self.network.send_message(0x700 + self.node.id, [0])
        self.node.nmt.on_command(0, bytes([ENTER_PREOPERATIONAL, self.node.id]), 0)

    def get(self, index, sub, layout):
        return struct.unpack(layout, self.node.get_data(index, sub))[0]

    def store(self, index, sub, layout, value):
        self.node.data_store.setdefault(index, {})[sub] = struct.pack(layout, value)

    def on_nmt(self, _, data, __):
        command, node_id = data[0], data[1]
        if node_id in (0, self.node.id) and command in (RESET_NODE, RESET_COMMUNICATION):
            threading.Timer(0.05, self.restart).start()

    def on_write(self, index, subindex, od, data):
        if 0x1400 <= index < 0x1404 and subindex == 1:
            self.listen(index - 0x1400, struct.unpack("<I", data)[0])

    def listen(self, number, cob_id):
        if number in self.receivers:
            self.network.unsubscribe(*self.receivers.pop(number))
        if not cob_id & 0x80000000:
            def receive(_, data, __):
                self.rpdo_frames[number] = bytes(data)
            self.receivers[number] = (cob_id & 0x7FF, receive)
            self.network.subscribe(*self.receivers[number])

    def mapping(self, index):
        for sub in range(1, self.get(index, 0, "<B") + 1):
            entry = self.get(index, sub, "<I")
            yield entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8

    def on_sync(self, *_):
        if self.node.nmt.state != "OPERATIONAL":
            return
        for number, frame in list(self.rpdo_frames.items()):
            for index, sub, size in self.mapping(0x1600 + number):
                self.node.data_store.setdefault(index, {})[sub] = frame[:size]
                frame = frame[size:]
        self.drive()
        for number in range(4):
            cob_id = self.get(0x1800 + number, 1, "<I")
            if not cob_id & 0x80000000 and 1 <= self.get(0x1800 + number, 2, "<B") <= 240:
                objects = self.mapping(0x1A00 + number)
                data = b"".join(self.node.get_data(index, sub)[:size] for index, sub, size in objects)
                self.network.send_message(cob_id & 0x7FF, data)

    def drive(self):
        controlword = self.get(0x6040, 0, "<H")
        if not controlword & 0x02:
            self.statusword = SWITCH_ON_DISABLED
        elif not controlword & 0x04:
            self.statusword = QUICK_STOP if self.statusword == ENABLED else SWITCH_ON_DISABLED
        elif controlword & 0x0F == 0x06:
            self.statusword = READY
        elif controlword & 0x0F == 0x07 and self.statusword != SWITCH_ON_DISABLED:
            self.statusword = SWITCHED_ON
        elif controlword & 0x0F == 0x0F and self.statusword in (SWITCHED_ON, ENABLED):
            if not self.was_warm:  # for a moment, when it is enabled first
                self.was_warm = True
                self.node.emcy.send(0x4210, 0x08, b"\x01\x02")
                self.node.emcy.reset()
            self.statusword = ENABLED
            self.store(0x6064, 0, "<i", self.get(0x607A, 0, "<i"))
        self.store(0x6041, 0, "<H", self.statusword)
        self.store(0x6061, 0, "<b", self.get(0x6060, 0, "<b"))


def main(interface, eds, *node_ids):
    network = canopen.Network()
    network.connect(interface="socketcan", channel=interface)
    axes = [Axis(network, eds, int(node_id)) for node_id in node_ids]
    print(f"{len(axes)} axes on {interface}", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
