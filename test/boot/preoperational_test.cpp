#include "test/boot/plant.hpp"

// The master writes parameters in PRE-OPERATIONAL even if the device changes its state by itself.

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

constexpr const char* differs = "sdo: [{index: 0x2000, value: 7}]";

sim::Fault always(sim::FaultKind kind) { return {.kind = kind, .node = 5_node}; }

Frame nmt(std::uint8_t command) { return make_frame(CobId::base(0), {command, 0x05}); }

/// Returns the NMT commands in order.
std::vector<std::uint8_t> commands(const Plant& plant) {
  std::vector<std::uint8_t> out;
  for (const Frame& frame : plant.wire.frames) {
    if (frame.id == CobId::base(0)) out.push_back(frame.data[0]);
  }
  return out;
}

bool is_write(const Frame& frame) {
  return frame.id == CobId::base(0x605) && (frame.data[0] >> 5U) == 1;
}

TEST(Preoperational, DeviceThatStartsItselfIsConfiguredInOneBoot) {
  Plant plant{valve("heartbeat_producer: 100"), {always(self_start), always(preop_only)}};
  plant.run(3s);
  EXPECT_EQ(plant.node().boot, BootState::ready) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x82, 0x80, 0x01}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(Preoperational, CommandComesBeforeTheFirstWrite) {
  Plant plant{valve("heartbeat_producer: 100")};
  plant.run(3s);
  const auto& frames = plant.wire.frames;
  const auto first_write = std::ranges::find_if(frames, is_write);
  const auto command = std::ranges::find(frames, nmt(0x80));
  ASSERT_NE(first_write, frames.end());
  EXPECT_LT(command, first_write);
}

TEST(Preoperational, DeviceThatWasFoundOperationalIsTakenOutOfItAndStartedAgain) {
  Plant plant{valve("reset: none, heartbeat_producer: 100"),
              {always(self_start), always(preop_only)}};
  plant.run_without_master(1s);
  plant.run(3s);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x80, 0x01}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(Preoperational, NodeThatIsRightAlreadyIsNotTouched) {
  const std::string keys = "reset: none, heartbeat_consumer: false, heartbeat_producer: 100";
  Plant first{valve(keys)};
  first.run(3s);
  std::vector<sim::Fault> right{always(self_start), always(preop_only)};
  for (const Frame& frame : first.wire.frames) {  // repeat the writes of the first master
    if (!is_write(frame)) continue;
    const ObjectKey key{static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8),
                        frame.data[3]};
    sim::Fault& fault = right.emplace_back(always(override_value));
    fault.object = key;
    const auto size = 4U - (frame.data[0] >> 2U & 3U);
    for (std::size_t i = 0; i < size; ++i) fault.value.push_back(std::byte{frame.data[4 + i]});
  }
  ASSERT_GT(right.size(), 2u);

  Plant plant{valve(keys), right};
  plant.run_without_master(1s);
  plant.run(3s);

  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(commands(plant), std::vector<std::uint8_t>{0x01});
  EXPECT_TRUE(std::ranges::none_of(plant.wire.frames, is_write));
}

TEST(Preoperational, KeepAliveLeavesAnOperationalNodeInIt) {
  Plant plant{valve(std::string{"reset: keep_alive, heartbeat_producer: 100, "} + differs),
              {always(self_start)}};
  plant.run_without_master(1s);
  plant.run(5s);
  EXPECT_EQ(plant.node().boot_letter, 'L');
  EXPECT_TRUE(commands(plant).empty());
}

TEST(Preoperational, ANodeThatSaysSoNeedsNoCommand) {
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{5}, std::byte{0}};  // ms
  Plant plant{valve("reset: none, heartbeat_producer: 100"), {beats}};
  plant.run_without_master(1s);
  plant.run(3s);
  EXPECT_EQ(commands(plant), std::vector<std::uint8_t>{0x01});
}

TEST(Preoperational, WithoutStartNodesWhoStartedItselfIsStartedAgain) {
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{5}, std::byte{0}};  // ms
  Plant plant{valve("", "start_nodes: false"), {beats, always(self_start), always(preop_only)}};
  plant.run(3s);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(std::ranges::count(commands(plant), 0x01), 1);
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

// The device reports OPERATIONAL before it is reset, and then only after the command.
TEST(Preoperational, WithoutStartNodesAHeartbeatBeforeTheResetDoesNotCount) {
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{200}, std::byte{0}};  // ms
  Plant plant{valve("", "start_nodes: false"), {beats, always(self_start), always(preop_only)}};
  plant.run_without_master(1s);
  plant.run(3s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x82, 0x80}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::preoperational);
}

