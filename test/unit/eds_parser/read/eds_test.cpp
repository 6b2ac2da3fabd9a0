#include "eds_parser/read/eds.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::integer;
using test::line_of;
using test::read;
using test::var;

TEST(Eds, ReadsTheDeviceItself) {
  const auto file = read("");

  const auto& device = file.dictionary.device;
  EXPECT_TRUE(file.readable);
  EXPECT_TRUE(file.findings.empty());
  EXPECT_EQ(device.vendor_number, 0x15AU);
  EXPECT_EQ(device.baud_rates_kbit, std::vector<std::uint16_t>{500});
  EXPECT_TRUE(file.dictionary.dummy_usage[5]);
  EXPECT_FALSE(file.dictionary.dummy_usage[6]);
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x1001})->type, ObjectType::var);
  EXPECT_EQ(integer(file, {0x1018, 1}), 0x15A);
}

TEST(Eds, IsRefusedOnlyWithoutAnyObject) {
  const auto file = read_eds("hello\nworld\n", "t.eds");

  EXPECT_FALSE(file.readable);
  EXPECT_TRUE(has(file.findings, "not-an-eds"));
  EXPECT_FALSE(read_eds("", "t.eds").readable);
  EXPECT_FALSE(read_eds_file("/does/not/exist.eds").readable);
  EXPECT_FALSE(read_eds_file("/").readable);
}

TEST(Eds, ReadsSignedBitPatternsInTheWidthOfTheType) {
  EXPECT_EQ(integer(read(var("0x0004", "0x80000001")), {0x2000, 0}), -2147483647);
  EXPECT_EQ(integer(read(var("0x0003", "0xFFFF")), {0x2000, 0}), -1);
  EXPECT_EQ(integer(read(var("0x0010", "0x800000")), {0x2000, 0}), -8388608);
  EXPECT_EQ(integer(read(var("0x0012", "0xFFFFFFFFFF")), {0x2000, 0}), -1);
  EXPECT_EQ(integer(read(var("0x0015", "0xFFFFFFFFFFFFFFFE")), {0x2000, 0}), -2);
  EXPECT_EQ(integer(read(var("0x0006", "-1")), {0x2000, 0}), 65535);
}

TEST(Eds, NeverCutsAValueToFit) {
  for (const auto* text : {"0x12345", "-40000", "70000"}) {
    const auto file = read(var("0x0006", text));
    EXPECT_EQ(integer(file, {0x2000, 0}), std::nullopt) << text;
    ASSERT_TRUE(has(file.findings, "value-exceeds-type")) << text;
    EXPECT_EQ(find(file.findings, "value-exceeds-type")->pos, (SourcePos{line_of(5), 14}));
    EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 0})->default_text, text);
  }
}

TEST(Eds, LeavesFormulasOpenWithoutANodeId) {
  const auto file = read(var("7", "$NODEID+0x180"), std::nullopt);

  EXPECT_EQ(integer(file, {0x2000, 0}), std::nullopt);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 0})->default_text, "$NODEID+0x180");
  EXPECT_FALSE(has(file.findings, "value-unreadable"));
  EXPECT_EQ(integer(read(var("7", "$NODEID+0x180"), 127_node), {0x2000, 0}), 0x1FF);
}

TEST(Eds, TakesTheNodeIdOfADcfInBothSpellings) {
  const auto one_m = read(var("7", "$NODEID+0x80") + "[DeviceComissioning]\nNodeID=6\n", {});
  const auto two_m = read(var("7", "$NODEID+0x80") + "[DeviceCommissioning]\nNodeId=0x06\n", {});

  EXPECT_EQ(integer(one_m, {0x2000, 0}), 134);
  EXPECT_EQ(integer(two_m, {0x2000, 0}), 134);
  EXPECT_FALSE(has(one_m.findings, "section-spelling"));
  EXPECT_TRUE(has(two_m.findings, "section-spelling"));
}

TEST(Eds, PrefersTheValueOfADcf) {
  const auto file = read(var("6", "5") + "ParameterValue=9\nDenotation=speed\n");

  const auto* sub = file.dictionary.find(ObjectKey{0x2000, 0});
  EXPECT_EQ(as_integer(*sub->default_value), 5);
  EXPECT_EQ(as_integer(*sub->value()), 9);
  EXPECT_EQ(sub->denotation, "speed");
}

TEST(Eds, KeepsTheDenotationOfAWholeArray) {
  const auto file = read(
      "[2000]\nParameterName=a\nObjectType=8\nSubNumber=2\nDenotation=axes\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[2000sub1]\nParameterName=v\nDataType=6\nAccessType=rw\nDenotation=lift\n");

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->denotation, "axes");
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 0})->denotation, "");
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 1})->denotation, "lift");
}

