// A service frame is sent only if there is also room for everything else that may be sent before
// the outputs.
#include <gtest/gtest.h>

#include "test/unit/master/rt/bus_loop_rig.hpp"

namespace takt {
namespace {

constexpr std::uint32_t request = 0x601;

/// Two axes at 1 Mbit/s. After the last PDO there are 1200 us until the outputs. A dialogue takes
/// 270 us, an answer 135 us.
struct Room : testing::Test {
  Room() { bus.run(40); }

  /// Returns the number of frames with this identifier in the next cycle.
  std::size_t sent(std::uint32_t id) {
    bus.port.sent.clear();
    bus.run(1);
    return bus.port.sent_with(id).size();
  }

  Loop bus;
};

TEST_F(Room, AnswersThatServersOweKeepTheirs) {
  bus.network->awaited = 8;
  bus.network->to_send.assign(2, make_frame(CobId::base(request), {0x40}));
  EXPECT_EQ(sent(request), 0U);

  bus.network->awaited = 6;
  EXPECT_EQ(sent(request), 1U);

  bus.network->awaited = 4;
  EXPECT_EQ(sent(request), 1U);
}

TEST_F(Room, ARequestThatFoundNoneForTwoCyclesGoesOutBehindSync) {
  bus.network->awaited = 8;
  bus.network->to_send.assign(1, make_frame(CobId::base(request), {0x40}));
  bus.run(2);

  ASSERT_EQ(sent(request), 1U);
  EXPECT_EQ(bus.port.sent_with(0x080)[0].when, bus.port.sent_with(request)[0].when);
}

TEST_F(Room, WhileNobodyExchangesPdosALateAnswerDoesNoHarm) {
  for (std::size_t node = 0; node < 2; ++node) bus.network->set_up(node, false);
  bus.network->awaited = 100;
  bus.network->to_send.assign(1, make_frame(CobId::base(request), {0x40}));

  EXPECT_EQ(sent(request), 1U);
}

}  // namespace
}  // namespace takt
