#include "master/core/sdo/sdo_server.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

BusPlan served_plan() {
  BusPlan plan{.name = "lift"};
  plan.master_heartbeat = 100ms;
  plan.cycle.period = 2ms;
  plan.cycle.sync_overflow = 10;
  NodePlan node{.name = "shoulder",
                .id = 5_node,
                .description_file = {},
                .product_name = {},
                .mandatory = true,
                .boot_plan = {}};
  node.heartbeat_timeout = 300ms;
  node.boot_plan.steps.push_back(
      {.action = BootAction::expect,
       .object = {0x1018, 1},
       .value = {std::byte{0x5A}, std::byte{0x01}, std::byte{}, std::byte{}}});
  plan.nodes.push_back(node);
  return plan;
}

/// The SDO server of the master (node 127) and a tool that reads it, with literal frames.
class OwnServer : public testing::Test {
 protected:
  OwnServer() {
    statuses[0].nmt = NmtState::operational;
    statuses[0].boot = BootState::ready;
    statuses[0].emcy_count = 3;
  }
  static Frame request(std::initializer_list<std::uint8_t> bytes) {
    return padded(CobId::base(0x67F), bytes);
  }
  static Frame answer(std::initializer_list<std::uint8_t> bytes) {
    return padded(CobId::base(0x5FF), bytes);
  }
  std::vector<Frame> ask(std::initializer_list<std::uint8_t> bytes) {
    server.on_frame(request(bytes), now, orders);
    return answers();
  }
  std::vector<Frame> answers() {
    Outbox out;
    for (int i = 0; i < 20; ++i) server.on_time(now, out);
    return {out.frames().begin(), out.frames().end()};
  }
  using Frames = std::vector<Frame>;

  BusPlan plan = served_plan();
  std::vector<NodeStatus> statuses{1};
  OwnDictionary dictionary{plan, statuses};
  SdoServer server{default_sdo_channel(127_node), dictionary};
  SdoServer::Orders orders = SdoServer::Orders::taken;
  Time now = 1s;
};

TEST_F(OwnServer, ReportsItsCommunicationParameters) {
  EXPECT_EQ(ask({0x40, 0x00, 0x10, 0x00}), Frames{answer({0x43, 0x00, 0x10, 0x00})});
  EXPECT_EQ(ask({0x40, 0x05, 0x10, 0x00}),
            Frames{answer({0x43, 0x05, 0x10, 0x00, 0x80, 0x00, 0x00, 0x40})});
  EXPECT_EQ(ask({0x40, 0x06, 0x10, 0x00}),
            Frames{answer({0x43, 0x06, 0x10, 0x00, 0xD0, 0x07, 0x00, 0x00})});
  EXPECT_EQ(ask({0x40, 0x17, 0x10, 0x00}), Frames{answer({0x4B, 0x17, 0x10, 0x00, 0x64})});
  EXPECT_EQ(ask({0x40, 0x19, 0x10, 0x00}), Frames{answer({0x4F, 0x19, 0x10, 0x00, 0x0A})});
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x00}), Frames{answer({0x4F, 0x18, 0x10, 0x00, 0x04})});
  EXPECT_EQ(ask({0x40, 0x16, 0x10, 0x01}),
            Frames{answer({0x43, 0x16, 0x10, 0x01, 0x2C, 0x01, 0x05, 0x00})});
}

TEST_F(OwnServer, ReportsItsNameInSegments) {
  EXPECT_EQ(ask({0x40, 0x08, 0x10, 0x00}), Frames{answer({0x41, 0x08, 0x10, 0x00, 0x13})});
  EXPECT_EQ(ask({0x60}), Frames{answer({0x00, 't', 'a', 'k', 't', ' ', 'C', 'A'})});
  EXPECT_EQ(ask({0x70}), Frames{answer({0x10, 'N', 'o', 'p', 'e', 'n', ' ', 'm'})});
  EXPECT_EQ(ask({0x60}), Frames{answer({0x05, 'a', 's', 't', 'e', 'r'})});
  EXPECT_EQ(ask({0x60}), Frames{answer({0x80, 0x00, 0x00, 0x00, 0x01, 0x00, 0x04, 0x05})});
}

