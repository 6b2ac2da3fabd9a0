"""Makes type hints for the classes that lcm-gen makes from share/lcm, because lcm-gen makes none. setup.py uses this module."""
import re

FIELD = re.compile(r"^\s*(\w+)\s+(\w+)\s*((?:\[\w+\])*)\s*;", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")
NUMBERS = {"boolean": "bool", "byte": "int", "double": "float", "float": "float", "int8_t": "int", "int16_t": "int",
           "int32_t": "int", "int64_t": "int", "string": "str"}


def fields_of(text):
    """Yields (name, type in Python) for each field of a message type, in order."""
    for kind, name, dimensions in FIELD.findall(COMMENT.sub("", text).partition("{")[2]):
        plain = NUMBERS.get(kind, kind)
        if kind == "byte" and dimensions:
            plain = "bytes"
        elif dimensions:  # a program sets a list; a received message has a tuple of numbers
            plain = f"Sequence[{plain}]" if kind in NUMBERS else f"list[{plain}]"
        yield name, plain


def stub_of(name, text):
    """Returns the file of type hints for the message type `name`, whose definition is `text`."""
    fields = list(fields_of(text))
    others = sorted({match[1] for _, kind in fields if (match := re.fullmatch(r"(?:list\[)?(\w+_t)\]?", kind))})
    return "\n".join(["from collections.abc import Sequence", "",
                      *(f"from .{other} import {other}" for other in others), "",
                      f"class {name}:",
                      *(f"    {field}: {kind}" for field, kind in fields),
                      "    def __init__(self) -> None: ...",
                      "    def encode(self) -> bytes: ...",
                      "    @staticmethod",
                      f"    def decode(data: bytes) -> {name}: ...", ""])
