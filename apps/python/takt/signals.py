"""Values of signals: raw numbers of the image and numbers in units. Used by Axes."""
from __future__ import annotations

import struct

INTEGERS = (2, 3, 4, 0x10, 0x12, 0x13, 0x14, 0x15)  # INTEGER8 to INTEGER64, CiA 301 data types
REALS = {8: ("<f", "<I"), 0x11: ("<d", "<Q")}  # REAL32 and REAL64: formats of value and raw number


def raw_limits(signal) -> tuple[int, int]:
    """The smallest and the largest value of an object of whole numbers."""
    if signal.data_type in INTEGERS:
        return -2 ** (signal.bits - 1), 2 ** (signal.bits - 1) - 1
    return 0, 2 ** signal.bits - 1


def decode(signal, raw: int) -> float:
    """The value in the unit of the signal."""
    if signal.data_type in REALS:
        form, number = REALS[signal.data_type]
        bits = raw & (1 << signal.bits) - 1
        raw = struct.unpack(form, struct.pack(number, bits))[0]
    return raw * signal.scale + signal.offset


def encode(signal, value: float) -> int | None:
    """The raw number of a value in the unit of the signal; None if the object can't hold it."""
    wanted = (value - signal.offset) / signal.scale
    if signal.data_type in REALS:
        form, number = REALS[signal.data_type]
        try:
            return struct.unpack(number, struct.pack(form, wanted))[0]
        except OverflowError:
            return None
    if wanted - wanted != 0:  # not a finite number
        return None
    lowest, highest = raw_limits(signal)
    return round(wanted) if lowest <= round(wanted) <= highest else None
