#!/bin/sh
# python_wheel_test.sh BIN PYTHON - tests the wheel of the Python package. Two builds without network give the same bytes. Programs
# outside the tree use the wheel, installed in a virtual environment, with a taktd. PYTHON has the module lcm.
. "$(dirname "$0")/python_on_bus.sh"
wheel=$(sh "$here/share/wheel.sh" "$tmp/first")
again=$(umask 077 && sh "$here/share/wheel.sh" "$tmp/second")
cmp "$wheel" "$again"

/usr/bin/python3 -m venv "$tmp/venv"
"$python" -c 'import lcm, pathlib; print(pathlib.Path(lcm.__file__).parent.parent)' >"$(echo "$tmp"/venv/lib/python3*/site-packages)/lcm.pth"
"$tmp/venv/bin/pip" -q install --no-index --disable-pip-version-check "$wheel"
mkdir "$tmp/programs"  # not beside the types that python_on_bus.sh has made
cp "$here/apps/python/first_motion.py" "$here/apps/python/first_bus.py" "$here/test/house/python_wheel_on_bus.py" "$tmp/programs"
run() { (cd / && timeout 240 "$tmp/venv/bin/python" "$@") >"$tmp/said" 2>&1 || fails; }

start_taktd "$here/share/demo/two_axes.yaml"
run "$tmp/programs/first_motion.py"
run "$tmp/programs/first_bus.py"
grep -q '^vendor 0x0000ABCD$' "$tmp/said" || fails
run "$tmp/programs/python_wheel_on_bus.py" demo

# On a bus with keys, whose images are signed, taktd answers nothing without the key, and everything with the key.
"$bin/takt" keys new "$tmp/plant.keys" --name plant >/dev/null
sed "s#\.\./eds/#$here/share/eds/#; s/{name: demo/{name: secret/" "$here/share/demo/two_axes.yaml" >"$tmp/secret.yaml"
echo "lcm: {keys: plant.keys, authenticate: images}" >>"$tmp/secret.yaml"
start_taktd "$tmp/secret.yaml"
run "$tmp/programs/python_wheel_on_bus.py" secret "$tmp/plant.keys"
