#include <gtest/gtest.h>

#include "eds_parser/write/eds_fix.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

/// True if the key in line `line` of the test's own part is reported as unknown.
bool unknown_key(const EdsFile& file, std::uint32_t line) {
  return std::ranges::any_of(file.findings, [line](const Finding& finding) {
    return finding.rule == "unknown-key" && finding.pos == SourcePos{line_of(line), 1} &&
           finding.severity == Severity::warning;
  });
}

TEST(HeaderSections, KeysThatCia306DoesNotHaveAreReported) {
  const auto file = read_eds(
      "[FileInfo]\nFileName=t.eds\nAutor=x\n[DeviceInfo]\nVendorName=V\nNrOfTXPDOs=4\n"
      "BaudRate500=1\n[DummyUsage]\nDummy9=1\n[DeviceComissioning]\nNodeID=5\nNodName=a\n"
      "[Comments]\nLines=1\nLine1=a\nText=b\n[Tools]\nItems=1\n[Tool1]\nName=T\nComand=x\n"
      "[M1ModuleInfo]\nProductNme=x\n[1000]\nParameterName=x\nDataType=7\nAccessType=ro\n",
      "t.dcf");

  std::vector<std::uint32_t> lines;
  for (const auto& finding : file.findings) {
    if (finding.rule == "unknown-key") lines.push_back(finding.pos.line);
  }
  EXPECT_EQ(lines, (std::vector<std::uint32_t>{3, 6, 7, 9, 12, 16, 21, 23}));
}

TEST(HeaderSections, ReservedKeysAndBitRatesOfVendorsAreNotReported) {
  const auto file = read_eds(
      "[FileInfo]\nFileName=a\nFileVersion=1\nFileRevision=1\nEDSVersion=4.0\nDescription=d\n"
      "CreationTime=01:00PM\nCreationDate=01-02-2020\nCreatedBy=x\nModificationTime=01:00PM\n"
      "ModificationDate=01-02-2020\nModifiedBy=x\nLastEDS=b.eds\n"
      "[DeviceInfo]\nVendorName=V\nProductVersion=1\nProductRevision=1\nLMT_ManufacturerName=x\n"
      "LMT_ProductName=y\nBaudRate_83=0\nBaudRate_auto=1\nExtendedBootUpMaster=0\n"
      "ExtendedBootUpSlave=0\nCANopenSafetySupported=0\nNG_Slave=1\nNG_Master=0\n"
      "[DummyUsage]\nDummy0000=0\nDummy001B=0\n[DeviceComissioning]\nNodeID=5\nNodeRefd=a\n"
      "NetRefd=b\nCANopenManager=0\nLSS_SerialNumber=1\n[1000]\nDataType=7\n",
      "t.dcf");

  EXPECT_FALSE(has(file.findings, "unknown-key"));
}

TEST(HeaderSections, WhatIsOddAboutANumberIsReported) {
  const auto rule_at = [](std::string_view line) {
    const auto file =
        read_eds("[DeviceInfo]\n" + std::string{line} + "\n[1000]\nDataType=7\n", "t");
    for (const auto& finding : file.findings) {
      if (finding.pos.line == 2) return std::string{finding.rule};
    }
    return std::string{};
  };

  EXPECT_EQ(rule_at("VendorNumber=08"), "leading-zero");
  EXPECT_EQ(rule_at("VendorNumber=15A"), "hex-without-prefix");
  EXPECT_EQ(rule_at("VendorNumber=0x15AUL"), "number-suffix");
  EXPECT_EQ(rule_at("VendorNumber=1.0"), "integer-with-fraction");
  EXPECT_EQ(rule_at("VendorNumber=012"), "octal-number");
  EXPECT_EQ(rule_at("VendorNumber=007"), "");
  EXPECT_EQ(rule_at("LSS_Supported=2"), "boolean-word");
  EXPECT_EQ(rule_at("LSS_Supported=-1"), "boolean-word");
  EXPECT_EQ(rule_at("LSS_Supported=1 ; yes"), "inline-comment");
  EXPECT_EQ(rule_at("LSS_Supported=0x1"), "");
}

TEST(HeaderSections, OnlyNumberedLinesAreComments) {
  const auto file = read("[Comments]\nLines=2\nLine1=one\nLine2=two\nAuthor=nobody\n");

  EXPECT_EQ(file.dictionary.notes.comments, (std::vector<std::string>{"one", "two"}));
  EXPECT_TRUE(unknown_key(file, 5));
  EXPECT_FALSE(has(file.findings, "entry-count-wrong"));
}