TEST_F(OwnServer, ReportsItsNameAsABlock) {
  EXPECT_EQ(ask({0xA4, 0x08, 0x10, 0x00, 0x02}), Frames{answer({0xC6, 0x08, 0x10, 0x00, 0x13})});
  EXPECT_EQ(ask({0xA3}), (Frames{answer({0x01, 't', 'a', 'k', 't', ' ', 'C', 'A'}),
                                 answer({0x02, 'N', 'o', 'p', 'e', 'n', ' ', 'm'})}));
  EXPECT_EQ(ask({0xA2, 0x01, 0x7F}), (Frames{answer({0x01, 'N', 'o', 'p', 'e', 'n', ' ', 'm'}),
                                             answer({0x82, 'a', 's', 't', 'e', 'r'})}));
  const auto end = ask({0xA2, 0x02, 0x7F});
  ASSERT_EQ(end.size(), 1U);
  EXPECT_EQ(end[0].data[0], 0xC9);  // two bytes of the last segment are unused
  EXPECT_EQ(ask({0xA1}), Frames{});
  EXPECT_EQ(server.deadline(), never);
}

TEST_F(OwnServer, ReportsTheNodesThatItManages) {
  EXPECT_EQ(ask({0x40, 0x80, 0x1F, 0x00}), Frames{answer({0x43, 0x80, 0x1F, 0x00, 0x01})});
  EXPECT_EQ(ask({0x40, 0x81, 0x1F, 0x05}), Frames{answer({0x43, 0x81, 0x1F, 0x05, 0x0D})});
  EXPECT_EQ(ask({0x40, 0x81, 0x1F, 0x06}), Frames{answer({0x43, 0x81, 0x1F, 0x06})});
  EXPECT_EQ(ask({0x40, 0x85, 0x1F, 0x05}), Frames{answer({0x43, 0x85, 0x1F, 0x05, 0x5A, 0x01})});
  EXPECT_EQ(ask({0x40, 0x82, 0x1F, 0x05}), Frames{answer({0x4F, 0x82, 0x1F, 0x05, 0x05})});
  EXPECT_EQ(ask({0x40, 0x00, 0x21, 0x05}), Frames{answer({0x43, 0x00, 0x21, 0x05, 0x03})});
  statuses[0].boot = BootState::lost;
  EXPECT_EQ(ask({0x40, 0x82, 0x1F, 0x05}), Frames{answer({0x4F, 0x82, 0x1F, 0x05, 0x01})});
}

TEST_F(OwnServer, ReportsHowItStartsTheNetwork) {
  EXPECT_EQ(ask({0x40, 0x89, 0x1F, 0x00}), Frames{answer({0x43, 0x89, 0x1F, 0x00})});
  EXPECT_EQ(ask({0x40, 0x2A, 0x10, 0x00}), Frames{answer({0x4B, 0x2A, 0x10, 0x00})});
  plan.start_up = {
      .start_all = true, .on_loss = MandatoryLoss::reset_all, .boot_time = 30s, .nmt_inhibit = 5ms};
  EXPECT_EQ(ask({0x40, 0x80, 0x1F, 0x00}), Frames{answer({0x43, 0x80, 0x1F, 0x00, 0x13})});
  EXPECT_EQ(ask({0x40, 0x89, 0x1F, 0x00}),
            Frames{answer({0x43, 0x89, 0x1F, 0x00, 0x30, 0x75, 0x00, 0x00})});
  EXPECT_EQ(ask({0x40, 0x2A, 0x10, 0x00}), Frames{answer({0x4B, 0x2A, 0x10, 0x00, 0x32})});
  plan.start_nodes = false;
  plan.start_up = {.start_master = false, .on_loss = MandatoryLoss::stop_all};
  EXPECT_EQ(ask({0x40, 0x80, 0x1F, 0x00}), Frames{answer({0x43, 0x80, 0x1F, 0x00, 0x4D})});
}

