#!/bin/sh
# test.sh - runs everything that CI runs and prints one line for each stage; at the end it prints the count. Exit code 0: all tests
# passed.
#   TAKT_STAGES  only these stages of: format release asan tsan fuzz tidy alone mutation trajectories packages. Without this variable, all
#                stages run but the last four, which belong to a release. They compile each source alone, compile 200 changed copies,
#                plan 10^8 trajectories, and build the Debian packages twice and install them into a new Debian, which needs root.
#   TAKT_FUZZ    seconds of the stage fuzz for EDS files; half of it for network files, a third for each other target (60)
#   TAKT_PCH     OFF: no precompiled headers
#   TAKT_JOBS    parallel jobs (number of processors)
set -u
cd "$(dirname "$0")/.." || exit 1
sh share/install_packages.sh build run wheel test || exit 1

stages=${TAKT_STAGES:-format release asan tsan fuzz tidy}
jobs=${TAKT_JOBS:-$(nproc)}
logs=build/test-logs
# ccache reuses what another checkout on this machine has compiled.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1
mkdir -p $logs
passed=0
failed=0
failed_logs=

sources() { find eds_parser master apps test share/include \( -name '*.hpp' -o -name '*.cpp' \) -print; }

# counts LOG: "PASSED FAILED" of the line that run_tests has added.
counts() { sed -n 's/^all tests: \([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$1" | tail -n 1; }

# Prints the output of the failed tests without the checks that passed, at most 100 lines of each test.
failed_tests() {
  awk '/^ *[0-9]+\/[0-9]+ Test +#/ { left = /\*\*\*/ && !/\*\*\*Skipped/ ? 100 : 0 }
       /^ +Start +[0-9]+: / || /^[0-9]+% tests passed/ { left = 0 }
       /^(ok |\[ RUN |\[ +OK )/ { next }
       left > 0 { print; left-- }' "$1"
}

# Shows the important part of the log of a failed stage.
explain() {
  echo "--- $1"
  grep -nE 'error:|Failure|\*\*\*|ERROR: |SUMMARY: |WARNING: ThreadSanitizer' "$1" | head -n 40
  echo "--- its failed tests"
  failed_tests "$1"
  echo "--- its end"
  tail -n 20 "$1"
}

# stage NAME COMMAND... - runs the command. It counts as one test, or, if the command is ctest, as the number of its tests.
stage() {
  name=$1
  log=$logs/$1.log
  shift
  started=$(date +%s)
  printf '%-16s' "$name"
  if "$@" >"$log" 2>&1; then good=1 bad=0; else good=0 bad=1; fi
  verdict=$bad
  counts=$(counts "$log")
  if [ -n "$counts" ]; then
    good=${counts% *}
    bad=${counts#* }
    [ "$verdict" -ne 0 ] && [ "$bad" -eq 0 ] && bad=1
  fi
  passed=$((passed + good))
  failed=$((failed + bad))
  [ "$verdict" -eq 0 ] && word=good || word=FAILED
  printf '%-7s %4d s   %d passed, %d failed\n' $word $(($(date +%s) - started)) "$good" "$bad"
  [ "$verdict" -eq 0 ] || failed_logs="$failed_logs $log"
  return "$verdict"
}

check_format() { sources | xargs clang-format-19 --dry-run -Werror; }

# read_sources SCRIPT BUILD OPTION... - reads sources without precompiled headers, because clang can't read those of GCC. A source
# that has passed before is not read again.
read_sources() {
  script=$1
  build=$2
  shift 2
  cmake --preset release -B "$build" -DTAKT_PCH=OFF -DTAKT_GROUPS=OFF -DTAKT_TESTS=OFF "$@" &&
    ninja -C "$build" takt_lcm_headers && python3 "test/house/$script.py" "$build" "$jobs"
}
check_tidy() { read_sources tidy build/tidy -DTAKT_UNITY=ON; }
# Proves that each source includes what it uses, because the other builds compile the sources of a library together. Each run of the
# tests checks the includes by names (test/house/check_includes.py).
check_alone() { read_sources alone build/alone -DTAKT_UNITY=OFF -DTAKT_WERROR=ON; }

# The copy of the tree and its programs stay in build/mutation, so a second run compiles only what has changed.
check_mutation() { python3 test/mutation/mutate.py --seed 1 --count 200 --jobs "$jobs"; }

# Compares trajectories with those of ruckig. CI compares a million of them (test/motion/judge_trajectories.py).
check_trajectories() {
  python3 test/motion/judge_many.py --cases 100000000 && python3 test/motion/judge_many.py --cases 1000000 --class "wide limits"
}

# The second build is in another folder and compiles everything again; its packages must have the same bytes.
check_packages() {
  first=build/packages
  second=build/packages-again
  rm -rf "$first" "$second"
  sh share/package.sh "$first" && CCACHE_DISABLE=1 sh share/package.sh "$second" || return 1
  for package in "$first"/*.deb; do cmp "$package" "$second/${package##*/}" || return 1; done
  sh test/house/package_test.sh "$first"
}

# build PRESET COMPILER [TARGET...]. Warnings are errors in release and fuzz, which compile all files.
build() {
  preset=$1
  compiler=$2
  shift 2
  [ "$preset" = release ] && benchmarks=ON || benchmarks=OFF
  [ "$preset" = tsan ] && werror=OFF || werror=ON
  cmake --preset "$preset" -DCMAKE_CXX_COMPILER="$compiler" -DTAKT_TESTS=ON -DTAKT_BENCHMARKS=$benchmarks \
    -DTAKT_WERROR=$werror -DTAKT_UNITY=ON -DTAKT_PCH="${TAKT_PCH:-ON}" && ninja -C "build/$preset" -j "$jobs" "$@"
}

# Each benchmark runs for about a second and must not fail. Its output is no measurement: use sh test/bench/run.sh for that.
run_benchmarks() {
  bin=build/release/bin
  $bin/pdo_benchmark --benchmark_min_time=0.1 && $bin/trajectory_cost --benchmark_min_time=0.1 &&
    $bin/beat_cost --benchmark_min_time=0.1 && $bin/envelope_cost --benchmark_min_time=0.1 && $bin/loop_cost 8 &&
    $bin/sync_lateness 1 1000 && $bin/virtual_factor 5000 && $bin/eds_speed share/eds/takt_drive402.eds
}

fuzz() {
  seconds=${TAKT_FUZZ:-60}
  build fuzz clang++-19 takt_fuzz_targets || return 1
  # All runs use one seed, so a finding comes from a change and not from chance. Longer runs with other seeds belong to a release.
  {
    echo "eds $seconds -dict=test/fuzz/eds.dict"
    echo "network $((seconds / 2)) -dict=test/fuzz/network.dict"
    for target in bus trace recording message broker text; do echo "$target $((seconds / 3)) -seed=1"; done
  } | xargs -P "$jobs" -L 1 sh test/fuzz/fuzz_one.sh
}

# run_tests PRESET [CTEST OPTION...]. Each run of run_gtest.py is one test for ctest; the count includes all its tests.
run_tests() {
  preset=$1
  shift
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$jobs" "$@" >"$logs/$preset-ctest.log" 2>&1
  code=$?
  cat "$logs/$preset-ctest.log"
  {
    sed -n 's/.* passed, \([0-9]*\) tests failed out of \([0-9]*\)$/ctest \2 \1/p' "$logs/$preset-ctest.log" | tail -n 1
    cat "build/$preset/Testing/Temporary/LastTest.log"
  } | awk '/^ctest [0-9]+ [0-9]+$/ { failed += $3; passed += $2 - $3 }
           /^tests: [0-9]+ passed, [0-9]+ failed$/ { passed += $2; failed += $4; if ($4 > 0) failed--; else passed-- }
           END { printf "all tests: %d passed, %d failed\n", passed, failed }'
  return $code
}

for wanted in $stages; do
  case $wanted in
    format) stage format check_format ;;
    tidy) stage tidy check_tidy ;;
    alone) stage alone check_alone ;;
    mutation) stage mutation check_mutation ;;
    trajectories) stage trajectories check_trajectories ;;
    packages) stage packages check_packages ;;
    release)
      if stage release-build build release c++; then
        stage release-tests run_tests release
        stage benchmarks run_benchmarks
      fi
      ;;
    # The tests under ASan and UBSan and the fuzz targets are programs of one build, because the preset fuzz is the preset asan with clang.
    asan) stage asan-build build fuzz clang++-19 takt_host_tests && stage asan-tests run_tests fuzz -L host ;;
    fuzz) stage fuzz fuzz ;;
    tsan) stage tsan-build build tsan c++ takt_threaded_tests taktd takt takt-follow takt-home takt-jog takt-logic takt-move && stage tsan-tests run_tests tsan -L threaded ;;
    *) echo "no stage $wanted" >&2 && exit 2 ;;
  esac
done
for log in $failed_logs; do explain "$log"; done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
