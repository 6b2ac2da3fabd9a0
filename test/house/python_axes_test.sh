#!/bin/sh
# python_axes_test.sh BIN PYTHON - checks that the Python examples move axes of the demo.
. "$(dirname "$0")/python_on_bus.sh"
start_taktd "$here/share/demo/two_axes.yaml"
PYTHONPATH=$tmp timeout 240 "$python" "$here/apps/python/axes.py" demo 2 >"$tmp/said" 2>&1 || fails
motion() { PYTHONPATH=$tmp timeout 240 "$python" "$here/apps/python/motion.py" demo "$@" >"$tmp/said" 2>&1; }
moves() { motion shoulder 1.5 --velocity 3 --acceleration 20 && grep -q '^the motion is done: shoulder is at 1\.[45]' "$tmp/said"; }
jogs() { motion elbow --jog -1 --for 1 --velocity 2 --acceleration 20; grep -q '^the motion has stopped: elbow is at -' "$tmp/said"; }
refuses() { ! motion shoulder 150 --velocity 3 --acceleration 20 && grep -q 'would leave its range' "$tmp/said"; }
moves || fails
jogs || fails
refuses || fails
first() { PYTHONPATH=$tmp timeout 240 "$python" "$here/apps/python/first_motion.py" >"$tmp/said" 2>&1; }
first || fails
homes() {
  PYTHONPATH=$tmp:$here/apps/python timeout 240 "$python" -c 'from takt_axes import Axes
with Axes("demo", "shoulder", "elbow") as axes:
    axes.home(together=True)
    print(axes.homed)' >"$tmp/said" 2>&1 && grep -q '^\[True, True\]' "$tmp/said"
}
homes || fails
# An inverter is an axis, too. Its program stops the inverter, and taktd stops it when the program has ended.
start_taktd "$here/share/demo/astraada_drv28.yaml"
runs() {
  PYTHONPATH=$tmp timeout 240 "$python" "$here/apps/python/first_speed.py" >"$tmp/said" 2>&1
  grep -qF "['pump'] [20.0] ['Hz']" "$tmp/said"
}
runs || fails