TEST(HeaderSections, OnlyNumberedEntriesAreLinks) {
  const auto file = read(
      "[1001ObjectLinks]\nObjectLinks=1\n1=0x1018\nfirst=1\n"
      "[1018ObjectLinks]\nObjectLinks=1\n1=0x1001\n");

  ASSERT_EQ(file.dictionary.links.size(), 2U);
  EXPECT_EQ(file.dictionary.links[0].to, (std::vector<std::uint16_t>{0x1018}));
  EXPECT_TRUE(unknown_key(file, 4));
}

TEST(HeaderSections, LinksOfAndToWhatIsNotThereAreReported) {
  const auto file = read(
      "[1001ObjectLinks]\nObjectLinks=2\n1=0x1018\n2=0x2002\n"
      "[2005ObjectLinks]\nObjectLinks=1\n1=0x1001\n");

  const auto* target = find(file.findings, "listed-without-section");
  ASSERT_NE(target, nullptr);
  EXPECT_EQ(target->pos, (SourcePos{line_of(4), 3}));
  const auto* source = find(file.findings, "object-section-missing");
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->pos.line, line_of(5));
}

TEST(HeaderSections, CountsThatAreNotThoseOfTheEntriesAreReported) {
  const auto reported_at = [](std::string_view text) {
    const auto file = read(text);
    const auto* finding = find(file.findings, "entry-count-wrong");
    return finding == nullptr ? SourcePos{} : finding->pos;
  };
  const std::string array =
      "[2000]\nParameterName=a\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=3\n";

  EXPECT_EQ(reported_at("[Comments]\nLines=3\nLine1=a\n"), (SourcePos{line_of(2), 7}));
  EXPECT_EQ(reported_at("[1001ObjectLinks]\nObjectLinks=2\n1=0x1018\n"),
            (SourcePos{line_of(2), 13}));
  EXPECT_EQ(reported_at("[Tools]\nItems=2\n[Tool1]\nName=a\nCommand=b\n"),
            (SourcePos{line_of(2), 7}));
  EXPECT_EQ(reported_at(array + "[2000Name]\nNrOfEntries=1\n1=a\n2=b\n"),
            (SourcePos{line_of(8), 13}));
  EXPECT_EQ(reported_at(array + "[2000Value]\nNrOfEntries=3\n1=1\n"), (SourcePos{line_of(8), 13}));
  EXPECT_EQ(reported_at(array + "[2000Denotation]\nNrOfEntries=0\n1=x\n"),
            (SourcePos{line_of(8), 13}));

  EXPECT_EQ(reported_at("[Comments]\nLines=0x1\nLine1=a\n"), SourcePos{});
  EXPECT_EQ(reported_at("[Tools]\nItems=1\n[Tool1]\nName=a\nCommand=b\n"), SourcePos{});
  EXPECT_EQ(reported_at(array + "[2000Name]\nNrOfEntries=2\n1=a\n2=b\n"), SourcePos{});
}

TEST(HeaderSections, CommentsAreCountedInDecimalAsTheFixCountsThem) {
  const std::string text =
      std::string{test::base} + "[Comments]\nLines=2\nLine1=one\nLineA=ten\nLine02=two\n";

  const auto file = read_eds(text, "t.eds");

  EXPECT_EQ(file.dictionary.notes.comments, (std::vector<std::string>{"one", "two"}));
  EXPECT_TRUE(unknown_key(file, 4));
  EXPECT_FALSE(has(file.findings, "entry-count-wrong"));
  EXPECT_EQ(fix_eds(text, "t.eds").text, text);
}

TEST(HeaderSections, AnEmptyCountOfNoEntriesIsNotReported) {
  const auto count = [](std::string_view value, std::string_view entries) {
    return has(
        read("[Comments]\nLines=" + std::string{value} + "\n" + std::string{entries}).findings,
        "entry-count-wrong");
  };

  EXPECT_FALSE(count("", ""));
  EXPECT_FALSE(count("; none", ""));
  EXPECT_TRUE(count("none", ""));
  EXPECT_TRUE(count("", "Line1=a\n"));
}

TEST(HeaderSections, LinksOfAndToObjectsOfModulesAreNotReported) {
  const auto file = read(
      "[1001ObjectLinks]\nObjectLinks=3\n1=0x6000\n2=0x6401\n3=0x7000\n"
      "[6000ObjectLinks]\nObjectLinks=1\n1=0x1001\n"
      "[M1Fixed6000]\nParameterName=q\nDataType=5\nAccessType=ro\n"
      "[M1SubExt6401]\nParameterName=i\nDataType=3\nAccessType=ro\nCount=1\n");

  EXPECT_FALSE(has(file.findings, "object-section-missing"));
  EXPECT_EQ(std::ranges::count(file.findings, "listed-without-section", &Finding::rule), 1);
  EXPECT_EQ(find(file.findings, "listed-without-section")->pos.line, line_of(5));
  EXPECT_EQ(file.dictionary.links.size(), 1U) << "6000 is not there yet";
}

}  // namespace
}  // namespace takt
