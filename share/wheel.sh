#!/bin/sh
# wheel.sh [FOLDER] - builds the Python package takt-VERSION-py3-none-any.whl in FOLDER (default: build/), and prints its name. The
# script needs lcm-gen and the setuptools of Debian, but no network. The build is reproducible: the time in the file is
# SOURCE_DATE_EPOCH, otherwise 2026-01-01.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:-$root/build}
sh "$root/share/install_packages.sh" wheel >&2
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

# This is done in a copy: setuptools writes beside its sources, and the files in the wheel get the access rights of the sources.
mkdir -p "$tmp/apps" "$tmp/share"
cp -r "$root/apps/python" "$tmp/apps"
cp -r "$root/share/lcm" "$root/share/eds" "$tmp/share"
rm -rf "$tmp/apps/python/takt/__pycache__"  # the wheel contains only what pyproject.toml and setup.py name
find "$tmp" -type d -exec chmod 755 {} + -o -type f -exec chmod 644 {} +

cd "$tmp/apps/python"
umask 022
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-1767225600} PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c '
import pathlib, sys, setuptools.build_meta as backend
folder, name = sys.argv[1:]
pathlib.Path(name).write_text(backend.build_wheel(folder))' "$folder" "$tmp/name" >"$tmp/log" 2>&1 || { cat "$tmp/log" >&2; exit 1; }
echo "$folder/$(cat "$tmp/name")"
