#include "eds_parser/write/eds_fix.hpp"

#include <cmath>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/device_files.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using testing::HasSubstr;
using testing::Not;

bool has(const Findings& findings, std::string_view rule) {
  return std::ranges::find(findings, rule, &Finding::rule) != findings.end();
}

/// Makes an EDS with a list of manufacturer objects, followed by `objects`.
std::string with_objects(const std::string& list, const std::string& objects) {
  return std::string{test::base} + "\n[ManufacturerObjects]\n" + list + objects;
}

std::string object(const std::string& index, const std::string& more) {
  return "[" + index + "]\nParameterName=x\nObjectType=0x7\nAccessType=rw\n" + more;
}

struct Case {
  std::string rule;
  std::string before;
  std::string becomes;  ///< part of the repaired text
};

std::string value_case(const std::string& more) {
  return with_objects("SupportedObjects=1\n1=0x2000\n", object("2000", more));
}

std::vector<Case> cases() {
  const std::string list = "SupportedObjects=1\n1=0x2000\n";
  const std::string u16 = "DataType=0x0006\n";
  const std::string plain = object("2000", u16);
  const std::string record =
      "[2000]\nParameterName=r\nObjectType=0x9\nSubNumber=2\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[2000sub1]\nParameterName=a\nDataType=5\nAccessType=rw\n";
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  return {
      {"access-type-letter", with_objects(list, changed(plain, "rw", "R ; read only")),
       "AccessType=ro\n; read only\n"},
      {"octal-number", value_case(u16 + "DefaultValue=012\n"), "DefaultValue=10\n"},
      {"leading-zero", value_case(u16 + "DefaultValue=08\n"), "DefaultValue=8\n"},
      {"number-suffix", value_case(u16 + "DefaultValue=0x10UL\n"), "DefaultValue=0x10\n"},
      {"nodeid-not-first", value_case(u16 + "DefaultValue=0x180+$NODEID\n"),
       "DefaultValue=$NODEID+0x180\n"},
      {"nodeid-without-dollar", value_case(u16 + "DefaultValue=NODEID+0x180\n"),
       "DefaultValue=$NODEID+0x180\n"},
      {"hex-without-prefix", value_case(u16 + "DefaultValue=1F\n"), "DefaultValue=0x1F\n"},
      {"integer-with-fraction", value_case(u16 + "DefaultValue=5.0\n"), "DefaultValue=5\n"},
      {"inline-comment", value_case(u16 + "DefaultValue=250 ; 25 ms\n"),
       "DefaultValue=250\n; 25 ms\n"},
      {"inline-comment",
       with_objects("SupportedObjects=1\n1=0x2000\n",
                    "[2000]\nParameterName=x\nObjectType=0x7 # VAR\nAccessType=rw ; both\n" + u16),
       "ObjectType=0x7\n; VAR\nAccessType=rw\n; both\n"},
      {"inline-comment", value_case("DataType=0x0008\nDefaultValue=0.5 ; gain\n"),
       "DefaultValue=0.5\n; gain\n"},
      {"inline-comment", value_case("DataType=0x000A\nDefaultValue=010f ; bytes\n"),
       "DefaultValue=010f\n; bytes\n"},
      {"inline-comment", value_case("DataType=0x000C\nDefaultValue=5 100 ; days\n"),
       "DefaultValue=5 100\n; days\n"},
      {"octet-string-form", value_case("DataType=0x000A\nDefaultValue=0x01 02 ; two\n"),
       "DefaultValue=0102\n; two\n"},
      {"number-suffix", value_case("DataType=0x0008\nDefaultValue=1.5F\n"), "DefaultValue=1.5\n"},
      {"boolean-word", value_case(u16 + "PDOMapping=true\n"), "PDOMapping=1\n"},
      {"boolean-word", value_case(u16 + "PDOMapping=2\n"), "PDOMapping=1\n"},
      {"inline-comment", value_case(u16 + "PDOMapping=1 ; yes\n"), "PDOMapping=1\n; yes\n"},
      {"hex-without-prefix", value_case("DataType=000A\n"), "DataType=0xA\n"},
      {"leading-zero", value_case(u16 + "ObjFlags=08\n"), "ObjFlags=8\n"},
      {"real-bit-pattern", value_case("DataType=0x0008\nDefaultValue=0x3FC00000\n"),
       "DefaultValue=1.5\n"},
      {"negative-unsigned", value_case(u16 + "DefaultValue=-1\n"), "DefaultValue=0xFFFF\n"},
      {"octet-string-form", value_case("DataType=0x000A\nDefaultValue=0x01 02\n"),
       "DefaultValue=0102\n"},
      {"unknown-key", value_case("DataTyp=0x0006\nDefaultValue=3\n"),
       "DataType=0x0006\nDefaultValue=3\n"},
      {"blank-in-key", with_objects("Supported Objects=1\n1=0x2000\n", plain),
       "\nSupportedObjects=1\n"},
      {"list-count-missing", with_objects("1=0x2000\n", plain),
       "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n"},
      {"list-count-wrong", with_objects("SupportedObjects=5\n1=0x2000\n", plain),
       "[ManufacturerObjects]\nSupportedObjects=1\n"},
      {"list-numbers-gap", with_objects("SupportedObjects=1\n7=0x2000\n", plain),
       "SupportedObjects=1\n1=0x2000\n"},
      {"listed-twice", with_objects("SupportedObjects=2\n1=0x2000\n2=0x2000\n", plain),
       "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n[2000]"},
      {"object-not-listed", with_objects(list, plain + object("2001", u16)),
       "SupportedObjects=2\n1=0x2000\n2=0x2001\n"},
      {"wrong-list",
       std::string{test::base} + "[OptionalObjects]\nSupportedObjects=2\n1=0x2000\n2=0x1008\n" +
           plain + object("1008", u16),
       "[OptionalObjects]\nSupportedObjects=1\n1=0x1008\n"},
      {"wrong-list",
       std::string{test::base} + "[OptionalObjects]\nSupportedObjects=1\n1=8192\n" + plain,
       "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n"},
      {"hex-without-prefix", with_objects("SupportedObjects=1\n1=2000\n", plain), "\n1=0x2000\n"},
      {"sub-number-wrong", with_objects(list, changed(record, "SubNumber=2", "SubNumber=9")),
       "SubNumber=2\n"},
      {"sub-number-missing", with_objects(list, changed(record, "SubNumber=2\n", "")),
       "ObjectType=0x9\nSubNumber=2\n"},
      {"section-name-form", with_objects(list, changed(plain, "[2000]", "[0x2000]")), "\n[2000]\n"},
      {"section-name-form", with_objects(list, changed(record, "[2000sub1]", "[2000sub01]")),
       "\n[2000sub1]\n"},
      {"decimal-sub-index", with_objects(list, changed(record, "[2000sub1]", "[2000sub100]")),
       "\n[2000sub64]\n"},
      {"section-not-closed", with_objects(list, changed(plain, "[2000]", "[2000")), "\n[2000]\n"},
      {"section-not-closed", with_objects(list, changed(plain, "[2000]", "[2000 ;foo")),
       "\n[2000] ;foo\n"},
      {"type-word",
       with_objects(list, changed(changed(plain, "=0x7", "=VAR ; foo"), "0x0006", "UNSIGNED16")),
       "ObjectType=0x7\n; foo\nAccessType=rw\nDataType=0x0006\n"},
      {"section-spelling",
       std::string{test::base} + "\n[DeviceCommissioning]\nNodeID=5\nBaudrate=500\n",
       "[DeviceComissioning]\n"},
      {"baudrate-unit",
       std::string{test::base} + "\n[DeviceComissioning]\nNodeID=5\nBaudrate=500000\n",
       "Baudrate=500\n"},
      {"compact-and-sub-number",
       with_objects(list,
                    "[2000]\nParameterName=c\nObjectType=0x8\nDataType=5\nAccessType=rw\n"
                    "SubNumber=4\nCompactSubObj=3\n"),
       "SubNumber=0\n"},
      {"entry-count-wrong",
       with_objects(list,
                    "[2000]\nParameterName=c\nObjectType=0x8\nDataType=5\nAccessType=rw\n"
                    "CompactSubObj=3\n[2000Name]\nNrOfEntries=7 ; names\n1=a\n02=b\n"),
       "[2000Name]\nNrOfEntries=2 ; names\n1=a"},
      {"entry-count-wrong", std::string{test::base} + "[Comments]\nLines=\nLine1=a\nLine2=b\n",
       "\nLines=2\nLine1=a"},
      {"entry-count-wrong",
       std::string{test::base} + "[Tools]\nItems=2\n[Tool1]\nName=a\nCommand=b\n", "\nItems=1\n"},
      {"entry-count-wrong",
       std::string{test::base} + "[1018ObjectLinks]\nObjectLinks=0\n1=0x1001\n",
       "\nObjectLinks=1\n"},
      {"entry-count-wrong",
       std::string{test::base} + "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\n"
                                 "ProductName=a\n[M2ModuleInfo]\nProductName=b\n",
       "[SupportedModules]\nNrOfEntries=2\n"},
      {"module-count",
       std::string{test::base} +
           "[M1SubExt6000]\nDataType=5\nAccessType=ro\nCount=1\n[ConnectedModules]\n"
           "NrOfEntries=1\n1=1\n2=1\n",
       "[ConnectedModules]\nNrOfEntries=2\n"},
      {"hash-comment", "# made by hand\n" + std::string{test::base}, "; made by hand\n"},
      {"byte-order-mark", "\xEF\xBB\xBF" + std::string{test::base}, "[FileInfo]"},
  };
}

