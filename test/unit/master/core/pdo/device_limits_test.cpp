// Limits that the boot has read from a drive, checked when the outputs are packed.
#include <gtest/gtest.h>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/pdo/limited_axes.hpp"

namespace takt::test {
namespace {

constexpr ObjectKey lowest{0x607D, 1};
constexpr ObjectKey highest{0x607D, 2};
constexpr ObjectKey fastest{0x607F, 0};

/// The device gives 607D in counts of 1 mrad and 607F in units of 0.01 rad/s, which are 0.02 counts
/// in 2 ms.
void reported_by_the_device(BusPlan& plan) {
  const SignalIndex target = plan.limits.outputs[0].signal;
  plan.limits.outputs[0].range = LimitKind::position;
  plan.limits.lines = {{.axis = 1,
                        .object = lowest,
                        .kind = LimitKind::position,
                        .source = LimitSource::device,
                        .unit = "rad",
                        .scale = 0.001,
                        .signals = {target}},
                       {.axis = 1,
                        .object = fastest,
                        .kind = LimitKind::velocity,
                        .source = LimitSource::device,
                        .unit = "rad/s",
                        .scale = 0.01,
                        .signals = {target}}};
  plan.limits.device = {
      {.object = lowest, .signal = target, .bound = DeviceBound::range, .line = 0},
      {.object = fastest, .signal = target, .bound = DeviceBound::rate, .factor = 0.02, .line = 1}};
}

LimitedAxes axis() { return LimitedAxes{1, {.wraps = true}, reported_by_the_device}; }

std::string reported(LimitedAxes& axes, const std::vector<LimitReading>& readings) {
  axes.learn(0, readings);
  std::string lines;
  for (const Event& event : axes.reported()) {
    EXPECT_EQ(event.kind, EventKind::limit_read);
    lines += describe(axes.plan(), event) + "\n";
  }
  return lines;
}

TEST(DeviceLimits, HoldCommandsAndAreReported) {
  LimitedAxes axes = axis();
  EXPECT_EQ(reported(axes, {{lowest, 0xFFFF'FC18}, {highest, 2000}, {fastest, 500}}),
            "node 1 'axis1': limit: position -1 .. 2 rad, read from the device (607D:01)\n"
            "node 1 'axis1': limit: velocity 5 rad/s, read from the device (607F:00)\n");

  axes.cycle_with(0, 10);
  EXPECT_EQ(axes.position(), 10);
  axes.cycle_with(0, 21);  // 11 counts where 10 are allowed
  EXPECT_EQ(axes.position(), 10);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(DeviceLimits, OfARangeHoldCommandsThatComeSlowly) {
  LimitedAxes axes = axis();
  axes.learn(0, std::vector<LimitReading>{{lowest, 0xFFFF'FC18}, {highest, 15}});
  axes.cycle_with(0, 10);
  axes.cycle_with(0, 16);
  EXPECT_EQ(axes.position(), 10);
  EXPECT_EQ(axes.controlword(), quick_stop);
}

TEST(DeviceLimits, OfARangeHaveTheUnitOfTheDevice) {
  LimitedAxes axes{1, {.wraps = true}, [](BusPlan& plan) {
                     reported_by_the_device(plan);
                     plan.limits.device[0].factor = 0.5;
                   }};
  axes.learn(0, std::vector<LimitReading>{{lowest, 0xFFFF'FC18}, {highest, 2000}});
  for (const std::int64_t inside : {-500, 1000}) {
    axes.cycle_with(0, inside);
    EXPECT_EQ(axes.position(), inside);
  }
  EXPECT_EQ(axes.refusals(), 0U);

  axes.cycle_with(0, -501);
  EXPECT_EQ(axes.refusals(), 1U);
  EXPECT_EQ(axes.controlword(), quick_stop);
}

TEST(DeviceLimits, ThatAreImplausibleAreIgnoredAndThatIsReported) {
  const std::vector<std::vector<LimitReading>> cases{
      {{lowest, 0}, {highest, 0}},
      {{lowest, 5}, {highest, 5}},
      {{lowest, 5}, {highest, 4}},
      {{lowest, 0x8000'0000}, {highest, 0x7FFF'FFFF}},
      {{lowest, 0x8000'0001}, {highest, 0x7FFF'FFFF}},
      {{fastest, 0}},
      {{fastest, 0x7FFF'FFFF}},
      {{fastest, 0x8000'0000}},  // negative
      {{fastest, 0xFFFF'FFFF}},
  };
  for (const auto& readings : cases) {
    LimitedAxes axes = axis();
    EXPECT_NE(reported(axes, readings).find("is implausible and is ignored; write `limits: {"),
              std::string::npos);
    axes.cycle_with(0, 10);
    axes.cycle_with(0, 500'000);
    EXPECT_EQ(axes.position(), 500'000) << readings[0].value;
    EXPECT_EQ(axes.refusals(), 0U);
  }
}

TEST(DeviceLimits, MayLeaveOneEndOpen) {
  LimitedAxes above = axis();
  EXPECT_EQ(reported(above, {{lowest, 0}, {highest, 0x7FFF'FFFF}}),
            "node 1 'axis1': limit: position from 0 rad, read from the device (607D:01)\n");
  above.cycle_with(0, 500'000);
  above.cycle_with(0, -1);
  EXPECT_EQ(above.position(), 500'000);
  EXPECT_EQ(above.refusals(), 1U);

  LimitedAxes below = axis();
  EXPECT_EQ(reported(below, {{lowest, 0x8000'0000}, {highest, 1000}}),
            "node 1 'axis1': limit: position up to 1 rad, read from the device (607D:01)\n");
  below.cycle_with(0, -500'000);
  below.cycle_with(0, 1001);
  EXPECT_EQ(below.position(), -500'000);
  EXPECT_EQ(below.refusals(), 1U);
}

TEST(DeviceLimits, OfHalfARangeAreNone) {
  LimitedAxes axes = axis();
  EXPECT_EQ(reported(axes, {{highest, 15}}), "");
  axes.cycle_with(0, 16);
  EXPECT_EQ(axes.position(), 16);
}

TEST(DeviceLimits, EndWhenTheNodeBootsAgainAndReportsOthers) {
  LimitedAxes axes = axis();
  axes.learn(0, std::vector<LimitReading>{{lowest, 0xFFFF'FC18}, {highest, 15}});
  axes.open(0);
  axes.cycle_with(0, 16);
  EXPECT_EQ(axes.position(), 16);
}

TEST(DeviceLimits, StandBesideThoseOfTheFile) {
  LimitedAxes axes{1, {.high = 12, .wraps = true}, reported_by_the_device};
  axes.learn(0, std::vector<LimitReading>{{lowest, 0xFFFF'FC18}, {highest, 15}, {fastest, 500}});
  axes.cycle_with(0, 10);
  axes.cycle_with(0, 13);
  EXPECT_EQ(axes.position(), 10);
}

}  // namespace
}  // namespace takt::test
