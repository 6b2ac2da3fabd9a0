#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::has;
using test::read;
using test::var;

std::optional<Value> value_of(std::string_view type, std::string_view text) {
  return read(var(type, text)).dictionary.find(ObjectKey{0x2000, 0})->value();
}

bool exceeds(std::string_view type, std::string_view text) {
  const auto file = read(var(type, text));
  return has(file.findings, "value-exceeds-type") &&
         !file.dictionary.find(ObjectKey{0x2000, 0})->value();
}

struct Integer {
  const char* type;
  const char* lowest;
  const char* below;
  const char* highest;
  const char* pattern;  ///< bit pattern of -1
  const char* above;    ///< the pattern
};

TEST(DataType, SignedIntegersHaveTheirRangeAndTheirBitPattern) {
  for (const auto& type : {
           Integer{"0x0002", "-128", "-129", "127", "0xFF", "0x100"},
           Integer{"0x0003", "-32768", "-32769", "32767", "0xFFFF", "0x10000"},
           Integer{"0x0010", "-8388608", "-8388609", "8388607", "0xFFFFFF", "0x1000000"},
           Integer{"0x0004", "-2147483648", "-2147483649", "2147483647", "0xFFFFFFFF",
                   "0x100000000"},
           Integer{"0x0012", "-549755813888", "-549755813889", "549755813887", "0xFFFFFFFFFF",
                   "0x10000000000"},
           Integer{"0x0013", "-140737488355328", "-140737488355329", "140737488355327",
                   "0xFFFFFFFFFFFF", "0x1000000000000"},
           Integer{"0x0014", "-36028797018963968", "-36028797018963969", "36028797018963967",
                   "0xFFFFFFFFFFFFFF", "0x100000000000000"},
           Integer{"0x0015", "-9223372036854775808", "-9223372036854775809", "9223372036854775807",
                   "0xFFFFFFFFFFFFFFFF", "0x10000000000000000"},
       }) {
    SCOPED_TRACE(type.type);
    EXPECT_EQ(value_of(type.type, type.lowest), Value{std::int64_t{std::stoll(type.lowest)}});
    EXPECT_EQ(value_of(type.type, type.highest), Value{std::int64_t{std::stoll(type.highest)}});
    EXPECT_EQ(value_of(type.type, type.pattern), Value{std::int64_t{-1}});
    EXPECT_TRUE(has(read(var(type.type, type.pattern)).findings, "bit-pattern"));
    EXPECT_TRUE(exceeds(type.type, type.below));
    EXPECT_FALSE(value_of(type.type, type.above));
  }
}

struct Unsigned {
  const char* type;
  const char* highest;
  std::uint64_t value;
  const char* above;
};

