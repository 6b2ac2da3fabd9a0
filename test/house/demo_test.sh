#!/bin/sh
# demo_test.sh BIN - the demo of the README, in a network of its own without a route where that is possible. It is real
# time: where the machine itself stood still, which the demo tells, it has another try, three in all.
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

# A network and programs may be named from where the user is.
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

# A busy machine may stand still, or miss cycles, which stops the move.
busy="This machine stood still|its set-points were not sent in several cycles|SYNC was missing in several periods"
for _ in 1 2 3 4 5 6; do
  if $alone sh share/demo.sh >"$log" 2>&1; then cat "$log" && exit 0; fi
  cat "$log"
  grep -qE "$busy" "$log" || exit 1
done
exit 1
