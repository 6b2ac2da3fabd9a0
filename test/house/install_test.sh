#!/bin/sh
# install_test.sh BUILD - installs BUILD below a temporary prefix and builds an application outside the tree against it,
# by find_package and by pkg-config; both must run.
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
prefix=$tmp/prefix
cmake --install "$build" --prefix "$prefix" >/dev/null

for file in bin/takt bin/taktd bin/takt-move lib/systemd/system/taktd@.service lib/systemd/network/60-takt-can.link \
  etc/security/limits.d/takt.conf share/takt/lcm/image_t.lcm share/takt/demo/two_axes.yaml; do
  [ -e "$prefix/$file" ] || { echo "not installed: $file" >&2; exit 1; }
done
eds=$(find "$prefix/share/takt/eds" -name '*drive*.eds' | head -n 1)

# Headers must stand on their own: the tree is not to be found from here.
cp -r "$here/outside" "$tmp/outside"
cmake -S "$tmp/outside" -B "$tmp/by_cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$tmp/by_cmake" >"$tmp/log" || { cat "$tmp/log" >&2; exit 1; }
"$tmp/by_cmake/outside" "$eds"

pc=$(dirname "$(find "$prefix" -name takt.pc)")
flags=$(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs takt)
# shellcheck disable=SC2086 # flags, one word each
c++ "$tmp/outside/main.cpp" -o "$tmp/by_pkg_config" $flags
"$tmp/by_pkg_config" "$eds"
