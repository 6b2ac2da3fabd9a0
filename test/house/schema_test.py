#!/usr/bin/env python3
"""schema_test.py BIN          compares the JSON schema of the network file with what takt says about network files
schema_test.py --self-test  shows that the comparison can fail

The schema accepts each good network file of the tree. Then each key of the schema gets values of all kinds: a wrong type,
the limits and what is beside them, its words and a misspelled one, nothing. The schema and takt have to agree on each.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DRIVE = str(ROOT / "share/eds/takt_drive402.eds")
FINDING = re.compile(r"^[^\n:]*:(\d+):\d+: (error|warning): .*\[([a-z-]+)\]$", re.M)
# What a schema can express. Other rules compare keys with each other, with devices, or read the text of a value.
KINDS = {"unknown-key", "wrong-type", "out-of-range", "unknown-value", "not-a-number", "not-a-version", "missing-key", "octal"}
# Keys whose readers check more than the schema: what they refuse depends on other keys or files, or is a gap in a
# range.
BEYOND = {
    "sync_overflow": "0 or 2..240: 1 is reserved",
    "sync_source": "needs sync_period",
    "sync_timeout": "is not shorter than sync_period",
    "sync_window": "is not longer than sync_period",
    "time_cob_id": "an identifier with two flags",
    "time_period": "0, or at least 100",
    "receive_window_us": "is within the cycle",
    "sign": "1 or -1, not 0",
    "set_speed: scale": "any number but 0",
    "actual_speed: scale": "any number but 0",
    "authenticate": "needs keys",
    "mechanics": "belongs to the model drive402",
    "values": "within the mask beside it",
    "device": "an entry of the device data",
    "software_file": "needs software_version",
    "sdo_channel": "two different identifiers",
    "limits: objects": "each entry has min, max or step",
}


class CoreLoader(yaml.SafeLoader):
    """Reads scalars as YAML 1.2 does, like the editors: `yes` and `off` are words, 1e-4 is a number."""


CoreLoader.yaml_implicit_resolvers = {}
for tag, pattern, first in (
        ("bool", r"true|True|TRUE|false|False|FALSE", "tTfF"), ("null", r"~|null|Null|NULL|", "~nN\0"),
        ("int", r"[-+]?[0-9]+|0x[0-9a-fA-F]+", "-+0123456789"),
        ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+0123456789."), ("merge", r"<<", "<")):
    CoreLoader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first))
CoreLoader.yaml_implicit_resolvers.setdefault("", []).append(("tag:yaml.org,2002:null", re.compile("^$")))
CoreLoader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value, 16 if "0x" in node.value else 10))
CoreLoader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def as_json(value):
    """Names of keys are texts in JSON."""
    if isinstance(value, dict):
        return {str(key): as_json(part) for key, part in value.items()}
    return [as_json(part) for part in value] if isinstance(value, list) else value


def load(text):
    return as_json(yaml.load(text, Loader=CoreLoader))


def flow(value):
    """The value in one line of YAML, words without quotes."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(flow(part) for part in value) + "]"
    bare = isinstance(value, str) and re.fullmatch(r"[A-Za-z_][\w-]*", value) and value not in ("true", "false", "null")
    return value if bare else json.dumps(value)


