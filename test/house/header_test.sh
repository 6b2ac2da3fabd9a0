#!/bin/sh
# header_test.sh BIN - checks that the header from `takt export header` compiles without a warning and has the right places of
# signals.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
for network in "$here"/share/demo/*.yaml; do
  "$1/takt" export header "$network" -o "$tmp" >"$tmp/written"
  c++ -std=c++17 -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -include "$(cat "$tmp/written")" -x c++ /dev/null
done
cat >"$tmp/check.cpp" <<'END'
#include <string_view>
#include "demo.hpp"
static_assert(demo::num_signals == 26 && demo::num_inputs == 16);
static_assert(demo::shoulder::target_position >= demo::num_inputs);
static_assert(std::string_view{demo::signals[demo::elbow::position_actual_value].name} == "position_actual_value");
static_assert(std::string_view{demo::signals[demo::elbow::position_actual_value].node} == "elbow");
static_assert(std::string_view{demo::signals[demo::elbow::position_actual_value].unit} == "rad");
END
c++ -std=c++17 -Wall -Werror -I"$tmp" -fsyntax-only "$tmp/check.cpp"