TEST(EdsFix, MendsEachRuleAndFindsItNoMore) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.rule + ": " + one.becomes);
    ASSERT_TRUE(has(read_eds(one.before, "t.eds").findings, one.rule)) << one.before;

    const FixedEds fixed = fix_eds(one.before, "t.eds");

    EXPECT_TRUE(has(fixed.fixed, one.rule));
    EXPECT_FALSE(has(fixed.left, one.rule)) << fixed.text;
    EXPECT_FALSE(has(read_eds(fixed.text, "t.eds").findings, one.rule));
    EXPECT_THAT(fixed.text, HasSubstr(one.becomes));
  }
}

TEST(EdsFix, TwoFaultsOfOneSectionNameAreMendedOneAfterTheOther) {
  std::string text{test::base};
  text +=
      "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n[2000]\nParameterName=r\n"
      "ObjectType=9\nSubNumber=3\n";
  for (const auto* header : {"[2000sub10", "[2000sub20]", "[2000sub100"}) {
    text += std::string{header} + "\nParameterName=v\nDataType=6\nAccessType=rw\n";
  }

  const FixedEds fixed = fix_eds(text, "t.eds");

  for (const auto* header : {"\n[2000subA]\n", "\n[2000sub14]\n", "\n[2000sub64]\n"}) {
    EXPECT_THAT(fixed.text, HasSubstr(header));
  }
  EXPECT_FALSE(has(fixed.left, "section-not-closed"));
  EXPECT_FALSE(has(fixed.left, "decimal-sub-index"));
}

