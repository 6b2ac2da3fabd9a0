#!/bin/sh
# python_verbs_test.sh BIN PYTHON - tests the calls of the Python library with taktd and simulated devices.
. "$(dirname "$0")/python_on_bus.sh"
start_taktd "$here/test/house/python_verbs.yaml"
PYTHONPATH=$tmp:$here/apps/python timeout 300 "$python" "$here/test/house/python_verbs_on_bus.py" || { cat "$tmp/log" >&2; exit 1; }
