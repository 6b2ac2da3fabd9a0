#include "master/linux/can/can_error_frame.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace takt {
namespace {

can_frame error_frame(canid_t classes, std::initializer_list<std::uint8_t> bytes) {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | classes;
  frame.can_dlc = 8;
  std::copy(bytes.begin(), bytes.end(), frame.data);
  return frame;
}

// Bytes as the drivers write them; linux/can/error.h.
TEST(CanErrorFrame, TransmitPassiveSetsPassiveAndTheCounters) {
  PortNews news;

  apply_error_frame(error_frame(0x004, {0, 0x20, 0, 0, 0, 0, 128, 3}), news);

  EXPECT_TRUE(news.error_passive);
  EXPECT_EQ(news.tx_error_counter, 128);
  EXPECT_EQ(news.rx_error_counter, 3);
  EXPECT_EQ(news.error_frames, 1U);
}

TEST(CanErrorFrame, AWarningAfterPassiveMeansNoLongerPassive) {
  PortNews news;
  apply_error_frame(error_frame(0x004, {0, 0x10, 0, 0, 0, 0, 0, 130}), news);

  apply_error_frame(error_frame(0x004, {0, 0x04, 0, 0, 0, 0, 0, 100}), news);

  EXPECT_FALSE(news.error_passive);
  EXPECT_EQ(news.rx_error_counter, 100);
}

TEST(CanErrorFrame, BusOffLastsUntilTheRestart) {
  PortNews news;
  apply_error_frame(error_frame(0x040, {}), news);
  EXPECT_TRUE(news.bus_off);

  apply_error_frame(error_frame(0x100, {}), news);

  EXPECT_FALSE(news.bus_off);
  EXPECT_FALSE(news.error_passive);
}

TEST(CanErrorFrame, AControllerOverflowCountsAsLostFramesAndChangesNoState) {
  PortNews news;
  news.error_passive = true;

  apply_error_frame(error_frame(0x004, {0, 0x01, 0, 0, 0, 0, 0, 0}), news);

  EXPECT_EQ(news.receive_overruns, 1U);
  EXPECT_TRUE(news.error_passive);
}

TEST(CanErrorFrame, AFrameThatCouldNotBeSentIsNoLostReceivedFrame) {
  PortNews news;

  apply_error_frame(error_frame(0x004, {0, 0x02, 0, 0, 0, 0, 0, 0}), news);

  EXPECT_EQ(news.receive_overruns, 0U);
  EXPECT_EQ(news.error_frames, 1U);
}

}  // namespace
}  // namespace takt