TEST(Eds, ReadsEveryOtherType) {
  const auto value = [](std::string_view type, std::string_view text) {
    return *read(var(type, text)).dictionary.find(ObjectKey{0x2000, 0})->value();
  };

  EXPECT_EQ(value("0x0008", "0.5"), Value{0.5});
  EXPECT_EQ(value("0x0008", "0x3F800000"), Value{1.0});
  EXPECT_EQ(value("0x0011", "-1.5"), Value{-1.5});
  EXPECT_EQ(value("0x0009", "1.0; beta"), Value{std::string{"1.0; beta"}});
  EXPECT_EQ(value("0x000A", "01a1053c"), (Value{std::string{"\x01\xA1\x05\x3C"}}));
  EXPECT_EQ(value("0x000A", "0x01 A1"), (Value{std::string{"\x01\xA1"}}));
  EXPECT_EQ(value("0x0001", "true"), Value{std::uint64_t{1}});
  EXPECT_EQ(value("0x000C", "365 43200000"), Value{std::uint64_t{365} << 32 | 43200000U});
  EXPECT_EQ(value("0x000D", "1 2"), Value{std::uint64_t{1} << 32 | 2U});
  EXPECT_EQ(value("0x000C", "3600000 2"), Value{std::uint64_t{2} << 32 | 3600000U});
  EXPECT_EQ(value("0x001B", "18446744073709551615"), Value{18446744073709551615U});
}

TEST(Eds, TakesNoFormulaForABitPattern) {
  const auto file = read(var("0x0008", "0x3F800000+$NODEID"));

  EXPECT_FALSE(file.dictionary.find(ObjectKey{0x2000, 0})->value());
  EXPECT_TRUE(has(file.findings, "value-unreadable"));
}

TEST(Eds, ReportsOfAFormulaThatNeedsMoreThan64Bits) {
  const auto text = var("0x001B", "$NODEID+0xFFFFFFFFFFFFFFFF");

  EXPECT_FALSE(read(text).dictionary.find(ObjectKey{0x2000, 0})->value());
  EXPECT_TRUE(has(read(text).findings, "value-exceeds-type"));
  EXPECT_FALSE(has(read(text, std::nullopt).findings, "value-exceeds-type"));
}

TEST(Eds, DropsLimitsThatAreInverted) {
  const auto file = read(var("2", "1") + "LowLimit=0x00\nHighLimit=0xFF\n");

  const auto* sub = file.dictionary.find(ObjectKey{0x2000, 0});
  EXPECT_FALSE(sub->low_limit);
  EXPECT_FALSE(sub->high_limit);
  EXPECT_TRUE(has(file.findings, "limits-inverted"));
  EXPECT_FALSE(has_error(file.findings));
}

/// Returns the limits of a VAR of the type as "low..high", with `-` for no limit.

std::string limits(const std::string& type, const std::string& value, const std::string& keys) {
  const auto file = read(var(type, value) + keys);
  const auto* sub = file.dictionary.find(ObjectKey{0x2000, 0});
  const auto text = [](const std::optional<Value>& limit) {
    return limit ? std::to_string(*as_integer(*limit)) : std::string{"-"};
  };
  const bool reported = has(file.findings, "limit-above-type");
  return text(sub->low_limit) + ".." + text(sub->high_limit) + (reported ? " told" : "");
}

TEST(Eds, DropsALimitAboveItsSignedType) {
  EXPECT_EQ(limits("3", "0x5A", "LowLimit=-32768\nHighLimit=32768\n"), "-32768..- told");
  EXPECT_EQ(limits("3", "", "LowLimit=-32767\nHighLimit=32768\n"), "-..-");  // inverted
  EXPECT_EQ(limits("2", "", "HighLimit=0xFF\n"), "-..- told");
  EXPECT_EQ(limits("4", "", "LowLimit=0x80000000\nHighLimit=0xFFFFFFFF\n"), "-2147483648..- told");
  EXPECT_EQ(limits("4", "", "LowLimit=-100\nHighLimit=4294967206\n"), "-100..- told");
}

TEST(Eds, DropsABitPatternAsLimitWhereTheDefaultLiesBehindIt) {
  EXPECT_EQ(limits("4", "0", "LowLimit=0x80000000\nHighLimit=0xFFFFFF00\n"), "-2147483648..- told");
  EXPECT_EQ(limits("3", "-5", "LowLimit=0xFFFE\nHighLimit=5\n"), "-..5 told");
}

