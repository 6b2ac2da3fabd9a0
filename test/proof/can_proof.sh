#!/bin/sh
# can_proof.sh LOOP_PROOF - the bus thread on vcan0, which goes down and comes up; and the traps catch there, too.
# Runs inside with-vcan.
set -u
"$1" --can vcan0 || { echo "the bus thread: exit code $?"; exit 1; }

for what in malloc:97 open:98 write:98; do
  "$1" --can vcan0 --break "${what%:*}"
  code=$?
  [ $code -eq "${what#*:}" ] || { echo "--break ${what%:*}: exit code $code, expected ${what#*:}"; exit 1; }
done
