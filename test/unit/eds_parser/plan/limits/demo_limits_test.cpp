// The networks that people copy from declare what may be commanded.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

TEST(Demos, WithSetPointsDeclareLimits) {
  for (const char* name : {"astraada_drv28", "beckhoff", "lenze8400", "lenze8400_sync", "one_axis",
                           "plain301", "sixteen_nodes", "two_axes"}) {
    const LoadedNetwork network =
        load_network(std::string{TAKT_SOURCE_DIR} + "/share/demo/" + name + ".yaml");
    EXPECT_FALSE(network.plan.limits.outputs.empty()) << name;
    EXPECT_TRUE(std::ranges::any_of(network.plan.limits.lines, [](const LimitLine& line) {
      return line.source == LimitSource::file;
    })) << name;
  }
}

}  // namespace
}  // namespace takt
