#include <gtest/gtest.h>
#include <vector>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

/// The place of a finding: `line` counts from the first line of `text`; 0 stands for a file that
/// can't be read.
struct Place {
  std::string_view rule;
  std::uint32_t line;
  std::uint32_t column;
  Severity severity;
  std::string text;
};

constexpr auto note = Severity::note;
constexpr auto warning = Severity::warning;
constexpr auto error = Severity::error;

/// Makes a section with its entries after a first line to which no rule applies.
std::string section(const std::string& name, const std::string& entries) {
  return ";\n[" + name + "]\nParameterName=x\nAccessType=rw\n" + entries;
}

void expect(const Findings& findings, const Place& place, std::uint32_t first_line) {
  SCOPED_TRACE(std::string{place.rule} + '\n' + place.text);
  const auto* finding = test::find(findings, place.rule);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->pos.line, place.line == 0 ? 0 : place.line + first_line);
  EXPECT_EQ(finding->pos.column, place.column);
  EXPECT_EQ(finding->severity, place.severity);
  EXPECT_EQ(std::ranges::count(findings, place.rule, &Finding::rule), 1);
}

TEST(RulePlace, IsThatOfTheObjectOrEntryAtFault) {
  const std::string number = "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\n";
  const std::vector<Place> places = {
      {"bit-pattern", 6, 14, note, section("2000", "DataType=4\nDefaultValue=0x80000001\n")},
      {"compact-too-many", 7, 16, warning,
       section("2000", "ObjectType=8\nDataType=5\nCompactSubObj= 255\n")},
      {"mappable-without-size", 6, 13, warning, section("2000", "DataType=9\nPDOMapping= 1\n")},
      {"no-sub-objects", 2, 1, warning, section("2000", "ObjectType=9\nSubNumber=1\n")},
      {"number-unreadable", 6, 11, warning,
       section("2000", "ObjectType=9\nSubNumber=three\n" + number)},
      {"object-type-unknown", 5, 12, warning, section("2000", "ObjectType=0x99\nDataType=5\n")},
      {"standard-type", 5, 10, warning, section("1017", "DataType=7\nDefaultValue=0\n")},
      {"type-word", 5, 12, warning, section("2000", "ObjectType=VAR\nDataType=5\n")},
      {"unknown-sub-object", 10, 1, warning,
       section("2000", "ObjectType=8\nDataType=5\nCompactSubObj=3\n") +
           "[2000Value]\nNrOfEntries=1\n9=1\n"},
  };
  for (const auto& place : places) {
    expect(test::read(place.text).findings, place, test::line_of(0));
  }
}

TEST(RulePlace, OfAJudgementIsThatOfTheValue) {
  const std::string u16 = "DataType=6\nDefaultValue=";
  const std::string u8 = "DataType=5\nDefaultValue=";
  const std::string u32 = "DataType=7\nDefaultValue=";
  const auto record = [](const std::string& subs) {
    return section("2000", "ObjectType=9\nSubNumber=2\n") + subs;
  };
  const std::vector<Place> places = {
      {"cob-id-bits", 6, 14, warning, section("1400sub1", u32 + "0x00012345\n")},
      {"pdo-half", 2, 1, warning, section("1A04", "ObjectType=9\nSubNumber=0\n")},
      {"pdo-inhibit-of-rpdo", 6, 14, note, section("1400sub3", u16 + "100\n")},
      {"pdo-mapping-count", 6, 14, warning,
       section("1A00sub0", u8 + "3\n") + section("1800sub1", u32 + "$NODEID+0x180\n")},
      {"pdo-mapping-count", 6, 14, error,
       section("1A00sub0", u8 + "65\n") + section("1800sub1", u32 + "$NODEID+0x180\n")},
      {"pdo-sync-start", 6, 14, error, section("1800sub6", u8 + "241\n")},
      {"sub-0-count", 12, 14, note,
       record(section("2000sub0", u8 + "3\n") + section("2000sub4", u16 + "0\n"))},
      {"sub-0-missing", 2, 1, warning,
       record(section("2000sub1", u16 + "0\n") + section("2000sub2", u16 + "0\n"))},
  };
  for (const auto& place : places) {
    expect(check(test::read(place.text).dictionary), place, test::line_of(0));
  }
}

