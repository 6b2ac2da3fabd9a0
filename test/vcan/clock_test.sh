#!/bin/bash
# clock_test.sh WITH_VCAN LIBRARIES PROBE - tests the clock that with-vcan -v gives to a guest. The clock advances while
# the guest is idle and while the guest computes, and does not advance while the host stops the guest. Exit code 77:
# this is no x86 processor, and user-mode-linux is not there.
set -u
case $(uname -m) in x86_64 | i?86) ;; *) exit 77 ;; esac
with_vcan=$1 probe=$3
export WITH_VCAN_LIBRARIES=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

check() { # WHAT TEST...
  local what=$1
  shift
  if "$@"; then echo "ok    $what"; return; fi
  echo "FAIL  $what"
  failures=$((failures + 1))
}

# The host stops the guest for three seconds while the guest looks for gaps in its clock.
cat >"$folder/clock.sh" <<END
sleep 5000 && echo "it slept"
"$probe" compute && echo "it computed"
while :; do :; done &
sleep 0.5 && kill \$! && echo "it was interrupted"
"$probe" gaps "$folder" && echo "no gap"
sleep 10000
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
begun=$SECONDS
WITH_VCAN_KERNEL=$folder/kernel "$with_vcan" -v -t 9000 sh "$folder/clock.sh" >"$folder/said" 2>&1
code=$?
kill $stopper 2>/dev/null
cat "$folder/said"
check "the clock of a guest goes on while that has nothing to do" grep -q "it slept" "$folder/said"
check "and 9,000 s of that take less than 9,000 s of the machine" test $((SECONDS - begun)) -lt 9000
check "its clock advances while it computes" grep -q "it computed" "$folder/said"
check "a process that never asks for anything is interrupted" grep -q "it was interrupted" "$folder/said"
check "it does not see that the host stopped it for 3 s" grep -q "no gap" "$folder/said"
check "the time limit is one of the guest: exit code $code" test $code -eq 124
[ $failures -eq 0 ]
