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
  PortCondition condition;

  apply_error_frame(error_frame(0x004, {0, 0x20, 0, 0, 0, 0, 128, 3}), condition);

  EXPECT_TRUE(condition.error_passive);
  EXPECT_EQ(condition.tx_error_counter, 128);
  EXPECT_EQ(condition.rx_error_counter, 3);
  EXPECT_EQ(condition.error_frames, 1U);
}

TEST(CanErrorFrame, AWarningAfterPassiveMeansNoLongerPassive) {
  PortCondition condition;
  apply_error_frame(error_frame(0x004, {0, 0x10, 0, 0, 0, 0, 0, 130}), condition);

  apply_error_frame(error_frame(0x004, {0, 0x04, 0, 0, 0, 0, 0, 100}), condition);

  EXPECT_FALSE(condition.error_passive);
  EXPECT_EQ(condition.rx_error_counter, 100);
}

TEST(CanErrorFrame, BusOffLastsUntilTheRestart) {
  PortCondition condition;
  apply_error_frame(error_frame(0x040, {}), condition);
  EXPECT_TRUE(condition.bus_off);

  apply_error_frame(error_frame(0x100, {}), condition);

  EXPECT_FALSE(condition.bus_off);
  EXPECT_FALSE(condition.error_passive);
}

TEST(CanErrorFrame, AControllerOverflowCountsAsLostFramesAndChangesNoState) {
  PortCondition condition;
  condition.error_passive = true;

  apply_error_frame(error_frame(0x004, {0, 0x01, 0, 0, 0, 0, 0, 0}), condition);

  EXPECT_EQ(condition.receive_overruns, 1U);
  EXPECT_TRUE(condition.error_passive);
}

TEST(CanErrorFrame, AFrameThatCouldNotBeSentIsNoLostReceivedFrame) {
  PortCondition condition;

  apply_error_frame(error_frame(0x004, {0, 0x02, 0, 0, 0, 0, 0, 0}), condition);

  EXPECT_EQ(condition.receive_overruns, 0U);
  EXPECT_EQ(condition.error_frames, 1U);
}

}  // namespace
}  // namespace takt