TEST(RulePlace, OfACountOfPdosIsThatOfTheCount) {
  const std::string device = "[DeviceInfo]\nVendorName=V\n";
  for (const auto& place :
       {Place{"pdo-count", 3, 12, warning, device + "NrOfRXPDO= 2\n"},
        Place{"pdo-count", 4, 11, warning, device + "NrOfRXPDO=0\nNrOfTXPDO=4\n"},
        Place{"pdo-count", 1, 1, warning, device + section("1400sub2", "DataType=5\n")}}) {
    expect(check(read_eds(place.text, "t.eds").dictionary), place, 0);
  }
}

TEST(RulePlace, OfAMissingObjectIsTheSectionBeforeItOrWhatDemandsIt) {
  const auto number = [](const std::string& index, const std::string& value) {
    return section(index, "DataType=7\nDefaultValue=" + value + "\n");
  };
  const auto late = check(read_eds(number("2000", "0"), "t.eds").dictionary);
  EXPECT_EQ(test::find(late, "mandatory-object-missing")->pos, (SourcePos{2, 1}));
  const auto first = number("1000", "0") + number("1001", "0");
  const auto last = check(read_eds(first + number("2000", "0"), "t.eds").dictionary);
  EXPECT_EQ(test::find(last, "mandatory-object-missing")->pos, (SourcePos{8, 1}));

  const auto drive = number("1000", "0x00020192");
  const auto bare = check(read_eds(drive, "t.eds").dictionary);
  EXPECT_EQ(test::find(bare, "profile-object-missing")->pos, (SourcePos{6, 14}));
  EXPECT_EQ(test::find(bare, "profile-object-advised")->pos, (SourcePos{6, 14}));
  std::string homing = drive;
  for (const auto* index : {"6040", "6041", "6060", "6061"}) homing += number(index, "0");
  const auto claimed = check(read_eds(homing + number("6502", "0x20"), "t.eds").dictionary);
  EXPECT_EQ(test::find(claimed, "profile-object-missing")->pos, (SourcePos{36, 14}));
}

TEST(RulePlace, OfTheEncodingIsTheFirstLine) {
  expect(read_eds("\xEF\xBB\xBF[1000]\nDataType=7\n", "t.eds").findings,
         {"byte-order-mark", 1, 1, note, ""}, 0);
  const std::string wide{"\xFF\xFE[\0001\0000\0000\0000\0]\0", 14};
  expect(read_eds(wide, "t.eds").findings, {"utf-16", 1, 1, warning, ""}, 0);
}

TEST(RulePlace, OfWhatIsMissingIsTheStartOfTheFile) {
  const auto object = section("2000", "DataType=5\n");
  for (const auto& place :
       {Place{"device-info-missing", 1, 1, warning, object},
        Place{"lists-missing", 1, 1, warning, object},
        Place{"node-id-range", 2, 8, warning, "[DeviceComissioning]\nNodeID=128\n" + object},
        Place{"node-id-range", 2, 8, warning, "[DeviceComissioning]\nNodeID=0\n" + object}}) {
    expect(read_eds(place.text, "t.dcf").findings, place, 0);
  }
  const Place place{"dcf-without-node-id", 1, 1, warning, object};
  expect(check(read_eds(object, "t.dcf").dictionary), place, 0);
  const auto text = object + "[DeviceComissioning]\nNodeName=x\n";
  expect(check(read_eds(text, "t.dcf").dictionary), {"dcf-without-node-id", 6, 1, warning, text},
         0);
  EXPECT_FALSE(test::has(check(read_eds(object, "t.eds").dictionary), "dcf-without-node-id"));
  for (const auto* other : {"", "no section at all\n"}) {
    expect(read_eds(other, "t.eds").findings, {"not-an-eds", 1, 1, error, ""}, 0);
  }
  const auto missing = read_eds_file("no-such-file.eds").findings;
  expect(missing, {"file-unreadable", 0, 0, error, ""}, 0);
}

}  // namespace
}  // namespace takt
