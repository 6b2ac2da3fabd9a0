// When an RPDO is sent.
#include <gtest/gtest.h>

#include "test/unit/master/core/pdo/outputs_rig.hpp"

namespace takt {
namespace {

BusPlan one_axis(std::uint8_t type = 1, bool seeds = false) {
  BusPlan plan = test::axes({.nodes = 1, .rpdo_type = type});
  if (!seeds) plan.layout.signals[3].seeded_from.reset();
  return plan;
}
constexpr std::size_t controlword = 0;
constexpr std::size_t target = 1;

TEST(PdoOutputs, SendEveryRateOnItsBeat) {
  for (unsigned n = 1; n <= 240; ++n) {
    BusPlan plan = one_axis(static_cast<std::uint8_t>(n));
    for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
    OutputsRig out{plan};
    out.command(controlword, 1);
    out.command(target, 2);
    unsigned sent = 0;
    for (unsigned i = 0; i < 3 * n; ++i) {
      const auto frames = out.pack();
      EXPECT_EQ(frames.size(), i % n == 0 ? 1U : 0U) << n;
      sent += static_cast<unsigned>(frames.size());
    }
    EXPECT_EQ(sent, 3U) << n;
  }
}

TEST(PdoOutputs, SendEventDrivenRpdosOnChangeOnly) {
  for (const std::uint8_t type : std::vector<std::uint8_t>{0, 254, 255}) {
    OutputsRig out{one_axis(type)};
    out.command(controlword, 1);
    out.command(target, 2);
    EXPECT_EQ(out.pack().size(), 1U);
    out.command(controlword, 1);
    out.command(target, 2);
    EXPECT_EQ(out.pack().size(), 0U);
    out.command(target, 3);
    EXPECT_EQ(out.pack().size(), 1U);
  }
}

TEST(PdoOutputs, HoldChangesBackForTheInhibitTimeAndSendTheNewest) {
  BusPlan plan = one_axis(255);
  plan.pdos.rpdos[0].inhibit = 6ms;
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 1);
  out.command(target, 1);
  EXPECT_EQ(out.pack().size(), 1U);
  out.command(target, 2);
  EXPECT_TRUE(out.pack().empty());
  out.command(target, 3);
  EXPECT_TRUE(out.pack().empty());
  const auto frames = out.pack();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].data[2], 3);
}

TEST(PdoOutputs, RepeatAfterTheEventTimer) {
  BusPlan plan = one_axis(255);
  plan.pdos.rpdos[0].event_timer = 8ms;
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 1);
  out.command(target, 1);
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 9; ++i) sizes.push_back(out.pack().size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(PdoOutputs, CountTheirTimesInCyclesHoweverLateTheyWakeUp) {
  BusPlan plan = one_axis(255);
  plan.pdos.rpdos[0].event_timer = 4ms;
  plan.pdos.rpdos[0].inhibit = 4ms;
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 1);
  out.command(target, 1);
  std::vector<std::size_t> sizes;
  for (const Time late : {90us, 10us, 30us, 80us, 0us, 50us, 20us}) {
    out.late = late;
    sizes.push_back(out.pack().size());
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 0, 1, 0, 1, 0, 1}));
}

TEST(PdoOutputs, KeepTheInhibitTimeAlsoAfterAStall) {
  BusPlan plan = one_axis(255);
  plan.pdos.rpdos[0].inhibit = 4ms;
  OutputsRig out{plan};
  out.command(controlword, 1);
  out.command(target, 1);
  out.late = 1ms;
  EXPECT_EQ(out.pack().size(), 1U);
  out.command(target, 2);
  out.late = 0ms;
  EXPECT_TRUE(out.pack().empty());
  EXPECT_TRUE(out.pack().empty()) << "3 ms after the frame before";
  EXPECT_EQ(out.pack().size(), 1U);
}

TEST(PdoOutputs, TryAgainWhatTheInterfaceDidNotTake) {
  OutputsRig out{one_axis(255)};
  out.command(controlword, 1);
  out.command(target, 1);
  out.accepted = 0;
  EXPECT_EQ(out.pack().size(), 1U);
  out.accepted = 100;
  EXPECT_EQ(out.pack().size(), 1U);
  EXPECT_TRUE(out.pack().empty());
}

}  // namespace
}  // namespace takt
