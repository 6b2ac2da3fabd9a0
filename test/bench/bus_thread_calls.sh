#!/bin/sh
# bus_thread_calls.sh BIN - strace counts the system calls of the bus thread of a real taktd on a unix: bus, while
# takt-move moves the axes. This checks the number that loop_cost counts at the port. Needs strace.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
bin=$(cd "$1" && pwd)
tmp=$(mktemp -d)
daemon= devices= move=
end() {
  for pid in $move $daemon $devices; do kill "$pid" && wait "$pid"; done 2>/dev/null || true
  rm -rf "$tmp"
}
trap end EXIT

sed -e "s|\.\./eds/|$here/share/eds/|" -e 's/sync_period: 2000 /sync_period: 20000 /' \
  "$here/share/demo/two_axes.yaml" >"$tmp/network.yaml"
export LCM_DEFAULT_URL=tcpq://127.0.0.1:$((20000 + $$ % 12000))
"$bin/takt" sim "$tmp/network.yaml" --bus "unix:$tmp/bus" 2>"$tmp/devices" &
devices=$!
for _ in $(seq 50); do grep -q 'devices on' "$tmp/devices" && break || sleep 0.1; done
"$bin/taktd" "$tmp/network.yaml" --bus "unix:$tmp/bus" --lcm-url "$LCM_DEFAULT_URL" 2>"$tmp/log" &
daemon=$!
for _ in $(seq 300); do [ "$(grep -c 'ready after' "$tmp/log")" -ge 3 ] && break || sleep 0.1; done
"$bin/takt-move" --sine --for 60s >"$tmp/move" 2>&1 &
move=$!
for _ in $(seq 100); do grep -q 'sine of' "$tmp/move" && break || sleep 0.1; done

thread=$(grep -lx takt-bus /proc/"$daemon"/task/*/comm | cut -d/ -f5)
timeout 10 strace -xx -s 64 -p "$thread" -o "$tmp/calls" 2>/dev/null || true
python3 "$here/test/bench/bus_thread_calls.py" "$tmp/calls"