TEST(DataType, UnsignedIntegersHaveTheirRange) {
  for (const auto& type : {
           Unsigned{"0x0005", "255", 0xFF, "256"},
           Unsigned{"0x0006", "65535", 0xFFFF, "65536"},
           Unsigned{"0x0016", "16777215", 0xFF'FFFF, "16777216"},
           Unsigned{"0x0007", "0xFFFFFFFF", 0xFFFF'FFFF, "4294967296"},
           Unsigned{"0x0018", "1099511627775", 0xFF'FFFF'FFFF, "0x10000000000"},
           Unsigned{"0x0019", "281474976710655", 0xFFFF'FFFF'FFFF, "0x1000000000000"},
           Unsigned{"0x001A", "72057594037927935", 0xFF'FFFF'FFFF'FFFF, "0x100000000000000"},
           Unsigned{"0x001B", "18446744073709551615", 0xFFFF'FFFF'FFFF'FFFF, "0x10000000000000000"},
       }) {
    SCOPED_TRACE(type.type);
    EXPECT_EQ(value_of(type.type, "0"), Value{std::uint64_t{0}});
    EXPECT_EQ(value_of(type.type, type.highest), Value{type.value});
    EXPECT_EQ(value_of(type.type, "-1"), Value{type.value});
    EXPECT_FALSE(value_of(type.type, type.above));
  }
  EXPECT_TRUE(exceeds("0x0016", "0x1000000"));
  EXPECT_TRUE(exceeds("0x0016", "-8388609"));
  EXPECT_TRUE(exceeds("0x001A", "0x100000000000000"));
}

TEST(DataType, AWordIsAValueOfABooleanAlone) {
  EXPECT_EQ(value_of("0x0001", "true"), Value{std::uint64_t{1}});
  EXPECT_FALSE(value_of("0x0005", "true"));
  EXPECT_TRUE(has(read(var("0x0005", "true")).findings, "value-unreadable"));
}

TEST(DataType, OddWidthsGoOntoTheWireInTheirBytes) {
  using Bytes = std::vector<std::byte>;
  const auto b = [](auto... byte) { return Bytes{std::byte(byte)...}; };

  EXPECT_EQ(to_bytes(*value_of("0x0002", "-128"), DataType::integer8), b(0x80));
  EXPECT_EQ(to_bytes(*value_of("0x0012", "-2"), DataType::integer40),
            b(0xFE, 0xFF, 0xFF, 0xFF, 0xFF));
  EXPECT_EQ(to_bytes(*value_of("0x0013", "-2"), DataType::integer48),
            b(0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF));
  EXPECT_EQ(to_bytes(*value_of("0x0014", "-36028797018963968"), DataType::integer56),
            b(0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80));
  EXPECT_EQ(to_bytes(*value_of("0x0016", "0x010203"), DataType::unsigned24), b(0x03, 0x02, 0x01));
  EXPECT_EQ(to_bytes(*value_of("0x0018", "0x0102030405"), DataType::unsigned40),
            b(0x05, 0x04, 0x03, 0x02, 0x01));
  EXPECT_EQ(to_bytes(*value_of("0x0019", "0x010203040506"), DataType::unsigned48),
            b(0x06, 0x05, 0x04, 0x03, 0x02, 0x01));
  EXPECT_EQ(to_bytes(*value_of("0x001A", "0x01020304050607"), DataType::unsigned56),
            b(0x07, 0x06, 0x05, 0x04, 0x03, 0x02, 0x01));
}

TEST(DataType, TheNodeIdIsAddedWithinTheWidth) {
  EXPECT_EQ(value_of("0x0016", "$NODEID+0xFFFFFA"), Value{std::uint64_t{0xFF'FFFF}});
  EXPECT_TRUE(exceeds("0x0016", "$NODEID+0xFFFFFB"));
  EXPECT_TRUE(exceeds("0x001A", "$NODEID+0xFFFFFFFFFFFFFB"));
}

TEST(DataType, ReservedCodesHaveNone) {
  for (const auto* code : {"0x000E", "0x0017", "0x001C", "0x0020"}) {
    EXPECT_TRUE(has(read(var(code, "1")).findings, "data-type-unknown")) << code;
  }
}

TEST(ObjectTypes, OfDataTypesAreReadAsTheirForm) {
  const auto deftype = read("[2000]\nObjectType=5\n" + var("0x0019", "7").substr(7));
  const auto defstruct = read(
      "[2000]\nParameterName=s\nObjectType=6\nSubNumber=2\n"
      "[2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n"
      "[2000sub1]\nParameterName=e\nDataType=0x0013\nAccessType=rw\nDefaultValue=-2\n");
  const auto null = read("[2000]\nObjectType=0\n" + var("0x0016", "3").substr(7));

  EXPECT_EQ(deftype.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::deftype);
  EXPECT_EQ(test::integer(deftype, {0x2000, 0}), 7);
  EXPECT_EQ(defstruct.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::defstruct);
  EXPECT_EQ(defstruct.dictionary.find(std::uint16_t{0x2000})->subs.size(), 2U);
  EXPECT_EQ(test::integer(defstruct, {0x2000, 1}), -2);
  EXPECT_EQ(null.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::null);
  EXPECT_EQ(test::integer(null, {0x2000, 0}), 3);
  for (const auto* file : {&deftype, &defstruct, &null}) {
    EXPECT_FALSE(has(file->findings, "object-type-unknown"));
    EXPECT_FALSE(has_error(file->findings));
  }
}

TEST(ObjectTypes, WithSubObjectsButNoRecordAreTaken) {
  for (const auto* code : {"0", "5"}) {
    const auto file = read("[2000]\nParameterName=t\nDataType=5\nObjectType=" + std::string{code} +
                           "\n[2000sub1]\nParameterName=e\nDataType=0x0016\nDefaultValue=9\n");

    EXPECT_TRUE(has(file.findings, "sub-objects-of-var")) << code;
    EXPECT_EQ(test::integer(file, {0x2000, 1}), 9) << code;
  }
  const auto empty = read("[2000]\nParameterName=t\nObjectType=6\nSubNumber=0\n");
  EXPECT_TRUE(has(empty.findings, "no-sub-objects"));
}

TEST(ObjectTypes, ADefstructInShortNotationIsExpanded) {
  const auto file = read(
      "[2000]\nParameterName=s\nObjectType=6\nDataType=0x001A\nAccessType=rw\n"
      "DefaultValue=72057594037927935\nCompactSubObj=2\n");

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->subs.size(), 3U);
  EXPECT_EQ(*file.dictionary.find(ObjectKey{0x2000, 2})->value(),
            Value{std::uint64_t{72057594037927935}});
}

TEST(ObjectTypes, AVarInShortNotationIsTakenForAnArrayAndReported) {
  for (const auto* type : {"7", "2", "5"}) {
    const auto file = read("[2000]\nParameterName=s\nObjectType=" + std::string{type} +
                           "\nDataType=6\nAccessType=rw\nCompactSubObj=2\n");

    const auto* reported = test::find(file.findings, "sub-objects-of-var");
    ASSERT_NE(reported, nullptr) << type;
    EXPECT_EQ(reported->pos, (SourcePos{test::line_of(3), 12}));
    EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::array);
    EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->subs.size(), 3U);
  }
}

TEST(DataType, HexadecimalOfARealIsItsBitPatternUnlessThatIsNextToNothing) {
  const auto value = [](std::string_view type, std::string_view text) {
    const auto file = read(var(type, text));
    EXPECT_TRUE(has(file.findings, "real-bit-pattern")) << text;
    return *file.dictionary.find(ObjectKey{0x2000, 0})->value();
  };

  EXPECT_EQ(value("0x0008", "0x00800000"), Value{0x1p-126});
  EXPECT_EQ(value("0x0008", "0x00000000"), Value{0.0});
  EXPECT_EQ(value("0x0008", "0xBF800000"), Value{-1.0});
  EXPECT_EQ(value("0x0008", "0xFFFF"), Value{65535.0});
  EXPECT_EQ(value("0x0011", "0x3FF0000000000000"), Value{1.0});
  EXPECT_EQ(value("0x0011", "0xFFFFFFFF"), Value{4294967295.0});
  EXPECT_EQ(value("0x0008", "0x1"), Value{1.0});
  EXPECT_EQ(value("0x0008", "0x00000001"), Value{0x1p-149}) << "all digits of a pattern";
  EXPECT_EQ(value("0x0011", "0x00000001"), Value{1.0});
  EXPECT_EQ(value("0x0011", "0x0000000000000001"), Value{0x1p-1074});
}

TEST(DataType, ANumberOfMoreThan64BitsFitsNoType) {
  for (const auto* type : {"0x1B", "0x15", "7"}) {
    const auto file = read(var(type, "18446744073709551616"));

    const auto* reported = test::find(file.findings, "value-exceeds-type");
    ASSERT_NE(reported, nullptr) << type;
    EXPECT_EQ(reported->severity, Severity::error);
    EXPECT_FALSE(has(file.findings, "value-unreadable"));
  }
  const auto limit = read(var("0x1B", "1") + "HighLimit=0x1FFFFFFFFFFFFFFFF\n");
  EXPECT_EQ(test::find(limit.findings, "value-exceeds-type")->severity, Severity::warning);
}

TEST(DataType, TheLargestReal32IsOneInAnyRounding) {
  const auto value = [](std::string_view text) {
    const auto file = read(var("0x0008", text));
    EXPECT_EQ(has(file.findings, "value-exceeds-type"),
              !file.dictionary.objects.back().subs[0].value());
    return file.dictionary.find(ObjectKey{0x2000, 0})->value();
  };

  EXPECT_EQ(value("3.40282347E+38"), Value{0x1.fffffep127});
  EXPECT_EQ(value("-3.4028235e38"), Value{-0x1.fffffep127});
  EXPECT_EQ(value("3.4028234663852886e38"), Value{0x1.fffffep127});
  EXPECT_EQ(value("3.4028236e38"), std::nullopt) << "rounds to infinity";
  EXPECT_EQ(value("-1e39"), std::nullopt);
}

TEST(DataType, WhatStandsBehindARealOrARowOfBytesIsReported) {
  const auto finding = [](std::string_view type, std::string_view text) {
    const auto file = read(var(type, text));
    const auto* reported = test::find(file.findings, "inline-comment");
    EXPECT_EQ(reported == nullptr ? 14U : reported->pos.column, 14U);
    return reported != nullptr;
  };

  EXPECT_TRUE(finding("0x0008", "0.5 ; gain"));
  EXPECT_TRUE(finding("0x0011", "0x3FF0000000000000 # one"));
  EXPECT_TRUE(finding("0x000A", "0102 ; bytes"));
  EXPECT_TRUE(finding("0x000C", "5 100 ; days"));
  EXPECT_FALSE(finding("0x0008", "0.5"));
  EXPECT_FALSE(finding("0x0009", "text ; text"));
  EXPECT_TRUE(has(read(var("0x0008", "0.5f")).findings, "number-suffix"));
}

TEST(DataType, MayBeAWordAsObjectTypeMay) {
  const auto file = read(
      "[2000]\nParameterName=r\nObjectType=Record\nSubNumber=1\n"
      "[2000sub0]\nParameterName=n\nObjectType=VAR\nDataType=unsigned8\nAccessType=ro\n"
      "[2001]\nParameterName=x\nDataType=REAL32\nAccessType=rw\nDefaultValue=0.5\n");

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::record);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 0})->type, DataType::unsigned8);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2001, 0})->default_value, Value{0.5});
  EXPECT_EQ(std::ranges::count(file.findings, "type-word", &Finding::rule), 4);
  EXPECT_FALSE(has(file.findings, "number-unreadable"));
  EXPECT_FALSE(has(file.findings, "sub-objects-of-var"));
}

