#include "eds_parser/write/dcf_writer.hpp"

#include <gtest/gtest.h>
#include <utility>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;

constexpr std::string_view small = R"(; a comment stays
[FileInfo]
FileName=gain.eds

[DeviceInfo]
CompactPDO=0
[OptionalObjects]
SupportedObjects=2
1=0x1017
2=0x3100

[1017]
ParameterName=Heartbeat
DataType=0x0006
AccessType=rw
DefaultValue=0 ; off
HighLimit=1000
; behind the object
[2000]
ParameterName=Serial
DataType=7
AccessType=ro
[3100]
ParameterName=Gain
ObjectType=8
DataType=6
AccessType=rw
DefaultValue=7
CompactSubObj=12
)";

DcfText write(const DcfOptions& options, std::string_view source = small) {
  return write_dcf(source, "folder/gain.eds", options);
}

TEST(DcfWriter, NothingToSetLeavesAllButLastEds) {
  const auto dcf = write({});
  auto expected = std::string{small};
  expected.replace(expected.find("FileName=gain.eds\n"), 18,
                   "FileName=gain.eds\nLastEDS=gain.eds\n");
  EXPECT_EQ(dcf.text, expected);
}

TEST(DcfWriter, WhatAModuleBringsIsWrittenBesideWhatTheFileDescribes) {
  constexpr std::string_view modular =
      "[OptionalObjects]\nSupportedObjects=1\n1=0x6200\n"
      "[6200]\nParameterName=Outputs\nObjectType=8\nSubNumber=1\n"
      "[6200sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=0\n"
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=x\n"
      "[M1SubExtends]\nNrOfEntries=1\n1=0x6200\n"
      "[M1SubExt6200]\nParameterName=Output\nDataType=5\nAccessType=rw\nCount=1\nObjExtend=1\n"
      "[ConnectedModules]\nNrOfEntries=2\n1=1\n2=1\n";
  const auto before = read_eds(modular, "io.dcf").dictionary;
  const auto dcf = write({.values = {{{0x6200, 1}, "5"}}}, modular);

  for (const auto* section : {"[6200]", "[6200sub0]", "[6200sub1]", "SubNumber=", "1=0x6200\n"}) {
    const auto at = dcf.text.find(section);
    ASSERT_NE(at, std::string::npos) << section;
    const bool list = std::string_view{section}.starts_with("1=");  // also in [M1SubExtends]
    EXPECT_EQ(dcf.text.find(section, at + 1) == std::string::npos, !list) << section << dcf.text;
  }
  const auto after = read_eds(dcf.text, "io.dcf");
  EXPECT_EQ(after.dictionary.find({0x6200, 1})->parameter_value, Value{std::uint64_t{5}});
  EXPECT_EQ(after.dictionary.find({0x6200, 0})->default_value,
            before.find({0x6200, 0})->default_value);
  EXPECT_EQ(find(after.findings, "sub-number-wrong"), nullptr);
}

TEST(DcfWriter, AValueStandsBehindTheDefaultAndCommentsStay) {
  const auto dcf = write({.values = {{{0x1017, 0}, "0x64"}}});
  EXPECT_NE(dcf.text.find("DefaultValue=0 ; off\nParameterValue=0x64\nHighLimit=1000\n; behind"),
            std::string::npos)
      << dcf.text;
}

TEST(DcfWriter, AnOldValueIsReplacedAndItsCommentStays) {
  const auto once = write({.values = {{{0x1017, 0}, "100"}}}).text;
  auto commented = once;
  commented.replace(commented.find("ParameterValue=100"), 18, "ParameterValue=100 ; ms");
  const auto twice = write({.values = {{{0x1017, 0}, "200"}}}, commented).text;
  EXPECT_NE(twice.find("ParameterValue=200 ; ms\n"), std::string::npos) << twice;
  EXPECT_EQ(twice.find("ParameterValue=100"), std::string::npos);
}

TEST(DcfWriter, OfTwoValuesOfOneObjectTheLaterCounts) {
  const auto dcf = write({.values = {{{0x1017, 0}, "100"}, {{0x1017, 0}, "300"}}});
  EXPECT_NE(dcf.text.find("ParameterValue=300\n"), std::string::npos);
  EXPECT_EQ(dcf.text.find("ParameterValue=100\n"), std::string::npos);
}

TEST(DcfWriter, CompactSubObjectsGetAValueList) {
  const auto dcf = write({.values = {{{0x3100, 1}, "1000"}, {{0x3100, 10}, "0x20"}}});
  EXPECT_TRUE(
      dcf.text.ends_with("CompactSubObj=12\n"
                         "\n"
                         "[3100Value]\n"
                         "NrOfEntries=2\n"
                         "1=1000\n"
                         "10=0x20\n"))
      << dcf.text;
  const auto more = write({.values = {{{0x3100, 2}, "5"}, {{0x3100, 1}, "9"}}}, dcf.text);
  EXPECT_TRUE(more.text.ends_with("NrOfEntries=3\n1=9\n10=0x20\n2=5\n")) << more.text;
}

