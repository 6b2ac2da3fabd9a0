#include <gtest/gtest.h>

#include "test/unit/master/core/network/network_fixture.hpp"

namespace takt {
namespace {

/// Nodes 5, which is mandatory, and 6. One broadcast starts them, and the loss of 5 resets both.
class NetworkStartTest : public NetworkTest {
 protected:
  NetworkStartTest() {
    plan.start_up.start_all = true;
    plan.start_up.on_loss = MandatoryLoss::reset_all;
    add_one(5).mandatory = true;
    add_one(6);
    start();
    run(300ms);
  }
  NodePlan& add_one(std::uint8_t id) {
    NodePlan& node = add_drive(id);
    node.boot_plan.steps.pop_back();  // the step that starts the node
    node.start_later = true;
    return node;
  }
  const Frame start_all = nmt({0x01, 0x00});
};

TEST_F(NetworkStartTest, StartsNobodyAfterAResetBeforeTheMandatoryNodeIsBack) {
  ASSERT_EQ(sent_count(start_all), 1);
  device(0).on = false;
  run(2s);
  EXPECT_EQ(sent_count(nmt({0x81, 0x00})), 1);
  EXPECT_EQ(status(1).boot, BootState::ready);
  EXPECT_EQ(sent_count(nmt({0x01, 0x06})), 0);

  device(0).on = true;
  run(3s);
  EXPECT_EQ(sent_count(start_all), 2);
  EXPECT_EQ(device(0).state, 5);
  EXPECT_EQ(device(1).state, 5);
}

TEST_F(NetworkStartTest, WaitsAfterAResetForTheFirstTryOfEachNodeAgain) {
  device(1).latency = 80ms;
  device(0).next_heartbeat = never;
  run(160ms);
  ASSERT_EQ(sent_count(nmt({0x81, 0x00})), 1);
  while (status(0).boot != BootState::ready) run(1ms);
  run(10ms);
  EXPECT_EQ(status(1).boot, BootState::booting);
  EXPECT_EQ(sent_count(start_all), 1);
  run(200ms);
  EXPECT_EQ(sent_count(start_all), 2);
}

}  // namespace
}  // namespace takt