TEST(EdsFix, AnObjectMovesInWhereTheLastOneGoes) {
  const std::string u16 = "DataType=0x0006\n";
  const FixedEds fixed =
      fix_eds(with_objects("SupportedObjects=2\n1=0x2001\n2=0x1009\n",
                           "[OptionalObjects]\nSupportedObjects=2\n1=0x1008\n2=0x2000\n" +
                               object("1008", u16) + object("1009", u16) + object("2000", u16) +
                               object("2001", u16)),
              "t.eds");

  EXPECT_THAT(fixed.text, HasSubstr("SupportedObjects=2\n1=0x2001\n2=0x2000\n[Opt"));
  EXPECT_THAT(fixed.text, HasSubstr("SupportedObjects=2\n1=0x1008\n2=0x1009\n[1008]"));
  EXPECT_EQ(fixed.fixed.size(), 2U) << "none that the mending itself made";
}

TEST(EdsFix, AMandatoryObjectGetsItsListWhereThereIsNone) {
  const std::string list = "SupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n";
  std::string text{test::base};
  text.replace(text.find("[MandatoryObjects]\n" + list), 19 + list.size(),
               "[OptionalObjects]\nSupportedObjects=2\n1=0x1001\n2=0x1018\n"
               "[ManufacturerObjects]\nSupportedObjects=1\n1=0x1000\n");

  EXPECT_THAT(fix_eds(text, "t.eds").text,
              HasSubstr("[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n"));
}

