// An application that goes on to enable its axis after NMT stop of its node, at any moment of the
// heartbeat.
#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "master/wire/nmt.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

constexpr std::uint32_t words = 0x201;  // RPDO1 of node 1: controlword and target

std::optional<Time> nmt_stop_of_node_1(const Rig& rig) {
  for (const sim::WireFrame& wire : rig.recorder.with(0x000)) {
    if (wire.frame.data[0] == 0x02 && wire.frame.data[1] == 1) return wire.start;
  }
  return std::nullopt;
}

/// Commands both axes in each cycle, as an application does.
void go_on(Rig& rig, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    rig.command_all(0x000F, 1);
    rig.run(1);
  }
}

void stop_node_1(Rig& rig) {
  ASSERT_TRUE(rig.master->submit(
      {.id = 1, .kind = RequestKind::nmt, .node = 1, .command = NmtCommand::stop}));
}

StopResult stop_in_order(Rig& rig) {
  rig.master->request_stop();
  for (int i = 0; i < 5000 && !rig.master->finished(); ++i) {
    rig.command_all(0x000F, 1);
    rig.cycle();
  }
  return rig.status().stop_result;
}

/// Frames of node 1 wait in its transmit queue, so that a heartbeat with OPERATIONAL may leave it
/// after the NMT command.
TEST(NmtStopOfANode, LetsNoWordOutBehindItWhereAHeartbeatIsUnderWay) {
  for (int cycles = 0; cycles < 12; ++cycles) {
    Rig rig{test::axes()};
    ASSERT_TRUE(rig.boot());
    go_on(rig, 5 + cycles);
    stop_node_1(rig);
    rig.world->add({.kind = sim::FaultKind::delay,
                    .node = NodeId::from(1),
                    .at = rig.world->now(),
                    .until = rig.world->now() + 1s,
                    .time = 3ms});
    go_on(rig, 200);

    const auto sent = nmt_stop_of_node_1(rig);
    ASSERT_TRUE(sent);
    EXPECT_LT(rig.recorder.with(words).back().start, *sent + 3ms) << cycles;
    EXPECT_EQ(rig.recorder.with(words).back().frame.data[0], 0x00) << cycles;
    EXPECT_EQ(stop_in_order(rig), StopResult::confirmed) << cycles;
  }
}

/// A controller in the bus thread commands in every cycle, whether frames are sent or not.
TEST(NmtStopOfANode, NeedsNoOtherConfirmationWhereAControllerGoesOn) {
  struct Enabler final : Controller {
    void update(const ImageView&, OutputWriter& out) noexcept override {
      for (const SignalIndex axis : {SignalIndex{0}, SignalIndex{1}}) {
        out.set(4 + axis, 0x000F);
        out.set(6 + axis, 1);
      }
    }
  } enabler;
  Rig rig{test::axes(), {.master = {.controller = &enabler}}};
  ASSERT_TRUE(rig.boot());
  rig.run(5);
  stop_node_1(rig);
  rig.run(200);
  ASSERT_TRUE(nmt_stop_of_node_1(rig));
  EXPECT_EQ(stop_in_order(rig), StopResult::confirmed);
}

/// Another master starts the node again.
TEST(NmtStopOfANode, EndsWithTheSecondHeartbeatThatSaysOperational) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  go_on(rig, 5);
  stop_node_1(rig);
  go_on(rig, 200);
  rig.recorder.frames.clear();
  rig.world->device(1_node)->on_frame(encode(NmtMessage{NmtCommand::start, 1}), rig.world->now());
  go_on(rig, 50);
  EXPECT_FALSE(rig.recorder.with(words).empty());
}

}  // namespace
}  // namespace takt
