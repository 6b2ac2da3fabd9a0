#include "eds_parser/read/compact.hpp"

#include <gtest/gtest.h>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::integer;
using test::line_of;
using test::read;

// The worked example of CiA 306, 4.6.3.4.2.
constexpr std::string_view gain = R"([3100]
ParameterName=Gain
ObjectType=0x8
DataType=0x0006
AccessType=rw
DefaultValue=7
PDOMapping=0
CompactSubObj=12
[3100Name]
NrOfEntries=1
2=Proportional
[3100Value]
NrOfEntries=2
1=1000
10=0x20
)";

TEST(Compact, ExpandsNamesAndValuesByDecimalSub) {
  const auto file = read(gain);

  const auto& object = *file.dictionary.find(std::uint16_t{0x3100});
  ASSERT_EQ(object.subs.size(), 13U);
  EXPECT_EQ(object.subs[0].name, "NrOfObjects");
  EXPECT_EQ(object.subs[0].access, Access::ro);
  EXPECT_EQ(integer(file, {0x3100, 0}), 12);
  EXPECT_EQ(object.subs[1].name, "Gain1");
  EXPECT_EQ(integer(file, {0x3100, 1}), 1000);
  EXPECT_EQ(object.subs[2].name, "Proportional");
  EXPECT_EQ(integer(file, {0x3100, 2}), 7);
  EXPECT_EQ(object.subs[10].name, "Gain10");
  EXPECT_EQ(integer(file, {0x3100, 0x0A}), 32);
  EXPECT_EQ(integer(file, {0x3100, 12}), 7);
}

TEST(Compact, TakesTheFirstOfARepeatedListEntry) {
  const auto file = read(std::string{gain} + "1=1001\n");

  EXPECT_EQ(integer(file, {0x3100, 1}), 1000);
  EXPECT_EQ(find(file.findings, "duplicate-key")->pos, (SourcePos{line_of(16), 1}));
}

TEST(Compact, TakesDecimalSubsOnly) {
  const auto file = read(std::string{gain} + "011=55\n0x3=66\n-4=77\n$NODEID=88\n");

  EXPECT_EQ(integer(file, {0x3100, 11}), 55);
  EXPECT_EQ(integer(file, {0x3100, 9}), 7);
  EXPECT_EQ(integer(file, {0x3100, 3}), 7);
  EXPECT_EQ(integer(file, {0x3100, 4}), 7);
  EXPECT_EQ(integer(file, {0x3100, 5}), 7);
  EXPECT_EQ(std::ranges::count(file.findings, "unknown-sub-object", &Finding::rule), 3);
}

TEST(Compact, MakesNoObjectOfAListAlone) {
  const auto file = read("[2000Value]\nNrOfEntries=1\n1=5\n");

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000}), nullptr);
  EXPECT_EQ(find(file.findings, "object-section-missing")->pos.line, line_of(1));
}

TEST(Compact, LetsExplicitSectionsCount) {
  const auto file = read(std::string{gain} +
                         "[3100sub3]\nParameterName=own\nDataType=6\nAccessType=ro\n"
                         "DefaultValue=99\n");

  EXPECT_EQ(integer(file, {0x3100, 3}), 99);
  EXPECT_EQ(integer(file, {0x3100, 4}), 7);
  EXPECT_TRUE(has(file.findings, "compact-and-sections"));
}

TEST(Compact, SkipsAnObjectWithoutTypeButKeepsTheFile) {
  const auto file = read("[3100]\nParameterName=x\nObjectType=8\nAccessType=rw\nCompactSubObj=3\n");

  EXPECT_TRUE(file.readable);
  EXPECT_TRUE(has(file.findings, "compact-without-type"));
  EXPECT_NE(file.dictionary.find(std::uint16_t{0x1000}), nullptr);
}

