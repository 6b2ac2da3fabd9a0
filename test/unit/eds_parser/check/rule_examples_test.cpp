#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <sstream>
#include <vector>

#include "eds_parser/check/rule_list.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

/// Kind of the text of an example: objects to append to a good device, or a complete file.
enum class Kind : std::uint8_t { objects, whole, dcf };

struct Example {
  std::string_view rule;
  Kind kind;
  std::string text;
};

std::string many(unsigned count, const std::function<std::string(unsigned)>& piece) {
  std::string text;
  for (unsigned i = 0; i < count; ++i) text += piece(i);
  return text;
}

std::vector<Example> examples() {
  const auto compact = [](unsigned i) {
    return "[" + hex(0x2000 + i).substr(2) + "]\nObjectType=8\nDataType=5\nCompactSubObj=254\n";
  };
  const auto connected = [](unsigned i) { return std::to_string(i + 1) + "=1\n"; };
  return {
      {"access-type-letter", Kind::objects, "[2000]\nDataType=0x0006\nAccessType=R\n"},
      {"access-type-missing", Kind::objects, "[2000]\nDataType=0x0006\nAccessType=\n"},
      {"access-type-unknown", Kind::objects, "[2000]\nDataType=0x0006\nAccessType=sometimes\n"},
      {"baudrate-unit", Kind::dcf, "[DeviceComissioning]\nBaudrate=500000\n"},
      {"baudrate-unsupported", Kind::dcf,
       "[DeviceInfo]\nBaudRate_500=1\n[DeviceComissioning]\nNodeID=5\nBaudrate=250\n"},
      {"bit-pattern", Kind::objects, "[2000]\nDataType=0x0004\nDefaultValue=0x80000001\n"},
      {"blank-in-key", Kind::whole, "[OptionalObjects]\nSupported Objects=3\n"},
      {"boolean-word", Kind::objects, "[2000]\nDataType=0x0006\nPDOMapping=true\n"},
      {"byte-order-mark", Kind::whole, "\xEF\xBB\xBF[FileInfo]\n"},
      {"channel-direction", Kind::whole,
       "[DeviceInfo]\nDynamicChannelsSupported=1\n[DynamicChannels]\nNrOfSeg=1\nType1=0x0005\nDir1="
       "out\nRange1=0xA080-0xA0BF\nPPOffset1=0\n"},
      {"channel-incomplete", Kind::whole,
       "[DeviceInfo]\nDynamicChannelsSupported=1\n[DynamicChannels]\nNrOfSeg=2\nType1=0x0005\nDir1="
       "ro\nRange1=0xA080-0xA0BF\nPPOffset1=0\n"},
      {"channel-range", Kind::whole,
       "[DeviceInfo]\nDynamicChannelsSupported=1\n[DynamicChannels]\nNrOfSeg=1\nType1=0x0005\nDir1="
       "ro\nRange1=0xA0BF-0xA080\nPPOffset1=0\n"},
      {"channel-type", Kind::whole,
       "[DeviceInfo]\nDynamicChannelsSupported=1\n[DynamicChannels]\nNrOfSeg=1\nType1=0x0000\nDir1="
       "ro\nRange1=0xA080-0xA0BF\nPPOffset1=0\n"},
      {"channels-missing", Kind::whole, "[DeviceInfo]\nDynamicChannelsSupported=1\n"},
      {"channels-unsupported", Kind::whole,
       "[DeviceInfo]\nDynamicChannelsSupported=0\n[DynamicChannels]\nNrOfSeg=1\nType1=0x0005\nDir1="
       "ro\nRange1=0xA080-0xA0BF\nPPOffset1=0\n"},
      {"cob-id-absolute", Kind::objects, "[1400sub1]\nDataType=7\nDefaultValue=0x205\n"},
      {"cob-id-bits", Kind::objects, "[1400sub1]\nDataType=7\nDefaultValue=0x00012345\n"},
      {"cob-id-extended", Kind::objects,
       "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x20000180\n"},
      {"cob-id-restricted", Kind::objects, "[1800sub1]\nDataType=7\nDefaultValue=0x585\n"},
      {"cob-id-twice", Kind::objects,
       "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n[1801sub1]\nDataType=7\nDefaultValue=$"
       "NODEID+0x180\n"},
      {"compact-and-sections", Kind::objects,
       "[2001]\nObjectType=8\nDataType=5\nCompactSubObj=3\n[2001sub2]\nDataType=5\n"},
      {"compact-and-sub-number", Kind::objects,
       "[2001]\nObjectType=8\nDataType=5\nSubNumber=4\nCompactSubObj=3\n"},
      {"compact-too-many", Kind::objects, "[2001]\nObjectType=8\nDataType=5\nCompactSubObj=255\n"},
      {"compact-without-type", Kind::objects, "[2001]\nObjectType=8\nCompactSubObj=3\n"},
      {"data-type-missing", Kind::objects, "[2000]\n"},
      {"data-type-unknown", Kind::objects, "[2000]\nDataType=0x0041\n"},
      {"dcf-without-node-id", Kind::dcf, "[DeviceComissioning]\nBaudrate=500\n"},
      {"default-outside-limits", Kind::objects,
       "[2000]\nDataType=0x0006\nHighLimit=5\nLowLimit=0\nDefaultValue=6\n"},
      {"decimal-sub-index", Kind::objects, "[2000]\nObjectType=9\n[2000sub128]\nDataType=5\n"},
      {"device-info-missing", Kind::whole, "[FileInfo]\n[MandatoryObjects]\n"},
      {"duplicate-key", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=5\nDefaultValue=6\n"},
      {"duplicate-section", Kind::objects, "[2000]\nDataType=0x0006\n[2000]\nDataType=0x0006\n"},
      {"encoding-assumed", Kind::objects,
       "[2000]\nParameterName=Z\xE4"
       "hler\n"},
      {"entry-count-wrong", Kind::objects,
       "[2000]\nObjectType=8\nDataType=5\nCompactSubObj=3\n[2000Name]\nNrOfEntries=1\n1=a\n2=b\n"},
      {"entry-outside-section", Kind::whole, "FileName=a.eds\n"},
      {"granularity", Kind::whole,
       "[DeviceInfo]\nGranularity=0\n[1600sub0]\nDataType=5\nAccessType=rw\n"},
      {"hash-comment", Kind::whole, "# text\n"},
      {"hex-without-prefix", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=1F\n"},
      {"identity-mismatch", Kind::whole,
       "[DeviceInfo]\nVendorNumber=1\n[1018sub1]\nDataType=7\nDefaultValue=2\n"},
      {"inline-comment", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=250 ; 25 ms\n"},
      {"integer-with-fraction", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=0.0\n"},
      {"leading-zero", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=08\n"},
      {"limit-above-type", Kind::objects, "[2000]\nDataType=3\nLowLimit=-32768\nHighLimit=32768\n"},
      {"limits-inverted", Kind::objects, "[2000]\nDataType=2\nLowLimit=0\nHighLimit=0xFF\n"},
      {"limits-of-16-bits", Kind::objects,
       "[1016]\nObjectType=8\nSubNumber=2\n[1016sub0]\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
       "[1016sub1]\nDataType=7\nAccessType=rw\nLowLimit=0\nHighLimit=65535\n"},
      {"list-count-missing", Kind::objects, "[OptionalObjects]\n1=0x1008\n"},
      {"list-count-wrong", Kind::objects,
       "[OptionalObjects]\nSupportedObjects=5\n1=0x1008\n2=0x1009\n3=0x100A\n"},
      {"list-numbers-gap", Kind::whole,
       "[MandatoryObjects]\nSupportedObjects=2\n1=0x1000\n3=0x1001\n"},
      {"listed-twice", Kind::objects,
       "[OptionalObjects]\nSupportedObjects=2\n1=0x1008\n2=0x1008\n[1008]\nDataType=0x0006\n"},
      {"listed-without-section", Kind::objects,
       "[ManufacturerObjects]\nSupportedObjects=5\n5=0x2002\n"},
      {"lists-missing", Kind::whole, "[1000]\nDataType=7\n"},
      {"mandatory-object-missing", Kind::whole, "[1000]\nDataType=7\n"},
      {"mappable-without-size", Kind::objects, "[2000]\nDataType=0x0009\nPDOMapping=1\n"},
      {"module-count", Kind::objects,
       "[M1SubExt6000]\nDataType=5\nAccessType=ro\nCount=1\n[ConnectedModules]\nNrOfEntries=1\n1="
       "1\n2=1\n"},
      {"module-list", Kind::objects, "[M1SubExtends]\nNrOfEntries=1\n1=0x6001\n"},
      {"module-sub-objects", Kind::objects,
       "[6000sub0]\nDataType=5\nDefaultValue=2\n[6000sub1]\nDataType=5\nDefaultValue=0\n[6000sub2]"
       "\nDataType=5\nDefaultValue=0\n[M1SubExt6000]\nDataType=5\nAccessType=ro\nCount=2\n["
       "ConnectedModules]\n1=1\n2=1\n"},
      {"negative-unsigned", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=-1\n"},
      {"no-equals", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue 5\n"},
      {"no-sub-objects", Kind::objects, "[2000]\nObjectType=0x9\nSubNumber=0\n"},
      {"node-id-range", Kind::dcf, "[DeviceComissioning]\nNodeID=0\n"},
      {"nodeid-not-first", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=0x180+$NODEID\n"},
      {"nodeid-without-dollar", Kind::objects,
       "[2000]\nDataType=0x0006\nDefaultValue=NODEID+0x180\n"},
      {"not-an-eds", Kind::whole, "int main() {}\n"},
      {"number-suffix", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=0x10UL\n"},
      {"number-unreadable", Kind::objects,
       "[2000]\nObjectType=0x9\nSubNumber=three\n[2000sub0]\nDataType=5\nAccessType="
       "ro\nDefaultValue=0\n"},
      {"object-not-listed", Kind::objects, "[2000]\nDataType=0x0006\n"},
      {"object-section-missing", Kind::objects, "[2001sub1]\nDataType=5\nDefaultValue=0\n"},
      {"object-type-unknown", Kind::objects, "[2000]\nDataType=0x0006\nObjectType=0x99\n"},
      {"octal-number", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=012\n"},
      {"octet-string-form", Kind::objects, "[2000]\nDataType=0x000A\nDefaultValue=0x01 02\n"},
      {"parameter-name-missing", Kind::objects, "[2000]\nDataType=5\n"},
      {"parameter-value-in-eds", Kind::objects, "[2000]\nDataType=0x0006\nParameterValue=5\n"},
      {"pdo-count", Kind::whole,
       "[DeviceInfo]\nNrOfTXPDO=4\n[1800sub1]\nDataType=7\nDefaultValue=\n[1801sub1]\nDataType="
       "7\nDefaultValue=\n"},
      {"pdo-direction", Kind::objects,
       "[6041]\nDataType=6\nAccessType=ro\nDefaultValue=0\n[1600sub1]\nDataType=7\nDefaultValue="
       "0x60410010\n[1400sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"},
      {"pdo-direction-hint", Kind::objects,
       "[6040]\nDataType=6\nAccessType=rww\nDefaultValue=0\n[1A00sub1]\nDataType=7\nDefaultValue="
       "0x60400010\n[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"},
      {"pdo-dummy", Kind::objects,
       "[1600sub1]\nDataType=7\nDefaultValue=0x00060010\n[1400sub1]\nDataType=7\nDefaultValue=$"
       "NODEID+0x180\n"},
      {"pdo-entry-length", Kind::objects,
       "[6041]\nDataType=6\nDefaultValue=0\n[1A00sub1]\nDataType=7\nDefaultValue=0x60410020\n["
       "1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"},
      {"pdo-event-timer-unused", Kind::objects,
       "[1800sub2]\nDataType=5\nDefaultValue=1\n[1800sub5]\nDataType=6\nDefaultValue=100\n"},
      {"pdo-half", Kind::objects, "[1A04sub0]\nDataType=5\nDefaultValue=0\n"},
      {"pdo-inhibit-of-rpdo", Kind::objects, "[1400sub3]\nDataType=6\nDefaultValue=100\n"},
      {"pdo-inhibit-too-long", Kind::objects,
       "[1800sub3]\nDataType=6\nDefaultValue=1001\n[1800sub5]\nDataType=6\nDefaultValue=100\n"},
      {"pdo-inhibit-unused", Kind::objects,
       "[1800sub2]\nDataType=5\nDefaultValue=1\n[1800sub3]\nDataType=6\nDefaultValue=100\n"},
      {"pdo-mapping-count", Kind::objects,
       "[1A00sub0]\nDataType=5\nDefaultValue=3\n[1A00sub1]\nDataType=7\nDefaultValue=0x60410010\n["
       "1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"},
      {"pdo-mapping-gap", Kind::objects,
       "[1A00sub0]\nDataType=5\nDefaultValue=2\n[1A00sub1]\nDataType=7\nDefaultValue=\n[1800sub1]"
       "\nDataType=7\nDefaultValue=$NODEID+0x180\n[1A00sub2]\nDataType=7\nDefaultValue="
       "0x60410010\n"},
      {"pdo-not-mappable", Kind::objects,
       "[2000]\nDataType=0x0006\nPDOMapping=0\n[1A00sub1]\nDataType=7\nDefaultValue=0x20000010\n["
       "1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x180\n"},
      {"pdo-object-missing", Kind::objects,
       "[1A00sub1]\nDataType=7\nDefaultValue=0x20000010\n[1800sub1]\nDataType=7\nDefaultValue=$"
       "NODEID+0x180\n"},
      {"pdo-rtr", Kind::objects,
       "[1800sub1]\nDataType=7\nDefaultValue=$NODEID+0x40000180\n[1800sub2]\nDataType="
       "5\nDefaultValue=253\n"},
      {"pdo-rtr-of-rpdo", Kind::objects,
       "[1400sub1]\nDataType=7\nDefaultValue=$NODEID+0x40000200\n"},
      {"pdo-sync-start", Kind::objects, "[1800sub6]\nDataType=5\nDefaultValue=241\n"},
      {"pdo-too-long", Kind::objects,
       "[1A00sub0]\nDataType=5\nDefaultValue=3\n[1A00sub1]\nDataType=7\nDefaultValue=0x60640020\n["
       "1A00sub2]\nDataType=7\nDefaultValue=0x60640020\n[1A00sub3]\nDataType=7\nDefaultValue="
       "0x60640020\n[1800sub1]\nDataType=7\nDefaultValue=\n"},
      {"pdo-transmission-type", Kind::objects, "[1400sub2]\nDataType=5\nDefaultValue=253\n"},
      {"profile-object-advised", Kind::whole, "[1000]\nDataType=7\nDefaultValue=0x00020192\n"},
      {"profile-object-missing", Kind::whole, "[1000]\nDataType=7\nDefaultValue=0x00020192\n"},
      {"range-of-16-bits", Kind::objects,
       "[607A]\nDataType=4\nAccessType=rw\nLowLimit=-32768\nHighLimit=32767\n"},
      {"real-bit-pattern", Kind::objects, "[2000]\nDataType=0x0008\nDefaultValue=0x3F800000\n"},
      {"sdo-default-channel", Kind::objects,
       "[1200sub1]\nDataType=7\nDefaultValue=$NODEID+0x580\n"},
      {"section-name-blank", Kind::objects,
       "[2000]\nObjectType=0x9\nSubNumber=2\n[2000sub0]\nDataType=5\nAccessType=ro\nDefaultValue="
       "1\n[2000 sub1]\nDataType=6\nDefaultValue=0\n"},
      {"section-name-form", Kind::objects, "[0x2000]\nDataType=0x0006\n"},
      {"section-not-closed", Kind::whole, "[1000\n"},
      {"section-spelling", Kind::dcf, "[DeviceCommissioning]\nNodeID=5\n"},
      {"standard-type", Kind::objects, "[1017]\nDataType=0x0007\nDefaultValue=0\n"},
      {"sub-0-count", Kind::objects,
       "[2000]\nObjectType=0x9\nSubNumber=3\n[2000sub0]\nDataType=5\nAccessType=ro\nDefaultValue="
       "3\n[2000sub2]\nDataType=6\nDefaultValue=0\n[2000sub4]\nDataType=6\nDefaultValue=0\n"},
      {"sub-0-missing", Kind::objects,
       "[2000]\nObjectType=0x9\nSubNumber=1\n[2000sub1]\nDataType=6\nDefaultValue=0\n"},
      {"sub-number-missing", Kind::objects,
       "[2000]\nObjectType=0x9\n[2000sub0]\nDataType=5\nAccessType=ro\nDefaultValue=0\n"},
      {"sub-number-wrong", Kind::objects,
       "[2000]\nObjectType=0x9\nSubNumber=3\n[2000sub0]\nDataType=5\nAccessType=ro\nDefaultValue="
       "4\n[2000sub1]\nDataType=6\nDefaultValue=0\n[2000sub2]\nDataType=6\nDefaultValue=0\n["
       "2000sub3]\nDataType=6\nDefaultValue=0\n[2000sub4]\nDataType=6\nDefaultValue=0\n"},
      {"sub-objects-of-var", Kind::objects,
       "[2000]\nObjectType=0x7\nSubNumber=2\n[2000sub0]\nDataType=5\nAccessType=ro\nDefaultValue="
       "1\n[2000sub1]\nDataType=6\nDefaultValue=0\n"},
      {"text-after-section", Kind::objects, "[1003sub01] # repeat\n"},
      {"type-word", Kind::objects, "[2000]\nObjectType=RECORD\n[2000sub0]\nDataType=5\n"},
      {"unknown-key", Kind::objects, "[2000]\nDataType=0x0006\nMaxSize=4\n"},
      {"unknown-module", Kind::objects, "[ConnectedModules]\n1=7\n"},
      {"unknown-section", Kind::objects, "[PreDefines]\n"},
      {"unknown-sub-object", Kind::objects,
       "[2000]\nObjectType=8\nDataType=5\nCompactSubObj=3\n[2000Value]\nNrOfEntries=1\n9=1\n"},
      {"value-exceeds-type", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=0x12345\n"},
      {"value-outside-limits", Kind::objects,
       "[2000]\nDataType=0x0006\nHighLimit=5\nLowLimit=0\nParameterValue=6\n"},
      {"value-unreadable", Kind::objects, "[2000]\nDataType=0x0006\nDefaultValue=-\n"},
      {"wrong-list", Kind::objects, "[OptionalObjects]\nSupportedObjects=7\n7=0x2000\n"},
      {"long-line", Kind::objects, "[2000]\nParameterName=" + std::string(300, 'x') + "\n"},
      {"too-many-modules", Kind::objects,
       "[M1SubExt6000]\nDataType=1\nCount=0;1\n[ConnectedModules]\n" + many(255, connected)},
      {"too-many-sub-objects", Kind::objects, many(1100, compact)},
      {"utf-16", Kind::whole, {"\xFF\xFE[\0F\0]\0\n\0", 10}},
  };
}

Findings findings_of(const Example& example) {
  const bool objects = example.kind == Kind::objects;
  const auto text = objects ? std::string{test::base} + example.text : example.text;
  auto file = read_eds(text, example.kind == Kind::dcf ? "drive.dcf" : "drive.eds");
  auto findings = check(file.dictionary);
  findings.insert(findings.end(), file.findings.begin(), file.findings.end());
  return findings;
}

TEST(RuleExamples, EachBreaksItsRuleWithTheUsualSeverity) {
  for (const auto& example : examples()) {
    const auto rule = std::ranges::find(eds_rules(), example.rule, &RuleInfo::name);
    ASSERT_NE(rule, eds_rules().end()) << example.rule;

    const auto findings = findings_of(example);
    const auto usual = [&](const Finding& finding) {
      return finding.rule == rule->name && finding.severity == rule->severity;
    };

    EXPECT_TRUE(std::ranges::any_of(findings, usual)) << example.rule << '\n' << example.text;
  }
}

/// The entries `Key=value` in the rule list must be those of the examples in this file.
TEST(RuleExamples, HoldTheEntriesThatTheRuleListShows) {
  for (const auto& example : examples()) {
    const auto rule = std::ranges::find(eds_rules(), example.rule, &RuleInfo::name);
    ASSERT_NE(rule, eds_rules().end()) << example.rule;
    std::istringstream words{std::string{rule->example}};
    std::string before;
    for (std::string word; words >> word; before = word) {
      if (word.ends_with(',')) word.pop_back();
      if (!word.contains('=') || before == "without") continue;
      EXPECT_TRUE(example.text.contains(word)) << example.rule << ": " << word;
    }
  }
}

TEST(RuleExamples, EveryRuleHasOne) {
  const auto all = examples();
  for (const auto& rule : eds_rules()) {
    if (rule.name == "file-unreadable") continue;  // no text can break this rule
    EXPECT_EQ(std::ranges::count(all, rule.name, &Example::rule), 1) << rule.name;
  }
}

TEST(RuleExamples, AFileThatIsNotThereCannotBeRead) {
  const auto file = read_eds_file("no-such-file.eds");

  ASSERT_EQ(file.findings.size(), 1U);
  EXPECT_EQ(file.findings[0].rule, "file-unreadable");
  EXPECT_EQ(file.findings[0].severity, Severity::error);
  EXPECT_EQ(file.findings[0].pos, (SourcePos{0, 0}));
  EXPECT_FALSE(file.readable);
}

}  // namespace
}  // namespace takt
