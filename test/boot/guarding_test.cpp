#include "test/boot/plant.hpp"

namespace takt {
namespace {

using namespace test;

const std::string guarded =
    "heartbeat_producer: 0, heartbeat_consumer: false, guard_time: 100, life_time_factor: 3, "
    "retry_factor: 2";

TEST(Guarding, KeepsANodeWithoutHeartbeatWatched) {
  Plant plant{valve(guarded)};
  plant.run(3s);

  EXPECT_EQ(plant.node().boot_count, 1u);
  EXPECT_EQ(plant.count(EventKind::guarding_lost), 0);
  EXPECT_EQ(plant.count(EventKind::guarding_toggle), 0);
  EXPECT_EQ(plant.node().emcy_count, 0u);
  EXPECT_GE(plant.frames(0x705, true), 25);
}

TEST(Guarding, MissesANodeThatStopsAnsweringAndBootsItAgain) {
  Plant plant{valve(guarded),
              {{.kind = sim::FaultKind::no_guarding, .node = 5_node, .at = 2s, .until = 2500ms}}};
  plant.run(4s);

  ASSERT_EQ(plant.count(EventKind::guarding_lost), 1);
  EXPECT_NE(plant.text_of(EventKind::guarding_lost).find("guarding lost: no valid answer for 2"),
            std::string::npos)
      << plant.text_of(EventKind::guarding_lost);
  EXPECT_EQ(plant.node().boot_count, 2u);
  EXPECT_EQ(plant.node().heartbeat_lost, 1u);
}

TEST(Guarding, ToggleBitThatRepeatsCountsAsSilence) {
  Plant plant{valve(guarded),
              {{.kind = sim::FaultKind::stuck_toggle, .node = 5_node, .at = 2s, .until = 2500ms}}};
  plant.run(4s);

  EXPECT_GE(plant.count(EventKind::guarding_toggle), 1);
  EXPECT_EQ(plant.count(EventKind::guarding_lost), 1);
  EXPECT_EQ(plant.node().boot_count, 2u);
}

TEST(Guarding, DeviceNoticesThatTheMasterIsGone) {
  Plant plant{valve(guarded),
              {{.kind = sim::FaultKind::interface_down, .at = 2s, .until = 2500ms}}};
  plant.run(2400ms);

  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::preoperational);
  EXPECT_NE(plant.device(5).objects().number({0x1001, 0}), 0);
}

TEST(Guarding, DeviceWithAHeartbeatIsNotGuarded) {
  const LoadedNetwork network = valve("heartbeat_producer: 100, guard_time: 100");

  EXPECT_EQ(network.plan.nodes[0].guard.period, 0ns);
  EXPECT_TRUE(std::ranges::any_of(network.findings, [](const Finding& finding) {
    return finding.rule == "guarding" && finding.severity == Severity::note;
  }));
}

}  // namespace
}  // namespace takt
