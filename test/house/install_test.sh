#!/bin/sh
# install_test.sh BUILD - installs BUILD below a temporary prefix. Then the public headers compile alone, and the programs outside the
# tree build against the installation, by find_package and by pkg-config, and run. The example of the README waits for its bus.
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d)
started=
end() {
  for id in $started; do kill "$id" 2>/dev/null && wait "$id" || true; done
  rm -rf "$tmp"
}
trap end EXIT
prefix=$tmp/prefix
cmake --install "$build" --prefix "$prefix" >/dev/null

for file in bin/takt bin/taktd bin/takt-follow bin/takt-home bin/takt-jog bin/takt-logic bin/takt-move lib/systemd/system/taktd@.service lib/systemd/network/60-takt-can.link \
  etc/security/limits.d/takt.conf share/takt/lcm/image_t.lcm share/takt/python/first_motion.py share/takt/python/takt_axes.py share/takt/python/takt/py.typed share/takt/demo/two_axes.yaml share/doc/takt/index.md \
  share/doc/takt/CHANGELOG.md share/takt/network.schema.json share/man/man1/takt.1 share/man/man1/takt-plan.1 \
  share/man/man8/taktd.8 share/bash-completion/completions/takt-jog share/fish/vendor_completions.d/taktd.fish share/zsh/site-functions/_takt; do
  [ -e "$prefix/$file" ] || { echo "not installed: $file" >&2; exit 1; }
done
! grep -n '](\.\./' "$prefix"/share/doc/takt/*.md >&2 || { echo "an installed page links to a file of the tree" >&2; exit 1; }

# The installed Python package needs only the types of lcm-gen, like the package in the tree.
lcm-gen -p --ppath "$tmp/python" "$prefix"/share/takt/lcm/*.lcm
mkdir "$tmp/double" && echo 'class LCM: pass' >"$tmp/double/lcm.py"
(cd / && PYTHONPATH=$prefix/share/takt/python:$tmp/python:$tmp/double python3 -c 'import takt; takt.Axes, takt.Bus, takt.image_t().encode()')

# A program finds its files relative to its own path: no installed file contains the path of the sources.
root=$(cd "$here/../.." && pwd)
! grep -rlF "$root" "$prefix" >&2 || { echo "the path of the sources is in these files" >&2; exit 1; }

# systemd understands each line of the unit, and restarts taktd without a limit.
unit="$prefix/lib/systemd/system/taktd@.service"
sed '/^\[Service\]/,$d' "$unit" | grep -qx 'StartLimitIntervalSec=0' || { echo "taktd@.service gives up" >&2; exit 1; }
if command -v systemd-analyze >/dev/null; then
  sed "s|^ExecStart=taktd|ExecStart=$prefix/bin/taktd|" "$unit" >"$tmp/taktd@lift.service"
  complaints=$(systemd-analyze verify "$tmp/taktd@lift.service" 2>&1) || true
  [ -z "$complaints" ] || { echo "$complaints" >&2; exit 1; }
fi

# Only the public headers and the LCM types are installed.
(cd "$prefix/include" && find . -type f | sort) >"$tmp/installed"
{ cd "$here/../../share/include" && find ./takt -name '*.hpp'; cd "$prefix/share/takt/lcm" && ls | sed 's|\(.*\)\.lcm|./takt/\1.hpp|'; } |
  sort >"$tmp/public"
diff "$tmp/public" "$tmp/installed" >&2 || { echo "these are not the public headers" >&2; exit 1; }

# Each public header compiles alone, without a warning. The compiler does not find the tree from this folder. (The LCM types are made
# by lcm-gen.)
pc=$(dirname "$(find "$prefix" -name takt.pc)")
flags=$(PKG_CONFIG_PATH=$pc pkg-config --cflags takt)
mkdir -p "$tmp/types/takt"
mv "$prefix"/include/takt/*_t.hpp "$tmp/types/takt"
for header in "$prefix"/include/takt/*.hpp; do
  for compiler in c++ clang++-19; do
    command -v $compiler >/dev/null || continue
    # shellcheck disable=SC2086 # flags, one word each
    echo "#include <takt/$(basename "$header")>" | $compiler $flags -isystem "$tmp/types" -isystem /usr/include/eigen3 \
      -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -x c++ - ||
      { echo "$compiler: takt/$(basename "$header") does not compile alone" >&2; exit 1; }
  done
done
mv "$tmp"/types/takt/* "$prefix/include/takt"

cp -r "$here/outside" "$tmp/outside"
cmake -S "$tmp/outside" -B "$tmp/by_cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$tmp/by_cmake" >"$tmp/log" || { cat "$tmp/log" >&2; exit 1; }
one_axis=$prefix/share/takt/demo/one_axis.yaml
"$tmp/by_cmake/in_process" "$one_axis" virtual

flags=$(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs takt)
# shellcheck disable=SC2086 # flags, one word each
c++ "$tmp/outside/in_process.cpp" -o "$tmp/by_pkg_config" $flags
"$tmp/by_pkg_config" "$one_axis" sim

export LCM_DEFAULT_URL=tcpq://127.0.0.1:$((20000 + $$ % 12000))
demo=$prefix/share/takt/demo/two_axes.yaml
sed "s#\.\./eds/#$prefix/share/takt/eds/#; s/name: demo/name: other/" "$demo" >"$tmp/other.yaml"
"$prefix/bin/taktd" "$tmp/other.yaml" --bus sim --lcm-url "$LCM_DEFAULT_URL" 2>"$tmp/hub" &  # the other programs use this hub
hub=$!
started=$hub
until grep -q 'the network is ready' "$tmp/hub"; do kill -0 "$hub"; sleep 0.1; done
example_of_readme() { exec "$tmp/by_cmake/example" 2>>"$tmp/example_log"; }
example_of_readme &
example=$!
started="$example $hub"
sleep 2
"$prefix/bin/taktd" "$demo" --bus sim --lcm-url "$LCM_DEFAULT_URL" 2>"$tmp/demo_log" &
demo_bus=$!
started="$example $demo_bus $hub"  # the hub last
# The example ends if its newest image is stale. On a busy machine this happens after any pause of 10 ms, and the test then starts the
# example again.
for _ in $(seq 400); do
  if "$prefix/bin/takt" status --bus-name demo 2>"$tmp/status_log" | grep -q 'shoulder.*example [0-9a-f]*$'; then
    "$tmp/by_cmake/over_lcm" | grep -q '^shoulder position_actual_value .* rad$' && exit 0
    echo "the program over LCM does not print the position of an axis" >&2
    exit 1
  fi
  if ! kill -0 $example 2>/dev/null; then
    example_of_readme &
    example=$!
    started="$example $demo_bus $hub"
  fi
  sleep 0.5
done
echo "the example does not move the axes of a bus that comes after it" >&2
tail -n 20 "$tmp/hub" "$tmp/example_log" "$tmp/demo_log" "$tmp/status_log" >&2
exit 1
