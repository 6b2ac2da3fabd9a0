// The texts of events contain the right numbers. The words around the numbers may change.
#include "master/explain/event_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class EventText : public testing::Test {
 protected:
  BusPlan plan = axes({});
};

TEST_F(EventText, APdoHasItsNumber) {
  for (const EventKind kind :
       {EventKind::pdo_missing, EventKind::pdo_back, EventKind::pdo_late, EventKind::pdo_length}) {
    EXPECT_THAT(describe(plan, {.kind = kind, .node = 1, .detail = 77, .value = 3}),
                HasSubstr("TPDO3 "));
  }
  EXPECT_THAT(describe(plan, {.kind = EventKind::pdo_back, .node = 1, .value = 3}),
              HasSubstr("back"));
  EXPECT_THAT(describe(plan, {.kind = EventKind::pdo_late, .node = 1, .detail = 77, .value = 3}),
              HasSubstr("77 us"));
}

TEST_F(EventText, OneCycleIsNoPlural) {
  const auto text = [this](std::int64_t cycles) {
    return describe(plan, {.kind = EventKind::cycles_missed, .value = cycles});
  };
  EXPECT_THAT(text(1), HasSubstr("1 cycle "));
  EXPECT_THAT(text(2), HasSubstr("2 cycles "));
}

TEST_F(EventText, AJumpOfTheSyncCounterHasBothNumbers) {
  const auto text = [this](std::int64_t received, std::uint32_t expected) {
    return describe(plan, {.kind = EventKind::sync_jump, .detail = expected, .value = received});
  };
  EXPECT_THAT(text(5, 3), AllOf(HasSubstr("counter 5"), HasSubstr("expected 3")));
  EXPECT_THAT(text(-1, 3), AllOf(HasSubstr("without counter"), HasSubstr("expected 3")));
  EXPECT_THAT(text(5, 0), AllOf(HasSubstr("`sync_overflow`"), Not(HasSubstr("expected"))));
}

TEST_F(EventText, EachReactionToALossHasItsOwnText) {
  std::set<std::string> texts;
  for (std::int64_t reaction = 0; reaction < 4; ++reaction) {
    const std::string text = reaction_text({.value = reaction});
    EXPECT_GT(text.size(), 10U) << reaction;
    texts.insert(text);
  }
  EXPECT_EQ(texts.size(), 4U);
}

TEST_F(EventText, TheFirstAxisOfADriveHasNoNumber) {
  const auto text = [this](std::uint32_t axis) {
    return named_axis_stop_text(plan, {.node = 1, .detail = axis << 8U});
  };
  EXPECT_THAT(text(0), Not(HasSubstr("axis 1")));
  EXPECT_THAT(text(1), HasSubstr(" axis 2 "));
}

TEST_F(EventText, AReadLimitIsNamedByItsLine) {
  plan.limits.lines = {{.axis = 1,
                        .object = {0x607F, 0},
                        .kind = LimitKind::velocity,
                        .unit = "rad/s",
                        .scale = 0.5}};
  EXPECT_THAT(read_limit_text(plan, {.detail = 0, .value = 4}),
              AllOf(HasSubstr("velocity 2 rad/s"), HasSubstr("607F")));
  EXPECT_THAT(read_limit_text(plan, {.detail = 1U << 8U, .value = 4}), Not(HasSubstr("607F")));
}

TEST_F(EventText, ADeviceThatGotItsIdByLssHasItsSerialNumber) {
  EXPECT_THAT(describe(plan, {.kind = EventKind::lss_assigned, .node = 1, .value = 4711}),
              AllOf(HasSubstr("4711"), HasSubstr("by LSS")));
}

TEST_F(EventText, ADriveThatStaysArmedNamesTheObject) {
  EXPECT_THAT(still_armed_text({.detail = 0x6007U << 8U | 1U}), HasSubstr("6007:01"));
}

}  // namespace
}  // namespace takt::test