TEST(DcfWriter, AValueListCountsBeforeASectionAndItsKeysAreNumbers) {
  const std::string source = R"([2000]
ParameterName=c
ObjectType=8
DataType=5
AccessType=rw
CompactSubObj=3
[2000sub2]
ParameterName=own
DataType=5
AccessType=rw
[2000Value]
NrOfEntries=3
2=9
03=8
0x1=7
)";
  const auto dcf = write_dcf(
      source, "t.eds", {.values = {{{0x2000, 1}, "76"}, {{0x2000, 2}, "77"}, {{0x2000, 3}, "78"}}});
  EXPECT_NE(dcf.text.find("NrOfEntries=4\n2=77\n03=78\n0x1=7\n1=76\n"), std::string::npos)
      << dcf.text;
  const auto after = read_eds(dcf.text, "t.dcf").dictionary;
  EXPECT_EQ(as_integer(*after.find(ObjectKey{0x2000, 1})->value()), 76);
  EXPECT_EQ(as_integer(*after.find(ObjectKey{0x2000, 2})->value()), 77);
  EXPECT_EQ(as_integer(*after.find(ObjectKey{0x2000, 3})->value()), 78);
}

TEST(DcfWriter, AValueThatWouldNotBeReadIsAnError) {
  const std::string source =
      "[2000]\nParameterName=c\nObjectType=8\nDataType=0xF\nAccessType=rw\nCompactSubObj=3\n";
  const auto dcf = write_dcf(source, "t.eds", {.values = {{{0x2000, 1}, "@new.bin"}}});
  EXPECT_TRUE(dcf.text.empty());
  EXPECT_TRUE(test::has(dcf.findings, "value-not-set"));
}

TEST(DcfWriter, NodeNameAndBitRateBecomeDeviceComissioning) {
  const auto dcf = write({.node = 5_node, .baudrate_kbit = 500, .node_name = "lift"});
  EXPECT_TRUE(
      dcf.text.ends_with("CompactSubObj=12\n"
                         "\n"
                         "[DeviceComissioning]\n"
                         "NodeID=5\n"
                         "NodeName=lift\n"
                         "Baudrate=500\n"))
      << dcf.text;
  const auto again = write({.node = 6_node}, dcf.text);
  EXPECT_TRUE(again.text.ends_with("NodeID=6\nNodeName=lift\nBaudrate=500\n"));
}

TEST(DcfWriter, LineEndsAreThoseOfTheFile) {
  std::string dos;
  for (const char c : small) dos += c == '\n' ? std::string{"\r\n"} : std::string{c};
  const auto dcf = write({.node = 5_node, .values = {{{0x1017, 0}, "1"}}}, dos);
  EXPECT_NE(dcf.text.find("ParameterValue=1\r\n"), std::string::npos);
  EXPECT_EQ(std::ranges::count(dcf.text, '\n'), std::ranges::count(dcf.text, '\r'));
}

TEST(DcfWriter, AFileWithoutLastLineEndGetsOne) {
  const std::string open{small.substr(0, small.size() - 1)};
  const auto dcf = write({.node = 5_node}, open);
  EXPECT_NE(dcf.text.find("CompactSubObj=12\n\n[DeviceComissioning]\nNodeID=5\n"),
            std::string::npos);
}

TEST(DcfWriter, WhatTheDeviceWouldRefuseIsAnErrorAndGivesNoText) {
  const auto refused = [](ObjectKey key, std::string value) {
    const auto dcf = write({.values = {{key, std::move(value)}}});
    EXPECT_TRUE(dcf.text.empty());
    EXPECT_TRUE(has_error(dcf.findings));
    return to_string(dcf.findings.back());
  };
  EXPECT_EQ(refused({0x2000, 0}, "1"),
            "folder/gain.eds:19:1: error: 2000:00 Serial is read-only: the device would refuse the "
            "value [read-only]");
  EXPECT_EQ(refused({0x1017, 0}, "1001"),
            "folder/gain.eds:12:1: error: 1017:00: 1001 lies outside any..1000: the device would "
            "refuse it [value-outside-limits]");
  EXPECT_EQ(refused({0x2001, 0}, "1"),
            "folder/gain.eds: error: 2001:00 is not an object of folder/gain.eds [unknown-object]");
  EXPECT_NE(refused({0x1017, 0}, "70000").find("is not a value of UNSIGNED16 [value"),
            std::string::npos);
  EXPECT_NE(refused({0x1017, 0}, "$NODEID+1").find("UNSIGNED16: $NODEID needs --node ["),
            std::string::npos);
  EXPECT_NE(refused({0x1017, 0}, "fast").find("is not a value of UNSIGNED16"), std::string::npos);
  EXPECT_NE(refused({0x1017, 0}, "1\n[9999]").find("line break"), std::string::npos);
}

