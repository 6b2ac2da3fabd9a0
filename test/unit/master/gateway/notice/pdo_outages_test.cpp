#include "master/gateway/notice/pdo_outages.hpp"

#include <gtest/gtest.h>
#include <string>

#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

using std::chrono::milliseconds;

class PdoOutagesTest : public testing::Test {
 protected:
  PdoOutagesTest() {
    for (std::uint8_t id = 10; id < 100; ++id) {
      NodePlan node{.name = "n", .id = *NodeId::from(id), .boot_plan = {}};
      plan_.nodes.push_back(node);
    }
  }

  /// Returns the text that is reported at once; empty if there is none.
  std::string hear(int at_ms, EventKind kind, std::uint8_t node = 5) {
    const auto notice =
        outages_.on_event({.when = milliseconds{at_ms}, .kind = kind, .node = node, .value = 1});
    return notice ? notice->text : "";
  }
  std::string missing(int at_ms, std::uint8_t node = 5) {
    return hear(at_ms, EventKind::pdo_missing, node);
  }
  std::string back(int at_ms, std::uint8_t node = 5) {
    return hear(at_ms, EventKind::pdo_back, node);
  }
  std::vector<std::string> due(int at_ms) {
    std::vector<std::string> texts;
    for (const Notice& notice : outages_.take_due(milliseconds{at_ms})) {
      texts.push_back(notice.text);
    }
    return texts;
  }

  BusPlan plan_ = test::a_plan();
  PdoOutages outages_{plan_};
};

TEST_F(PdoOutagesTest, AFirstOutageIsReportedAtOnceAndSoIsItsEnd) {
  EXPECT_EQ(missing(5000), "node 5 'shoulder': TPDO1 is missing");
  EXPECT_EQ(back(35000), "node 5 'shoulder': TPDO1 is back");

  EXPECT_TRUE(due(99000).empty());
}

TEST_F(PdoOutagesTest, WhatFollowsSoonIsSummedUpOnceASecond) {
  missing(5000);
  back(5002);
  for (int i = 1; i <= 37; ++i) {
    EXPECT_EQ(missing(5000 + 20 * i), "");
    EXPECT_EQ(back(5002 + 20 * i), "");
  }

  EXPECT_TRUE(due(5999).empty());
  EXPECT_EQ(due(6010), (std::vector<std::string>{
                           "node 5 'shoulder': TPDO1 was missing 37 times in the last second; it "
                           "is back"}));
  EXPECT_TRUE(due(6500).empty());
}

TEST_F(PdoOutagesTest, ASumSaysThatThePdoStaysAwayAndALaterLineThatItIsBack) {
  missing(5000);
  back(5002);
  missing(5500);

  EXPECT_EQ(
      due(7000),
      (std::vector<std::string>{
          "node 5 'shoulder': TPDO1 was missing once in the last 1.5 s; it is still missing"}));
  EXPECT_EQ(back(7400), "");
  EXPECT_EQ(due(8000), (std::vector<std::string>{"node 5 'shoulder': TPDO1 is back"}));
}

TEST_F(PdoOutagesTest, AfterTenSecondsInOrderAnOutageIsAFirstOneAgain) {
  missing(5000);
  back(5002);
  missing(6000);
  back(6002);
  EXPECT_EQ(due(7000).size(), 1U);

  EXPECT_EQ(missing(16001), "");
  EXPECT_EQ(back(16002), "");
  EXPECT_EQ(due(17000).size(), 1U);
  EXPECT_EQ(missing(26002), "node 5 'shoulder': TPDO1 is missing");
}

TEST_F(PdoOutagesTest, ManyPdosShareOneLine) {
  for (std::uint8_t node = 10; node < 42; ++node) {
    missing(5100, node);
    back(5101, node);
  }
  for (std::uint8_t node = 10; node < 42; ++node) {
    missing(5500, node);
    if (node != 11) back(5502, node);
  }
  missing(5600, 20);
  back(5602, 20);

  const auto lines = due(6000);

  ASSERT_EQ(lines.size(), 0U) << "a line within a second of the first one";
  EXPECT_EQ(due(7000),
            (std::vector<std::string>{"32 TPDOs were missing 33 times in the last 1.5 s, most "
                                      "often TPDO1 of node 20 'n' (twice); 1 is still missing"}));
}

TEST_F(PdoOutagesTest, AFloodOfAMinuteMakesAtMostALineASecondAndPdo) {
  std::size_t lines = 0;
  for (int at = 0; at < 60000; at += 2) {
    for (const std::uint8_t node : {std::uint8_t{5}, std::uint8_t{6}}) {
      lines += !missing(5000 + at, node).empty();
      lines += !back(5001 + at, node).empty();
    }
    lines += due(5001 + at).size();
  }

  EXPECT_LE(lines, 2U * (2 + 60));
  EXPECT_GE(lines, 2U * (2 + 58));
}

TEST_F(PdoOutagesTest, TheRestIsReportedAtTheEnd) {
  missing(5000);
  back(5001);
  missing(5002);

  EXPECT_EQ(outages_.take_rest(milliseconds{5003}).size(), 1U);
  EXPECT_TRUE(outages_.take_rest(milliseconds{5004}).empty());
}

}  // namespace
}  // namespace takt
