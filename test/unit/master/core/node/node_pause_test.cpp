// A node is stopped while SYNC of another device is lost, and started again afterwards.
#include <algorithm>
#include <gtest/gtest.h>

#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

class NodePause : public testing::Test, public NetworkRig {
 protected:
  /// Boots and starts nodes 5 and 6 of one group. The loss of node 6 stops the group.
  void boot() {
    for (const std::uint8_t id : {std::uint8_t{5}, std::uint8_t{6}}) {
      NodePlan& node = add(id, Steps{}.nmt(NmtCommand::start).plan);
      node.heartbeat_timeout = 100ms;
      node.group = 1;
      node.on_loss = id == 6 ? LossReaction::stop_group : LossReaction::report;
      devices.back().heartbeats(now, 30ms);
    }
    start();
    run(200ms);
    ASSERT_EQ(status(0).nmt, NmtState::operational);
    ASSERT_EQ(status(1).nmt, NmtState::operational);
    sent.clear();
  }
  auto commands(std::initializer_list<std::uint8_t> bytes) const {
    return std::ranges::count(sent, nmt(bytes));
  }
};

TEST_F(NodePause, EndsWithAStartWhenSyncIsBack) {
  boot();
  network->on_sync_loss();
  run(10ms);
  EXPECT_EQ(commands({2, 5}), 1);
  network->on_sync_back();
  run(50ms);
  EXPECT_EQ(commands({1, 5}), 1);
  EXPECT_EQ(status(0).nmt, NmtState::operational);
}

TEST_F(NodePause, EndsWithoutAStartIfALossHasStoppedTheNodeMeanwhile) {
  boot();
  network->on_sync_loss();
  run(10ms);
  device(1).on = false;
  run(200ms);
  ASSERT_EQ(count(EventKind::loss_reaction), 1);

  network->on_sync_back();
  run(50ms);
  EXPECT_EQ(commands({1, 5}), 0) << "it waits for a command of an application";
  EXPECT_EQ(status(0).nmt, NmtState::stopped);
}

}  // namespace
}  // namespace takt
