// The causes of cycles without SYNC in the event `cycles_missed`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vector>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/rt/bus_loop_rig.hpp"

namespace takt {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A bus on which each SYNC is on the wire 60 us after send(), while `echoes` is true.
class EchoLoop : public Loop {
 public:
  EchoLoop() {
    port.on_sent = [this](const Frame& frame) {
      const bool seen = echoes && frame.id == CobId::base(0x080);
      if (seen) port.news_now.last_sync_echo = port.now() + 60us;
    };
  }
  /// Returns the causes of all cycles without SYNC so far.
  std::vector<MissedBecause> causes() {
    std::vector<MissedBecause> all;
    for (Event event; exchange->events.pop(event);) {
      if (event.kind != EventKind::cycles_missed) continue;
      all.push_back(static_cast<MissedBecause>(event.detail));
    }
    return all;
  }

  bool echoes = true;
};

TEST(MissedCycles, BlameTheBusThreadForTheSyncThatItHandedOverLate) {
  EchoLoop bus;
  bus.run(5);

  bus.port.send_stall = 1950us;  // of a period of 2 ms
  bus.echoes = false;
  bus.run(2);
  bus.port.news_now.last_sync_echo = bus.port.now();
  bus.echoes = true;
  bus.run(50);

  EXPECT_EQ(bus.status().cycles_missed, 1U);
  EXPECT_EQ(bus.causes(), std::vector{MissedBecause::sent_late});
}

TEST(MissedCycles, BlameTheWireOnlyForWhatTheControllerReports) {
  EchoLoop bus;
  bus.run(5);
  const auto miss_five = [&](bool error_passive) {
    bus.echoes = false;
    bus.run(3);
    bus.port.news_now.error_passive = error_passive;
    bus.run(3);
    bus.port.news_now.last_sync_echo = bus.port.now();
    bus.port.news_now.error_passive = false;
    bus.echoes = true;
    bus.run(3);
    return bus.causes();
  };

  EXPECT_EQ(miss_five(false), std::vector{MissedBecause::not_seen});
  EXPECT_EQ(miss_five(true), std::vector{MissedBecause::wire_blocked});
}

TEST(MissedCycles, OfALongerSilenceAreNotExplainedByOneLateCycle) {
  EchoLoop bus;
  bus.run(5);

  bus.port.send_stall = 1950us;
  bus.echoes = false;
  bus.run(10);
  bus.port.news_now.last_sync_echo = bus.port.now();
  bus.echoes = true;
  bus.run(2);

  EXPECT_EQ(bus.causes(), std::vector{MissedBecause::not_seen});
}

TEST(MissedCycles, NameBusOffOnlyWhereTheControllerReportsIt) {
  const auto text_of = [](MissedBecause cause) {
    const Event event{
        .kind = EventKind::cycles_missed, .detail = static_cast<std::uint32_t>(cause), .value = 1};
    return describe(test::axes(), event);
  };

  EXPECT_THAT(text_of(MissedBecause::wire_blocked),
              HasSubstr("is bus-off or no node acknowledges"));
  EXPECT_THAT(
      text_of(MissedBecause::sent_late),
      AllOf(HasSubstr("1 cycle without SYNC: the bus thread was late"), Not(HasSubstr("bus-off"))));
  EXPECT_THAT(text_of(MissedBecause::not_seen),
              AllOf(HasSubstr("the controller reports no error"), Not(HasSubstr("bus-off"))));
  EXPECT_THAT(text_of(MissedBecause::late), HasSubstr("1 cycle missed: the bus thread was late"));
}

}  // namespace
}  // namespace takt
