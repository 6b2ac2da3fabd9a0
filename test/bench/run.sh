#!/bin/sh
# Builds and runs the benchmarks and prints the table of share/doc/performance.md in Markdown.
#   sh test/bench/run.sh [BUILD_FOLDER]
# Installs the packages that are missing.
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$source/build/bench}
programs="pdo_benchmark loop_cost sync_lateness virtual_factor eds_speed"

sh "$source/share/install_packages.sh" build test >&2
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTAKT_BENCHMARKS=ON >/dev/null
# shellcheck disable=SC2086
cmake --build "$build" --target $programs >&2
bin=$build/bin

row() { printf '| %s | %s | %s |\n' "$1" "$2" "$3"; }

# nanoseconds of processor time of one benchmark
nanoseconds() {
  "$bin/pdo_benchmark" --benchmark_filter="^$1\$" --benchmark_format=csv \
    --benchmark_repetitions=5 --benchmark_report_aggregates_only=true 2>/dev/null |
    awk -F, -v per="$2" '$1 ~ /_median"?$/ { printf "%.1f ns", $4 / per }'
}

# instructions of one cycle, the port not counted
instructions() {
  valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file=/dev/null \
    "$bin/loop_cost" "$@" 2>&1 >/dev/null | awk '/Collected/ { printf "%d", $NF / 100 }'
}

echo "| what | takt | peer (Lely; measured earlier on a machine of this kind, not in this run) |"
echo "|---|---|---|"
row "unpack a PDO of eight u8" "$(nanoseconds unpack_pdo 1)" "1,050 ns"
row "receive that PDO: look-up, length, expected set, values" "$(nanoseconds receive_pdo 1)" "1,050 ns"
row "send a PDO of eight u8, each a new command" "$(nanoseconds send_pdo 32)" "666-762 ns"

for nodes in 1 8 32 120; do
  case $nodes in 1) peer=21,892 ;; 8) peer=116,075 ;; 32) peer=451,975 ;; *) peer=- ;; esac
  row "instructions a cycle, $nodes nodes, TPDO and RPDO of eight u8" "$(instructions "$nodes")" "$peer"
done
few=$(instructions 8 --receive-path)
many=$(instructions 120 --receive-path)
row "instructions per received PDO, receive call to published image" "$(((many - few) / 112))" "13,700"

for nodes in 1 8 32 120; do
  # The peer was measured at 1, 8 and 32 nodes; its allocations, with drivers, at 8 and 32.
  case $nodes in
  1) peer_calls=13 peer_allocations=- ;;
  8) peer_calls=27 peer_allocations=72 ;;
  32) peer_calls=75 peer_allocations=288 ;;
  *) peer_calls=- peer_allocations=- ;;
  esac
  counts=$("$bin/loop_cost" "$nodes")
  calls=$(echo "$counts" | sed 's/.*: \([0-9.]*\) system calls.*/\1/')
  most=$(echo "$counts" | sed 's/.*at most \([0-9]*\) .*/\1/')
  allocations=$(echo "$counts" | sed 's/.*, \([0-9.]*\) allocations/\1/')
  row "system calls a cycle, $nodes nodes (with a missing PDO)" "$calls ($most)" "$peer_calls"
  row "allocations a cycle, $nodes nodes" "$allocations" "$peer_allocations"
done

"$bin/sync_lateness" 2>/dev/null | while IFS= read -r line; do
  row "SYNC lateness, ${line%%:*}" "${line#*: }" "-"
done
"$bin/virtual_factor" | while IFS= read -r line; do
  row "virtual time, ${line%%:*}" "${line#*: }" "-"
done
"$bin/eds_speed" | while IFS= read -r line; do
  row "reading a ${line%%:*}" "${line#*: }" "4.6 MB/s"
done
