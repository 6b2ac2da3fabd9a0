#!/bin/bash
# clock_test.sh WITH_VCAN LIBRARIES - the clock that with-vcan -v gives to a guest: it goes on by itself while the guest
# has nothing to do, it stands still while the host stops the guest, and it advances while the guest computes.
# Exit code 77: this is no x86 processor, and user-mode-linux is not there.
set -u
case $(uname -m) in x86_64 | i?86) ;; *) exit 77 ;; esac
with_vcan=$1
export WITH_VCAN_LIBRARIES=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

check() { # WHAT TEST...
  local what=$1
  shift
  if "$@"; then echo "ok    $what"; return; fi
  echo "FAIL  $what"
  cat "$folder/said"
  failures=$((failures + 1))
}

guest() { "$with_vcan" "$@" >"$folder/said" 2>&1; }

cat >"$folder/clock.sh" <<'END'
sleep 5000 && echo "it slept"
/usr/bin/python3 -c '
import time
end = time.monotonic() + 0.2
while time.monotonic() < end:
    pass' && echo "it computed"
while :; do :; done &
sleep 0.5 && kill $! && echo "it was interrupted"
END
begun=$SECONDS
check "a guest ends" guest -v -t 100000 sh "$folder/clock.sh"
check "its clock goes on while it has nothing to do" grep -q "it slept" "$folder/said"
check "and 5,000 s of that take less than 5,000 s of the machine" test $((SECONDS - begun)) -lt 5000
check "its clock advances while it computes" grep -q "it computed" "$folder/said"
check "a process that never asks for anything is interrupted" grep -q "it was interrupted" "$folder/said"
check "the time limit is one of the guest" bash -c '"$1" -v -t 5 sleep 100; [ $? -eq 124 ]' - "$with_vcan"

# The longest gap that a guest finds in its own clock while the host stops it for three seconds.
cat >"$folder/gaps.py" <<'END'
import pathlib, sys, time
folder = pathlib.Path(sys.argv[1])
longest, last = 0, time.monotonic()
(folder / "begun").touch()
while not (folder / "stopped").exists():
    time.sleep(0.001)
    now = time.monotonic()
    longest, last = max(longest, now - last), now
print("the longest gap has", round(longest * 1000), "ms")
sys.exit(longest > 1)
END
cat >"$folder/kernel" <<END
#!/bin/sh
echo \$\$ >"$folder/process"
exec ${WITH_VCAN_KERNEL:-linux.uml} "\$@"
END
chmod 755 "$folder/kernel"
stop_the_guest() {
  until [ -e "$folder/begun" ]; do sleep 0.1; done
  kill -STOP "$(cat "$folder/process")"
  sleep 3
  kill -CONT "$(cat "$folder/process")"
  touch "$folder/stopped"
}
stop_the_guest & stopper=$!
WITH_VCAN_KERNEL=$folder/kernel check "it does not see that the host stopped it for 3 s" \
  guest -v -t 100000 /usr/bin/python3 "$folder/gaps.py" "$folder"
kill $stopper 2>/dev/null
cat "$folder/said"
[ $failures -eq 0 ]
