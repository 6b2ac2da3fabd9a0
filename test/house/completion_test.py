#!/usr/bin/env python3
"""completion_test.py BIN: checks what bash, zsh and fish propose for takt and its programs. It tests zsh and fish only
if they are installed."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPTS = ROOT / "share/completions"
BIN = pathlib.Path(sys.argv[1]).resolve()
ENV = os.environ | {"PATH": f"{BIN}:{os.environ['PATH']}", "LCM_DEFAULT_URL": "tcpq://127.0.0.1:1"}
failures = []


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, env=ENV, cwd=ROOT, timeout=60, stdin=subprocess.DEVNULL)


def check(name, good, told):
    print(("ok    " if good else "FAIL  ") + name, flush=True)
    if not good:
        failures.append(name)
        print("      " + str(told))


def by_bash(line):
    script = f'. {SCRIPTS}/takt.bash; COMP_LINE=$1 COMP_POINT=${{#1}}; _takt; printf "%s\\n" "${{COMPREPLY[@]}}"'
    return run("bash", "-c", script, "bash", line)


def by_zsh(line):
    words = " ".join(f"'{word}'" for word in line.split(" "))
    script = f"""
      _describe() {{ local one; for one in "${{(@P)4}}"; do print -r -- "${{one%%:*}}"; done; }}
      _files() {{ local pattern="$PREFIX${{2:-*}}"; print -rl -- ${{~pattern}}(N); }}
      words=({words}); CURRENT=${{#words}}; PREFIX=${{words[-1]}}
      . {SCRIPTS}/_takt"""
    return run("zsh", "-fc", script)


def by_fish(line):
    return run("fish", "--no-config", "-c", f"source {SCRIPTS}/takt.fish; complete -C '{line}'")


SHELLS = {"bash": by_bash, "zsh": by_zsh, "fish": by_fish}
NET = "share/demo/two_axes.yaml"
CASES = (
    ("takt pl", {"plan"}, {"status", "complete"}),
    ("takt ", {"plan", "status", "help"}, {"complete"}),
    ("takt eds ", {"show", "check", "dcf"}, {"plan"}),
    ("takt help e", {"eds", "emcy"}, {"plan"}),
    ("takt plan --d", {"--diff", "--diff-devices"}, {"--node"}),
    ("taktd --rt ", {"enforce", "try", "off"}, set()),
    ("takt nmt st", {"start", "stop"}, {"reset"}),
    ("takt-jog --vel", {"--velocity"}, set()),
    ("takt reference ", {"network-file", "device-data"}, set()),
    (f"takt plan {NET} --node ", {"shoulder", "elbow", "io"}, set()),
    ("taktd share/demo/two", {NET}, {"share/demo/one_axis.yaml"}),
)


def shells():
    for shell, ask in SHELLS.items():
        if not shutil.which(shell):
            print(f"skip  {shell} is not installed")
            continue
        for line, wanted, unwanted in CASES:
            done = ask(line)
            got = {proposal.split("\t")[0] for proposal in done.stdout.split("\n")}
            check(f"{shell}: '{line}'", wanted <= got and not unwanted & got, f"{sorted(got)} {done.stderr}")


def names():
    def of(kind, *more):
        return set(run(str(BIN / "takt"), "complete", kind, *more).stdout.split("\n"))
    check("nodes of a file", {"shoulder", "elbow", "io"} <= of("nodes", "--network", NET), of("nodes", "--network", NET))
    check("signals of a file", "shoulder.statusword" in of("signals", "--network", NET), of("signals", "--network", NET))
    objects = of("objects", "--network", NET, "--node", "elbow")
    check("objects of a node", "6041\tstatusword" in objects and not any(name.startswith("6411") for name in objects), objects)
    check("also by their names", {"statusword\t6041", "identity_object.vendor_id\t1018:01"} <= objects, objects)
    check("the simulated bus is an interface", "sim" in of("interfaces"), of("interfaces"))
    check("a file that is none gives no names", of("nodes", "--network", "none.yaml") == {""}, of("nodes", "--network", "none.yaml"))


def without_a_bus():
    done = run(str(BIN / "takt"), "complete", "nodes")
    check("without a bus there are no names", done.stdout == "" and done.returncode in (0, 3), done)


with tempfile.TemporaryDirectory() as home:
    ENV["HOME"] = home  # fish writes there
    shells()
    names()
    without_a_bus()
sys.exit(bool(failures))
