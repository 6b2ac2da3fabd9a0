#include "master/rt/journal/recorded_port.hpp"

#include <array>
#include <gtest/gtest.h>

#include "test/unit/master/rt/fake_port.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(RecordedPort, HidesChangesOfTheTimeOfDayThatAreJitter) {
  test::FakePort port;
  Journal journal{8192};
  const RecordedPort<test::FakePort> recorded{port, &journal};
  const auto shown = [&](Time since_1970) {
    port.news_now.since_1970 = since_1970;
    return recorded.condition().since_1970;
  };

  EXPECT_EQ(shown(1h), 1h);
  EXPECT_EQ(shown(1h + 50us), 1h);
  EXPECT_EQ(shown(1h - 50us), 1h);
  EXPECT_EQ(shown(1h + 51us), 1h + 51us);
  EXPECT_EQ(shown(1h), 1h);
  EXPECT_EQ(shown(1h - 1us), 1h);
}

TEST(RecordedPort, EachPartOfTheConditionComesBackAlone) {
  const PortCondition conditions[]{
      {},
      {.interface_down = true},
      {.error_passive = true},
      {.bus_off = true},
      {.receive_overruns = 0xFFFF'FFFF},
      {.error_frames = 0xFFFF'FFFF},
      {.tx_error_counter = 0xFF},
      {.rx_error_counter = 0xFF},
      {.last_error = 100},
      {.last_error = -1},
  };
  for (const PortCondition& condition : conditions) {
    std::array<std::uint64_t, 3> words{};
    journal::put_state(condition, words.data());
    PortCondition back;
    journal::get_state(words.data(), back);
    EXPECT_EQ(back, condition) << &condition - conditions;
  }
}

}  // namespace
}  // namespace takt
