#!/usr/bin/env python3
"""unite.py OUT SOURCE... - writes a source that has the text of several test files, so that these files compile
together.

Each file gets a namespace of its own inside the namespace that it opens, so that equal names of two files do not collide:
`namespace takt {` becomes `namespace takt::united_0 {`. Messages and failures name the file and line of the original.
"""
import pathlib
import re
import sys

OPENED = re.compile(r"^namespace takt((?:::\w+)*) \{", re.MULTILINE)


def united(sources):
    texts = []
    for number, source in enumerate(sources):
        text = OPENED.sub(rf"namespace takt\1::united_{number} {{", source.read_text())
        texts.append(f'#line 1 "{source}"\n{text}')
    return "\n".join(texts)


if __name__ == "__main__":
    out, *sources = map(pathlib.Path, sys.argv[1:])
    out.write_text(united(sources))
