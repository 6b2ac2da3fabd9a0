"""LSS slaves (CiA 305) on a CAN interface, written from the standard's tables alone."""
import struct
import threading

import can

MASTER, SLAVE = 0x7E5, 0x7E4
NONE = 255


class Slave:
    """`always`: the slave also answers every question of fastscan in configuration state, as some stacks do."""

    def __init__(self, serial, node_id=NONE, store_error=0, always=False):
        self.always = always
        self.identity = (0x15A, 2, 0x00010003, serial)
        self.active = self.pending = node_id
        self.store_error = store_error
        self.stored = self.bit_timing = self.delay = None
        self.configuring, self.position, self.selected, self.ranged = False, 0, 0, 0

    def react(self, frame):
        """Bytes of the answer, or None."""
        command, value = frame[0], struct.unpack_from("<I", frame, 1)[0]
        if command == 0x04:
            if self.configuring and frame[1] == 0 and self.active == NONE:
                self.active = self.pending
            self.configuring = frame[1] == 1
        elif 0x40 <= command <= 0x43 and not self.configuring:
            self.selected = self.selected + 1 if command - 0x40 == self.selected and value == self.identity[command - 0x40] else 0
            if command == 0x40 and value == self.identity[0]:
                self.selected = 1
            if self.selected == 4:
                self.selected, self.configuring = 0, True
                return [0x44]
        elif 0x46 <= command <= 0x4B:
            step = command - 0x46
            own = self.identity[(0, 1, 2, 2, 3, 3)[step]]
            fits = (own == value, own == value, own >= value, own <= value, own >= value, own <= value)[step]
            self.ranged = (self.ranged if step else 0) + 1 if fits and (step == 0 or self.ranged == step) else 0
            if self.ranged == 6:
                return [0x4F]
        elif command == 0x4C and self.active == self.pending == NONE:
            return [0x50]
        elif command == 0x51 and not self.configuring and self.active == self.pending == NONE:
            return self.fast_scan(value, *frame[5:8])
        elif command == 0x51 and self.configuring and self.always:
            return [0x4F]
        elif self.configuring:
            return self.configure(command, frame)
        return None

    def fast_scan(self, number, bit, part, following):
        if bit == 0x80:
            self.position = 0
            return [0x4F]
        if bit > 31 or part != self.position or (self.identity[part] ^ number) >> bit:
            return None
        self.position = following
        if bit == 0 and following < part:
            self.configuring = True
        return [0x4F]

    def configure(self, command, frame):
        if command == 0x11:
            good = 1 <= frame[1] <= 127 or frame[1] == NONE
            self.pending = frame[1] if good else self.pending
            return [0x11, 0 if good else 1]
        if command == 0x13:
            good = frame[1] == 0 and frame[2] in (0, 2, 3, 4)
            self.bit_timing = frame[2] if good else self.bit_timing
            return [0x13, 0 if good else 1]
        if command == 0x15:
            self.delay = struct.unpack_from("<H", frame, 1)[0]
        if command == 0x17:
            self.stored = self.pending if self.store_error == 0 else self.stored
            return [0x17, self.store_error]
        if 0x5A <= command <= 0x5D:
            return [command, *struct.pack("<I", self.identity[command - 0x5A])]
        if command == 0x5E:
            return [0x5E, self.active]
        return None


class Slaves:
    """Each frame of the master reaches all slaves."""

    def __init__(self, interface, slaves):
        self.slaves, self.commands = slaves, []
        self.bus = can.Bus(interface="socketcan", channel=interface)
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.running = True
        self.thread.start()

    def run(self):
        while self.running:
            message = self.bus.recv(0.05)
            if message is not None and message.arbitration_id == MASTER:
                self.take(message)

    def take(self, message):
        self.commands.append((message.timestamp, bytes(message.data)))
        for slave in self.slaves:
            answer = slave.react(message.data) if message.dlc == 8 else None
            if answer is not None:
                self.bus.send(can.Message(arbitration_id=SLAVE, is_extended_id=False, data=bytes(answer).ljust(8, b"\0")))

    def stop(self):
        self.running = False
        self.thread.join()
        self.bus.shutdown()
