"""Names and data types of objects: finds the object that "shoulder.statusword" means. Used by
Bus."""
from __future__ import annotations

import re
import struct

from .link import Link, Obstacle

Value = int | float | str | bytes  # of an object, by its data type

# Data types of CiA 301 by their index, with the words of the text gateway (CiA 309-3).
SIGNED = {2: 1, 3: 2, 4: 4, 0x10: 3, 0x12: 5, 0x13: 6, 0x14: 7, 0x15: 8}  # bytes
UNSIGNED = {1: 1, 5: 1, 6: 2, 7: 4, 0x16: 3, 0x18: 5, 0x19: 6, 0x1A: 7, 0x1B: 8}
REALS = {8: "<f", 0x11: "<d"}
TEXT = 9  # VISIBLE_STRING
TYPES = {"b": 1, "r32": 8, "r64": 0x11, "vs": TEXT,
         **{f"i{8 * size}": code for code, size in SIGNED.items()},
         **{f"u{8 * size}": code for code, size in UNSIGNED.items() if code != 1}}
INDEX = re.compile(r"(?:0[xX])?([0-9A-Fa-f]{4})(?::([0-9A-Fa-f]{1,2}))?")


def find_object(link: Link, name: str) -> tuple[str, int, int, int | None]:
    """Returns node, index, sub-index and data type of "shoulder.statusword" or
    "shoulder.0x6041:00". The index and the sub-index are hexadecimal. Names of signals of the node
    take precedence over names of CiA 301, 401, 402 and 406. The type is None if it is not known."""
    node, _, part = name.partition(".")
    signals = [signal for signal in link.signals.values() if signal.node == node]
    number = INDEX.fullmatch(part)
    if number:
        index, sub = int(number[1], 16), int(number[2] or "0", 16)
        types = {(signal.index, signal.sub): signal.data_type for signal in signals}
        known = types | {(at, below): code for at, below, code in standard_objects().values()
                         if (at, below) not in types}
        return node, index, sub, known.get((index, sub))
    for signal in signals:
        if signal.name == part:
            return node, signal.index, signal.sub, signal.data_type
    if part in standard_objects():
        return node, *standard_objects()[part]
    raise Obstacle("wrong use", f"'{name}' is neither NODE.SIGNAL of bus {link.bus} nor NODE.NAME "
                                "of an object of CiA 301 or 402: give its index, as in "
                                f"{node or 'NODE'}.0x6041:00")


def standard_objects() -> dict[str, tuple[int, int, int]]:
    """Returns index, sub-index and data type by name. The result is empty in the source tree,
    because share/wheel.sh makes the table from the EDS files of takt."""
    try:
        from .objects import OBJECTS
    except ImportError:
        return {}
    return OBJECTS


def code_of(name: str, word: str | None, known: int | None) -> int | None:
    """Returns the data type that the caller has given, else the known one."""
    if word is None:
        return known
    if word not in TYPES:
        raise Obstacle("wrong use", f"{name}: '{word}' is not one of the types {', '.join(TYPES)}")
    return TYPES[word]


def from_bytes(name: str, code: int | None, data: bytes) -> Value:
    """Returns the value of an object, or its bytes if the type is not known or is none of TYPES."""
    size = SIGNED.get(code or 0) or UNSIGNED.get(code or 0) or {8: 4, 0x11: 8}.get(code or 0)
    if size and len(data) != size:
        raise Obstacle("refused", f"{name}: its type has {size} bytes, and the device has sent "
                                  f"{len(data)}")
    if code in SIGNED or code in UNSIGNED:
        return int.from_bytes(data, "little", signed=code in SIGNED)
    if code in REALS:
        return float(struct.unpack(REALS[code], data)[0])
    return data.rstrip(b"\0").decode("latin-1") if code == TEXT else data


def to_bytes(name: str, code: int | None, value: Value) -> bytes:
    """Returns the bytes of a value for an object of this type."""
    try:
        if isinstance(value, bytes):
            return value
        if isinstance(value, str):
            return value.encode("latin-1")
        if code in REALS:
            return struct.pack(REALS[code], value)
        if isinstance(value, int) and (code in SIGNED or code in UNSIGNED):
            size = SIGNED.get(code) or UNSIGNED[code]
            return value.to_bytes(size, "little", signed=code in SIGNED)
    except (OverflowError, UnicodeEncodeError):
        raise Obstacle("wrong use", f"{name} can't hold {value!r}") from None
    raise Obstacle("wrong use", f"{name}: the type of the object is not known or does not fit "
                                f"{value!r}: give `type`, for example \"u16\", or bytes")
