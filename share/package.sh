#!/bin/sh
# package.sh [--arch arm64] [FOLDER] - builds the Debian packages takt, libtakt-dev and takt-doc in FOLDER (default: build/packages),
# and prints their names. The debian folder comes from share/debian; the sources are the files that git knows, or all files but .git
# and build. The build is reproducible: the time in the files is SOURCE_DATE_EPOCH, otherwise that of the newest commit. The
# findings of lintian go to stderr; if lintian reports an error, the exit code is 1.
# For another architecture, the script builds in a separate Debian system, because the LCM packages of two architectures can't be
# installed together. This needs root, and downloads about 500 MB.
#   TAKT_JOBS       parallel jobs (number of processors)
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
usage() { echo "usage: package.sh [--arch arm64] [FOLDER]" >&2; exit 2; }
native=$(dpkg --print-architecture)
arch=$native
if [ "${1:-}" = --arch ]; then
  arch=${2:-}
  [ "$arch" = "$native" ] || [ "$arch" = arm64 ] || usage
  shift 2
fi
case ${1:-} in -*) usage ;; esac
[ $# -le 1 ] || usage
folder=${1:-$root/build/packages}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
jobs=${TAKT_JOBS:-$(nproc)}
version=$(sed -n 's/^project(takt VERSION \([0-9.]*\) .*/\1/p' "$root/CMakeLists.txt")

if [ "$arch" = "$native" ]; then purposes="build package"; else purposes=chroot; fi
# shellcheck disable=SC2086 # one word each
sh "$root/share/install_packages.sh" $purposes >&2

umask 022
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
tree=$tmp/takt-$version
mkdir "$tree"

# The tree also has the files that only the tests need, as a clone has, because CMakeLists.txt names them.
list_files() {
  if [ -e .git ]; then
    git ls-files -z --cached --others --exclude-standard
  else
    find . -path ./.git -prune -o -path ./build -prune -o -type f -print0
  fi
}
(cd "$root" && list_files | tar --create --null --files-from=- --ignore-failed-read --warning=no-failed-read) | tar --extract --directory "$tree"
cp -r "$tree/share/debian" "$tree/debian"
find "$tree" -type d -exec chmod 755 {} + -o -type f -perm /100 -exec chmod 755 {} + -o -type f -exec chmod 644 {} +

commit_time() { git -C "$root" log -1 --format=%ct 2>/dev/null || date -ud "$(sed -n 's/^## \[.*\] - //p' "$root/CHANGELOG.md" | head -n 1)" +%s; }
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(commit_time)}
export SOURCE_DATE_EPOCH
find "$tree" -exec touch --no-dereference --date "@$SOURCE_DATE_EPOCH" {} +  # dpkg-deb leaves older times as they are
cat >"$tree/debian/changelog" <<END
takt ($version) bookworm; urgency=medium

  * Version $version: see changelog.gz.

 -- $(sed -n 's/^Maintainer: //p' "$tree/debian/control")  $(LC_ALL=C date -uRd "@$SOURCE_DATE_EPOCH")
END

options="parallel=$jobs nocheck"
# ccache reuses what another checkout has compiled.
build_here() {
  if command -v ccache >/dev/null; then
    CCACHE_DIR=$(ccache --get-config cache_dir) CCACHE_BASEDIR=$tree CCACHE_NOHASHDIR=1
    export CCACHE_DIR CCACHE_BASEDIR CCACHE_NOHASHDIR
  fi
  (cd "$tree" && DEB_BUILD_OPTIONS=$options dpkg-buildpackage -b -us -uc)
}

# for_target PACKAGE - the name of the package with the architecture, unless the package is the same for all architectures.
for_target() {
  case $(apt-cache show --no-all-versions "$1" | sed -n 's/^Architecture: //p') in
    all) echo "$1" ;;
    *) echo "$1:$arch" ;;
  esac
}

# Builds in a Debian system that has the compiler of this machine and the libraries of the other architecture. lcm-gen of this machine
# is unpacked into a folder. The programs write their manual pages and completions under an emulator.
build_there() {
  other=$tmp/root
  included=cmake,crossbuild-essential-$arch,debhelper,ninja-build,pkgconf:$arch,qemu-user-static
  for library in $(awk '$1 == "build" && $2 ~ /-dev$/ { print $2 }' "$root/share/packages.txt"); do
    included=$included,$(for_target "$library")
  done
  mmdebstrap --variant=apt --architectures="$native,$arch" --include="$included" bookworm "$other" &&
    chroot "$other" sh -ec "cd /tmp && apt-get -qq download liblcm-bin:$native && dpkg-deb -x liblcm-bin_*.deb /opt/lcm-gen" &&
    mv "$tree" "$other/tmp/tree" || return 1
  tree=$other/tmp/tree
  chroot "$other" env SOURCE_DATE_EPOCH="$SOURCE_DATE_EPOCH" DEB_BUILD_OPTIONS="$options" \
    TAKT_CMAKE="-DLCM_GEN=/opt/lcm-gen/usr/bin/lcm-gen -DCMAKE_CROSSCOMPILING_EMULATOR=/usr/bin/qemu-aarch64-static" \
    sh -c "cd /tmp/tree && dpkg-buildpackage -b -us -uc -d -a$arch"
}

log=$folder/build-$arch.log
if [ "$arch" = "$native" ]; then way=build_here; else way=build_there; fi
$way >"$log" 2>&1 || { tail -n 60 "$log" >&2; exit 1; }
built=$(dirname "$tree")
names=$(cd "$built" && ls takt_*_"$arch".deb libtakt-dev_*_"$arch".deb takt-doc_*_all.deb)
for name in $names; do mv "$built/$name" "$folder"; done
cd "$folder"
# shellcheck disable=SC2086 # names, one word each
if [ "$arch" = "$native" ]; then lintian --fail-on error --tag-display-limit 0 $names >&2 || exit 1; fi
for name in $names; do echo "$folder/$name"; done
