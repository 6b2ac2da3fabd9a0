// One command_t for several axes, from the bytes of the message to the devices of a bus in virtual
// time.
#include <gtest/gtest.h>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "master/sim/device/device.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A transport that delivers one given message.
class OneMessage final : public Transport {
 public:
  bool publish(const std::string&, std::span<const std::byte>) override { return true; }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    if (!data.empty()) handler(channel, data);
    data.clear();
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::string channel;
  std::vector<std::byte> data;
};

/// A plan with three axes whose RPDOs have the types 0, 5 and 1.
BusPlan three_axes() {
  BusPlan plan = test::axes({.nodes = 3, .rpdo_type = 0, .period = 4ms, .fallback_cycles = 0});
  plan.pdos.rpdos[1].transmission = 5;
  plan.pdos.rpdos[2].transmission = 1;
  return plan;
}

TEST(GroupCommand, AllSignalsOfOneMessageBecomeValidWithOneSync) {
  test::Rig rig{three_axes()};
  ASSERT_TRUE(rig.boot());
  OneMessage lcm;
  BridgeOptions options;
  options.session = 7;
  const test::RigClocks clocks{rig};
  Bridge bridge{*rig.master, lcm, clocks, options, [](const Notice&) {}};
  lcm.channel = bridge.channels().command;
  const auto target = [&](NodeId node) {
    return rig.world->device(node)->objects().number({0x607A, 0});
  };
  for (std::int64_t round = 1; round < 40; ++round) {
    rig.master->cycle();
    bridge.serve();
    command_t command{};
    command.schema = message_schema;
    command.session = 7;
    command.instance = 1;
    command.sender = "test";
    command.cycle = static_cast<std::int64_t>(bridge.status().bus.cycle);
    for (std::int32_t axis = 0; axis < 3; ++axis) {
      command.signals.insert(command.signals.end(), {6 + axis, 9 + axis});
      command.values.insert(command.values.end(), {0x000F, round});
    }
    command.num_values = static_cast<std::int32_t>(command.values.size());
    lcm.data.resize(static_cast<std::size_t>(command.getEncodedSize()));
    command.encode(lcm.data.data(), 0, command.getEncodedSize());
    bridge.serve();
    ASSERT_EQ(bridge.commands_refused(), 0U);
    for (int cycle = 0; cycle < 4; ++cycle) {
      rig.master->cycle();
      EXPECT_EQ(target(2_node), target(1_node)) << "round " << round << " cycle " << cycle;
      EXPECT_EQ(target(3_node), target(1_node)) << "round " << round << " cycle " << cycle;
      bridge.serve();
    }
    EXPECT_EQ(target(1_node), round);
  }
}

}  // namespace
}  // namespace takt