TEST_F(OwnServer, ReportsHowItBootsEachNode) {
  const auto word = [](std::uint8_t low) {
    return std::vector{std::byte{low}, std::byte{2}, std::byte{}, std::byte{}};
  };
  NodePlan& node = plan.nodes[0];
  node.mandatory = false;
  node.guard = {.period = 500ms, .retries = 3};
  node.boot_plan.steps = {
      {.action = BootAction::await_alive},
      {.action = BootAction::compare, .object = {0x1F56, 1}, .value = word(0x34)},
      {.action = BootAction::download_program, .object = {0x1F50, 1}},
      {.action = BootAction::compare, .object = {0x1020, 1}, .value = word(0x11)},
      {.action = BootAction::compare, .object = {0x1020, 2}, .value = word(0x22)},
      {.action = BootAction::write, .object = {0x1011, 2}, .value = word(0)}};
  EXPECT_EQ(ask({0x40, 0x81, 0x1F, 0x05}),
            Frames{answer({0x43, 0x81, 0x1F, 0x05, 0xF5, 0x03, 0xF4, 0x01})});
  EXPECT_EQ(ask({0x40, 0x55, 0x1F, 0x05}), Frames{answer({0x43, 0x55, 0x1F, 0x05, 0x34, 0x02})});
  EXPECT_EQ(ask({0x40, 0x26, 0x1F, 0x05}), Frames{answer({0x43, 0x26, 0x1F, 0x05, 0x11, 0x02})});
  EXPECT_EQ(ask({0x40, 0x27, 0x1F, 0x05}), Frames{answer({0x43, 0x27, 0x1F, 0x05, 0x22, 0x02})});
  EXPECT_EQ(ask({0x40, 0x8A, 0x1F, 0x05}), Frames{answer({0x4F, 0x8A, 0x1F, 0x05, 0x02})});
  EXPECT_EQ(ask({0x40, 0x8A, 0x1F, 0x06}), Frames{answer({0x4F, 0x8A, 0x1F, 0x06})});
  EXPECT_EQ(ask({0x40, 0x55, 0x1F, 0x00}), Frames{answer({0x4F, 0x55, 0x1F, 0x00, 0x7F})});
}

TEST_F(OwnServer, ReportsWhatItExpectsOfANodesIdentity) {
  const auto word = [](std::uint8_t low) {
    return std::vector{std::byte{low}, std::byte{1}, std::byte{2}, std::byte{3}};
  };
  plan.nodes[0].boot_plan.steps = {
      {.action = BootAction::expect, .object = {0x1000, 0}, .value = word(0x92)},
      {.action = BootAction::expect, .object = {0x1018, 2}, .value = word(0x22)},
      {.action = BootAction::expect, .object = {0x1018, 3}, .value = word(0x33)},
      {.action = BootAction::expect, .object = {0x1018, 4}, .value = word(0x44)}};
  EXPECT_EQ(ask({0x40, 0x84, 0x1F, 0x05}),
            Frames{answer({0x43, 0x84, 0x1F, 0x05, 0x92, 0x01, 0x02, 0x03})});
  EXPECT_EQ(ask({0x40, 0x85, 0x1F, 0x05}), Frames{answer({0x43, 0x85, 0x1F, 0x05})})
      << "any vendor";
  EXPECT_EQ(ask({0x40, 0x86, 0x1F, 0x05}),
            Frames{answer({0x43, 0x86, 0x1F, 0x05, 0x22, 0x01, 0x02, 0x03})});
  EXPECT_EQ(ask({0x40, 0x87, 0x1F, 0x05}),
            Frames{answer({0x43, 0x87, 0x1F, 0x05, 0x33, 0x01, 0x02, 0x03})});
  EXPECT_EQ(ask({0x40, 0x88, 0x1F, 0x05}),
            Frames{answer({0x43, 0x88, 0x1F, 0x05, 0x44, 0x01, 0x02, 0x03})});
  EXPECT_EQ(ask({0x40, 0x86, 0x1F, 0x06}), Frames{answer({0x43, 0x86, 0x1F, 0x06})})
      << "no such node";
}

