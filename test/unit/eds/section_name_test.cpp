#include <gtest/gtest.h>

#include "test/unit/eds/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::integer;
using test::line_of;
using test::read;

/// A RECORD 2000 whose sub 1 has the value 7 and a section header of the test.
EdsFile record_with(const std::string& header) {
  return read(
      "[2000]\nParameterName=r\nObjectType=9\nSubNumber=2\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n" +
      header + "\nParameterName=v\nDataType=6\nAccessType=rw\nDefaultValue=7\n");
}

TEST(SectionName, BlanksAreLeftOutAndTold) {
  for (const auto* header : {"[2000 sub1]", "[2000  Sub1]", "[2000\tsub1]", "[2000sub 1]",
                             "[2000 sub 1]", "[ 2000sub1 ]", "[2000sub1 ]", "[ 2000 sub1]"}) {
    const auto file = record_with(header);

    EXPECT_EQ(integer(file, {0x2000, 1}), 7) << header;
    ASSERT_TRUE(has(file.findings, "section-name-blank")) << header;
    EXPECT_EQ(std::ranges::count(file.findings, "section-name-blank", &Finding::rule), 1) << header;
    EXPECT_EQ(find(file.findings, "section-name-blank")->pos, (SourcePos{line_of(10), 1}));
    EXPECT_FALSE(has(file.findings, "unknown-section")) << header;
  }
  EXPECT_FALSE(has(record_with("[2000sub1]").findings, "section-name-blank"));
}

TEST(SectionName, ABlankBeforeAListIsLeftOutToo) {
  const auto file = read(
      "[2000]\nParameterName=g\nObjectType=8\nDataType=6\nAccessType=rw\nCompactSubObj=2\n"
      "[2000 Name]\nNrOfEntries=1\n2=gain\n[2000 Value]\nNrOfEntries=1\n1=9\n");

  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 2})->name, "gain");
  EXPECT_EQ(integer(file, {0x2000, 1}), 9);
  EXPECT_EQ(std::ranges::count(file.findings, "section-name-blank", &Finding::rule), 2);
}

TEST(SectionName, OtherTextBehindAnIndexIsNoSectionOfIt) {
  EXPECT_TRUE(has(record_with("[2000 sub]").findings, "unknown-section"));
  EXPECT_TRUE(has(record_with("[2000 sub1 2]").findings, "unknown-section"));
  EXPECT_TRUE(has(record_with("[2000 gain]").findings, "unknown-section"));
}

}  // namespace
}  // namespace takt
