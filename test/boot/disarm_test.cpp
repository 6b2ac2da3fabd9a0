#include "test/boot/plant.hpp"

// The master disarms the supervision of its heartbeat in the devices once the stop of every axis is
// confirmed.

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

sim::Fault of_drive(sim::FaultKind kind) { return {.kind = kind, .node = 6_node}; }

LoadedNetwork watching(const std::string& keys = "") {
  return network_of(
      "bus: {name: plant}\nmaster: {sync_period: 10000, heartbeat_producer: 100}\nnodes:\n"
      "  lift: {node_id: 6, dcf: ../../../share/eds/takt_drive402.eds, profile: cia402, "
      "heartbeat_producer: 100" +
      keys + "}\n");
}

std::int64_t watched(Plant& plant) { return plant.device(6).objects().number({0x1016, 1}); }

TEST(Disarming, ReachesANodeWhoseBootFailedBehindItsArming) {
  Plant plant{watching(), {of_drive(no_start)}};
  for (int i = 0; i < 1000 && plant.node().boot != BootState::failed; ++i) plant.run(10ms);
  ASSERT_EQ(plant.node().boot, BootState::failed);
  ASSERT_NE(watched(plant), 0) << "it is armed";

  EXPECT_EQ(plant.stop(), StopResult::confirmed);

  EXPECT_EQ(watched(plant), 0);
  EXPECT_EQ(plant.count(EventKind::still_armed), 0);
}

TEST(Disarming, LeavesANodeAloneWhoseBootFailedBeforeItsArming) {
  Plant plant{watching(", vendor_id: 0x1234"), {of_drive(self_start)}};
  plant.run(3s);
  ASSERT_EQ(plant.node().boot, BootState::failed);
  plant.wire.frames.clear();

  EXPECT_EQ(plant.stop(), StopResult::confirmed);

  EXPECT_TRUE(std::ranges::none_of(plant.wire.frames, [](const Frame& frame) {
    return frame.id == CobId::base(0x606) && frame.data[1] == 0x16 && frame.data[2] == 0x10;
  }));
}

sim::Fault refusing(std::uint32_t abort_code) {
  sim::Fault fault = of_drive(refuse_object);
  fault.object = ObjectKey{0x1016, 1};
  fault.abort_code = abort_code;
  return fault;
}

TEST(Disarming, LeavesANodeAloneThatHasRefusedItsArming) {
  Plant plant{watching(), {refusing(0x0602'0000)}};
  for (int i = 0; i < 1000 && plant.node().boot != BootState::failed; ++i) plant.run(10ms);
  ASSERT_EQ(plant.node().boot, BootState::failed);
  plant.wire.frames.clear();

  EXPECT_EQ(plant.stop(), StopResult::confirmed);

  EXPECT_EQ(plant.count(EventKind::still_armed), 0) << plant.text_of(EventKind::still_armed);
  EXPECT_TRUE(std::ranges::none_of(plant.wire.frames, [](const Frame& frame) {
    return frame.id == CobId::base(0x606) && frame.data[1] == 0x16 && frame.data[2] == 0x10;
  }));
}

/// Only the answer to the write is missing, so the device may be armed.
TEST(Disarming, IsTriedWhereTheArmingWasNotAnswered) {
  sim::Fault mute = of_drive(mute_sdo);
  mute.object = ObjectKey{0x1016, 1};
  Plant plant{watching(", sdo_timeout_ms: 300"), {mute}};
  for (int i = 0; i < 1000 && plant.node().boot != BootState::failed; ++i) plant.run(10ms);
  ASSERT_EQ(plant.node().boot, BootState::failed);

  plant.stop();

  EXPECT_EQ(plant.count(EventKind::still_armed), 1);
}

TEST(Disarming, SaysForHowLongTheDeviceGaveNoAnswer) {
  Plant plant{watching(", sdo_timeout_ms: 300")};
  plant.run(5s);
  ASSERT_EQ(plant.node().boot, BootState::ready);
  plant.world.add(of_drive(mute_sdo));

  EXPECT_EQ(plant.stop(), StopResult::confirmed);

  EXPECT_NE(
      plant.text_of(EventKind::still_armed)
          .find(
              "the write to 1016:01 that ends the supervision of the master failed, because the "
              "device gave no answer within 300 ms: the device may report the loss of its master"),
      std::string::npos)
      << plant.text_of(EventKind::still_armed);
}

TEST(Disarming, SaysWithWhichCodeTheDeviceRefused) {
  Plant plant{watching()};
  plant.run(5s);
  ASSERT_EQ(plant.node().boot, BootState::ready);
  plant.world.add(refusing(0x0504'0000));

  EXPECT_EQ(plant.stop(), StopResult::confirmed);

  EXPECT_NE(plant.text_of(EventKind::still_armed).find("refused the write (0504 0000)"),
            std::string::npos)
      << plant.text_of(EventKind::still_armed);
}

}  // namespace
}  // namespace takt