TEST(DcfWriter, AFormulaStaysAFormula) {
  const std::string source = std::string{test::base} +
                             "[1014]\nParameterName=EMCY\nDataType=7\nAccessType=rw\n"
                             "DefaultValue=$NODEID+0x80\n";
  const auto dcf =
      write_dcf(source, "t.eds", {.node = 9_node, .values = {{{0x1014, 0}, "$NODEID+0x90"}}});
  EXPECT_NE(dcf.text.find("DefaultValue=$NODEID+0x80\nParameterValue=$NODEID+0x90\n"),
            std::string::npos);
  const auto read = read_eds(dcf.text, "t.dcf");
  EXPECT_EQ(as_integer(*read.dictionary.find(ObjectKey{0x1014, 0})->value()), 0x99);
}

TEST(DcfWriter, AnImpliedPdoIsWrittenOutWithItsMapping) {
  const std::string source = R"([DeviceInfo]
CompactPDO=3
NrOfRXPDO=2
NrOfTXPDO=1
[OptionalObjects]
SupportedObjects=1
1=0x1017
[1017]
ParameterName=Heartbeat
DataType=6
AccessType=rw
)";
  const auto before = read_eds(source, "t.eds", 5_node).dictionary;
  const auto dcf = write_dcf(source, "t.eds",
                             {.node = 5_node, .values = {{{0x1400, 2}, "1"}, {{0x1A00, 0}, "1"}}});
  ASSERT_FALSE(has_error(dcf.findings));
  EXPECT_NE(dcf.text.find("SupportedObjects=7\n1=0x1017\n2=0x1400\n3=0x1401\n4=0x1600\n"
                          "5=0x1601\n6=0x1800\n7=0x1A00\n"),
            std::string::npos)
      << dcf.text;
  const auto after = read_eds(dcf.text, "t.dcf").dictionary;
  ASSERT_EQ(after.objects.size(), before.objects.size());
  for (std::size_t i = 0; i < after.objects.size(); ++i) {
    ASSERT_EQ(after.objects[i].index, before.objects[i].index);
    ASSERT_EQ(after.objects[i].subs.size(), before.objects[i].subs.size());
    for (std::size_t s = 0; s < after.objects[i].subs.size(); ++s) {
      const auto& sub = after.objects[i].subs[s];
      EXPECT_EQ(sub.default_value, before.objects[i].subs[s].default_value);
      const bool set = (after.objects[i].index == 0x1400 && sub.sub == 2) ||
                       (after.objects[i].index == 0x1A00 && sub.sub == 0);
      EXPECT_EQ(sub.parameter_value, set ? std::optional{Value{std::uint64_t{1}}} : std::nullopt);
    }
  }
}

TEST(DcfWriter, AnImpliedPdoIsAsOnAsItWas) {
  const std::string eds =
      "[DeviceInfo]\nCompactPDO=3\nNrOfRXPDO=0\nNrOfTXPDO=5\n"
      "[1017]\nParameterName=Heartbeat\nDataType=6\nAccessType=rw\n";
  const auto on = [](std::string_view text, const char* name) {
    std::string pdos;
    for (const auto& pdo : describe_pdos(read_eds(text, name, 5_node).dictionary)) {
      pdos += pdo.valid ? '1' : '0';
    }
    return pdos;
  };
  const DcfOptions heartbeat{.node = 5_node, .values = {{{0x1017, 0}, "100"}}};
  const DcfOptions pdo{.node = 5_node, .values = {{{0x1801, 2}, "1"}}};
  const DcfOptions both{.node = 5_node, .values = {{{0x1801, 2}, "1"}, {{0x1801, 1}, "0x285"}}};

  ASSERT_EQ(on(eds, "t.eds"), "11110");
  EXPECT_EQ(on(write_dcf(eds, "t.eds", heartbeat).text, "t.dcf"), "11110");
  EXPECT_EQ(on(write_dcf(eds, "t.eds", pdo).text, "t.dcf"), "11110");
  ASSERT_EQ(on(eds, "t.dcf"), "00000");
  EXPECT_EQ(on(write_dcf(eds, "t.dcf", heartbeat).text, "t.dcf"), "00000");
  EXPECT_EQ(on(write_dcf(eds, "t.dcf", pdo).text, "t.dcf"), "00000");
  EXPECT_EQ(on(write_dcf(eds, "t.dcf", both).text, "t.dcf"), "01000");
}

TEST(DcfWriter, Utf16BecomesUtf8) {
  std::string wide = "\xFF\xFE";
  for (const char c : small) wide += {c, '\0'};
  const auto dcf = write({.values = {{{0x1017, 0}, "1"}}}, wide);
  EXPECT_NE(dcf.text.find("DefaultValue=0 ; off\nParameterValue=1\n"), std::string::npos);
}

TEST(DcfWriter, ADomainNamesItsFile) {
  const std::string source =
      "[1F50]\nParameterName=Program\nObjectType=2\nDataType=0xF\nAccessType=wo\n";
  const auto dcf = write_dcf(source, "t.eds", {.values = {{{0x1F50, 0}, "@new.bin"}}});
  EXPECT_EQ(dcf.text, source + "DownloadFile=new.bin\n");
}

}  // namespace
}  // namespace takt
