#include "test/boot/plant.hpp"

// The ordered stop of a drive that was already enabled before this master started and that this
// master can't boot.

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

sim::Fault of_drive(sim::FaultKind kind) { return {.kind = kind, .node = 6_node}; }

sim::Fault override_of(ObjectKey object, std::vector<std::byte> value) {
  sim::Fault fault = of_drive(override_value);
  fault.object = object;
  fault.value = std::move(value);
  return fault;
}

/// A drive that starts itself and has a heartbeat of 50 ms and a mapping that differs from the
/// network file.
class FoundEnabled : public testing::Test {
 protected:
  explicit FoundEnabled(const std::string& keys = "reset: keep_alive", sim::Faults more = {})
      : plant{network_of("bus: {name: plant}\nmaster: {sync_period: 10000}\nnodes:\n"
                         "  lift: {node_id: 6, dcf: ../../../share/eds/takt_drive402.eds, "
                         "profile: cia402, heartbeat_producer: 100, "
                         "rpdo: {2: {mapping: [{index: 0x6060}]}}, " +
                         keys + "}\n"),
              all_of(std::move(more))} {}

  static sim::Faults all_of(sim::Faults more) {
    more.push_back(of_drive(self_start));
    more.push_back(override_of({0x1017, 0}, {std::byte{50}, std::byte{0}}));
    return more;
  }

  void SetUp() override { plant.run_without_master(1s); }

