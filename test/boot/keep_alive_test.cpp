// `reset: keep_alive`: attaching to a bus that is OPERATIONAL.
#include "test/boot/plant.hpp"

namespace takt {
namespace {

using namespace test;

sim::Fault starts_by_itself() { return {.kind = sim::FaultKind::self_start, .node = 5_node}; }

/// The valve has a heartbeat of 100 ms before the master sets one.
sim::Fault beating() {
  return {.kind = sim::FaultKind::override_value,
          .node = 5_node,
          .object = ObjectKey{0x1017, 0},
          .value = {std::byte{100}, std::byte{0}}};
}

long resets(const Plant& plant) {
  return std::ranges::count(plant.wire.frames, make_frame(CobId::base(0), {0x82, 5}));
}

TEST(KeepAlive, LeavesAnOperationalNodeAsItIs) {
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 100, heartbeat_consumer: false"),
              {starts_by_itself(), beating()}};
  plant.run_without_master(1s);
  plant.run(2s);
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
  EXPECT_EQ(plant.frames(0x000), 0) << "no NMT command at all";
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(plant.node().boot_letter, 'L');
  const bool wrote = std::ranges::any_of(plant.wire.frames, [](const Frame& frame) {
    return frame.id == CobId::base(0x605) && (frame.data[0] >> 5U) == 1;
  });
  EXPECT_FALSE(wrote);
}

TEST(KeepAlive, ReportsWhatDiffersAndLeavesItAlone) {
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 100, heartbeat_consumer: false, "
                    "sdo: [{index: 0x2000, value: 7}]"),
              {starts_by_itself(), beating()}};
  plant.run_without_master(1s);
  plant.run(2s);
  const std::string text = plant.text_of(EventKind::boot_done);
  EXPECT_NE(text.find("operational already and was not reset (status L"), std::string::npos);
  EXPECT_NE(text.find("2 objects differ from the network file"), std::string::npos) << text;
  EXPECT_EQ(plant.device(5).objects().number({0x2000, 0}), 100);
}

TEST(KeepAlive, ResetsANodeThatIsAliveButNotOperational) {
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 100"), {beating()}};
  plant.run_without_master(1s);
  plant.run(2s);
  EXPECT_EQ(resets(plant), 1);
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(KeepAlive, WithoutASignOfLifeTheNodeIsAskedForItsHeartbeat) {
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 100")};
  plant.run_without_master(1s);
  plant.run(5s);
  EXPECT_NE(plant.text_of(EventKind::boot_failed).find("E of CiA 302-2"), std::string::npos);
  EXPECT_EQ(resets(plant), 1) << "its heartbeat says that it is not OPERATIONAL";
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(KeepAlive, AnOperationalNodeWithoutHeartbeatGetsOneAndNothingElse) {
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 100, heartbeat_consumer: false, "
                    "sdo: [{index: 0x2000, value: 7}]"),
              {starts_by_itself()}};
  plant.run_without_master(1s);
  plant.run(5s);
  EXPECT_NE(plant.text_of(EventKind::boot_failed).find("E of CiA 302-2"), std::string::npos);
  EXPECT_EQ(plant.frames(0x000), 0) << "no NMT command at all";
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(plant.node().boot_letter, 'L');
  std::vector<std::uint16_t> written;
  for (const Frame& frame : plant.wire.frames) {
    if (frame.id != CobId::base(0x605) || (frame.data[0] >> 5U) != 1) continue;
    written.push_back(static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8));
  }
  EXPECT_EQ(written, std::vector<std::uint16_t>{0x1017});
}

}  // namespace
}  // namespace takt
