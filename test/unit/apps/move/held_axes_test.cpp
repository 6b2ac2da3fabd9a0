#include "apps/move/held_axes.hpp"

#include <gtest/gtest.h>
#include <memory>

#include "test/unit/apps/axis/fake_lcm.hpp"
#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::FakeLcm;
using test::FakeTransport;
using test::image;
using test::status;
using test::two_axes;

constexpr std::int64_t operation_enabled = 0x27;

class HeldAxes : public ::testing::Test {
 protected:
  HeldAxes() {
    lcm_.arrive("LIFT_LAYOUT", two_axes());
    group_.wait(0ns);
  }
  /// The newest status shows these holders `times` times.
  void held_by(const std::string& shoulder, const std::string& elbow, int times = 1) {
    for (int i = 0; i < times; ++i) lcm_.arrive("LIFT_STATUS", status(shoulder, elbow));
    group_.wait(0ns);
  }
  /// Both axes are enabled and at these positions, in thousandths.
  void at(std::int64_t shoulder, std::int64_t elbow) {
    lcm_.arrive("LIFT_IMAGE",
                image(++cycle_, {operation_enabled, operation_enabled, shoulder, elbow}));
    ASSERT_EQ(group_.wait(0ns), Input::fresh);
  }

  FakeLcm lcm_;
  AxisGroup group_{std::make_unique<FakeTransport>(lcm_),
                   {.bus = "lift", .sender = "me 1", .instance = 0x0a0b}};
  std::int64_t cycle_ = 0;
};

TEST_F(HeldAxes, AreNobodysBeforeTheFirstStatus) {
  EXPECT_FALSE(holds_all(group_));
  EXPECT_FALSE(others_hold_all(group_, 1));
  EXPECT_EQ(held_by_others(group_, 1), "");
}

TEST_F(HeldAxes, AreNotAllOwnWhileNobodyHoldsOne) {
  held_by("me 1 00000a0b", "");
  EXPECT_FALSE(holds_all(group_));
  EXPECT_EQ(held_by_others(group_, 1), "");
  held_by("me 1 00000a0b", "me 1 00000a0b");
  EXPECT_TRUE(holds_all(group_));
}

TEST_F(HeldAxes, AreReportedWithTheNameOfTheirHolder) {
  held_by("me 1 00000a0b", "me 1 00000c0d");
  EXPECT_EQ(held_by_others(group_, 1),
            "elbow belongs to 'me 1 00000c0d', and the commands of this program are refused");
  EXPECT_FALSE(others_hold_all(group_, 1));
}

TEST_F(HeldAxes, AreReportedInOneLine) {
  held_by("a\nb", "a\nb");
  EXPECT_EQ(held_by_others(group_, 1),
            "shoulder belongs to 'a?b', and the commands of this program are refused; elbow "
            "belongs to 'a?b', and the commands of this program are refused");
  EXPECT_TRUE(others_hold_all(group_, 1));
}

TEST_F(HeldAxes, AreNotReportedBecauseOfOneForgedStatus) {
  held_by("other", "other", 5);
  held_by("me 1 00000a0b", "me 1 00000a0b");
  held_by("other", "other", 5);
  EXPECT_EQ(held_by_others(group_, 6), "");
  held_by("other", "other");
  EXPECT_NE(held_by_others(group_, 6), "");
}

TEST_F(HeldAxes, HaveNoOldTargetWhenAnotherProgramHasMovedThem) {
  at(100, 100);
  held_by("other", "me 1 00000a0b");
  at(900, 120);

  rest_where_others_hold(group_);

  EXPECT_DOUBLE_EQ(group_.axes().target_positions()(0), 0.9);
  EXPECT_DOUBLE_EQ(group_.axes().target_positions()(1), 0.1) << "its own axis keeps its target";
}

}  // namespace
}  // namespace takt
