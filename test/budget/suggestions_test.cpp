#include "eds_parser/budget/suggestions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/print_budget.hpp"
#include "test/budget/changed_plan.hpp"
#include "test/budget/random_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

std::vector<Suggestion> suggestions_for(const BusPlan& plan) {
  return cheapest_changes(plan, {}, {},
                          [&](const WhatIf& changes) { return changed(plan, changes); });
}

TEST(Suggestions, ThePeriodIsTheShortestOnWhichItFits) {
  const auto plan = hand_made_bus(4, 1ms);
  ASSERT_FALSE(bus_budget(plan).fits());

  const auto found = suggestions_for(plan);

  // At 1750 us the window ends at 885 us, at 1800 us at 909 us; the last TPDO ends after 895 us.
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].text, "SYNC every 1800 us instead of 1000 us");
  EXPECT_EQ(to_string(found[0].changes), "period=1800us");
  EXPECT_TRUE(bus_budget(*changed(plan, found[0].changes)).fits());
}

TEST(Suggestions, ABitRateIsTheLowestOnWhichItFits) {
  auto plan = hand_made_bus(4, 4ms);
  plan.bitrate = 250'000;
  compile(plan);

  const auto found = suggestions_for(plan);

  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].text, "500 kbit/s instead of 250");
}

/// Makes a bus of four drives. The first drive has `events` event-driven TPDOs that have priority
/// over all other TPDOs.
BusPlan with_urgent_events(Time period, std::uint16_t events, std::uint8_t bytes) {
  auto plan = hand_made_bus(4, period);
  for (auto& row : plan.pdos.tpdos) row.cob_id = CobId::base(row.cob_id.id() + 0x100U);
  for (std::uint16_t number = 2; number < 2 + events; ++number) {
    plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x17FU + number),
                               .node = plan.nodes[0].id,
                               .node_index = 0,
                               .number = number,
                               .transmission = 255,
                               .length = bytes,
                               .inhibit = 50ms});
  }
  compile(plan);
  return plan;
}

TEST(Suggestions, AnotherIdentifierIsWhatMakesItFit) {
  // Without this TPDO the last TPDO ends after 895 of 909 us.
  const auto plan = with_urgent_events(1800us, 1, 8);
  ASSERT_FALSE(bus_budget(plan).fits());

  const auto found = suggestions_for(plan);

  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].text, "lower priority than all synchronous PDOs for TPDO2 n1");
  EXPECT_EQ(to_string(found[0].changes), "n1.tpdo2.cob_id=0x57F");
  EXPECT_TRUE(bus_budget(*changed(plan, found[0].changes)).fits());
}

TEST(Suggestions, NoMoreIdentifiersAreChangedThanMustBe) {
  // There is time for one frame of 65 us before the window ends, but not for two.
  const auto plan = with_urgent_events(2ms, 2, 1);
  ASSERT_FALSE(bus_budget(plan).fits());

  const auto found = suggestions_for(plan);

  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].text, "lower priority than all synchronous PDOs for TPDO2 n1");
  EXPECT_TRUE(bus_budget(*changed(plan, found[0].changes)).fits());
}

/// Makes a bus at 1 Mbit/s of two drives and a device that sends four TPDOs each millisecond.
BusPlan with_a_talker(Time inhibit) {
  auto plan = hand_made_bus(3, 2ms);
  for (std::uint16_t number = 2; number <= 9; ++number) {
    auto row = plan.pdos.tpdos[0];
    row.number = number;
    row.cob_id = CobId::base(0x300U + number);
    row.transmission = 255;
    row.inhibit = inhibit;
    plan.pdos.tpdos.push_back(row);
  }
  compile(plan);
  return plan;
}

TEST(Suggestions, WhereNoChangeAloneIsEnoughTwoAreReported) {
  const auto plan = with_a_talker(1ms);  // 8 x 135 us each ms: no period is enough
  ASSERT_FALSE(bus_budget(plan).fits());

  const auto found = suggestions_for(plan);

  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found[0].text, testing::ContainsRegex("^inhibit times [0-9]+ times as long for "));
  EXPECT_THAT(
      found[0].text,
      testing::HasSubstr("; and every second SYNC, alternately (SYNC with counter), for TPDO1 n3"));
  EXPECT_TRUE(bus_budget(*changed(plan, found[0].changes)).fits());
}

/// At 20 kbit/s: TPDO2 leaves so little room that TPDO3, which has the lowest priority, needs
/// seconds.
BusPlan with_a_slow_frame(Time inhibit) {
  auto plan = hand_made_bus(1, 1s);
  plan.bitrate = 20'000;
  for (std::uint16_t number = 2; number <= 3; ++number) {
    auto row = plan.pdos.tpdos[0];
    row.number = number;
    row.cob_id = CobId::base(number == 2 ? 0x190U : 0x500U);
    row.transmission = 255;
    row.inhibit = number == 2 ? inhibit : 3s;
    plan.pdos.tpdos.push_back(row);
  }
  compile(plan);
  return plan;
}

