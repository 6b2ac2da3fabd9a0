#include "master/gateway/notice/merged_notices.hpp"

#include <gtest/gtest.h>
#include <utility>

namespace takt {
namespace {

using namespace std::chrono_literals;

Notice lost(std::uint8_t node, Time when, std::string kind = "heartbeat_lost") {
  return {.when = when,
          .node = node,
          .kind = std::move(kind),
          .weight = Weight::error,
          .text = "node " + std::to_string(node) + ": the node is lost"};
}

TEST(MergedNotices, NodesWithOneCauseShareALine) {
  MergedNotices merged;

  EXPECT_FALSE(merged.add(lost(1, 1s)));
  EXPECT_FALSE(merged.add(lost(2, 1s + 2ms)));
  EXPECT_FALSE(merged.add(lost(3, 1s + 4ms)));

  EXPECT_EQ(merged.take().value_or(Notice{}).text, "node 1, node 2, node 3: the node is lost");
  EXPECT_FALSE(merged.take());
}

TEST(MergedNotices, AnotherKindTimeOrTextIsAnotherLine) {
  MergedNotices merged;
  merged.add(lost(1, 1s));

  EXPECT_EQ(merged.add(lost(2, 1s, "emcy")).value_or(Notice{}).node, 1);
  EXPECT_EQ(merged.add(lost(3, 2s, "emcy")).value_or(Notice{}).node, 2);
  Notice other = lost(4, 2s, "emcy");
  other.text = "node 4: EMCY";
  EXPECT_EQ(merged.add(other).value_or(Notice{}).node, 3);
  EXPECT_EQ(merged.take().value_or(Notice{}).text, "node 4: EMCY");
}

TEST(MergedNotices, ALineDoesNotGrowWithoutBound) {
  MergedNotices merged;
  int lines = 0;
  for (std::uint8_t node = 1; node < 120; ++node) lines += merged.add(lost(node, 1s)) ? 1 : 0;

  EXPECT_GE(lines, 4);
  EXPECT_LT(lines, 10);
}

TEST(MergedText, LeavesRepetitionsAndReportsApart) {
  EXPECT_FALSE(merged_text("a: text", "a: text"));
  EXPECT_FALSE(merged_text("a: one\ntwo", "b: one\ntwo"));
  EXPECT_FALSE(merged_text("no subject", "no subject either"));
  EXPECT_EQ(merged_text("a: x: y", "b: x: y"), "a, b: x: y");
}

}  // namespace
}  // namespace takt