class Schema:
    def __init__(self, schema):
        jsonschema.Draft7Validator.check_schema(schema)
        self.schema, self.validator = schema, jsonschema.Draft7Validator(schema)

    def errors(self, document):
        return list(self.validator.iter_errors(document))

    def forms(self, schema):
        """The alternatives of a schema, with references followed."""
        if "$ref" in schema:
            return self.forms(self.schema["definitions"][schema["$ref"].rsplit("/", 1)[1]])
        parts = schema.get("anyOf", []) + schema.get("allOf", [])
        return [schema] * (not parts) + [form for part in parts if "if" not in part for form in self.forms(part)] or [schema]

    def good(self, schema):
        """A value that the schema accepts."""
        form = self.forms(schema)[0]
        kind = form.get("type", "string")
        kind = kind if isinstance(kind, str) else kind[0]
        if "enum" in form:
            return form["enum"][0]
        if kind == "object":
            return {key: self.good(form["properties"][key]) for key in form.get("required", [])}
        if kind == "array":
            return [self.good(form["items"])] * form.get("minItems", 0)
        low = form.get("minimum", form.get("exclusiveMinimum", -1) + 1)
        return {"boolean": True, "integer": max(low, 1) if form.get("maximum", 1) >= 1 else low, "number": low, "string": "x"}[kind]

    def keys(self, schema, depth=0):
        """Each key below a map, as a list of steps, with its schema and the map that it is in."""
        for form in self.forms(schema):
            for key, part in form.get("properties", {}).items():
                if part.get("doNotSuggest"):
                    continue
                yield [key], part, form
                for inner in self.forms(part):
                    entry, step = inner, None
                    if inner.get("type") in ("array", ["array", "null"]):
                        entry, step = inner["items"], 0
                    elif "patternProperties" in inner:
                        entry, step = next(iter(inner["patternProperties"].values())), "1"
                    between = [] if step is None else [step]
                    if depth < 5:
                        for steps, deep, around in self.keys(entry, depth + 1) if entry is not form else ():
                            yield [key, *between, *steps], deep, around

    def variants(self, schema):
        """Values of all kinds for a key."""
        values = [{}, [], [1], "zzz", True, None, 0, 1, -1, 1.5, "0x10", "010", {"zzz": 1}, [{}], ["zzz"], [1, 2, 3], [0, 1]]
        for form in self.forms(schema):
            values += form.get("enum", [])[:3] + [word + "x" for word in form.get("enum", [])[:1]]
            for limit in ("minimum", "maximum", "exclusiveMinimum"):
                if limit in form:
                    values += [form[limit] - 1, form[limit], form[limit] + 1]
            for pattern, entry in form.get("patternProperties", {}).items():
                values += [{number: self.good(entry)} for number in (0, 1, 8, 9, 254, 255, 512, 513)]
                values += [{1: value} for value in (0, 255, 256, -1, "zzz")]
            if form.get("type") in ("array", ["array", "null"]):
                values += [[self.good(form["items"])], [None]]
        return [value for at, value in enumerate(values) if repr(value) not in map(repr, values[:at])]

    def nested(self, schema, steps, value):
        """A map that has `value` at the end of the steps, and whatever else is required on the way."""
        if not steps:
            return value
        if steps[0] == 0:
            items = next(form["items"] for form in self.forms(schema) if "items" in form)
            return [self.nested(items, steps[1:], value)]
        form = next(form for form in self.forms(schema) if "properties" in form or "patternProperties" in form)
        if "properties" not in form:
            return {steps[0]: self.nested(next(iter(form["patternProperties"].values())), steps[1:], value)}
        found = {key: self.good(form["properties"][key]) for key in form.get("required", []) if key != steps[0]}
        found[steps[0]] = self.nested(form["properties"].get(steps[0], {}), steps[1:], value)
        return found

    def changes(self, schema):
        """Contents of a map, each with one key that has a value of some kind, is misspelled or is missing."""
        seen = set()
        for steps, part, around in self.keys(schema):
            mark = (id(around), steps[-1])
            if mark in seen:
                continue
            seen.add(mark)
            for value in self.variants(part):
                yield steps, self.nested(schema, steps, value)
            yield steps, self.nested(schema, [*steps[:-1], steps[-1] + "x"], 1)
            if steps[-1] in around.get("required", []):
                lacking = self.nested(schema, steps, None)
                self.holder(lacking, steps).pop(steps[-1])
                yield steps, lacking

    @staticmethod
    def holder(value, steps):
        for step in steps[:-1]:
            value = value[step]
        return value


class Takt:
    def __init__(self, binaries):
        self.binaries, self.folder = binaries, tempfile.TemporaryDirectory()

    def findings(self, text):
        """The findings by line: each a severity and a rule."""
        path = pathlib.Path(self.folder.name) / "net.yaml"
        path.write_text(text)
        return self.findings_of(path)

    def findings_of(self, path):
        done = subprocess.run([f"{self.binaries}/taktd", path, "--check"], capture_output=True, text=True, timeout=60)
        if done.returncode not in (0, 1, 2):
            sys.exit(f"taktd --check ended with {done.returncode}: {done.stderr}")
        found = {}
        for line, severity, rule in FINDING.findall(done.stderr + done.stdout):
            found.setdefault(int(line), []).append((severity, rule))
        return found


def disagreement(refused, findings, steps, in_quotes=False):
    """What is wrong, if the schema and takt do not agree on one change. The schema does not count in quotes."""
    if refused and not findings:
        return "the schema refuses what takt accepts"
    told = {rule for severity, rule in findings if severity == "error" and rule in KINDS}
    told -= {"out-of-range"} if in_quotes else set()
    path = f": {': '.join(map(str, steps))}:"
    beyond = any(f": {keys}:" in path for keys in BEYOND)
    return f"the schema accepts what takt refuses: {sorted(told)}" if told and not refused and not beyond else None


def compare(schema, takt, changes, document_of, first_line):
    """`document_of(changes)` is a text with one change a line, from `first_line` on, and how to find its line from a path."""
    wrong = []
    text, line_of = document_of(changes)
    refused = {line_of(error) for error in schema.errors(load(text))}
    findings = takt.findings(text)
    for at, (steps, change) in enumerate(changes):
        line = first_line + at
        told = disagreement(line in refused, findings.get(line, []), steps, '"' in flow(change))
        if told:
            wrong.append(f"{': '.join(map(str, steps))} in {flow(change)}: {told}")
    return wrong


def nodes_text(changes):
    lines = ["master: {sync_period: 4000}", "nodes:"]
    for at, (_, change) in enumerate(changes):
        node = {"node_id": at + 1, "dcf": DRIVE} | change if isinstance(change, dict) else change
        lines.append(f" n{at}: {flow(node)}")
    return "\n".join(lines) + "\n", lambda error: 3 + int(error.absolute_path[1][1:]) if len(error.absolute_path) > 1 else 0


