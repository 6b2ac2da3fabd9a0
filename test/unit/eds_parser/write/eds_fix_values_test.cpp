#include <bit>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/write/eds_fix.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::has;
using testing::HasSubstr;

std::string device(std::string_view objects) {
  return std::string{test::base} + "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n" +
         std::string{objects};
}

std::string array(std::string_view type, std::string_view more) {
  return device("[2000]\nParameterName=a\nObjectType=8\nAccessType=rw\nCompactSubObj=2\nDataType=" +
                std::string{type} + "\n" + std::string{more});
}

std::string module(std::string_view more) {
  return std::string{test::base} +
         "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=m\n"
         "[M1FixedObjects]\nNrOfEntries=1\n1=0x6423\n[M1Fixed6423]\nParameterName=q\n" +
         std::string{more};
}

TEST(EdsFixValues, ThoseOfCompactSubObjectsAreOfTheTypeOfTheElements) {
  struct Case {
    std::string_view type;
    std::string_view more;
    std::string_view becomes;
  };
  for (const Case& one : {Case{"0x0008", "DefaultValue=100f\n", "DefaultValue=100\n"},
                          {"0x0008", "DefaultValue=010 ; ten\n", "DefaultValue=010\n; ten\n"},
                          {"0x0008", "DefaultValue=0x3F800000\n", "DefaultValue=1\n"},
                          {"0x0008", "HighLimit=010f\n", "HighLimit=010\n"},
                          {"0x0008", "[2000Value]\n1=010f\n", "\n1=010\n"},
                          {"0x0008", "[2000Value]\n1=010 ; ten\n", "\n1=010\n; ten\n"},
                          {"0x0008", "[2000Value]\n2=0x3F800000\n", "\n2=1\n"},
                          {"0x000A", "DefaultValue=0010 ; two\n", "DefaultValue=0010\n; two\n"},
                          {"0x000A", "[2000Value]\n1=0010 ; two\n", "\n1=0010\n; two\n"},
                          {"0x000A", "[2000Value]\n1=0x00 10\n", "\n1=0010\n"},
                          {"0x000C", "[2000Value]\n1=010 2 ; days\n", "\n1=010 2\n; days\n"},
                          {"0x0006", "DefaultValue=010 ; eight\n", "DefaultValue=8\n; eight\n"},
                          {"0x0006", "DefaultValue=-1 ; all\n", "DefaultValue=0xFFFF\n; all\n"},
                          {"0x0006", "[2000Value]\n1=010 ; eight\n", "\n1=8\n; eight\n"}}) {
    const std::string before = array(one.type, one.more);

    const FixedEds fixed = fix_eds(before, "t.dcf");

    EXPECT_THAT(fixed.text, HasSubstr(one.becomes));
    EXPECT_EQ(fixed.fixed.size(), read_eds(before, "t.dcf").findings.size()) << one.more;
    EXPECT_TRUE(fixed.left.empty()) << to_string(fixed.left.front());
  }
}

TEST(EdsFixValues, ASectionOfItsOwnHasATypeOfItsOwn) {
  const std::string own =
      "[2000sub1]\nParameterName=o\nDataType=0x000A\nAccessType=rw\nDefaultValue=00 10\n";

  const FixedEds fixed = fix_eds(array("0x0008", "DefaultValue=010f\n" + own), "t.eds");

  EXPECT_THAT(fixed.text, HasSubstr("DefaultValue=010\n[2000sub1]"));
  EXPECT_THAT(fixed.text, HasSubstr("DefaultValue=0010\n"));
}

TEST(EdsFixValues, ABitPatternIsNoNumberWithASuffix) {
  const std::string before = device(test::var("0x0008", "0x3F80000F ; c"));

  const FixedEds fixed = fix_eds(before, "t.eds");

  EXPECT_EQ(fixed.fixed.size(), 2U);
  const EdsFile after = read_eds(fixed.text, "t.eds");
  const auto* sub = after.dictionary.find(ObjectKey{0x2000, 0});
  ASSERT_NE(sub, nullptr);
  EXPECT_EQ(sub->default_value, Value{double{std::bit_cast<float>(0x3F80000FU)}});
}

