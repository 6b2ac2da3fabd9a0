#!/bin/sh
# python_verbs_test.sh BIN PYTHON - the verbs of the Python library on taktd and simulated devices.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
bin=$1 python=$2
tmp=$(mktemp -d)
daemon=
end() {
  [ -z "$daemon" ] || { kill "$daemon" && wait "$daemon"; } 2>/dev/null || true
  rm -rf "$tmp"
}
trap end EXIT
lcm-gen -p --ppath "$tmp" "$here"/share/lcm/*.lcm

export LCM_DEFAULT_URL=tcpq://127.0.0.1:$((20000 + $$ % 12000))
"$bin/taktd" "$here/test/house/python_verbs.yaml" --bus sim --lcm-url "$LCM_DEFAULT_URL" 2>"$tmp/log" &
daemon=$!
for _ in $(seq 600); do grep -q 'serving' "$tmp/log" && break || sleep 0.1; done
PYTHONPATH=$tmp:$here/apps/python timeout 300 "$python" "$here/test/house/python_verbs_on_bus.py" ||
  { cat "$tmp/log" >&2; exit 1; }
