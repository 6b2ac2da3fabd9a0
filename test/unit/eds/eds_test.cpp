#include "eds_parser/eds.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds/eds_text.hpp"

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
  EXPECT_EQ(value("0x000C", "3600000 2"), Value{std::uint64_t{2} << 32 | 3600000U});
  EXPECT_EQ(value("0x001B", "18446744073709551615"), Value{18446744073709551615U});
}

TEST(Eds, DropsLimitsThatAreInverted) {
  const auto file = read(var("2", "1") + "LowLimit=0x00\nHighLimit=0xFF\n");

  const auto* sub = file.dictionary.find(ObjectKey{0x2000, 0});
  EXPECT_FALSE(sub->low_limit);
  EXPECT_FALSE(sub->high_limit);
  EXPECT_TRUE(has(file.findings, "limits-inverted"));
  EXPECT_FALSE(has_error(file.findings));
}

TEST(Eds, TakesTheFirstOfARepeatedKeyOrSection) {
  const auto key = read(var("6", "5") + "DefaultValue=6\n");
  const auto section = read(var("6", "5") + var("6", "6"));

  EXPECT_EQ(integer(key, {0x2000, 0}), 5);
  EXPECT_EQ(find(key.findings, "duplicate-key")->pos, (SourcePos{line_of(6), 14}));
  EXPECT_EQ(integer(section, {0x2000, 0}), 5);
  EXPECT_EQ(find(section.findings, "duplicate-section")->pos.line, line_of(6));
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
}

TEST(Eds, OrderOfSectionsDoesNotMatter) {
  const auto forward = read(var("6", "5"));
  const auto backward = read_eds(var("6", "5") + std::string{test::base}, "t.eds", 5_node);

  ASSERT_EQ(forward.dictionary.objects.size(), backward.dictionary.objects.size());
  for (std::size_t i = 0; i < forward.dictionary.objects.size(); ++i) {
    EXPECT_EQ(forward.dictionary.objects[i].index, backward.dictionary.objects[i].index);
  }
}

}  // namespace
}  // namespace takt
