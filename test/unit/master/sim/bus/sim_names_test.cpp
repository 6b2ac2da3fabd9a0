#include "eds_parser/table/sim_names.hpp"

#include <gtest/gtest.h>

#include "master/sim/bus/faults.hpp"

namespace takt::sim {
namespace {

TEST(SimNames, EveryQuirkThatANetworkFileMayNameMeansSomething) {
  for (const std::string_view quirk : sim_quirks) {
    const bool feature = quirk == "loopback" || quirk == "event_timer_raster" || quirk == "lss" ||
                         quirk == "no_node_id";
    EXPECT_NE(fault_kind(quirk).has_value(), feature) << quirk;
  }
}

}  // namespace
}  // namespace takt::sim
