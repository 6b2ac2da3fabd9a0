#include "apps/takt/simulate/program/virtual_lcm.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(VirtualLcm, KnowsWhichChannelsAreWanted) {
  const sim::World world{{}, {}};
  VirtualLcm lcm{world, sim::Random{1}};
  VirtualEndpoint& sender = lcm.join(10);
  VirtualEndpoint& receiver = lcm.join(10);
  receiver.subscribe("heard");

  EXPECT_TRUE(sender.wanted("heard"));
  EXPECT_FALSE(sender.wanted("hear"));

  receiver.close();
  EXPECT_FALSE(sender.wanted("heard"));
}

}  // namespace
}  // namespace takt