def compare_nodes(schema, takt):
    wrong = []
    node = schema.schema["properties"]["defaults"]
    changes = list(schema.changes(node))
    for first in range(0, len(changes), 100):
        wrong += compare(schema, takt, changes[first:first + 100], nodes_text, 3)
    return wrong, len(changes)


def compare_sections(schema, takt):
    wrong, count = [], 0
    names = [name for name in schema.schema["properties"] if name not in ("nodes", "defaults")]
    changes = {name: list(schema.changes(schema.schema["properties"][name])) for name in names}
    for at in range(max(map(len, changes.values()))):
        here = [([name, *changes[name][at][0]], changes[name][at][1]) for name in names if at < len(changes[name])]
        count += len(here)

        def text_of(some):
            lines = [f"{steps[0]}: {flow(change)}" for steps, change in some]
            order = [steps[0] for steps, _ in some]
            text = "\n".join(lines) + f"\nnodes: {{a: {{node_id: 1, dcf: {DRIVE}}}}}\n"
            return text, lambda error: order.index(error.absolute_path[0]) + 1 if error.absolute_path else 0
        wrong += compare(schema, takt, here, text_of, 1)
    return wrong, count


NODE = f"{{node_id: 1, dcf: {DRIVE}}}"
WHOLE = {  # whole files that have one fault each
    "no node": "master: {node_id: 5}\n",
    "a misspelled section": f"bsu: {{name: x}}\nnodes: {{a: {NODE}}}\n",
    "misspelled nodes": f"ndes: {{a: {NODE}}}\n",
    "a node without node_id": f"nodes: {{a: {{dcf: {DRIVE}}}}}\n",
    "a node without dcf": "nodes: {a: {node_id: 1}}\n",
    "an empty node": "nodes: {a: }\n",
    "a node at the top without dcf": "a: {node_id: 1}\n",
    "a node named all": f"nodes: {{all: {NODE}}}\n",
    "a node named 12": f"nodes: {{12: {NODE}}}\n",
    "an unknown key in defaults": f"defaults: {{mandatoryy: true}}\nnodes: {{a: {NODE}}}\n",
    "a list": "[1, 2]\n",
    "a list of nodes": f"nodes: [{NODE}]\n",
}


def compare_files(schema, takt):
    wrong = []
    for name, text in WHOLE.items():
        errors = [rule for found in takt.findings(text).values() for severity, rule in found if severity == "error"]
        if not errors:
            wrong.append(f"{name}: takt accepts it")
        if not schema.errors(load(text)):
            wrong.append(f"{name}: the schema accepts it")
    count = 0
    for path in sorted(ROOT.glob("share/demo/**/*.y*ml")) + sorted(ROOT.glob("test/**/*.y*ml")):
        found = takt.findings_of(path)
        if any(severity == "error" for findings in found.values() for severity, _ in findings):
            continue
        if "node_id" not in path.read_text():
            continue
        count += 1
        for error in schema.errors(load(path.read_text())):
            where = ": ".join(map(str, error.absolute_path))
            wrong.append(f"{path.relative_to(ROOT)}: the schema refuses a good file: {where}: {error.message[:300]}")
    if count < 20:
        wrong.append(f"only {count} good files were found")
    return wrong, count + len(WHOLE)


def self_test():
    small = {"definitions": {"1": {"type": "object", "properties": {"a": {"type": "integer", "minimum": 0, "maximum": 5}},
                                   "required": ["a"], "additionalProperties": False}}, "$ref": "#/definitions/1"}
    changes = [change for _, change in Schema(small).changes({"$ref": "#/definitions/1"})]
    tried = all(change in changes for change in ({"a": -1}, {"a": 6}, {"a": {}}, {"ax": 1, "a": 1}, {}))
    strict = disagreement(True, [], ["a"])
    lax = disagreement(False, [("error", "out-of-range")], ["a"])
    agree = [disagreement(True, [("error", "wrong-type")], ["a"]), disagreement(False, [("error", "lcm-url")], ["a"])]
    sys.exit(0 if tried and strict and lax and agree == [None, None] else "the comparison can't fail")


def main():
    if sys.argv[1] == "--self-test":
        self_test()
    printed = subprocess.run([f"{sys.argv[1]}/takt", "reference", "network-file", "--json-schema"], capture_output=True,
                             text=True, check=True).stdout
    schema, takt = Schema(json.loads(printed)), Takt(sys.argv[1])
    failed = False
    for name, part in (("files", compare_files), ("sections", compare_sections), ("nodes", compare_nodes)):
        wrong, count = part(schema, takt)
        print(f"{name}: {count} compared, {len(wrong)} wrong")
        failed = failed or bool(wrong) or count == 0
        for line in wrong:
            print("  " + line)
    sys.exit(failed)


main()
