#include "master/lcm/channel_patterns.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace takt {
namespace {

bool matches(std::string_view pattern, std::string_view channel) {
  const auto parsed = ChannelPattern::parse(pattern);
  EXPECT_TRUE(parsed) << pattern << ": " << (parsed ? "" : parsed.error());
  return parsed && parsed->match(channel);
}

TEST(ChannelPattern, MatchesWholeNamesAsLcmDoes) {
  EXPECT_TRUE(matches("LIFT_IMAGE", "LIFT_IMAGE"));
  EXPECT_FALSE(matches("LIFT_IMAGE", "LIFT_IMAGES"));
  EXPECT_FALSE(matches("LIFT_IMAGE", "XLIFT_IMAGE"));
  EXPECT_FALSE(matches("LIFT_IMAGE", ""));
  EXPECT_TRUE(matches("^LIFT_IMAGE$", "LIFT_IMAGE"));
  EXPECT_TRUE(matches("ARM_.*", "ARM_STATUS"));
  EXPECT_TRUE(matches("ARM_.*", "ARM_"));
  EXPECT_FALSE(matches("ARM_.*", "XARM_STATUS"));
  EXPECT_TRUE(matches(".*_STATUS", "ARM_STATUS"));
  EXPECT_FALSE(matches(".*_STATUS", "ARM_STATUSES"));
  EXPECT_TRUE(matches(".*", "anything at all"));
  EXPECT_TRUE(matches(".*", ""));
  EXPECT_TRUE(matches("A.C", "ABC"));
  EXPECT_FALSE(matches("A.C", "AC"));
}

TEST(ChannelPattern, MatchesAlternativesGroupsAndRepetition) {
  EXPECT_TRUE(matches("BUS_(A|B)", "BUS_B"));
  EXPECT_FALSE(matches("BUS_(A|B)", "BUS_C"));
  EXPECT_TRUE(matches("A|BC|D", "BC"));
  EXPECT_FALSE(matches("A|BC|D", "ABC"));
  EXPECT_TRUE(matches("(A|B)(_X)?", "A"));
  EXPECT_TRUE(matches("(A|B)(_X)?", "B_X"));
  EXPECT_TRUE(matches("(?:AB)+", "ABAB"));
  EXPECT_FALSE(matches("(AB)+", "ABA"));
  EXPECT_TRUE(matches("CAM_[0-9]+", "CAM_17"));
  EXPECT_FALSE(matches("CAM_[0-9]+", "CAM_"));
  EXPECT_TRUE(matches("[^A-C]", "D"));
  EXPECT_FALSE(matches("[^A-C]", "B"));
  EXPECT_TRUE(matches("a\\.b", "a.b"));
  EXPECT_FALSE(matches("a\\.b", "aXb"));
  EXPECT_TRUE(matches("A(|B)C", "AC"));
}

TEST(ChannelPattern, RefusesWhatLcmProgramsDoNotSend) {
  for (const char* const pattern :
       {"((a{1000}){1000}){1000}", "(a", "a)", "(a)\\1", "(?=a)b", "(?!a)b", "*", "+a", "a\\d",
        "[[:alpha:]]", "[a", "a^b", "a$b", "\\", "a{2}"}) {
    EXPECT_FALSE(ChannelPattern::parse(pattern)) << pattern;
  }
  EXPECT_FALSE(ChannelPattern::parse(std::string(100, '(')));
  EXPECT_FALSE(ChannelPattern::parse(std::string(ChannelPattern::longest + 1, 'a')));
}

// A matcher with backtracking would not finish here. Neither would a deterministic automaton, which
// needs 2^n states for the positions before the end of the name.
TEST(ChannelPattern, EvilPatternsCostNoMoreThanTheirLengthTimesThatOfTheName) {
  const std::string many_a(60, 'a');
  EXPECT_FALSE(matches("(a*)*(a*)*(a*)*(a|aa)*b", many_a));
  EXPECT_FALSE(matches("(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*(a|a)*b", many_a));
  EXPECT_FALSE(matches(".*a...............................................b", many_a));
  EXPECT_TRUE(matches(".*a.......................................", many_a));
  std::string nested(15, '(');
  nested += "a";
  for (int i = 0; i < 15; ++i) nested += ")*";
  EXPECT_TRUE(matches(nested, many_a));
  EXPECT_FALSE(matches(nested, many_a + "b"));
}

TEST(ChannelPatterns, MatchAnyOfThemUntilTheyAreRemoved) {
  ChannelPatterns patterns;
  EXPECT_TRUE(patterns.add("LIFT_IMAGE"));
  EXPECT_TRUE(patterns.add("ARM_.*"));
  EXPECT_TRUE(patterns.match("LIFT_IMAGE"));
  EXPECT_TRUE(patterns.match("ARM_STATUS"));

  patterns.remove("ARM_.*");

  EXPECT_FALSE(patterns.match("ARM_STATUS"));
  EXPECT_EQ(patterns.characters(), 10U);
}

TEST(ChannelPatterns, AreBoundedInNumberAndSize) {
  ChannelPatterns many;
  for (std::size_t i = 0; i < ChannelPatterns::most_patterns; ++i) EXPECT_TRUE(many.add("A"));
  EXPECT_FALSE(many.add("A"));

  ChannelPatterns large;
  for (std::size_t i = 0; i < ChannelPatterns::most_characters / 128; ++i) {
    EXPECT_TRUE(large.add(std::string(128, 'a')));
  }
  EXPECT_FALSE(large.add("A"));
}

}  // namespace
}  // namespace takt