Time worst_of(const BusPlan& plan, const std::string& name) {
  for (const BudgetRow& row : bus_budget(plan).rows) {
    if (row.frame.name == name) return row.worst.value_or(Time::max());
  }
  return {};
}

TEST(Suggestions, AFrameThatNeedsMoreThanTheLongestInhibitTimeDoesNotHideThoseOfOthers) {
  Time inhibit = 8ms;
  while (worst_of(with_a_slow_frame(inhibit), "TPDO3 n1") < 3500ms) inhibit -= 2us;
  const auto plan = with_a_slow_frame(inhibit);
  ASSERT_LT(worst_of(plan, "TPDO3 n1"), 6500ms) << "it has a bound";

  const auto found = suggestions_for(plan);

  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].text, "longer inhibit times for TPDO2 n1, TPDO3 n1");
  EXPECT_TRUE(bus_budget(*changed(plan, found[0].changes)).fits());
}

/// Reads changes as typed on the command line.
WhatIf read_back(const WhatIf& changes) {
  WhatIf out;
  std::istringstream in{to_string(changes)};
  for (std::string change; std::getline(in, change, ',');) EXPECT_TRUE(add_change(change, out));
  return out;
}

TEST(Suggestions, EachThatIsReportedMakesItFitAsItIsTyped) {
  unsigned reported = 0;
  unsigned combined = 0;
  for (unsigned network = 0; network < 25; ++network) {
    sim::Random random{network};
    const BusPlan plan = random_bus(random, {.by_event = 0.3, .least_percent = 60});
    if (bus_budget(plan).fits()) continue;

    for (const auto& suggestion : suggestions_for(plan)) {
      const auto other = changed(plan, read_back(suggestion.changes));
      EXPECT_TRUE(bus_budget(*other).fits())
          << "network " << network << ": " << to_string(suggestion.changes);
      ++reported;
      combined += suggestion.text.find("; and ") != std::string::npos;
    }
  }
  EXPECT_GT(reported, 20U);
  EXPECT_GT(combined, 0U);
}

TEST(Suggestions, ThatNothingHelpsIsFoundInBoundedTime) {
  auto plan = hand_made_bus(2, 2ms);
  plan.nodes[0].heartbeat_period = 50us;  // more than the whole bus at any rate
  unsigned tries = 0;

  const auto found = cheapest_changes(plan, {}, {}, [&](const WhatIf& changes) {
    ++tries;
    return changed(plan, changes);
  });

  EXPECT_TRUE(found.empty());
  EXPECT_LT(tries, 500U);
}

TEST(WhatIf, IsWrittenAsItIsRead) {
  const std::string text =
      "period=1500us,bitrate=500,services=2,counter=60,arm.tpdo2=10,arm.tpdo2.start=3,"
      "arm.tpdo2.inhibit=10ms,arm.tpdo2.cob_id=0x1C0,x.y.rpdo1=off";
  WhatIf changes;
  std::istringstream in{text};
  for (std::string change; std::getline(in, change, ',');) {
    EXPECT_TRUE(add_change(change, changes)) << change;
  }

  ASSERT_EQ(changes.pdos.size(), 2U);
  EXPECT_EQ(changes.pdos[1].node, "x.y");
  EXPECT_EQ(to_string(changes), text);
}

TEST(WhatIf, BlanksAroundAChangeAreNoPartOfIt) {
  WhatIf changes;

  EXPECT_TRUE(add_change(" bitrate = 500 ", changes));
  EXPECT_TRUE(add_change(" arm.tpdo2=10", changes));

  EXPECT_EQ(to_string(changes), "bitrate=500,arm.tpdo2=10");
}

TEST(WhatIf, WhatANetworkFileMayNotHaveIsRefused) {
  for (const auto* text :
       {"counter=1", "arm.tpdo1=241", "arm.tpdo1=251", "arm.rpdo1=252", "arm.rpdo1=253",
        "period=199us", "services=251", "arm.tpdo1.start=241"}) {
    WhatIf changes;
    EXPECT_FALSE(add_change(text, changes)) << text;
  }
  for (const auto* text :
       {"counter=0", "counter=2", "arm.tpdo1=240", "arm.tpdo1=252", "arm.rpdo1=254", "period=200us",
        "services=250", "arm.tpdo1.start=240"}) {
    WhatIf changes;
    EXPECT_TRUE(add_change(text, changes)) << text;
  }
}

TEST(WhatIf, WhatItCanNotBeIsRefused) {
  for (const auto* text :
       {"", "period", "period=", "period=1", "period=0us", "period=61s", "bitrate=300", "=5",
        "counter=241", "arm.tpdo=1", "arm.tpdo0=1", "arm.tpdo513=1", ".tpdo1=1", "arm.tpdo1=256",
        "arm.tpdo1.what=1", "arm.tpdo1.inhibit=150us", "arm.tpdo1.inhibit=7s", "services=0"}) {
    WhatIf changes;
    EXPECT_FALSE(add_change(text, changes)) << text;
  }
}

