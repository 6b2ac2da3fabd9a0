#include "eds_parser/read/module_lists.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

constexpr std::string_view module = R"([SupportedModules]
NrOfEntries=1
[M1ModuleInfo]
ProductName=DI4
[M1FixedObjects]
NrOfEntries=1
1=0x6423
[M1Fixed6423]
ParameterName=Enable
DataType=1
AccessType=rw
[M1SubExtends]
NrOfEntries=1
1=0x6000
[M1SubExt6000]
ParameterName=In
DataType=5
AccessType=ro
Count=4
)";

std::string changed(std::string_view from, std::string_view to) {
  std::string text{module};
  return text.replace(text.find(from), from.size(), to);
}

SourcePos reported(std::string_view text, std::string_view rule) {
  const auto file = read(text);
  const auto* finding = find(file.findings, rule);
  return finding == nullptr ? SourcePos{} : finding->pos;
}

TEST(ModuleLists, ASoundModuleHasNoFinding) {
  EXPECT_TRUE(read(module).findings.empty());
  EXPECT_TRUE(
      read(std::string{module} + "[ConnectedModules]\nNrOfEntries=2\n1=1\n2=1\n").findings.empty());
}

TEST(ModuleLists, AnObjectWithoutSectionAndASectionThatIsNotListedAreReported) {
  const auto file = read(changed("1=0x6423", "1=0x6424"));

  std::vector<SourcePos> places;
  for (const auto& finding : file.findings) {
    if (finding.rule == "module-list") places.push_back(finding.pos);
  }
  EXPECT_EQ(places, (std::vector{SourcePos{line_of(7), 3}, SourcePos{line_of(8), 1}}));
  EXPECT_EQ(reported(changed("1=0x6000", "1=0x6001"), "module-list"), (SourcePos{line_of(14), 3}));
  EXPECT_EQ(reported(changed("[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n", ""), "module-list").line,
            line_of(12));
}

TEST(ModuleLists, CountsAreReported) {
  EXPECT_EQ(
      reported(changed("[SupportedModules]\nNrOfEntries=1", "[SupportedModules]\nNrOfEntries=2"),
               "entry-count-wrong"),
      (SourcePos{line_of(2), 13}));
  EXPECT_EQ(
      reported(changed("Objects]\nNrOfEntries=1", "Objects]\nNrOfEntries=3"), "entry-count-wrong"),
      (SourcePos{line_of(6), 13}));
}

TEST(ModuleLists, ACountOfSubObjectsThatBringsNothingIsReported) {
  for (const auto* count :
       {"Count=0", "Count=", "Count=300", "Count=four", "Count=0;0", "Count=0;65", "Count=-1"}) {
    EXPECT_EQ(reported(changed("Count=4", count), "number-unreadable"), (SourcePos{line_of(19), 7}))
        << count;
  }
  EXPECT_EQ(reported(changed("Count=4\n", ""), "number-unreadable"), (SourcePos{line_of(15), 1}));
  for (const auto* count : {"Count=254", "Count=0;2", "Count=0x4", "Count = 2"}) {
    EXPECT_EQ(reported(changed("Count=4", count), "number-unreadable"), SourcePos{}) << count;
  }
}

TEST(ModuleLists, SectionsOfAModuleAreJudgedOnceConnectedOrNot) {
  const auto text = changed("DataType=5", "DataTyp=5");
  const auto judged = [](std::string_view eds) {
    const auto file = read(eds);
    return std::ranges::count(file.findings, "unknown-key", &Finding::rule);
  };

  EXPECT_EQ(judged(text), 1);
  EXPECT_EQ(judged(text + "[ConnectedModules]\nNrOfEntries=3\n1=1\n2=1\n3=1\n"), 1);
  EXPECT_EQ(judged(changed("ParameterName=Enable", "ParamName=Enable")), 1);
}

}  // namespace
}  // namespace takt
