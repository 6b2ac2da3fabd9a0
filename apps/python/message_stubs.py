"""Makes type hints for the classes of lcm-gen, which have none, of the files of share/lcm. setup.py uses it."""
import re

FIELD = re.compile(r"^\s*(\w+)\s+(\w+)\s*((?:\[\w+\])*)\s*;", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")
NUMBERS = {"boolean": "bool", "byte": "int", "double": "float", "float": "float", "int8_t": "int", "int16_t": "int",
           "int32_t": "int", "int64_t": "int", "string": "str"}


def fields_of(text):
    """(name, type in Python) of the fields of a message type, in their order."""
    for kind, name, dimensions in FIELD.findall(COMMENT.sub("", text).partition("{")[2]):
        plain = NUMBERS.get(kind, kind)
        if kind == "byte" and dimensions:
            plain = "bytes"
        elif dimensions:  # a list when it is made, and a tuple of numbers when it was received
            plain = f"Sequence[{plain}]" if kind in NUMBERS else f"list[{plain}]"
        yield name, plain


def stub_of(name, text):
    """The file of type hints for the message type `name`, whose definition is `text`."""
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