TEST(Compact, ImplicitPdosStandWhereTheyAreCounted) {
  const auto file = read_eds(
      "[DeviceInfo]\nCompactPDO=3\nNrOfRXPDO=1\nNrOfTXPDO=1\n[Comments]\nLines=0\n", "t.eds");

  ASSERT_EQ(file.dictionary.objects.size(), 4U);
  EXPECT_EQ(file.dictionary.objects[0].pos, (SourcePos{3, 11}));
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x1A00, 1})->default_pos, (SourcePos{4, 11}));
  for (const auto& finding : check(file.dictionary)) {
    EXPECT_GT(finding.pos.line, 0U) << finding.message;
  }
}

TEST(Compact, FillsImplicitPdosFromTheBottom) {
  constexpr std::string_view text = R"([DeviceInfo]
CompactPDO=0x17
NrOfRXPDO=5
NrOfTXPDO=0
[1000]
ParameterName=t
DataType=7
AccessType=ro
[1401]
ParameterName=own
ObjectType=9
SubNumber=2
[1401sub0]
ParameterName=n
DataType=5
AccessType=ro
DefaultValue=1
[1401sub1]
ParameterName=c
DataType=7
AccessType=rw
DefaultValue=0x333
)";
  const auto file = read_eds(text, "t.eds", 1_node);

  const auto pdos = describe_pdos(file.dictionary);
  ASSERT_EQ(pdos.size(), 5U);
  EXPECT_EQ(pdos[0].cob_id_raw, 0x201U);
  EXPECT_EQ(pdos[1].cob_id_raw, 0x333U);
  EXPECT_EQ(pdos[3].cob_id_raw, 0x501U);
  EXPECT_EQ(pdos[4].cob_id_raw, 0x80000000U);
  EXPECT_FALSE(pdos[4].valid);
  const auto& made = *file.dictionary.find(std::uint16_t{0x1400});
  ASSERT_EQ(made.subs.size(), 5U);  // 0, 1, 2, 3, 5
  EXPECT_EQ(made.subs.back().sub, 5);
  EXPECT_EQ(integer(file, {0x1400, 0}), 5);
  EXPECT_EQ(integer(file, {0x1600, 0}), 0);
}

TEST(Compact, ImplicitPdosOfADcfAreOff) {
  constexpr std::string_view text =
      "[DeviceInfo]\nCompactPDO=3\nNrOfRXPDO=0\nNrOfTXPDO=5\n[Comments]\nLines=0\n";
  const auto dcf = read_eds(text, "t.dcf", 5_node);
  const auto* cob_id = dcf.dictionary.find(ObjectKey{0x1800, 1});

  EXPECT_EQ(as_integer(*cob_id->default_value), 0x185);
  EXPECT_EQ(as_integer(*cob_id->parameter_value), 0x8000'0185);
  EXPECT_EQ(cob_id->parameter_pos, (SourcePos{4, 11}));
  EXPECT_FALSE(dcf.dictionary.find(ObjectKey{0x1804, 1})->parameter_value);
  for (const auto& pdo : describe_pdos(dcf.dictionary)) EXPECT_FALSE(pdo.valid) << pdo.number;
  for (const auto& pdo : describe_pdos(read_eds(text, "t.dcf").dictionary)) {
    EXPECT_FALSE(pdo.valid) << pdo.number << " without a node id";
  }
}

TEST(Compact, WhatIsOddAboutItsNumberIsReportedOnceAndInItsPlace) {
  const auto file = read(
      "[3100]\nParameterName=Gain\nObjectType=0x8\nDataType=6\nAccessType=rw\n"
      "CompactSubObj=0A\nSubNumber=010\n");

  ASSERT_EQ(std::ranges::count(file.findings, "hex-without-prefix", &Finding::rule), 1);
  EXPECT_EQ(find(file.findings, "hex-without-prefix")->pos.line, line_of(6));
  EXPECT_EQ(find(file.findings, "octal-number")->pos.line, line_of(7));
}

}  // namespace
}  // namespace takt
