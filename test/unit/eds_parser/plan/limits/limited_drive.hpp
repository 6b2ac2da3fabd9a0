#pragma once
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <string_view>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt::test {

inline constexpr std::string_view units =
    "    units:\n"
    "      position: {scale: 0.001, unit: rad}\n"
    "      velocity: {scale: 0.01, unit: rad/s}\n"
    "      acceleration: {scale: 0.1, unit: rad/s^2}\n";

/// Compiles a network with a cycle of 2 ms and a drive whose RPDO2 carries `mapped`, with the given
/// limits and units.
inline Compiled drive(const std::string& limits, const std::string& mapped = "{index: 0x607A}",
                      std::string_view its_units = units, const std::string& eds = tiny_eds()) {
  return compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    tpdo: {1: {mapping: [{index: 0x6041}, {index: 0x6064}]}}\n"
      "    rpdo: {2: {enabled: true, cob_id: auto, mapping: [{index: 0x6040}, " +
          mapped + "]}}\n" + std::string{its_units} + limits,
      eds);
}

inline const OutputLimit& only(const Compiled& net) {
  EXPECT_EQ(net.plan.limits.outputs.size(), 1U);
  return net.plan.limits.outputs.at(0);
}

inline std::string text_of(const Compiled& net) {
  std::ostringstream out;
  print_plan_text(out, net.plan, {});
  return out.str();
}

inline std::string json_of(const Compiled& net) {
  std::ostringstream out;
  print_plan_json(out, net.plan, {});
  return out.str();
}

}  // namespace takt::test
