#!/bin/sh
# python_libraries_test.sh PYTHON - tests the Python package and axes.py on buses in the process of the test, with many faults.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$1
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
lcm-gen -p --ppath "$tmp" "$here"/../../share/lcm/*.lcm
/usr/bin/python3 "$here/../../apps/python/object_names.py" "$here"/../../share/eds/*.eds >"$tmp/takt/objects.py"
for test in speed_test bus_test motions_test verbs_test profiles_test axes_faults; do "$python" "$here/python_$test.py" "$tmp"; done
