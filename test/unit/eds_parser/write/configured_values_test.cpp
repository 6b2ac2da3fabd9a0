#include "eds_parser/write/configured_values.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

std::string record(const std::string& index, std::string_view subs) {
  return "[" + index + "]\nParameterName=r\nObjectType=9\nSubNumber=3\n" + std::string{subs};
}

std::string sub(const std::string& section, std::string_view type, std::string_view rest) {
  return "[" + section + "]\nParameterName=s\nAccessType=rw\nDataType=" + std::string{type} + "\n" +
         std::string{rest} + "\n";
}

std::string lines(const std::vector<ConciseEntry>& entries) {
  std::string text;
  for (const auto& entry : entries) {
    text += to_string(entry.object);
    for (const auto byte : entry.value) {
      text += ' ' + hex(std::to_integer<unsigned>(byte), 2).substr(2);
    }
    text += '\n';
  }
  return text;
}

std::string configured(const std::string& objects, Findings* findings = nullptr) {
  const auto file = test::read(objects);
  Report report{"t.dcf"};
  auto text = lines(configured_values(file.dictionary, report));
  if (findings != nullptr) *findings = report.take();
  return text;
}

TEST(ConfiguredValues, HoldParameterValuesThatMayBeWritten) {
  EXPECT_EQ(configured(sub("1017", "6", "ParameterValue=100") + sub("6081", "7", "DefaultValue=5") +
                       sub("6083", "4", "ParameterValue=-2") +
                       "[2000]\nParameterName=x\nAccessType=ro\nDataType=7\nParameterValue=1\n" +
                       sub("2001", "5", "ParameterValue=1\nObjFlags=1")),
            "1017:00 64 00\n"
            "6083:00 FE FF FF FF\n");
}

TEST(ConfiguredValues, APdoIsSwitchedOffWhileItChanges) {
  const auto pdo = record("1800", "") + sub("1800sub0", "5", "DefaultValue=2") +
                   sub("1800sub1", "7", "DefaultValue=$NODEID+0x40000180") +
                   sub("1800sub2", "5", "ParameterValue=1") + record("1A00", "") +
                   sub("1A00sub0", "5", "ParameterValue=2") +
                   sub("1A00sub1", "7", "DefaultValue=0x60410010") +
                   sub("1A00sub2", "7", "ParameterValue=0x60640020") +
                   sub("1A00sub3", "7", "DefaultValue=0x606C0020");
  EXPECT_EQ(configured(pdo),
            "1800:01 85 01 00 C0\n"
            "1A00:00 00\n"
            "1A00:01 10 00 41 60\n"
            "1A00:02 20 00 64 60\n"
            "1A00:00 02\n"
            "1800:02 01\n"
            "1800:01 85 01 00 40\n");
}

/// Makes TPDO1 whose 1A00 has these sub-objects.
std::string mapped(const std::string& entries) {
  return record("1800", "") + sub("1800sub0", "5", "DefaultValue=1") +
         sub("1800sub1", "7", "DefaultValue=$NODEID+0x180") + record("1A00", "") + entries;
}

TEST(ConfiguredValues, AMappingWithoutACountHasItsConfiguredEntries) {
  const auto pdo =
      mapped(sub("1A00sub0", "5", "") + sub("1A00sub1", "7", "DefaultValue=0x60410010") +
             sub("1A00sub2", "7", "ParameterValue=0x10010008") +
             sub("1A00sub3", "7", "DefaultValue=0x60640020"));
  EXPECT_EQ(configured(pdo),
            "1800:01 85 01 00 80\n"
            "1A00:00 00\n"
            "1A00:01 10 00 41 60\n"
            "1A00:02 08 00 01 10\n"
            "1A00:00 02\n"
            "1800:01 85 01 00 00\n");
}

TEST(ConfiguredValues, AMappingWithoutACountAndWithAGapIsAnError) {
  const auto file = test::read(mapped(sub("1A00sub0", "5", "") + sub("1A00sub1", "7", "") +
                                      sub("1A00sub2", "7", "ParameterValue=0x10010008")));
  const auto values = configured_values(file);
  EXPECT_TRUE(values.entries.empty());
  EXPECT_EQ(test::find(values.findings, "mapping-count-unknown")->severity, Severity::error);
}

TEST(ConfiguredValues, AnEntryBehindTheCountIsLeftOutAndReported) {
  Findings findings;
  const auto text = configured(mapped(sub("1A00sub0", "5", "DefaultValue=0") +
                                      sub("1A00sub1", "7", "ParameterValue=0x10010008")),
                               &findings);
  EXPECT_EQ(text.find("1A00:01"), std::string::npos);
  EXPECT_TRUE(test::has(findings, "mapping-entry-left-out"));
}

TEST(ConfiguredValues, AFileWithAnErrorConfiguresNothing) {
  const auto values = configured_values(
      test::read(sub("1017", "6", "ParameterValue=100") + sub("6081", "7", "ParameterValue=fast")));
  EXPECT_TRUE(values.entries.empty());
  EXPECT_TRUE(has_error(values.findings));
  EXPECT_FALSE(test::has(values.findings, "value-left-out"));
}

TEST(ConfiguredValues, AFormulaOfAnUnknownNodeIsLeftOutAndReported) {
  const auto values = configured_values(test::read(
      sub("1017", "6", "ParameterValue=100") + sub("2000", "7", "ParameterValue=$NODEID+0x300"),
      std::nullopt));
  EXPECT_EQ(lines(values.entries), "1017:00 64 00\n");
  EXPECT_TRUE(test::has(values.findings, "value-left-out"));
}

TEST(ConfiguredValues, AFileForADomainIsLeftOutAndReported) {
  const auto values = configured_values(test::read(sub("1017", "6", "ParameterValue=100") +
                                                   sub("1F50", "0xF", "DownloadFile=p.bin")));
  EXPECT_EQ(lines(values.entries), "1017:00 64 00\n");
  EXPECT_EQ(test::find(values.findings, "download-left-out")->severity, Severity::warning);
}

TEST(ConfiguredValues, StoreAndRestoreAreCommandsAndNoConfiguration) {
  Findings findings;
  EXPECT_EQ(configured(record("1010", "") + sub("1010sub1", "7", "ParameterValue=1"), &findings),
            "");
  EXPECT_TRUE(test::has(findings, "command-left-out"));
}

TEST(ConfiguredValues, AnUnknownTypeIsLeftOutAndReported) {
  Findings findings;
  EXPECT_EQ(configured(sub("2000", "0x44", "ParameterValue=1"), &findings), "");
  EXPECT_TRUE(test::has(findings, "data-type-unknown"));
}

}  // namespace
}  // namespace takt
