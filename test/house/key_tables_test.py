#!/usr/bin/env python3
"""key_tables_test.py BIN          fails if the key tables of a page differ from what `takt reference` prints
key_tables_test.py --renew BIN  writes the tables into the pages
key_tables_test.py --self-test  shows that the comparison can fail

A page holds each table between `<!-- keys: SECTION -->` and `<!-- end of keys -->`; the text around the tables is free.
"""
import difflib
import pathlib
import re
import subprocess
import sys

DOC = pathlib.Path(__file__).resolve().parent.parent.parent / "share/doc"
PAGES = {"network-file": "network_file.md", "device-data": "device_data.md"}
TABLE = re.compile(r"<!-- keys: (.*?) -->\n.*?<!-- end of keys -->\n", re.S)


def tables(text):
    return {table[1]: table[0] for table in TABLE.finditer(text)}


def renewed(page, reference):
    return TABLE.sub(lambda table: reference.get(table[1], ""), page)


def differences(page, reference):
    """The faults of a page, as lines."""
    wrong = [f"no table for the keys of `{section}`" for section in reference if section not in tables(page)]
    new = renewed(page, reference)
    return wrong + list(difflib.unified_diff(page.splitlines(), new.splitlines(), "page", "takt reference", "", "", 0, ""))


def self_test():
    table = "<!-- keys: a -->\n| x |\n<!-- end of keys -->\n"
    reference = {"a": table}
    good = not differences("text\n" + table, reference)
    missing = differences("text\n", reference)
    changed = differences(table.replace("x", "y"), reference)
    unknown = differences(table + table.replace("keys: a", "keys: b"), reference)
    sys.exit(0 if good and missing and changed and unknown else "the comparison can't fail")


if sys.argv[1] == "--self-test":
    self_test()
failed = False
for topic, name in PAGES.items():
    printed = subprocess.run([f"{sys.argv[-1]}/takt", "reference", topic], capture_output=True, text=True, check=True).stdout
    page, reference = (DOC / name).read_text(), tables(printed)
    if sys.argv[1] == "--renew":
        page = renewed(page, reference)
        (DOC / name).write_text(page)
    for line in differences(page, reference):
        failed = True
        print(f"share/doc/{name}: {line}")
if failed:
    print(f"renew the tables with: python3 test/house/key_tables_test.py --renew {sys.argv[-1]}")
sys.exit(failed)