TEST(Eds, KeepsLimitsThatAreBitPatterns) {
  EXPECT_EQ(limits("4", "0", "LowLimit=0x80000000\nHighLimit=0x7FFFFFFF\n"),
            "-2147483648..2147483647");
  EXPECT_EQ(limits("3", "-5", "LowLimit=0x8000\nHighLimit=0xFFFE\n"), "-32768..-2");
  EXPECT_EQ(limits("3", "7", "LowLimit=-1\nHighLimit=5\n"), "-1..5");
  EXPECT_EQ(limits("2", "0xFD", "LowLimit=0xFD\nHighLimit=0xFD\n"), "-3..-3");  // one value
}

TEST(Eds, TakesTheFirstOfARepeatedKeyOrSection) {
  const auto key = read(var("6", "5") + "DefaultValue=6\n");
  const auto section = read(var("6", "5") + var("6", "6"));

  EXPECT_EQ(integer(key, {0x2000, 0}), 5);
  EXPECT_EQ(find(key.findings, "duplicate-key")->pos, (SourcePos{line_of(6), 14}));
  EXPECT_EQ(integer(section, {0x2000, 0}), 5);
  EXPECT_EQ(find(section.findings, "duplicate-section")->pos.line, line_of(6));
}

TEST(Eds, FormulasThatAreNoSumAreAllJudgedAlike) {
  for (const auto* formula : {"$NODEID-1", "2*$NODEID"}) {
    const auto file = read(var("7", formula));
    const auto* finding = find(file.findings, "value-unreadable");
    ASSERT_NE(finding, nullptr) << formula;
    EXPECT_EQ(finding->severity, Severity::warning) << formula;
    EXPECT_EQ(finding->message, "2000:00 DefaultValue: '" + std::string{formula} +
                                    "' is not UNSIGNED32; the value is dropped");
  }
  const auto other = read(var("7", "$NODE-1"));
  EXPECT_EQ(find(other.findings, "value-unreadable")->severity, Severity::error);
}

TEST(Eds, CallsAConfiguredValueThatCannotBeReadAnError) {
  const auto file = read(var("6", "five") + "ParameterValue=six\n");

  EXPECT_EQ(find(file.findings, "value-unreadable")->severity, Severity::warning);
  EXPECT_EQ(std::ranges::count_if(file.findings,
                                  [](const Finding& finding) {
                                    return finding.rule == "value-unreadable" &&
                                           finding.severity == Severity::error &&
                                           finding.pos == SourcePos{line_of(6), 16};
                                  }),
            1);
}

TEST(Eds, KeepsSubObjectsWhateverSubNumberSays) {
  const std::string subs =
      "[2001sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=2\n"
      "[2001Sub02]\nParameterName=two\nDataType=5\nAccessType=rw\nDefaultValue=12\n";
  const auto without_parent = read(subs);
  const auto too_small = read("[2001]\nParameterName=a\nObjectType=8\nSubNumber=1\n" + subs);
  const auto missing = read("[2001]\nParameterName=a\nObjectType=8\n" + subs);
  const auto as_var = read("[2001]\nParameterName=a\nObjectType=7\nDataType=5\n" + subs);

  for (const auto* file : {&without_parent, &too_small, &missing, &as_var}) {
    EXPECT_EQ(integer(*file, {0x2001, 2}), 12);
  }
  EXPECT_TRUE(has(without_parent.findings, "object-section-missing"));
  EXPECT_TRUE(has(too_small.findings, "sub-number-wrong"));
  EXPECT_TRUE(has(missing.findings, "sub-number-missing"));
  EXPECT_TRUE(has(as_var.findings, "sub-objects-of-var"));
  EXPECT_EQ(as_var.dictionary.find(std::uint16_t{0x2001})->type, ObjectType::record);
}

TEST(Eds, TheThreeMandatoryObjectsBelongIntoTheirList) {
  const auto declared = [](const std::string& index) {
    const auto file = read("[ManufacturerObjects]\nSupportedObjects=1\n1=" + index + "\n");
    return find(file.findings, "wrong-list")->message;
  };

  for (const auto* index : {"0x1000", "0x1001", "0x1018"}) {
    EXPECT_TRUE(declared(index).ends_with("belongs in [MandatoryObjects]")) << declared(index);
  }
  EXPECT_TRUE(declared("0x1008").ends_with("belongs in [OptionalObjects]"));
}

TEST(Eds, ListsOnlySayWhereAnObjectBelongs) {
  const auto file = read("[OptionalObjects]\nSupported Objects=3\n1=0x2000\n3=0x2000\n4=0x3000\n" +
                         var("6", "5"));

  EXPECT_EQ(integer(file, {0x2000, 0}), 5);
  EXPECT_TRUE(has(file.findings, "blank-in-key"));
  EXPECT_EQ(find(file.findings, "wrong-list")->pos, (SourcePos{line_of(3), 3}));
  EXPECT_EQ(find(file.findings, "listed-twice")->pos.line, line_of(4));
  EXPECT_EQ(find(file.findings, "listed-without-section")->pos.line, line_of(5));
  EXPECT_TRUE(has(file.findings, "list-numbers-gap"));
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->list, ObjectList::optional);
}

