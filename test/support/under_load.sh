#!/bin/sh
# Repeats tests of a build beside busy processes and counts the failures: no test may fail because the machine is busy.
#
#   test/support/under_load.sh [-n TIMES] [-b BUSY] [-d BUILD] [CTEST OPTION...]
#
#   -n  how often all tests run, default 50
#   -b  busy processes beside them, default 4
#   -d  the build, default build/release
#
# Examples:
#   sh test/support/under_load.sh -n 50 -L 'vcan|e2e|threaded'
#   sh test/support/under_load.sh -n 5 -j 2
#
# Exit code 0: no test failed. BUILD/under_load.log has the output of the failed tests.
set -u
times=50 busy=4 build=build/release
while [ $# -gt 1 ]; do
  case $1 in
    -n) times=$2 ;;
    -b) busy=$2 ;;
    -d) build=$2 ;;
    *) break ;;
  esac
  shift 2
done
log=$build/under_load.log
started=
end() {
  for id in $started; do kill "$id" 2>/dev/null; done
}
trap end EXIT
trap 'exit 130' INT TERM HUP
for _ in $(seq "$busy"); do
  while :; do :; done &
  started="$started $!"
done

: >"$log"
good=0 bad=0
for round in $(seq "$times"); do
  begun=$(date +%s)
  ctest --test-dir "$build" --output-on-failure --no-tests=error "$@" >"$log.round" 2>&1
  code=$?
  # "98% tests passed, 2 tests failed out of 100"
  counts=$(sed -n 's/.* passed, \([0-9]*\) tests failed out of \([0-9]*\)$/\1 \2/p' "$log.round" | tail -n 1)
  [ -n "$counts" ] || { cat "$log.round"; exit 2; }
  failed=${counts% *}
  [ "$code" -ne 0 ] && [ "$failed" -eq 0 ] && failed=1
  bad=$((bad + failed)) good=$((good + ${counts#* } - failed))
  echo "round $round of $times: $failed of ${counts#* } failed, $(($(date +%s) - begun)) s"
  [ "$failed" -eq 0 ] && continue
  cat "$log.round" >>"$log"
  sed -n '/^The following tests FAILED/,$ s/^[[:space:]]*[0-9]* - /    /p' "$log.round"
done
rm -f "$log.round"
echo "$good passed, $bad failed beside $busy busy processes"
[ "$bad" -eq 0 ]
