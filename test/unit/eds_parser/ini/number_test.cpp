#include "eds_parser/ini/number.hpp"

#include <gtest/gtest.h>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {
namespace {

/// Returns the value for node 5, as listed in the fact sheet.
std::int64_t at_node_5(std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return -999;
  const auto value = static_cast<std::int64_t>(number->magnitude);
  return (number->negative ? -value : value) + 5 * number->node_ids;
}

TEST(Number, ReadsTheFormsOfCia306) {
  EXPECT_EQ(at_node_5("10"), 10);
  EXPECT_EQ(at_node_5("0xa"), 10);
  EXPECT_EQ(at_node_5("0x0A"), 10);
  EXPECT_EQ(at_node_5("0X000A"), 10);
  EXPECT_EQ(at_node_5("012"), 10);
  EXPECT_EQ(at_node_5("-16"), -16);
  EXPECT_EQ(at_node_5("-0x10"), -16);
  EXPECT_EQ(at_node_5("0"), 0);
  EXPECT_EQ(at_node_5("00"), 0);
}

TEST(Number, AddsTheNodeIdInEveryOrderCaseAndSpacing) {
  EXPECT_EQ(at_node_5("$NODEID+0x180"), 0x185);
  EXPECT_EQ(at_node_5("$NODEID+384"), 0x185);
  EXPECT_EQ(at_node_5("$NODEID + 0x180"), 0x185);
  EXPECT_EQ(at_node_5("$NODEID +0x180"), 0x185);
  EXPECT_EQ(at_node_5("$NodeId+0x80000180"), 0x80000185);
  EXPECT_EQ(at_node_5("$nodeid"), 5);
  EXPECT_EQ(at_node_5("0x180+$NODEID"), 0x185);
  EXPECT_EQ(at_node_5("$NODEID+0x100+0x80"), 0x185);
  EXPECT_EQ(at_node_5("0x100+$NODEID+0x80"), 0x185);
  EXPECT_EQ(at_node_5("$NODEID+0x80000300   ; mk $NODEID+0x300"), 0x80000305);
}

TEST(Number, SaysWhatWasUnusual) {
  EXPECT_TRUE(parse_number("0x180+$NODEID")->has(NumberQuirk::node_id_not_first));
  EXPECT_FALSE(parse_number("$NODEID+0x180")->has(NumberQuirk::node_id_not_first));
  EXPECT_TRUE(parse_number("NODEID+0x80")->has(NumberQuirk::node_id_no_dollar));
  EXPECT_TRUE(parse_number("010")->has(NumberQuirk::octal));
  EXPECT_EQ(at_node_5("08"), 8);
  EXPECT_TRUE(parse_number("08")->has(NumberQuirk::decimal_zero));
  EXPECT_EQ(parse_number("007")->quirks, 0);
  EXPECT_TRUE(parse_number("0x10UL")->has(NumberQuirk::suffix));
  EXPECT_EQ(at_node_5("0x1234567890ABCDEFLL"), 0x1234567890ABCDEF);
  EXPECT_TRUE(parse_number("5.0")->has(NumberQuirk::fraction));
  EXPECT_EQ(at_node_5("1F"), 0x1F);
  EXPECT_TRUE(parse_number("1F")->has(NumberQuirk::hex_without_prefix));
  EXPECT_EQ(at_node_5("0B12"), 0xB12);  // not a binary number
  EXPECT_TRUE(parse_number("250 ; 25ms")->has(NumberQuirk::comment));
}

TEST(Number, RefusesWhatHasNoSingleReading) {
  for (const auto* text : {"-", "+", "abc", "DEAD", "3.14", "0x", "0xG", "1-2", "$NODEID-1", "1e3",
                           "$NODEID+", "+$", "1,5", "0x12 0x34", "0b101", "0B1", "0b101u"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  EXPECT_EQ(parse_number("").error(), NumberFault::empty);
  EXPECT_EQ(parse_number(" ; only a comment").error(), NumberFault::empty);
  EXPECT_EQ(parse_number("$MY_NODE_ID+0x80").error(), NumberFault::unknown_name);
  EXPECT_EQ(parse_number("0x10000000000000000").error(), NumberFault::too_big);
  EXPECT_EQ(parse_number("18446744073709551615+1").error(), NumberFault::too_big);
}

TEST(Number, KnowsTheNodeIdInAFormulaThatItCannotRead) {
  for (const auto* text : {"$NODEID-1", "$NODEID*2", "$NodeId 1", "2*$NODEID", "0x80+$NODEID-1"}) {
    ASSERT_FALSE(parse_number(text)) << text;
    EXPECT_EQ(parse_number(text).error(), NumberFault::not_a_number) << text;
  }
  for (const auto* text : {"$NODEIDS+1", "$NODEID_2", "$NODEID2", "$NODE-1", "$"}) {
    ASSERT_FALSE(parse_number(text)) << text;
    EXPECT_EQ(parse_number(text).error(), NumberFault::unknown_name) << text;
  }
}

TEST(Number, HoldsAll64Bits) {
  EXPECT_EQ(parse_number("18446744073709551615")->magnitude, 18446744073709551615U);
  EXPECT_EQ(parse_number("0xFFFFFFFFFFFFFFFF")->magnitude, 18446744073709551615U);
  EXPECT_EQ(parse_number("-9223372036854775808")->magnitude, 9223372036854775808U);
}

TEST(Number, ReadsReals) {
  EXPECT_EQ(parse_real("0.5"), 0.5);
  EXPECT_EQ(parse_real("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_real("17"), 17.0);
  EXPECT_FALSE(parse_real("1,5"));
  EXPECT_FALSE(parse_real(""));
  EXPECT_FALSE(parse_real("1e999"));
}

TEST(Value, GoesOntoTheWireLittleEndianInItsWidth) {
  using Bytes = std::vector<std::byte>;
  const auto b = [](auto... byte) { return Bytes{std::byte(byte)...}; };
  EXPECT_EQ(to_bytes(std::int64_t{-2}, DataType::integer16), b(0xFE, 0xFF));
  EXPECT_EQ(to_bytes(std::int64_t{-1}, DataType::integer24), b(0xFF, 0xFF, 0xFF));
  EXPECT_EQ(to_bytes(std::uint64_t{0x12345678}, DataType::unsigned32), b(0x78, 0x56, 0x34, 0x12));
  EXPECT_EQ(to_bytes(std::uint64_t{1}, DataType::boolean), b(1));
  EXPECT_EQ(to_bytes(1.0, DataType::real32), b(0x00, 0x00, 0x80, 0x3F));
  EXPECT_EQ(to_bytes(std::string{"ab"}, DataType::visible_string), b('a', 'b'));
  EXPECT_EQ(to_bytes(std::string{"\xC3\xA4"}, DataType::unicode_string), b(0xE4, 0x00));
}

}  // namespace
}  // namespace takt
