#include <gtest/gtest.h>
#include <map>
#include <random>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

BootPlan plan_with_every_action() {
  Steps steps;
  steps.nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 50ms)
      .object(BootAction::probe, 'B', {0x1000, 0})
      .object(BootAction::compare, 'J', {0x1800, 1}, bytes({0x81, 1, 0, 0}))
      .skip(8)
      .object(BootAction::disable_pdo, 'J', {0x1800, 1})
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({0}))
      .object(BootAction::enable_pdo, 'J', {0x1800, 1}, bytes({0x81, 1, 0, 0}))
      .object(BootAction::write_if_differs, 'J', {0x1008, 0}, std::vector<std::byte>(40))
      .wait(BootAction::await_heartbeat, 'K', 50ms)
      .nmt(NmtCommand::start)
      .wait(BootAction::await_operational, 'L', 50ms)
      .wait(BootAction::pause, 'J', 5ms);
  return steps.plan;
}

/// Makes an answer that a good device might send.
Frame answer(const Frame& asked, std::mt19937& random) {
  Frame frame = asked;
  frame.id = CobId::base(asked.id.id() - 0x80);
  const bool upload = asked.data[0] == 0x40;
  frame.data[0] = upload ? (random() % 4 == 0 ? 0x41 : 0x43) : 0x60;
  if ((asked.data[0] & 0xEF) == 0x60) frame.data[0] = asked.data[0] & 0x10;
  if (asked.data[0] < 0x20) frame.data[0] = 0x20 | (asked.data[0] & 0x10);
  if (upload) frame.data[4] = 7;
  return frame;
}

/// Makes frames that look like those of the nodes, with random content and length. They are valid
/// often enough to reach deep states of every state machine.
Frame noise(std::mt19937& random, const std::vector<Frame>& sent) {
  const auto below = [&random](unsigned limit) { return static_cast<unsigned>(random() % limit); };
  if (!sent.empty() && below(10) < 7) {
    const Frame& asked = sent[below(static_cast<unsigned>(sent.size()))];
    if (asked.id.id() > 0x600 && asked.id.id() < 0x680) return answer(asked, random);
  }
  static constexpr std::uint32_t bases[] = {0x580, 0x700, 0x080, 0x600, 0x180, 0x000};
  Frame frame;
  frame.id = CobId::base(bases[below(6)] + below(11));
  if (below(50) == 0) frame.id = CobId::extended(static_cast<std::uint32_t>(random()));
  frame.rtr = below(50) == 0;
  frame.length = static_cast<std::uint8_t>(below(4) == 0 ? below(9) : 8);
  for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random());
  static constexpr std::uint8_t states[] = {0x04, 0x05, 0x7F, 0xFF, 0x05, 0x05};
  if ((frame.id.id() & ~0x7FU) == 0x700 && below(10) != 0) frame.data[0] = states[below(6)];
  return frame;
}

void expect_named(const NodeStatus& status) {
  EXPECT_NE(name(status.boot), "unknown");
  const bool known = name(status.nmt) != "unknown" || status.nmt == NmtState::unknown;
  EXPECT_TRUE(known) << static_cast<int>(status.nmt);
}

class Noise : public testing::TestWithParam<unsigned> {};

TEST_P(Noise, NeitherConfusesNorStopsTheMaster) {
  std::mt19937 random{GetParam()};
  BusPlan plan{.name = "lift"};
  plan.master_heartbeat = 20ms;
  for (std::uint8_t id = 1; id <= 8; ++id) {
    NodePlan& node = plan.nodes.emplace_back(NodePlan{.name = "n", .id = *NodeId::from(id)});
    node.boot_plan = plan_with_every_action();
    node.heartbeat_timeout = 30ms;
    node.sdo_timeout = 20ms;
    node.reboot_delay = 40ms;
    node.boot = id != 8;
  }
  Network network{plan};
  Time now = 1s;
  network.start(now);

  std::map<std::uint64_t, int> answers;
  std::vector<Frame> sent;
  std::uint64_t next_id = 0;
  int ready = 0;
  const auto collect = [&] {
    for (Reply reply; network.take(reply);) ++answers[reply.id];
    for (Event event; network.take(event);) {
      EXPECT_FALSE(describe(plan, event).empty());
      ready += event.kind == EventKind::boot_done;
    }
  };
  for (int i = 0; i < 100'000; ++i) {
    now += std::chrono::microseconds{random() % 300};
    Outbox out;
    network.on_frame(noise(random, sent), now, out);
    ASSERT_TRUE(out.empty());
    if (random() % 40 == 0) {
      Request request;
      request.id = ++next_id;
      request.kind = static_cast<RequestKind>(random() % 3);
      request.node = static_cast<std::uint8_t>(random() % 12);
      request.command = random() % 9 != 0 ? NmtCommand::start : NmtCommand::reset_node;
      request.object = {0x2000, 0};
      request.size = static_cast<std::uint16_t>(random() % 2000);
      if (network.submit(request, now)) answers[request.id] += 0;
    }
    if (random() % 3 == 0) {
      network.on_time(now, out);
      ASSERT_LE(out.frames().size(), plan.cycle.service_frames);
      if (!out.empty()) sent.assign(out.frames().begin(), out.frames().end());
    }
    collect();
  }
  for (const NodeStatus& status : network.nodes()) expect_named(status);
  EXPECT_GT(ready, 0) << "the noise never got through a boot";

  network.begin_stop(now);
  for (int i = 0; i < 20 && !network.stopped(); ++i) {
    Outbox out;
    network.on_time(now += 1ms, out);
  }
  collect();
  EXPECT_TRUE(network.stopped());
  EXPECT_GT(answers.size(), 500U);
  for (const auto& [id, count] : answers) EXPECT_EQ(count, 1) << "request " << id;
}

TEST_P(Noise, AndLossOfOneFrameInFiftyOnlyDelayTheBoot) {
  NetworkRig rig;
  for (std::uint8_t id = 1; id <= 8; ++id) {
    Steps steps;
    steps.nmt(NmtCommand::reset_communication)
        .wait(BootAction::await_bootup, 'B', 100ms)
        .object(BootAction::probe, 'B', {0x1000, 0});
    for (std::uint16_t i = 0; i < 40; ++i) {
      const auto index = static_cast<std::uint16_t>(0x2000 + i);
      steps.object(BootAction::write_if_differs, 'J', {index, 0}, bytes({1u + i, 0}));
    }
    steps.nmt(NmtCommand::start).wait(BootAction::await_operational, 'K', 200ms);
    NodePlan& node = rig.add(id, steps.plan);
    node.heartbeat_timeout = 1s;
    node.reboot_delay = 100ms;
    rig.devices.back().objects[{0x1000, 0}] = bytes({0x92, 0x01, 0x02, 0x00});
    for (std::uint16_t i = 0; i < 40; ++i) {
      rig.devices.back().objects[{static_cast<std::uint16_t>(0x2000 + i), 0}] = bytes({0, 0});
    }
    rig.devices.back().heartbeats(rig.now, 50ms);
  }
  rig.lose_one_in(50, GetParam());
  rig.start();
  rig.run(60s);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GE(rig.status(i).boot_count, 1U) << "node " << i + 1;
    for (std::uint16_t k = 0; k < 40; ++k) {
      const ObjectKey key{static_cast<std::uint16_t>(0x2000 + k), 0};
      EXPECT_EQ(rig.device(i).objects[key], bytes({1u + k, 0}));
    }
  }
  EXPECT_GT(rig.lost, 100);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Noise, testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace takt
