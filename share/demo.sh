#!/bin/sh
# demo.sh - from EDS files to axes that move: builds taktd and takt-move, runs the daemon on a simulated bus and moves two axes
# through LCM for about 15 s. It needs no CAN hardware and no network; it needs root rights only to install missing Debian packages.
#   DEMO_NETWORK  another network file        DEMO_SECONDS  seconds for which the axes move (15)
#   TAKT_DEMO_BIN  programs that have been built already
set -eu
from_here() {
  case $1 in '' | /*) printf %s "$1" ;; *) printf %s "$PWD/$1" ;; esac
}
network=$(from_here "${DEMO_NETWORK:-}")
TAKT_DEMO_BIN=$(from_here "${TAKT_DEMO_BIN:-}")
cd "$(dirname "$0")/.."
network=${network:-share/demo/two_axes.yaml}
seconds=${DEMO_SECONDS:-15}
build=build/release
say() { printf '\n== %s\n' "$*"; }

build_failed() {
  tail -n 60 $build/demo-build.log >&2
  exit 1
}

build_programs() {
  sh share/install_packages.sh build run
  say "Building taktd and takt-move (about two minutes the first time)"
  started=$(date +%s)
  mkdir -p $build && rm -f $build/demo-built
  # Builds without the tests, unless this folder has been configured before. The tool `takt` would double the time of the build.
  [ -e $build/build.ninja ] ||
    cmake --preset release -DTAKT_TESTS=OFF -DTAKT_PCH=ON -DTAKT_UNITY=ON >$build/demo-build.log 2>&1 || build_failed
  { ninja -C $build taktd takt-move && touch $build/demo-built; } 2>&1 | tee $build/demo-build.log |
    sed -un 's/^\(\[[0-9]*\(00\|25\|50\|75\)\/[0-9]*\]\).*/  \1/p'
  [ -e $build/demo-built ] || build_failed
  echo "built in $(($(date +%s) - started)) s"
}

[ -n "$TAKT_DEMO_BIN" ] || build_programs
PATH=${TAKT_DEMO_BIN:-$PWD/$build/bin}:$PATH

tmp=$(mktemp -d)
daemon=
end() {
  [ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true
  rm -rf "$tmp"
}
trap end EXIT
trap 'exit 130' INT TERM

# LCM uses the daemon's own hub on loopback, which needs no multicast route.
LCM_DEFAULT_URL=tcpq://127.0.0.1:$((20000 + $$ % 20000))
export LCM_DEFAULT_URL
ip -o link show lo 2>/dev/null | grep -q UP || ip link set lo up 2>/dev/null || true

say "taktd $network --bus sim   (the daemon: boots the devices, beats SYNC)"
{
  rc=0
  taktd "$network" --bus sim --lcm-url $LCM_DEFAULT_URL &
  echo $! >"$tmp/pid"
  wait $! || rc=$?
  echo $rc >"$tmp/taktd"
} 2>&1 | tee "$tmp/log" | sed -u 's/^/  taktd | /' &
log=$!
while [ ! -s "$tmp/pid" ]; do sleep 0.05; done
daemon=$(cat "$tmp/pid")
sleep 1

say "takt-move --for ${seconds}s   (an application: image in, set-points out, over LCM)"
{
  rc=0
  takt-move --for "${seconds}s" --wait 20 || rc=$?
  echo $rc >"$tmp/move"
} 2>&1 | sed -u 's/^/  move  | /'

if command -v takt >/dev/null; then
  say "takt status"
  takt status 2>&1 | sed 's/^/  /' || true
fi

say "SIGTERM to taktd: ordered stop"
kill "$daemon" 2>/dev/null || true
wait $log
daemon=

moved=$(cat "$tmp/move") stopped=$(cat "$tmp/taktd")
if [ "$moved" -eq 0 ] && [ "$stopped" -eq 0 ]; then
  say "Good: the axes followed (takt-move 0), the daemon stopped in order (taktd 0)."
  [ -n "$TAKT_DEMO_BIN" ] || echo "The tool: ninja -C $build takt && export PATH=$PWD/$build/bin:\$PATH"
  echo "Next: takt plan $network, takt top beside a running taktd, share/doc/tutorial.md."
  exit 0
fi
say "The demo failed: exit code $moved of takt-move, $stopped of taktd (exit codes: share/doc/command_line.md)."
missed=$(sed -n 's/.*: \([0-9][0-9]*\) cycles missed: .*/\1/p' "$tmp/log" | sort -n | tail -n 1)
if [ "${missed:-0}" -ge 100 ]; then
  echo "This computer missed $missed cycles in a row, which stops every motion. End other programs and try again."
fi
exit 1
