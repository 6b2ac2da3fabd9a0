# python_on_bus.sh - read by tests that run Python programs beside a taktd with simulated devices; $1 BIN, $2 PYTHON.
# Leaves bin, python, here (the root of the sources) and tmp, which has the message types of LCM for Python.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
bin=$1 python=$2
tmp=$(mktemp -d)
daemon=
end_taktd() { [ -z "$daemon" ] || { kill "$daemon" && wait "$daemon"; } 2>/dev/null || true; daemon=; }
trap 'end_taktd; rm -rf "$tmp"' EXIT
lcm-gen -p --ppath "$tmp" "$here"/share/lcm/*.lcm
export LCM_DEFAULT_URL=tcpq://127.0.0.1:$((20000 + $$ % 12000))

fails() { cat "$tmp"/log "$tmp"/said >&2; exit 1; }

# start_taktd NETWORK - ends the previous taktd and starts another one, which is ready when the function returns.
start_taktd() {
  end_taktd
  "$bin/taktd" "$1" --bus sim --lcm-url "$LCM_DEFAULT_URL" 2>"$tmp/log" &
  daemon=$!
  for _ in $(seq 600); do
    grep -q 'the network is ready' "$tmp/log" && return
    sleep 0.1
  done
  echo "taktd is not ready within 60 s" >&2
  fails
}
