#include "master/gateway/notice/notice_limit.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using std::chrono::milliseconds;

Notice notice(const char* kind, std::uint8_t node, int at_ms) {
  return {.when = milliseconds{at_ms}, .node = node, .kind = kind, .text = {}};
}

TEST(NoticeLimit, SixteenAtOncePassThenTwoASecondAreReportedWithTheNumberKeptBack) {
  NoticeLimit limit;
  for (int i = 0; i < 16; ++i) EXPECT_EQ(limit.allow(notice("emcy", 5, 1000)), 0U) << i;

  EXPECT_EQ(limit.allow(notice("emcy", 5, 1000)), std::nullopt);
  EXPECT_EQ(limit.allow(notice("emcy", 5, 1499)), std::nullopt);
  EXPECT_EQ(limit.allow(notice("emcy", 5, 1500)), 2U);
  EXPECT_EQ(limit.allow(notice("emcy", 5, 1501)), std::nullopt);
}

TEST(NoticeLimit, AFloodOfOneKindLeavesOtherKindsAndNodesAlone) {
  NoticeLimit limit;
  for (int i = 0; i < 1000; ++i) (void)limit.allow(notice("cycles_missed", 0, 1000));

  EXPECT_EQ(limit.allow(notice("bus_off", 0, 1000)), 0U);
  EXPECT_EQ(limit.allow(notice("cycles_missed", 5, 1000)), 0U);
}

TEST(NoticeLimit, AFloodOfAMinuteIsReportedAtMostTwiceASecond) {
  NoticeLimit limit;
  int reported = 0;
  for (int at = 0; at < 60000; ++at)
    reported += limit.allow(notice("cycles_missed", 0, at)).has_value();

  EXPECT_EQ(reported, 16 + 119);
}

}  // namespace
}  // namespace takt