  /// Another master writes to the drive.
  void write(std::uint8_t command, std::uint16_t index, std::uint32_t value) {
    const auto byte = [](std::uint32_t bits) { return static_cast<std::uint8_t>(bits & 0xFF); };
    plant.device(6).on_frame(
        make_frame(CobId::base(0x606), {command, byte(index), byte(index >> 8U), 0x00, byte(value),
                                        byte(value >> 8U), byte(value >> 16U), byte(value >> 24U)}),
        plant.world.now());
    plant.run_without_master(50ms);
  }
  /// Moves the drive in profile velocity mode.
  void move() {
    write(0x2F, 0x6060, 3);
    write(0x23, 0x60FF, 20'000);
    for (const std::uint32_t word : {0x06U, 0x07U, 0x0FU}) write(0x2B, 0x6040, word);
    plant.run_without_master(500ms);
    ASSERT_EQ(state(), 0x27);
    ASSERT_GT(velocity(), 10'000);
  }
  std::int64_t state() { return plant.device(6).objects().number({0x6041, 0}) & 0x6F; }
  std::int64_t velocity() { return plant.device(6).objects().number({0x606C, 0}); }

  Plant plant;
};

TEST_F(FoundEnabled, IsStoppedAndDisabledBySdo) {
  move();
  plant.run(5s);
  ASSERT_EQ(plant.node().boot_count, 0U);
  ASSERT_EQ(plant.node().boot_letter, 'L');
  ASSERT_GT(velocity(), 10'000) << "it is left as it was";

  const StopResult result = plant.stop();

  EXPECT_EQ(state(), 0x40);
  EXPECT_EQ(velocity(), 0);
  EXPECT_EQ(result, StopResult::confirmed);
  EXPECT_EQ(plant.count(EventKind::axis_not_stopped), 0);
}

TEST_F(FoundEnabled, IsStoppedInTheMiddleOfItsBoot) {
  move();
  sim::Fault slow = of_drive(slow_sdo);
  slow.time = 200ms;
  plant.world.add(slow);
  plant.run(1s);
  ASSERT_EQ(plant.node().boot, BootState::booting);
  EXPECT_EQ(plant.stop(), StopResult::confirmed);
  EXPECT_EQ(state(), 0x40);
}

TEST_F(FoundEnabled, IsNotConfirmedWhereItTakesNoControlword) {
  move();
  plant.run(5s);
  sim::Fault refuses = of_drive(refuse_object);
  refuses.object = ObjectKey{0x6040, 0};
  refuses.abort_code = 0x0800'0022;
  plant.world.add(refuses);

  EXPECT_EQ(plant.stop(), StopResult::unconfirmed);

  EXPECT_NE(plant.text_of(EventKind::axis_not_stopped).find("was not disabled, its velocity is"),
            std::string::npos)
      << plant.text_of(EventKind::axis_not_stopped);
}

TEST_F(FoundEnabled, IsDisabledThoughItSaysNothingOfItsMotion) {
  move();
  plant.run(5s);
  for (const std::uint16_t index : {std::uint16_t{0x606C}, std::uint16_t{0x6064}}) {
    sim::Fault refuses = of_drive(refuse_object);
    refuses.object = ObjectKey{index, 0};
    refuses.abort_code = 0x0602'0000;
    plant.world.add(refuses);
  }
  plant.wire.frames.clear();

  EXPECT_EQ(plant.stop(), StopResult::unconfirmed);

  const Frame disable_voltage = make_frame(CobId::base(0x606), {0x2B, 0x40, 0x60, 0, 0, 0, 0, 0});
  EXPECT_GE(std::ranges::count(plant.wire.frames, disable_voltage), 1);
}

TEST_F(FoundEnabled, IsNotConfirmedWhereItDoesNotAnswer) {
  move();
  plant.run(5s);
  plant.world.add(of_drive(mute_sdo));
  EXPECT_EQ(plant.stop(), StopResult::unconfirmed);
  EXPECT_EQ(plant.count(EventKind::axis_not_stopped), 1);
}

TEST_F(FoundEnabled, IsConfirmedWhereItIsDisabledAlready) {
  plant.run(5s);
  ASSERT_EQ(plant.node().boot_count, 0U);
  EXPECT_EQ(plant.stop(), StopResult::confirmed);
  EXPECT_TRUE(std::ranges::none_of(plant.wire.frames, [](const Frame& frame) {
    return frame.id == CobId::base(0x606) && frame.data[1] == 0x40 && frame.data[2] == 0x60;
  })) << "it is only asked";
}

/// A drive with the given device type that aborts the read of its statusword.
class FoundWithoutStatusword : public FoundEnabled {
 protected:
  explicit FoundWithoutStatusword(std::uint8_t profile_low = 0x92, std::uint8_t profile_high = 0x01)
      : FoundEnabled{"reset: keep_alive",
                     {override_of({0x1000, 0}, {std::byte{profile_low}, std::byte{profile_high},
                                                std::byte{0x02}, std::byte{0x00}})}} {}
  StopResult stop_refused_with(std::uint32_t abort_code) {
    plant.run(5s);
    EXPECT_EQ(plant.node().boot_count, 0U);
    EXPECT_EQ(plant.node().nmt, NmtState::operational);
    sim::Fault refuses = of_drive(refuse_object);
    refuses.object = ObjectKey{0x6041, 0};
    refuses.abort_code = abort_code;
    plant.world.add(refuses);
    return plant.stop();
  }
  std::string text() const { return plant.text_of(EventKind::axis_not_stopped); }
};

TEST_F(FoundWithoutStatusword, IsNotConfirmedWhereItSaysThatItIsADrive) {
  EXPECT_EQ(stop_refused_with(0x0602'0000), StopResult::unconfirmed);
  EXPECT_NE(text().find("reports that it has no statusword 6041:00 (0602 0000): takt does not know "
                        "whether the drive is enabled"),
            std::string::npos)
      << text();
}

TEST_F(FoundWithoutStatusword, IsNotConfirmedWhereItRefusesForAnotherReason) {
  EXPECT_EQ(stop_refused_with(0x0800'0022), StopResult::unconfirmed);
  EXPECT_NE(text().find("refuses to send its statusword 6041:00 (0800 0022)"), std::string::npos)
      << text();
}

/// A device with the device profile 401.
class FoundAsAnotherDevice : public FoundWithoutStatusword {
 protected:
  FoundAsAnotherDevice() : FoundWithoutStatusword{0x91} {}
};

TEST_F(FoundAsAnotherDevice, NeedsNoConfirmationWithoutAStatusword) {
  EXPECT_EQ(stop_refused_with(0x0602'0000), StopResult::confirmed) << text();
}

TEST_F(FoundAsAnotherDevice, IsNotConfirmedWhereItRefusesForAnotherReason) {
  EXPECT_EQ(stop_refused_with(0x0800'0022), StopResult::unconfirmed);
}

/// A device without a standard profile may still be a drive, as its EDS says.
class FoundWithoutProfile : public FoundWithoutStatusword {
 protected:
  FoundWithoutProfile() : FoundWithoutStatusword{0x00, 0x00} {}
};

TEST_F(FoundWithoutProfile, IsNotConfirmedWithoutAStatusword) {
  EXPECT_EQ(stop_refused_with(0x0602'0000), StopResult::unconfirmed);
}

/// A broadcast cannot start an absent drive.
TEST(AbsentDrive, NeedsNoConfirmationAfterABroadcastStart) {
  Plant plant{network_of("bus: {name: plant}\nmaster: {sync_period: 10000}\nnodes:\n"
                         "  lift: {node_id: 6, dcf: ../../../share/eds/takt_drive402.eds, "
                         "profile: cia402, heartbeat_producer: 100}\n"
                         "  valve: {node_id: 5, dcf: valve.eds}\n"),
              {of_drive(power_off)}};
  plant.run(20s);
  plant.nmt(NmtCommand::start, 0);
  plant.run(1s);
  ASSERT_EQ(plant.node(1).boot_count, 0U);
  ASSERT_TRUE(std::ranges::any_of(plant.events, [](const Event& event) {
    return event.kind == EventKind::node_state && event.node == 6 && event.value == 5;
  })) << "the master assumes so much";

  EXPECT_EQ(plant.stop(), StopResult::confirmed);
  EXPECT_EQ(plant.count(EventKind::axis_not_stopped), 0);
}

/// The master first commands PRE-OPERATIONAL. The boot of the drive fails because of its vendor-ID.
class FoundEnabledAndTakenOut : public FoundEnabled {
 protected:
  FoundEnabledAndTakenOut() : FoundEnabled{"reset: none, vendor_id: 0x1234"} {}
};

TEST_F(FoundEnabledAndTakenOut, IsAskedAllTheSame) {
  move();
  plant.run(5s);
  ASSERT_EQ(plant.node().boot_count, 0U);
  ASSERT_EQ(state(), 0x27);
  EXPECT_EQ(plant.stop(), StopResult::confirmed);
  EXPECT_EQ(state(), 0x40);
}

}  // namespace
}  // namespace takt