TEST(EdsFixValues, AValueThatFollowsTheNodeIdStaysRelative) {
  const std::string before =
      device(test::var("0x0007", "$NODEID+-10") + "[DeviceComissioning]\nNodeID=5\n");
  ASSERT_TRUE(has(read_eds(before, "t.dcf").findings, "negative-unsigned"));

  EXPECT_EQ(fix_eds(before, "t.dcf").text, before);
}

TEST(EdsFixValues, ThoseOfModulesAreLeftAndNamed) {
  const std::string subs =
      "[M1Fixed6423sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[M1Fixed6423sub1]\nParameterName=e\nDataType=5\nAccessType=rw\n";
  const std::vector<std::pair<std::string, std::string_view>> cases = {
      {"ObjectType=8\nSubNumber=5\n" + subs, "sub-number-wrong"},
      {"ObjectType=8\n" + subs, "sub-number-missing"},
      {"AccessType=rw\nDataType=0x0008\nDefaultValue=100f\n", "number-suffix"},
      {"AccessType=rw\nDataType=0x0008\nDefaultValue=010 ; ten\n", "inline-comment"},
      {"AccessType=rw\nDataType=0x000A\nDefaultValue=0010 ; two\n", "inline-comment"},
      {"AccessType=rw\nDataType=5\nDefaultValue=010\n", "octal-number"},
  };
  for (const auto& [more, rule] : cases) {
    for (const std::string_view connected : {"", "[ConnectedModules]\nNrOfEntries=1\n1=1\n"}) {
      const std::string before = module(more) + std::string{connected};
      ASSERT_TRUE(has(read_eds(before, "t.eds").findings, rule)) << more;

      const FixedEds fixed = fix_eds(before, "t.eds");

      EXPECT_EQ(fixed.text, before);
      EXPECT_TRUE(fixed.fixed.empty());
      EXPECT_TRUE(has(fixed.left, rule)) << more;
    }
  }
}

TEST(EdsFixValues, CountsInSectionsOfModulesAreMended) {
  std::string before = module("AccessType=rw\nDataType=5\n");
  const std::string list = "[M1FixedObjects]\nNrOfEntries=";
  before.replace(before.find(list) + list.size(), 1, "7");

  EXPECT_THAT(fix_eds(before, "t.eds").text, HasSubstr(list + "1\n"));
}

TEST(EdsFixValues, EachFindingOfALineIsCountedOnceWhereTwoMendingsFollow) {
  const std::string subs =
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[2000sub1]\nParameterName=e\nDataType=5\nAccessType=rw\n";
  const std::string record = "[2000]\nParameterName=r\nObjectType=9\nSubNumber=";
  const std::string list = "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n";
  std::string misplaced = device(test::var("5", "1"));
  misplaced.replace(misplaced.find(list), list.size(),
                    "[OptionalObjects]\nSupportedObjects=1\n1=2000\n");
  for (const std::string& before :
       {device(record + "010\n" + subs), device(record + "010 ; eight\n" + subs), misplaced,
        array("5", "SubNumber=010\n"),
        std::string{test::base} + "[DeviceComissioning]\nNodeID=5\nBaudrate=0x7A120 ; bit/s\n"}) {
    const auto found = read_eds(before, "t.dcf").findings.size();
    ASSERT_GE(found, 2U) << before;

    const FixedEds fixed = fix_eds(before, "t.dcf");

    EXPECT_EQ(fixed.fixed.size(), found) << fixed.text;
    EXPECT_TRUE(fixed.left.empty()) << fixed.text;
  }
}

TEST(EdsFixValues, AMendingThatWouldChangeAnObjectIsLeftAloneAndAllOthersDone) {
  const std::string slip = "[1017]\nParameterName=h\nAccessType=rw\nDataTyp=5\nDefaultValue=012\n";
  const std::string before =
      device("[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n" + slip +
             "[2000]\nParameterName=x\nAccessType=rw\nDataTyp=0x0006\nDefaultValue=3\n");

  const FixedEds fixed = fix_eds(before, "t.eds");

  EXPECT_THAT(fixed.text, HasSubstr("\nDataTyp=5\nDefaultValue=10\n"));
  EXPECT_THAT(fixed.text, HasSubstr("\nDataType=0x0006\nDefaultValue=3\n"));
  EXPECT_TRUE(has(fixed.left, "unknown-key"));
}

}  // namespace
}  // namespace takt
