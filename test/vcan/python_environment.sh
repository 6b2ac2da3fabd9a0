#!/bin/sh
# python_environment.sh DIR: the judges' virtual environment in DIR, made once for each
# requirements.txt; prints its interpreter.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
wanted=$(sha256sum "$here/requirements.txt" | cut -d' ' -f1)
if [ "$(cat "$1/.made_of" 2>/dev/null)" != "$wanted" ]; then
  rm -rf "$1"
  /usr/bin/python3 -m venv "$1"
  "$1/bin/pip" -q install --disable-pip-version-check --require-hashes --no-deps -r "$here/requirements.txt" >&2
  echo "$wanted" >"$1/.made_of"
fi
echo "$1/bin/python"
