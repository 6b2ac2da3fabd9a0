#!/bin/sh
# demo_test.sh BIN - runs the demo of the README. If possible, the demo runs in a separate network namespace without a route.
set -eu
cd "$(dirname "$0")/../.."
export TAKT_DEMO_BIN="$1" DEMO_SECONDS=5
alone=
for way in "unshare -n" "unshare -rn"; do
  [ -z "$alone" ] && $way true 2>/dev/null && alone=$way
done
log=$(mktemp)
fake=$(mktemp -d)
trap 'rm -rf "$log" "$fake"' EXIT

# The paths of a network file and of programs may be relative to the folder of the user.
mkdir "$fake/bin" && touch "$fake/net.yaml"
cat >"$fake/bin/taktd" <<'EOF'
#!/bin/sh
test -e "$1" || exit 2
trap 'exit 0' TERM
while :; do sleep 0.1; done
EOF
for program in takt takt-move; do printf '#!/bin/sh\n' >"$fake/bin/$program"; done
chmod +x "$fake"/bin/*
(cd "$fake" && DEMO_NETWORK=net.yaml TAKT_DEMO_BIN=bin sh "$OLDPWD/share/demo.sh") >"$log" || { cat "$log" && exit 1; }

if ! $alone sh share/demo.sh >"$log" 2>&1; then cat "$log" && exit 1; fi
cat "$log"
