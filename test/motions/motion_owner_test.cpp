// Which sender the gateway regards as the owner of an axis. The test plays the bus thread.
#include <gtest/gtest.h>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/motion/motion_commands.hpp"
#include "master/lcm/messages.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using test::MotionBus;

/// The gateway of two axes at standstill.
class Desk {
 public:
  Desk()
      : network{load_network(MotionBus::demo)},
        nodes(network.plan.nodes.size()),
        commands{network.plan,
                 {.session = 7},
                 [](SignalIndex, std::int64_t, std::uint32_t) {},
                 [](const Notice&) {}},
        motions{network.plan, commands,
                [this](const motion::MotionMessage& message) {
                  sent.push_back(message);
                  return true;
                },
                [](const Notice&) {}} {
    for (NodeStatus& node : nodes) {
      node.nmt = NmtState::operational;
      node.boot = BootState::ready;
    }
    report.cycle = 100;
    report.axes.resize(2);
    for (motion::AxisReport& axis : report.axes) axis.state = motion::AxisState::standing;
  }
  CommandContext at(std::uint64_t cycle) const { return {.cycle = cycle, .nodes = nodes}; }
  int sent_of(motion::MessageKind kind) const {
    return static_cast<int>(std::ranges::count(sent, kind, &motion::MotionMessage::kind));
  }

  LoadedNetwork network;
  std::vector<NodeStatus> nodes;
  Commands commands;
  std::vector<motion::MotionMessage> sent;
  MotionCommands motions;
  MotionSnapshot report;
};

TEST(MotionOwner, AMotionThatBeginsAndEndsBetweenTwoReportsHasOne) {
  Desk desk;
  desk.motions.observe(desk.report, desk.at(100));
  motion_command_t move{};
  move.schema = message_schema;
  move.session = 7;
  move.instance = 5;
  move.sender = "test";
  move.cycle = 100;
  move.id = 1;
  move.kind = "move";
  move.goals = {MotionBus::goal("shoulder", 0.001)};
  move.num_goals = 1;
  desk.motions.take(move, desk.at(100));
  ASSERT_EQ(desk.sent_of(motion::MessageKind::order), 1);
  const std::uint32_t order = desk.sent.back().order.id;
  desk.motions.take(motion::MotionEnd{.axis = 0, .order = {order, motion::Outcome::done}},
                    desk.at(130));
  desk.report.cycle = 130;
  desk.motions.observe(desk.report, desk.at(130));
  desk.motions.serve(desk.at(130));
  EXPECT_EQ(desk.sent_of(motion::MessageKind::left), 0);
  desk.motions.serve(desk.at(1000));  // the node is free again
  EXPECT_EQ(desk.sent_of(motion::MessageKind::left), 1);
}

}  // namespace
}  // namespace takt
