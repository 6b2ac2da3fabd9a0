// A device sends its event-driven PDOs when it is started, and not again until they change.
#include <gtest/gtest.h>

#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using test::Rig;

/// True if each input of the two axes has a value.
bool all_fresh(const Rig& rig) { return !rig.last_stale.empty() && (rig.last_stale[0] & 0xF) == 0; }

Request order(NmtCommand command) {
  return {.id = 1, .kind = RequestKind::nmt, .node = 0, .command = command};
}

class EventDrivenPdos : public testing::TestWithParam<int> {};

TEST_P(EventDrivenPdos, OfANodeThatIsStartedAreInTheImage) {
  Rig rig{test::axes({.nodes = 2,
                      .tpdo_type = static_cast<std::uint8_t>(GetParam()),
                      .period = std::chrono::milliseconds{10}})};
  ASSERT_TRUE(rig.boot());
  rig.run(1);

  EXPECT_TRUE(all_fresh(rig)) << "by its boot, before its heartbeat says so";

  ASSERT_TRUE(rig.master->submit(order(NmtCommand::enter_preoperational)));
  rig.run(5);
  EXPECT_FALSE(all_fresh(rig));
  ASSERT_TRUE(rig.master->submit(order(NmtCommand::start)));
  rig.run(5);
  EXPECT_TRUE(all_fresh(rig)) << "by an application";
}

INSTANTIATE_TEST_SUITE_P(Types, EventDrivenPdos, testing::Values(254, 255));

TEST(EarlyPdos, AreNotMissedWhereTheNodeIsNotOperationalYet) {
  Rig rig{test::axes({.nodes = 1})};
  ASSERT_TRUE(rig.boot());
  rig.run(100);

  for (const Event& event : rig.events) EXPECT_NE(event.kind, EventKind::pdo_missing);
}

}  // namespace
}  // namespace takt
