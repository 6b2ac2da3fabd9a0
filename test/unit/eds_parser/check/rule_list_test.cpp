#include "eds_parser/check/rule_list.hpp"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

const RuleInfo* rule(std::string_view name) {
  const auto it = std::ranges::find(eds_rules(), name, &RuleInfo::name);
  return it == eds_rules().end() ? nullptr : &*it;
}

TEST(RuleList, IsSortedAndGivesEachRuleAMeaningAndAnExample) {
  EXPECT_TRUE(std::ranges::is_sorted(eds_rules(), std::less_equal{}, &RuleInfo::name));
  for (const auto& info : eds_rules()) {
    EXPECT_FALSE(info.meaning.empty()) << info.name;
    EXPECT_FALSE(info.example.empty()) << info.name;
  }
}

TEST(RuleList, SaysThatAValueOutsideItsLimitsMayBeANote) {
  EXPECT_TRUE(rule("value-outside-limits")->meaning.ends_with("(a note where nothing writes it)"));
}

TEST(RuleList, KnowsEveryRuleThatANastyFileBreaks) {
  const auto file =
      read_eds_file(TAKT_SOURCE_DIR "/test/unit/eds_parser/read/data/chaos.eds", 5_node);
  auto findings = check(file.dictionary);
  findings.insert(findings.end(), file.findings.begin(), file.findings.end());

  EXPECT_GT(findings.size(), 20U);
  for (const auto& finding : findings) EXPECT_NE(rule(finding.rule), nullptr) << finding.rule;
}

}  // namespace
}  // namespace takt
