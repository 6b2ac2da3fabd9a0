#include "master/rt/journal/recorded_port.hpp"

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

}  // namespace
}  // namespace takt