TEST(Pictures, TheTextShowsEachFrameWhereItIsAtTheLatest) {
  const auto plan = hand_made_bus(1, 1440us);
  std::ostringstream out;
  print_budget_timeline(out, plan, bus_budget(plan));

  // a column is 20 us: SYNC ends at 190, the TPDO at 490 us; the window at 733
  EXPECT_THAT(out.str(), testing::HasSubstr("\n  us       0         200 "));
  EXPECT_THAT(out.str(), testing::HasSubstr("\n  SYNC     ......###  "));
  EXPECT_THAT(out.str(), testing::HasSubstr("\n  TPDO1 n1   ...............#######  "));
  EXPECT_THAT(out.str(), testing::HasSubstr("     490     243\n"));
}

TEST(Pictures, WhatIsTooLateIsRedInTheSvgAndHasItsMargin) {
  auto plan = hand_made_bus(1, 2ms);
  plan.cycle.receive_window = 400us;
  std::ostringstream out;
  print_budget_svg(out, plan, bus_budget(plan));

  EXPECT_THAT(out.str(), testing::HasSubstr("It does not fit."));
  EXPECT_THAT(out.str(), testing::HasSubstr(">490</text>\n<text x="));
  EXPECT_THAT(out.str(), testing::HasSubstr("fill=\"#c0392b\">-90</text>"));
  EXPECT_THAT(out.str(), testing::HasSubstr(">receive window ends 400 us</text>"));
}

/// Returns a bus on which the last RPDO ends behind SYNC, but fits.
BusPlan bus_with_late_sync() {
  for (Time period = 2ms; period < 6ms; period += 50us) {
    BusPlan plan = with_urgent_events(period, 1, 8);
    const BusBudget budget = bus_budget(plan);
    const BudgetRow* const row = budget.tightest();
    if (budget.fits() && row != nullptr && row->is_behind_sync()) return plan;
  }
  return {};
}

TEST(Pictures, AgreeWithTheWordsOnAnOutputBehindSync) {
  const BusPlan plan = bus_with_late_sync();
  ASSERT_FALSE(plan.nodes.empty());
  const BusBudget budget = bus_budget(plan);
  std::ostringstream text;
  std::ostringstream picture;
  std::ostringstream svg;
  print_budget_text(text, plan, budget);
  print_budget_timeline(picture, plan, budget);
  print_budget_svg(svg, plan, budget);

  EXPECT_THAT(text.str(), testing::StartsWith("It fits. SYNC can be "));
  EXPECT_THAT(text.str(), testing::HasSubstr("  behind SYNC\n"));
  EXPECT_THAT(picture.str(), testing::ContainsRegex("\n  RPDO1 n4 .*#*[+]+ "));
  EXPECT_THAT(svg.str(), testing::HasSubstr("fill=\"#e08a00\""));
  EXPECT_THAT(svg.str(), testing::HasSubstr("It fits; outputs may delay SYNC."));
}

TEST(Pictures, FitTheTerminal) {
  const auto plan = hand_made_bus(2, 2ms);
  std::ostringstream out;
  print_budget_timeline(out, plan, bus_budget(plan), 60);

  std::istringstream lines{out.str()};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) {
      EXPECT_LE(line.size(), 60U) << line;
    }
  }
}

TEST(BudgetText, BeginsWithTheVerdictAndTheWorstMargin) {
  const auto plan = hand_made_bus(1, 1440us);
  std::ostringstream out;
  print_budget_text(out, plan, bus_budget(plan));

  EXPECT_THAT(
      out.str(),
      testing::ContainsRegex(
          "^It fits(, with a margin of [0-9]+ us|[.] SYNC can be [0-9]+ us late if all these "
          "frames come at once, "
          "and [0-9]+ us are permitted):\n  [TR]PDO1 n1 ends at [0-9]+ us, "));
}

TEST(Pictures, SayThatThereIsNoCycleWithoutSync) {
  auto plan = hand_made_bus(1, 2ms);
  plan.cycle.sync = false;
  std::ostringstream text;
  std::ostringstream svg;
  print_budget_timeline(text, plan, bus_budget(plan));
  print_budget_svg(svg, plan, bus_budget(plan));

  EXPECT_EQ(text.str(),
            "\nno SYNC: no frame has a fixed place in the cycle, so there is no picture\n");
  EXPECT_THAT(svg.str(), testing::HasSubstr("no SYNC, a cycle of 2 ms"));
  EXPECT_THAT(svg.str(), testing::Not(testing::HasSubstr("outputs go out")));
  EXPECT_THAT(svg.str(), testing::EndsWith("</svg>\n"));
}

TEST(Pictures, NamesDoNotBreakTheSvg) {
  auto plan = hand_made_bus(1, 2ms);
  plan.nodes[0].name = "<a&b>";
  std::ostringstream out;
  print_budget_svg(out, plan, bus_budget(plan));

  EXPECT_THAT(out.str(), testing::HasSubstr("TPDO1 &lt;a&amp;b&gt;</text>"));
  EXPECT_THAT(out.str(), testing::EndsWith("</svg>\n"));
}

}  // namespace
}  // namespace takt