TEST(EdsFix, WhatIsNotMendedIsNotCounted) {
  const std::string lists =
      std::string{test::base} + "[OptionalObjects]\nSupportedObjects=1\n1=8192\n";

  const FixedEds fixed = fix_eds("# remark\n" + lists, "t.eds");

  EXPECT_EQ(fixed.text, "; remark\n" + lists);
  EXPECT_TRUE(has(fixed.left, "wrong-list"));
  EXPECT_FALSE(has(fixed.fixed, "wrong-list"));
}

TEST(EdsFix, EachFindingOfASectionNameIsCountedOnce) {
  const std::string u16 = "DataType=0x0006\n";
  const std::string list = "SupportedObjects=1\n1=0x2000\n";

  EXPECT_EQ(
      fix_eds(std::string{test::base} + "[DeviceCommissioning\nNodeID=5\n", "t.dcf").fixed.size(),
      2U);
  std::string both = object("2000", u16);
  both.replace(0, std::string{"[2000]"}.size(), "[0x2000");
  EXPECT_EQ(fix_eds(with_objects(list, both), "t.eds").fixed.size(), 2U);
}

TEST(EdsFix, EachFindingOfAValueIsCounted) {
  const auto mended = [](const std::string& more) {
    return fix_eds(value_case(more), "t.eds").fixed.size();
  };

  EXPECT_EQ(mended("DataType=0x0006\nDefaultValue=08 ; eight\n"), 2U);
  EXPECT_EQ(mended("DataType=0x0008\nDefaultValue=1.5f # gain\n"), 2U);
  EXPECT_EQ(mended("DataType=0x0005\nDefaultValue=0777 ; too much\n"), 2U) << "not that it exceeds";
}

TEST(EdsFix, EveryRuleThatIsDeclaredToBeMendedHasItsCase) {
  const std::vector<Case> all = cases();
  for (const std::string_view rule : fixable_rules) {
    EXPECT_TRUE(std::ranges::any_of(all, [&](const Case& one) { return one.rule == rule; }))
        << rule;
  }
}

TEST(EdsFix, AFileWithoutAFaultStaysByteForByte) {
  for (const auto& path : test::device_files(test::own_eds_files())) {
    std::ifstream in{path, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};

    EXPECT_EQ(fix_eds(text, path).text, text) << path;
  }
}

TEST(EdsFix, LineEndsCommentsAndOrderStayAsTheyAre) {
  const std::string before =
      "; head\r\n[ManufacturerObjects]\r\nSupportedObjects=2\r\n1=0x2000\r\n\r\n; "
      "tail\r\n[2000]\r\n"
      "ParameterName=a ; b\r\nDataType=6\r\nAccessType=rw\r\nDefaultValue=010 ; eight\r\n"
      "odd=\xE4\r\n";

  EXPECT_EQ(fix_eds(before, "t.eds").text,
            "; head\r\n[ManufacturerObjects]\r\nSupportedObjects=1\r\n1=0x2000\r\n\r\n; "
            "tail\r\n[2000]\r\nParameterName=a ; b\r\nDataType=6\r\nAccessType=rw\r\n"
            "DefaultValue=8\r\n; eight\r\nodd=\xE4\r\n");
}

TEST(EdsFix, WhatHasTwoReadingsIsLeftAndNamed) {
  const std::string before = value_case("DataType=0x0006\nDefaultValue=5\nDefaultValue=6\n");

  const FixedEds fixed = fix_eds(before, "t.eds");

  EXPECT_EQ(fixed.text, before);
  EXPECT_TRUE(has(fixed.left, "duplicate-key"));
}

TEST(EdsFix, ABinaryNumberIsNotMadeHexadecimal) {
  const std::string before = value_case("DataType=0x0006\nDefaultValue=0b101\n");
  const FixedEds fixed = fix_eds(before, "t.eds");
  EXPECT_EQ(fixed.text, before);
  EXPECT_TRUE(has(fixed.left, "value-unreadable"));
}

