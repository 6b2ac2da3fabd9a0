// During an ordered stop, the master resets, boots and starts no node.
#include <gtest/gtest.h>

#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

class StopWithoutBoots : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(rig.boot());
    rig.command_all(0x000F, 1);
    rig.run(3);
  }
  void begin_stop() {
    rig.recorder.frames.clear();
    rig.master->request_stop();
    rig.run(5);
  }
  StopResult end_stop() {
    for (int i = 0; i < 5000 && !rig.master->finished(); ++i) rig.cycle();
    EXPECT_TRUE(rig.master->finished());
    return rig.status().stop_result;
  }
  /// Number of NMT commands that reset or start nodes, since the stop began.
  long commands() const {
    long count = 0;
    for (const sim::WireFrame& wire : rig.recorder.with(0x000)) {
      const std::uint8_t command = wire.frame.data[0];
      count += command == 0x01 || command == 0x81 || command == 0x82;
    }
    return count;
  }
  void restart(NodeId node) {
    rig.world->power(node, false);
    rig.run(2);
    rig.world->power(node, true);
  }
  Rig rig{test::axes()};
};

TEST_F(StopWithoutBoots, LeavesANodeAloneThatRestarts) {
  begin_stop();
  restart(2_node);
  EXPECT_EQ(end_stop(), StopResult::unconfirmed);
  EXPECT_EQ(commands(), 0);
  EXPECT_EQ(rig.count(EventKind::bootup_again), 1);
  EXPECT_EQ(rig.count(EventKind::boot_started), 2) << "those of the start";
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 1);
}

TEST_F(StopWithoutBoots, LeavesANodeAloneThatComesBack) {
  rig.world->power(2_node, false);
  rig.run(100);
  ASSERT_EQ(rig.count(EventKind::heartbeat_lost), 1);
  begin_stop();
  rig.world->power(2_node, true);
  EXPECT_EQ(end_stop(), StopResult::unconfirmed);
  EXPECT_EQ(commands(), 0);
}

TEST_F(StopWithoutBoots, LeavesANodeAloneWhoseBootIsUnderWay) {
  restart(2_node);
  for (int i = 0; i < 2000 && rig.count(EventKind::boot_started) < 3; ++i) rig.run(1);
  ASSERT_EQ(rig.count(EventKind::boot_started), 3);
  begin_stop();
  EXPECT_EQ(end_stop(), StopResult::unconfirmed);
  EXPECT_EQ(commands(), 0);
}

TEST_F(StopWithoutBoots, TakesNoNmtCommandOfAnApplication) {
  begin_stop();
  ASSERT_TRUE(rig.master->submit(
      {.id = 1, .kind = RequestKind::nmt, .node = 2, .command = NmtCommand::reset_node}));
  rig.run(5);
  Reply reply;
  ASSERT_TRUE(rig.master->take(reply));
  EXPECT_EQ(reply.fault, SdoFault::cancelled);
  EXPECT_EQ(end_stop(), StopResult::confirmed);
  EXPECT_EQ(commands(), 0);
}

TEST(StopAfterTheLossOfAMandatoryNode, ResetsNobody) {
  BusPlan plan = test::axes();
  plan.nodes[1].mandatory = true;
  plan.start_up.on_loss = MandatoryLoss::reset_all;
  Rig rig{plan};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1);
  rig.run(3);
  rig.recorder.frames.clear();
  rig.master->request_stop();
  rig.world->power(2_node, false);
  for (int i = 0; i < 5000 && !rig.master->finished(); ++i) rig.cycle();
  EXPECT_EQ(rig.count(EventKind::heartbeat_lost), 1);
  for (const sim::WireFrame& wire : rig.recorder.with(0x000)) {
    EXPECT_EQ(wire.frame.data[0], 0x80) << "enter pre-operational, at the end";
  }
}

}  // namespace
}  // namespace takt