TEST(Preoperational, WithoutStartNodesKeepAliveLeavesAnOperationalNodeInIt) {
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{200}, std::byte{0}};  // ms
  Plant plant{valve("reset: keep_alive, heartbeat_producer: 200", "start_nodes: false"),
              {beats, always(self_start), always(preop_only)}};
  plant.run_without_master(1s);
  plant.run(5s);
  EXPECT_EQ(plant.node().boot_letter, 'L');
  EXPECT_TRUE(commands(plant).empty());
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

/// Starts node 5 just before it receives a write, as a device that starts by itself does.
struct SelfStart final : sim::BusObserver {
  SelfStart(Plant& started, int number) : plant{started}, times{number} {
    plant.world.observe(this);
  }
  void on_wire(const sim::WireFrame& seen) noexcept override {
    plant.wire.on_wire(seen);
    if (seen.result != sim::WireResult::sent || seen.frame.id != CobId::base(0x605)) return;
    if (!is_write(seen.frame) || times == 0) return;
    --times;
    plant.device(5).on_frame(nmt(0x01), plant.world.now());
  }

  Plant& plant;
  int times;
};

TEST(Preoperational, DeviceThatStartsItselfAfterTheCommandIsConfiguredInOneBoot) {
  Plant plant{valve("heartbeat_producer: 100"), {always(preop_only)}};
  SelfStart once{plant, 1};
  plant.run(3s);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x82, 0x80, 0x80, 0x01}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(Preoperational, WithoutStartNodesARefusedWriteShowsWhoStartedItself) {
  Plant plant{valve("", "start_nodes: false"), {always(preop_only)}};
  SelfStart once{plant, 1};
  plant.run(3s);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x82, 0x80, 0x80, 0x01}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::operational);
}

TEST(Preoperational, WithoutStartNodesADeviceWhoseStateIsUnknownStaysInIt) {
  Plant plant{valve("", "start_nodes: false"), {always(self_start), always(preop_only)}};
  plant.run(3s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x82, 0x80}));
  EXPECT_EQ(plant.device(5).state(), sim::DeviceState::preoperational);
}

TEST(Preoperational, DeviceThatNeverStaysInItIsNamed) {
  Plant plant{valve("heartbeat_producer: 100"), {always(preop_only)}};
  SelfStart always_again{plant, 1000};
  for (int i = 0; i < 100 && plant.count(EventKind::boot_failed) == 0; ++i) plant.run(10ms);
  const std::string text = plant.text_of(EventKind::boot_failed);
  EXPECT_NE(text.find("0800 0022"), std::string::npos) << text;
  EXPECT_NE(text.find("leaves PRE-OPERATIONAL by itself"), std::string::npos) << text;
  EXPECT_EQ(text.find("let the boot reset it"), std::string::npos) << text;
  EXPECT_EQ(std::ranges::count(commands(plant), 0x80), 2);
}

TEST(Preoperational, RefusalInItIsNotExplainedByTheNmtState) {
  sim::Fault refusal = always(refuse_write);
  refusal.object = ObjectKey{0x2000, 0};
  refusal.abort_code = 0x0800'0022;
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{5}, std::byte{0}};  // ms
  Plant plant{valve(differs), {refusal, beats}};
  for (int i = 0; i < 100 && plant.count(EventKind::boot_failed) == 0; ++i) plant.run(10ms);
  const std::string text = plant.text_of(EventKind::boot_failed);
  EXPECT_NE(text.find("disable the drive or leave local control"), std::string::npos) << text;
  EXPECT_EQ(text.find("by itself"), std::string::npos) << text;
  EXPECT_EQ(text.find("let the boot reset it"), std::string::npos) << text;
}

TEST(Preoperational, AStoppedNodeIsAskedInPreoperational) {
  sim::Fault beats = always(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{50}, std::byte{0}};  // ms
  Plant plant{valve("reset: none"), {beats}};
  plant.run_without_master(500ms);
  plant.device(5).on_frame(nmt(0x02), plant.world.now());
  plant.run_without_master(100ms);
  plant.run(4s);
  EXPECT_EQ(plant.count(EventKind::boot_failed), 0) << plant.text_of(EventKind::boot_failed);
  EXPECT_EQ(commands(plant), (std::vector<std::uint8_t>{0x80, 0x01}));
}

}  // namespace
}  // namespace takt
