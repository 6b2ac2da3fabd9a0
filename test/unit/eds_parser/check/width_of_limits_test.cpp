#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

// 32-bit objects with the limits of 16 bits, a mistake of the tools that write device files.

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

std::string object(const std::string& section, const std::string& type, const std::string& low,
                   const std::string& high, const std::string& access = "rw") {
  return "[" + section + "]\nParameterName=x\nDataType=" + type + "\nAccessType=" + access +
         "\nLowLimit=" + low + "\nHighLimit=" + high + "\n";
}

Findings judged(const std::string& objects) { return check(read(objects).dictionary); }

TEST(WidthOfLimits, OfAnSdoChannelCostItsSwitch) {
  for (const char* section : {"1201sub1", "1201sub2", "127Fsub2", "1280sub1", "12FFsub2"}) {
    const auto findings = judged(object(section, "7", "0", "65535"));

    const auto* finding = find(findings, "limits-of-16-bits");
    ASSERT_NE(finding, nullptr) << section;
    EXPECT_EQ(finding->severity, Severity::warning);
    EXPECT_EQ(
        finding->message,
        std::string{section} +
            ": UNSIGNED32 with HighLimit 65535, the limit of 16 bits; it excludes bit 31, which "
            "switches the SDO channel off while its COB-IDs change. Correct HighLimit to "
            "0xFFFFFFFF if the device accepts more");
    EXPECT_FALSE(has(findings, "range-of-16-bits"));
  }
  EXPECT_FALSE(has(judged(object("1200sub1", "7", "0", "65535", "ro")), "limits-of-16-bits"));
}

TEST(WidthOfLimits, OfAMappingCostTheIndexOfTheObject) {
  const auto findings = judged(object("1A00sub1", "7", "0", "65535"));

  ASSERT_TRUE(has(findings, "limits-of-16-bits"));
  EXPECT_NE(find(findings, "limits-of-16-bits")->message.find("nothing can be mapped"),
            std::string::npos);
}

TEST(WidthOfLimits, OfAnEntryOfAnotherRecordAreTheRangeThatIsLeft) {
  const auto findings = judged(object("2000sub1", "7", "0", "65535"));

  EXPECT_TRUE(has(findings, "range-of-16-bits"));
  EXPECT_FALSE(has(findings, "limits-of-16-bits"));
}

TEST(WidthOfLimits, OfAPositionAreTheRangeThatIsLeft) {
  const auto findings = judged(object("607A", "4", "-32768", "32767"));

  const auto* finding = find(findings, "range-of-16-bits");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::note);
  EXPECT_EQ(finding->pos, (SourcePos{line_of(1), 1}));
  EXPECT_EQ(finding->message,
            "a 32-bit object has the limits of 16 bits: 607Asub0 (-32768..32767); takt refuses "
            "values outside them. Correct the limits if the device accepts more");
}

TEST(WidthOfLimits, OfManyObjectsAreOneNoteWithTheirNumber) {
  std::string objects;
  for (const char* section : {"6081", "6083", "6084", "6085", "60C5"}) {
    objects += object(section, "7", "0", "65535");
  }

  const auto findings = judged(objects);

  EXPECT_EQ(std::ranges::count(findings, "range-of-16-bits", &Finding::rule), 1);
  ASSERT_TRUE(has(findings, "range-of-16-bits"));
  EXPECT_EQ(find(findings, "range-of-16-bits")->message,
            "5 32-bit objects have the limits of 16 bits: 6081sub0 (0..65535), 6083sub0 "
            "(0..65535), 6084sub0 (0..65535), 6085sub0 (0..65535) and 1 more; takt refuses "
            "values outside them. Correct the limits if the device accepts more");
}

TEST(WidthOfLimits, AreNoFindingWhereTheyFitTheObject) {
  for (const auto& good :
       {object("607A", "4", "-2147483648", "2147483647"), object("6083", "7", "0", "100000"),
        object("6071", "3", "-32768", "32767"), object("1017", "6", "0", "65535"),
        object("6064", "4", "-32768", "32767", "ro"), object("1201sub3", "5", "0", "127")}) {
    const auto findings = judged(good);
    EXPECT_FALSE(has(findings, "range-of-16-bits")) << good;
    EXPECT_FALSE(has(findings, "limits-of-16-bits")) << good;
  }
}

}  // namespace
}  // namespace takt
