#!/bin/sh
# install_packages.sh PURPOSE... - installs the packages of share/packages.txt for a purpose (build, run, wheel, package, chroot or
# test) that this machine lacks. If nothing is to be installed, it prints nothing and needs no root rights.
set -eu
list=$(dirname "$0")/packages.txt
[ $# -gt 0 ] || { echo "usage: $0 build|run|wheel|package|chroot|test..." >&2; exit 2; }

wanted=
for purpose; do
  of_purpose=$(awk -v purpose="$purpose" '$1 == purpose { print $2 }' "$list")
  [ -n "$of_purpose" ] || { echo "$0: no packages for '$purpose' in $list" >&2; exit 2; }
  wanted="$wanted $of_purpose"
done

if ! command -v dpkg-query >/dev/null; then
  echo "This is not a Debian system: if the build misses something, see $list." >&2
  exit 0
fi
# shellcheck disable=SC2086 # package names, one word each
installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' || true)
missing=
for package in $wanted; do
  printf '%s\n' "$installed" | grep -qx -- "$package" || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Missing packages. As root:  apt-get install$missing" >&2; exit 1; }
  as_root=sudo
fi
echo "Installing Debian packages:$missing"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qy "$@" >"$log" 2>&1 </dev/null; }
# shellcheck disable=SC2086
install() { apt install --no-install-recommends $missing; }
# The package lists of a new or old system may lack a package. The lists are fetched only in this case.
# shellcheck disable=SC2086
if ! { apt install -s --no-install-recommends $missing && install; }; then
  apt update && install || { cat "$log" >&2; echo "apt-get failed (above)." >&2; exit 1; }
fi
