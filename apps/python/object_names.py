"""object_names.py EDS... - makes the table of names of objects for takt.dictionary from EDS files. setup.py uses it.

The name of an object is in lower case, as in the layout of a bus: "position_actual_value". A sub-object has two names:
"identity_object.vendor_id". A name that several objects have is left out, unless these objects differ only by a multiple of
0x800, as those of the axes of a drive do. The name then means the object of the first axis.
"""
import configparser
import re
import sys

SECTION = re.compile(r"([0-9A-Fa-f]{4})(?:sub([0-9A-Fa-f]{1,2}))?")
STANDARD = (range(0x1000, 0x2000), range(0x6000, 0xA000))  # the areas of CiA 301 and of the profiles
AXIS_STEP = 0x800


def snake_case(text):
    """Returns the text as taktd writes names in a layout."""
    words = re.sub(r"([a-z])([A-Z])", r"\1_\2", text)
    return re.sub(r"[^0-9A-Za-z]+", "_", words).strip("_").lower()


def objects_of(path):
    """Yields (name, index, sub-index, data type) for each object of an EDS file."""
    eds = configparser.ConfigParser(interpolation=None, strict=False, delimiters=("=",), comment_prefixes=(";",))
    eds.read(path, encoding="latin-1")
    for section in eds.sections():
        number = SECTION.fullmatch(section)
        if not number or not any(int(number[1], 16) in area for area in STANDARD) or "DataType" not in eds[section]:
            continue
        name = snake_case(eds[section]["ParameterName"])
        if number[2]:
            name = f"{snake_case(eds[number[1]]['ParameterName'])}.{name}"
        yield name, int(number[1], 16), int(number[2] or "0", 16), int(eds[section]["DataType"], 0)


def table_of(paths):
    """Returns the text of the module takt.objects."""
    found = {}
    for path in paths:
        for name, index, sub, code in objects_of(path):
            found.setdefault(name, set()).add((index, sub, code))
    lines = []
    for name, places in sorted(found.items()):
        first = min(places)
        if all(place[1:] == first[1:] and (place[0] - first[0]) % AXIS_STEP == 0 for place in places):
            lines.append(f'    "{name}": (0x{first[0]:04X}, 0x{first[1]:02X}, 0x{first[2]:02X}),')
    return "\n".join(['"""Index, sub-index and data type of objects of CiA 301, 401, 402 and 406, by their names."""',
                      "OBJECTS: dict[str, tuple[int, int, int]] = {", *lines, "}", ""])


if __name__ == "__main__":
    sys.stdout.write(table_of(sys.argv[1:]))
