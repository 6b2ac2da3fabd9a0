#include "master/lcm/channel_names.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(Names, ChannelsAreInCapitals) {
  EXPECT_EQ(channel_name("lift", "IMAGE"), "LIFT_IMAGE");
  EXPECT_EQ(channel_name("can0", "STATUS"), "CAN0_STATUS");
  EXPECT_EQ(channel_name("my bus-2", "EVENT"), "MY_BUS_2_EVENT");
}

TEST(Names, ChannelsStayWithinTheLimitOfLcm) {
  const std::string channel = channel_name(std::string(100, 'x'), "IMAGE");

  EXPECT_EQ(channel.size(), 63U);
  EXPECT_TRUE(channel.ends_with("_IMAGE"));
}

TEST(Names, BusIsReadBackFromAChannel) {
  EXPECT_EQ(bus_of_channel("LIFT_STATUS", "STATUS"), "LIFT");
  EXPECT_EQ(bus_of_channel("MY_BUS_STATUS", "STATUS"), "MY_BUS");
  EXPECT_EQ(bus_of_channel("STATUS", "STATUS"), "");
  EXPECT_EQ(bus_of_channel("LIFTSTATUS", "STATUS"), "");
}

}  // namespace
}  // namespace takt
