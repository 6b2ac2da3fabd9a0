#!/usr/bin/env python3
"""candump_to_pcap.py LOG PCAP: turns a `candump -L` log into a capture that tshark reads."""
import struct
import sys

LINKTYPE_CAN_SOCKETCAN = 227
EXTENDED, REMOTE, ERROR = 0x80000000, 0x40000000, 0x20000000


def frame_of(text):
    """`185#0102`, `00012345#R`, `20000080#...` -> identifier with flags, payload."""
    identifier, payload = text.split("#", 1)
    flags = EXTENDED if len(identifier) == 8 else 0
    number = int(identifier, 16)
    if number & ERROR and len(identifier) == 8:
        flags = 0  # candump writes error frames with their flag in the identifier
    if payload[:1] in ("R", "r"):
        return number | flags | REMOTE, b""
    return number | flags, bytes.fromhex(payload)


def to_pcap(log, pcap):
    with open(log) as lines, open(pcap, "wb") as out:
        out.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, LINKTYPE_CAN_SOCKETCAN))
        for line in lines:
            stamp, _, text = line.split()[:3]
            seconds, micros = stamp.strip("()").split(".")
            identifier, payload = frame_of(text)
            packet = struct.pack(">IBxxx", identifier, len(payload)) + payload
            head = struct.pack("<IIII", int(seconds), int(micros), len(packet), len(packet))
            out.write(head + packet)


if __name__ == "__main__":
    to_pcap(*sys.argv[1:3])
