#include "eds_parser/report/text_diff.hpp"

#include <algorithm>
#include <charconv>
#include <gtest/gtest.h>
#include <random>

#include "eds_parser/write/eds_fix.hpp"

namespace takt {
namespace {

bool never(std::string_view) { return false; }
bool is_section(std::string_view line) { return line.starts_with('['); }

/// Removes the first line of `text` including its LF and returns it.
std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
  text.remove_prefix(line.size());
  return line;
}

std::size_t number_behind(std::string_view text, std::string_view mark) {
  std::size_t number = 0;
  const std::size_t at = text.find(mark) + mark.size();
  std::from_chars(text.data() + at, text.data() + text.size(), number);
  return number;
}

/// Applies a difference as `patch --binary` does: only LF ends a line, and every byte of the old
/// lines has to match. Returns an empty text if the difference can't be applied.
std::string applied(std::string_view before, std::string_view diff) {
  std::string out;
  std::size_t old_line = 1;
  std::size_t new_line = 1;
  const auto keep = [&] { out += next_line(before), ++old_line, ++new_line; };
  next_line(diff);
  next_line(diff);
  while (!diff.empty()) {
    std::string_view line = next_line(diff);
    const char mark = line.front();
    if (mark == '@') {
      const std::size_t first = number_behind(line, "@@ -");
      while (old_line < first && !before.empty()) keep();
      if (old_line != first || new_line != number_behind(line, " +")) return "";
      continue;
    }
    line.remove_prefix(1);
    if (diff.starts_with("\\ No newline at end of file\n")) {
      line.remove_suffix(1);
      next_line(diff);
    }
    if (mark != '+' && (++old_line, next_line(before) != line)) return "";
    if (mark != '-') ++new_line, out += line;
  }
  while (!before.empty()) keep();
  return out;
}

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

TEST(TextDiff, KeepsTheCarriageReturnsOfItsLines) {
  EXPECT_EQ(unified_diff("[a]\r\nb\r\nc\n", "[a]\r\nB\r\nc\n", "x", "y", is_section),
            "--- x\n+++ y\n@@ -1,3 +1,3 @@\n [a]\r\n-b\r\n+B\r\n c\n");
  EXPECT_EQ(unified_diff("a\r\n", "a\n", "x", "y", never), "--- x\n+++ y\n@@ -1 +1 @@\n-a\r\n+a\n");
}

TEST(TextDiff, HeadingsAreWithoutCarriageReturn) {
  const std::string before = "[a]\r\n1\r\n2\r\n3\r\n4\r\n5\r\n";
  std::string after = before;
  after.replace(after.find('5'), 1, "6");

  EXPECT_EQ(unified_diff(before, after, "x", "y", is_section),
            "--- x\n+++ y\n@@ -3,4 +3,4 @@ [a]\n 2\r\n 3\r\n 4\r\n-5\r\n+6\r\n");
}

TEST(TextDiff, NamesALastLineWithoutEnd) {
  const std::string none = "\\ No newline at end of file\n";
  EXPECT_EQ(unified_diff("a\nb", "a\nc", "x", "y", never),
            "--- x\n+++ y\n@@ -1,2 +1,2 @@\n a\n-b\n" + none + "+c\n" + none);
  EXPECT_EQ(unified_diff("a\nb", "A\nb", "x", "y", never),
            "--- x\n+++ y\n@@ -1,2 +1,2 @@\n-a\n+A\n b\n" + none);
  EXPECT_EQ(unified_diff("a", "a\n", "x", "y", never),
            "--- x\n+++ y\n@@ -1 +1 @@\n-a\n" + none + "+a\n");
}

/// If no line ends with LF, as on old Macs, `diff -u` would show the file as one line.
TEST(TextDiff, CarriageReturnsAloneAreShownAsLines) {
  EXPECT_EQ(unified_diff("a\rb\r", "a\rc\r", "x", "y", never),
            "--- x\n+++ y\n@@ -1,2 +1,2 @@\n a\n-b\n+c\n");
}

TEST(TextDiff, AppliesToTheTextItWasMadeOf) {
  std::mt19937 random{2};
  const std::vector<std::string_view> words{"a", "b", "c", "[d]", "\re"};
  const std::vector<std::string_view> ends{"\n", "\r\n", "\r\n", "\r"};
  const auto text = [&] {
    std::string lines = "\n";
    for (std::size_t count = random() % 40; count-- > 0;) {
      lines += words[random() % words.size()];
      if (count > 0 || random() % 2 == 0) lines += ends[random() % ends.size()];
    }
    return lines;
  };
  for (int round = 0; round < 2000; ++round) {
    const std::string before = text();
    const std::string after = text();
    if (before == after) continue;

    const std::string diff = unified_diff(before, after, "x", "y", is_section);

    ASSERT_EQ(applied(before, diff), after) << diff;
  }
}

TEST(TextDiff, OfAMendedFileWithCarriageReturnsApplies) {
  std::string source;
  for (const auto* line :
       {"[MandatoryObjects]", "Supported Objects=1", "1=0x1000", "", "[0x1000]",
        "ParameterName=Device type", "DataType=7", "AccessType=ro", "DefaultValue=1F ; what"}) {
    if (!source.empty()) source += "\r\n";
    source += line;
  }
  const FixedEds fixed = fix_eds(source, "drive.eds");
  ASSERT_NE(fixed.text, source);

  const std::string diff = unified_diff(source, fixed.text, "x", "y", is_section);

  EXPECT_EQ(applied(source, diff), fixed.text) << diff;
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
