#!/bin/sh
# fuzz_one.sh NAME SECONDS OPTION... - runs build/fuzz/bin/NAME_fuzz on test/fuzz/seeds/NAME and earlier finds.
# What this run finds new is kept beside the build, so that the next one goes on from there. Runs beside others of its kind:
# prints its whole log when it ends.
set -eu
name=$1 seconds=$2
shift 2
mkdir -p "build/fuzz/corpus/$name"
log=build/fuzz/$name.log
code=0
"build/fuzz/bin/${name}_fuzz" "build/fuzz/corpus/$name" "test/fuzz/seeds/$name" -max_total_time="$seconds" -timeout=60 \
  -rss_limit_mb=1500 -artifact_prefix="build/fuzz/$name-" -print_final_stats=1 "$@" >"$log" 2>&1 || code=$?
echo "--- $name"
cat "$log"
exit "$code"