TEST(Eds, NamesComeOutAsUtf8) {
  const auto name = [](std::string_view text) {
    return read("[2000]\nDataType=5\nAccessType=rw\nParameterName=" + std::string{text} + "\n")
        .dictionary.find(std::uint16_t{0x2000})
        ->name;
  };

  EXPECT_EQ(name("\xC3\xA4"), "\xC3\xA4");
  EXPECT_EQ(name("gr\xF6\xDF"
                 "er"),
            "gr\xC3\xB6\xC3\x9F"
            "er");
  EXPECT_EQ(name("\x80"), "\xE2\x82\xAC");
  EXPECT_EQ(name("Main; C1p24 # 1"), "Main; C1p24 # 1");
}

TEST(Eds, ReadsAccessInAnyCaseAndSaysWhatItAssumed) {
  const auto access = [](std::string_view text) {
    return read("[2000]\nParameterName=x\nDataType=5\nAccessType=" + std::string{text} + "\n");
  };
  const auto of = [](const EdsFile& file) {
    return file.dictionary.find(ObjectKey{0x2000, 0})->access;
  };

  EXPECT_EQ(of(access("RO")), Access::ro);
  EXPECT_EQ(of(access("Const")), Access::constant);
  EXPECT_EQ(of(access("rww;")), Access::rww);
  EXPECT_EQ(of(access("")), Access::rw);
  EXPECT_TRUE(has(access("").findings, "access-type-missing"));
  EXPECT_TRUE(has(access("sometimes").findings, "access-type-unknown"));
  EXPECT_EQ(of(access("sometimes")), Access::rw);
  EXPECT_EQ(of(access("R")), Access::ro);
  EXPECT_EQ(of(access("w ; by the configuration tool")), Access::wo);
  EXPECT_TRUE(has(access("R").findings, "access-type-letter"));
  EXPECT_FALSE(has(access("R").findings, "access-type-unknown"));
}

TEST(Eds, OrderOfSectionsDoesNotMatter) {
  const auto forward = read(var("6", "5"));
  const auto backward = read_eds(var("6", "5") + std::string{test::base}, "t.eds", 5_node);

  ASSERT_EQ(forward.dictionary.objects.size(), backward.dictionary.objects.size());
  for (std::size_t i = 0; i < forward.dictionary.objects.size(); ++i) {
    EXPECT_EQ(forward.dictionary.objects[i].index, backward.dictionary.objects[i].index);
  }
}

TEST(Eds, KeepsWhatItSaysForPeopleAndOtherPrograms) {
  const auto file = read_eds(R"([FileInfo]
FileName=lift.dcf
FileVersion=1
FileRevision=2
EDSVersion=4.0
CreationDate=05-12-2026
CreatedBy=Joerg
LastEDS=lift.eds
[Comments]
Lines=2
Line1=for the lift
Line2=; not a comment here
[Tools]
Items=1
[Tool1]
Name=Wizard
Command=wizard.exe $DCF $NODEID
[2000]
ParameterName=Program
ObjectType=0x2
DataType=0xF
AccessType=rw
DownloadFile=app.bin
UploadFile=back.bin
[2000ObjectLinks]
ObjectLinks=2
1=0x2001
2=0x2002
)",
                             "lift.dcf");
  const auto& notes = file.dictionary.notes;
  EXPECT_EQ(notes.info.file_name, "lift.dcf");
  EXPECT_EQ(notes.info.file_version, "1");
  EXPECT_EQ(notes.info.file_revision, "2");
  EXPECT_EQ(notes.info.eds_version, "4.0");
  EXPECT_EQ(notes.info.creation_date, "05-12-2026");
  EXPECT_EQ(notes.info.last_eds, "lift.eds");
  EXPECT_EQ(notes.comments, (std::vector<std::string>{"for the lift", "; not a comment here"}));
  ASSERT_EQ(notes.tools.size(), 1U);
  EXPECT_EQ(notes.tools[0].name, "Wizard");
  EXPECT_EQ(notes.tools[0].command, "wizard.exe $DCF $NODEID");
  ASSERT_EQ(file.dictionary.domain_files.size(), 1U);
  EXPECT_EQ(file.dictionary.domain_files[0].key, (ObjectKey{0x2000, 0}));
  EXPECT_EQ(file.dictionary.domain_files[0].download, "app.bin");
  EXPECT_EQ(file.dictionary.domain_files[0].upload, "back.bin");
  ASSERT_EQ(file.dictionary.links.size(), 1U);
  EXPECT_EQ(file.dictionary.links[0].to, (std::vector<std::uint16_t>{0x2001, 0x2002}));
}

}  // namespace
}  // namespace takt