TEST(EdsFix, AKeyThatTheSectionHasAlreadyIsNotMadeTwice) {
  const std::string before = value_case("DataType=0x0006\nDefaultValue=5\nDefaultValu=6\n");

  EXPECT_EQ(fix_eds(before, "t.eds").text, before);
}

TEST(EdsFix, AnIgnoredKeyDoesNotBecomeAValue) {
  const std::string u16 = "DataType=0x0006\nDefaultValue=3\n";
  for (const char* key : {"ParameterValue1=9\n", "HighLimit2=2\n", "LowLimitt=4\n", "PDOMaping=1\n",
                          "DefaultValue2=7\n"}) {
    const std::string before = value_case(u16 + key);

    EXPECT_EQ(fix_eds(before, "t.eds").text, before);
  }
  const std::string empty = value_case("DataType=0x0006\nDefaultValu=3\n");
  EXPECT_EQ(fix_eds(empty, "t.eds").text, empty);
}

TEST(EdsFix, ASlipThatWouldChangeTheObjectIsLeftAndTheRestMended) {
  const std::string before =
      with_objects("SupportedObjects=1\n1=0x2000\n",
                   "[2000]\nParameterName=x\nAcessType=ro\nDataType=6\nDefaultValue=012\n");

  const FixedEds fixed = fix_eds(before, "t.eds");

  EXPECT_THAT(fixed.text, HasSubstr("AcessType=ro\nDataType=6\nDefaultValue=10\n"));
  EXPECT_TRUE(has(fixed.left, "unknown-key"));
}

TEST(EdsFix, WhatIsNoEdsIsDeclared) {
  const FixedEds fixed = fix_eds("hello\n", "t.eds");

  EXPECT_FALSE(fixed.readable);
  EXPECT_TRUE(has_error(fixed.left));
  EXPECT_EQ(fixed.text, "hello\n");
}

TEST(EdsFix, AUtf16FileBecomesUtf8) {
  std::ifstream in{test::nasty_eds_files() / "utf16_le.eds", std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};

  const FixedEds fixed = fix_eds(text, "t.eds");

  EXPECT_FALSE(has(fixed.left, "utf-16"));
  EXPECT_THAT(fixed.text, HasSubstr("[1000]"));
}

bool is_nan(const Value& value) {
  const auto* real = std::get_if<double>(&value);
  return real != nullptr && std::isnan(*real);
}

void keeps_all(const std::filesystem::path& path) {
  std::ifstream in{path, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  const EdsFile before = read_eds(text, path, 5_node);

  const FixedEds fixed = fix_eds(text, path);
  const EdsFile after = read_eds(fixed.text, path, 5_node);

  ASSERT_EQ(after.readable, before.readable) << path;
  for (const Object& object : before.dictionary.objects) {
    ASSERT_NE(after.dictionary.find(object.index), nullptr) << path << hex(object.index);
    for (const SubObject& sub : object.subs) {
      const SubObject* now = after.dictionary.find(ObjectKey{object.index, sub.sub});
      ASSERT_NE(now, nullptr) << path << hex(object.index);
      if (!sub.value() || is_nan(*sub.value())) continue;
      EXPECT_EQ(now->value(), sub.value()) << path << hex(object.index);
    }
  }
  EXPECT_EQ(fix_eds(fixed.text, path).text, fixed.text) << path << ": mended once more";
}

TEST(EdsFix, AFileOfThousandsOfFaultsTakesBoundedWork) {
  std::string text{test::base};
  for (int i = 0; i < 5000; ++i) {
    text += "[" + hex(static_cast<std::uint32_t>(0x2000 + i)).substr(2) +
            "]\nParameterName=x\nObjectType=0x9\nSubNumber=9\nDataTyp=0x0006\n";
  }
  text += "[9000]\n";
  for (int i = 0; i < 100'000; ++i) text += "DefaultValu=010\n";

  const FixedEds fixed = fix_eds(text, "t.eds");

  EXPECT_TRUE(fixed.readable);
  EXPECT_GT(fixed.fixed.size(), 5000u);
}

TEST(EdsFix, TheCorpusLosesNothing) {
  for (const auto& folder : {test::nasty_eds_files(), test::eds_corpus()}) {
    for (const auto& path : test::device_files(folder)) keeps_all(path);
  }
}

}  // namespace
}  // namespace takt
