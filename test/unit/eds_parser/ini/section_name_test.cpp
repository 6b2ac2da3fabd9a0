#include <gtest/gtest.h>

#include "eds_parser/write/dcf_writer.hpp"
#include "eds_parser/write/eds_fix.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::integer;
using test::line_of;
using test::read;

/// Reads a RECORD 2000 whose sub-index 1 has the value 7 and the section header of the test.
EdsFile record_with(const std::string& header) {
  return read(
      "[2000]\nParameterName=r\nObjectType=9\nSubNumber=2\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n" +
      header + "\nParameterName=v\nDataType=6\nAccessType=rw\nDefaultValue=7\n");
}

TEST(SectionName, BlanksAreLeftOutAndReported) {
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

TEST(SectionName, AMissingBracketLosesNothing) {
  for (const auto* header : {"[2000sub1", "[2000sub1 ", "[ 2000sub1"}) {
    const auto file = record_with(header);

    EXPECT_EQ(integer(file, {0x2000, 1}), 7) << header;
    EXPECT_EQ(integer(file, {0x2000, 0}), 1) << header;
    ASSERT_TRUE(has(file.findings, "section-not-closed")) << header;
    EXPECT_EQ(find(file.findings, "section-not-closed")->pos, (SourcePos{line_of(10), 1}));
  }
  const auto lost = record_with("[2000sub1]\nParameterName=v\nDataType=6\nAccessType=rw\n[20");
  EXPECT_EQ(integer(lost, {0x2000, 1}), std::nullopt);
  EXPECT_TRUE(has(read_eds("[1000", "t.eds").findings, "section-not-closed"));
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

std::string entry(const std::string& section, unsigned value) {
  return "[" + section +
         "]\nParameterName=v\nDataType=6\nAccessType=rw\nDefaultValue=" + std::to_string(value) +
         "\n";
}

/// Makes a RECORD with sub-objects of these names; the value of each is its position.
std::string record_of(const std::string& index, const std::vector<std::string>& subs) {
  std::string text = "[" + index +
                     "]\nParameterName=r\nObjectType=9\nSubNumber=" + std::to_string(subs.size()) +
                     "\n";
  for (std::size_t i = 0; i < subs.size(); ++i) {
    text += entry(index + "sub" + subs[i], static_cast<unsigned>(i));
  }
  return text;
}

TEST(SectionName, SubIndicesBeyondFfAreDecimal) {
  const auto file = read(record_of("2000", {"0", "10", "100", "254"}));

  EXPECT_EQ(integer(file, {0x2000, 10}), 1);
  EXPECT_EQ(integer(file, {0x2000, 0x10}), std::nullopt);
  EXPECT_EQ(integer(file, {0x2000, 100}), 2);
  EXPECT_EQ(integer(file, {0x2000, 254}), 3);
  ASSERT_TRUE(has(file.findings, "decimal-sub-index"));
  EXPECT_EQ(find(file.findings, "decimal-sub-index")->pos, (SourcePos{line_of(5), 1}));
  EXPECT_EQ(std::ranges::count(file.findings, "decimal-sub-index", &Finding::rule), 1);
  EXPECT_FALSE(has(file.findings, "unknown-section"));
}

TEST(SectionName, DecimalSubIndicesGoForOtherObjectsThatShowThem) {
  const auto proof = record_of("2000", {"100"});
  const std::vector<std::string> to_10{"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"};
  const auto file = read(proof + record_of("2001", to_10) + record_of("2002", {"0", "10"}) +
                         record_of("2003", {"9", "A", "10"}) + record_of("2004", {"A", "100"}));

  EXPECT_EQ(integer(file, {0x2001, 10}), 9);
  EXPECT_EQ(integer(file, {0x2002, 0x10}), 1);
  EXPECT_EQ(integer(file, {0x2003, 0x10}), 2);
  EXPECT_EQ(integer(file, {0x2004, 10}), 0);
  EXPECT_TRUE(has(file.findings, "unknown-section"));
  EXPECT_EQ(integer(read(record_of("2001", to_10)), {0x2001, 0x10}), 9);
}

TEST(SectionName, OneSlipDoesNotMakeASparseRecordDecimal) {
  const std::string slip = record_of("2001", {"0", "100"});
  const auto sparse = [](unsigned highest) {
    return "[2000]\nParameterName=r\nObjectType=9\nSubNumber=4\n" + entry("2000sub0", highest) +
           entry("2000sub8", 8) + entry("2000sub9", 9) + entry("2000sub10", 7);
  };
  const auto hexadecimal = read(sparse(16) + slip);
  const auto decimal = read(sparse(10) + slip);

  EXPECT_EQ(integer(hexadecimal, {0x2000, 0x10}), 7);
  EXPECT_EQ(integer(hexadecimal, {0x2000, 10}), std::nullopt);
  EXPECT_EQ(integer(decimal, {0x2000, 10}), 7);
  EXPECT_EQ(integer(decimal, {0x2001, 100}), 1);
}

TEST(SectionName, AFileWithDecimalSubIndicesIsMendedAndConfigured) {
  const std::string text =
      std::string{test::base} + record_of("2000", {"0", "10", "254"}) + "[2001]\nDataTyp=5\n";

  const FixedEds fixed = fix_eds(text, "t.eds");
  EXPECT_EQ(integer(read_eds(fixed.text, "t.eds"), {0x2000, 10}), 1);
  EXPECT_NE(fixed.text, text);

  const auto dcf = write_dcf(text, "t.eds", {.values = {{{0x2000, 254}, "7"}}});
  EXPECT_EQ(integer(read_eds(dcf.text, "t.dcf"), {0x2000, 254}), 7);
  EXPECT_EQ(integer(read_eds(dcf.text, "t.dcf"), {0x2000, 10}), 1);
}

}  // namespace
}  // namespace takt
