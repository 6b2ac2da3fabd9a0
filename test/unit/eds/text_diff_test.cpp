#include "eds_parser/text_diff.hpp"

#include <gtest/gtest.h>
#include <random>

namespace takt {
namespace {

bool never(std::string_view) { return false; }
bool is_section(std::string_view line) { return line.starts_with('['); }

TEST(TextDiff, EqualTextsHaveNoDifference) {
  EXPECT_EQ(unified_diff("a\nb\n", "a\nb\n", "x", "y", never), "");
  EXPECT_EQ(unified_diff("", "", "x", "y", never), "");
}

TEST(TextDiff, OneChangedLineIsOneHunkWithThreeLinesAround) {
  EXPECT_EQ(unified_diff("1\n2\n3\n4\n5\n6\n7\n8\n9\n", "1\n2\n3\n4\nfive\n6\n7\n8\n9\n", "a", "b",
                         never),
            "--- a\n+++ b\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
}

TEST(TextDiff, ChangesFarApartAreTwoHunksWithTheirHeadings) {
  std::string before = "[one]\nx=1\n";
  for (int i = 0; i < 9; ++i) before += "line\n";
  std::string after = before;
  before += "[two]\na\nb\nc\nd\nx=2\n";
  after += "[two]\na\nb\nc\nd\nx=3\n";
  after.replace(after.find("x=1"), 3, "x=0");

  EXPECT_EQ(unified_diff(before, after, "a", "b", is_section),
            "--- a\n+++ b\n@@ -1,5 +1,5 @@\n [one]\n-x=1\n+x=0\n line\n line\n line\n"
            "@@ -14,4 +14,4 @@ [two]\n b\n c\n d\n-x=2\n+x=3\n");
}

TEST(TextDiff, AddedAndRemovedWholes) {
  EXPECT_EQ(unified_diff("", "a\n", "x", "y", never), "--- x\n+++ y\n@@ -0,0 +1 @@\n+a\n");
  EXPECT_EQ(unified_diff("a\nb\n", "", "x", "y", never), "--- x\n+++ y\n@@ -1,2 +0,0 @@\n-a\n-b\n");
}

TEST(TextDiff, LineEndsOfAllKindsEndLines) {
  const auto lines = lines_of("a\r\nb\rc\n\nd");

  EXPECT_EQ(lines, (std::vector<std::string_view>{"a", "b", "c", "", "d"}));
}

TEST(TextDiff, AMovedLineIsNoReasonToChangeTheRest) {
  const auto diff = unified_diff("a\nb\nc\nd\n", "b\nc\nd\na\n", "x", "y", never);

  EXPECT_EQ(diff, "--- x\n+++ y\n@@ -1,4 +1,4 @@\n-a\n b\n c\n d\n+a\n");
}

TEST(TextDiff, BothTextsCanBeReadFromTheDifference) {
  std::mt19937 random{1};
  const std::vector<std::string_view> words{"a", "b", "c", "d", "e", "f", "g", "h"};
  for (int round = 0; round < 500; ++round) {
    std::vector<std::string_view> before(random() % 30), after(random() % 30);
    const std::size_t kinds = 2 + random() % 7;
    for (auto& line : before) line = words[random() % kinds];
    for (auto& line : after) line = words[random() % kinds];

    std::vector<std::string_view> left, right;
    for (const DiffLine& line : diff_lines(before, after)) {
      if (line.kind != DiffLine::Kind::added) left.push_back(line.text);
      if (line.kind != DiffLine::Kind::removed) right.push_back(line.text);
    }
    ASSERT_EQ(left, before);
    ASSERT_EQ(right, after);
  }
}

TEST(TextDiff, ManyLinesThatRepeatTakeBoundedWork) {
  std::string before, after;
  for (int i = 0; i < 100'000; ++i) {
    before += i % 2 == 0 ? "x\n" : "y\n";
    after += i % 3 == 0 ? "x\n" : "y\n";
  }

  EXPECT_NE(unified_diff(before, after, "a", "b", never), "");
}

}  // namespace
}  // namespace takt