TEST_F(OwnServer, TakesNmtRequestsAndNothingElse) {
  EXPECT_EQ(ask({0x2F, 0x82, 0x1F, 0x05, 0x06}), Frames{answer({0x60, 0x82, 0x1F, 0x05})});
  auto order = server.take_order();
  ASSERT_TRUE(order);
  EXPECT_EQ(order->node, 5);
  EXPECT_EQ(order->command, NmtCommand::reset_node);
  EXPECT_FALSE(server.take_order());

  EXPECT_EQ(ask({0x2F, 0x82, 0x1F, 0x80, 0x7F}), Frames{answer({0x60, 0x82, 0x1F, 0x80})});
  order = server.take_order();
  ASSERT_TRUE(order);
  EXPECT_EQ(order->node, 0);
  EXPECT_EQ(order->command, NmtCommand::enter_preoperational);

  struct Refusal {
    Frame asked;
    std::uint32_t code;
  };
  const Refusal refusals[] = {
      {request({0x2B, 0x17, 0x10, 0x00, 0x64}), 0x0601'0002},
      {request({0x2F, 0x82, 0x1F, 0x05, 0x01}), 0x0609'0030},
      {request({0x2B, 0x82, 0x1F, 0x05, 0x05}), 0x0607'0012},
      {request({0x2F, 0x82, 0x1F, 0x06, 0x05}), 0x0800'0020},
      {request({0x40, 0x00, 0x30, 0x00}), 0x0602'0000},
      {request({0x40, 0x08, 0x10, 0x01}), 0x0609'0011},
      {request({0x40, 0x82, 0x1F, 0x80}), 0x0601'0001},
      {request({0xE0}), 0x0504'0001},
  };
  for (const Refusal& refusal : refusals) {
    server.on_frame(refusal.asked, now, orders);
    const auto answered = answers();
    ASSERT_EQ(answered.size(), 1U);
    EXPECT_EQ(answered[0].data[0], 0x80);
    EXPECT_EQ(load_le<std::uint32_t>(std::span{answered[0].data}.subspan(4)), refusal.code);
  }
  EXPECT_FALSE(server.take_order());
}

TEST_F(OwnServer, RefusesNmtRequestsThatNobodyTakes) {
  orders = SdoServer::Orders::refused;
  EXPECT_EQ(ask({0x2F, 0x82, 0x1F, 0x05, 0x06}),
            Frames{answer({0x80, 0x82, 0x1F, 0x05, 0x22, 0x00, 0x00, 0x08})});
  EXPECT_FALSE(server.take_order());
}

TEST_F(OwnServer, TakesAnNmtRequestBySegmentsAndByBlock) {
  EXPECT_EQ(ask({0x21, 0x82, 0x1F, 0x05, 0x01}), Frames{answer({0x60, 0x82, 0x1F, 0x05})});
  EXPECT_EQ(ask({0x0D, 0x05}), Frames{answer({0x20})});
  EXPECT_TRUE(server.take_order());

  EXPECT_EQ(ask({0xC2, 0x82, 0x1F, 0x05, 0x01}), Frames{answer({0xA4, 0x82, 0x1F, 0x05, 0x7F})});
  EXPECT_EQ(ask({0x81, 0x05}), Frames{answer({0xA2, 0x01, 0x7F})});
  EXPECT_EQ(ask({0xD9}), Frames{answer({0xA1})});
  EXPECT_TRUE(server.take_order());
}

TEST_F(OwnServer, ForgetsAClientThatFellSilent) {
  ask({0x40, 0x08, 0x10, 0x00});
  EXPECT_EQ(server.deadline(), now + 1s);
  now += 1s;
  EXPECT_EQ(answers(), Frames{answer({0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05})});
  EXPECT_EQ(server.deadline(), never);
}

TEST_F(OwnServer, NeverAnswersAnAbort) {
  ask({0x40, 0x08, 0x10, 0x00});
  EXPECT_EQ(ask({0x80, 0x08, 0x10, 0x00}), Frames{});
  EXPECT_EQ(ask({0x80, 0x08, 0x10, 0x00}), Frames{});
  EXPECT_EQ(ask({0x40, 0x19, 0x10, 0x00}).size(), 1U);
}

TEST_F(OwnServer, DoesNotAnswerTheEndOfABlockTransferThatCanHasRepeated) {
  ask({0xA4, 0x08, 0x10, 0x00, 0x7F});
  ask({0xA3});
  ask({0xA2, 0x03, 0x7F});
  EXPECT_EQ(ask({0xA1}), Frames{});
  EXPECT_EQ(ask({0xA1}), Frames{});

  ask({0xC2, 0x82, 0x1F, 0x05, 0x01});
  ask({0x81, 0x05});
  server.on_frame(request({0xD9}), now, orders);
  server.on_frame(request({0xD9}), now, orders);
  EXPECT_EQ(answers(), Frames{answer({0xA1})});
}

}  // namespace
}  // namespace takt