TEST(DataType, AWordBeforeACommentCountsAndBothAreReported) {
  const auto file = read(
      "[2000]\nParameterName=r\nObjectType=RECORD ; foo\nSubNumber=1\n"
      "[2000sub0]\nParameterName=n\nDataType=UNSIGNED8 # foo\nAccessType=ro\n");

  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2000})->type, ObjectType::record);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2000, 0})->type, DataType::unsigned8);
  EXPECT_EQ(std::ranges::count(file.findings, "type-word", &Finding::rule), 2);
  EXPECT_EQ(std::ranges::count(file.findings, "inline-comment", &Finding::rule), 2);
  EXPECT_FALSE(has(file.findings, "number-unreadable"));
}

TEST(DataType, AnObjectTypeIsReportedOnceWhereThereIsNoDataType) {
  const auto count = [](const std::string& type, std::string_view rule) {
    const auto file = read("[2000]\nParameterName=d\nAccessType=rw\nObjectType=" + type + "\n");
    return std::ranges::count(file.findings, rule, &Finding::rule);
  };

  EXPECT_EQ(count("DOMAIN", "type-word"), 1);
  EXPECT_EQ(count("DOMAIN", "data-type-missing"), 0);
  EXPECT_EQ(count("0x2", "data-type-missing"), 0);
  EXPECT_EQ(count("sometimes", "number-unreadable"), 1);
  EXPECT_EQ(count("2 ; foo", "inline-comment"), 1);
  EXPECT_EQ(count("9\n[2000sub0]\nObjectType=VAR", "type-word"), 1) << "of a sub-object too";
}

}  // namespace
}  // namespace takt
