"""A device whose PDOs python-canopen reads from its object dictionary, receives and sends.

python-canopen knows no SYNC and no events on the side of a device, so this file decides when a PDO is due, by its
transmission type. python-canopen itself repeats a PDO with event timer.
"""
import struct
import threading

import canopen

START, RESETS = 1, (129, 130)
ECHO = {0x60FF: 0x606C, 0x607A: 0x6064}  # a set-point and the value that follows it
COUNT = 0x60FD  # how many set-points came


class Device:
    """`left_out`: the numbers, from 1, of the times at which a TPDO of type 1 to 240 is due but not sent.
    `pause`: PDOs with event timer are not sent after this number of SYNCs, for this number of seconds."""

    def __init__(self, network, eds, node_id, left_out=(), pause=(0, 0)):
        self.node = canopen.LocalNode(node_id, eds)
        self.left_out, self.pause = left_out, pause
        network.add_node(self.node)
        network.subscribe(0x000, self.on_nmt)
        network.subscribe(0x080, self.on_sync)
        self.network, self.running = network, False
        for pdo in self.node.rpdo.values():
            pdo.callbacks.append(self.on_rpdo)
        self.restart()

    def restart(self):
        """Power-on values, boot-up message, pre-operational."""
        self.node.nmt.stop_heartbeat()
        self.node.data_store.clear()
        self.network.send_message(0x700 + self.node.id, [0])
        self.node.nmt.on_command(0, bytes([128, self.node.id]), 0)

    def on_nmt(self, _, data, __):
        command, node_id = data[0], data[1]
        if node_id not in (0, self.node.id):
            return
        if command == START and not self.running:
            self.start()
        elif command != START:
            self.running = False
            self.node.tpdo.stop()
            if command in RESETS:
                threading.Timer(0.05, self.restart).start()

    def start(self):
        self.syncs, self.count, self.waiting = 0, 0, {}
        self.node.tpdo.read()
        self.node.rpdo.read()
        for pdo in self.tpdos():
            self.fill(pdo)
        self.start_timers()
        self.running = True

    def start_timers(self):
        for pdo in self.timed():
            pdo.start(pdo.event_timer / 1000)

    def rest(self):
        for pdo in self.timed():
            pdo.stop()
        threading.Timer(self.pause[1], lambda: self.running and self.start_timers()).start()

    def tpdos(self):
        return [pdo for pdo in self.node.tpdo.values() if pdo.enabled]

    def timed(self):
        return [pdo for pdo in self.tpdos() if pdo.trans_type == 255 and pdo.event_timer]

    def fill(self, pdo):
        for variable in pdo:
            variable.set_data(self.node.get_data(variable.index, variable.subindex))

    def on_rpdo(self, pdo):
        """The set-points are valid at once, or with the next SYNC."""
        if not self.running:
            return
        values = {variable.index: bytes(variable.get_data()) for variable in pdo}
        if pdo.trans_type <= 240:
            self.waiting.update(values)
        else:
            self.use(values)

    def use(self, values):
        for index, value in values.items():
            self.node.set_data(ECHO[index], 0, value)
        self.count += 1
        self.node.set_data(COUNT, 0, struct.pack("<I", self.count))
        changed = {ECHO[index] for index in values} | {COUNT}
        for pdo in self.tpdos():
            if pdo.trans_type == 255 and changed & {variable.index for variable in pdo}:
                self.fill(pdo)  # with an event timer, python-canopen sends the new value when the timer expires
                if not pdo.event_timer:
                    pdo.transmit()

    def on_sync(self, *_):
        if not self.running:
            return
        if self.waiting:
            values, self.waiting = self.waiting, {}
            self.use(values)
        self.syncs += 1
        for pdo in self.tpdos():
            if 1 <= pdo.trans_type <= 240 and self.syncs % pdo.trans_type == 0:
                self.fill(pdo)
                if self.syncs // pdo.trans_type not in self.left_out:
                    pdo.transmit()
        if self.syncs == self.pause[0]:
            self.rest()
