#include "apps/takt/learn/sdo_value_text.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt::learn {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(SdoValueText, WritesNumbersWithTheSignOfTheirType) {
  EXPECT_EQ(sdo_value_text(Bytes{0xFF, 0xFF}, DataType::integer16), "-1");
  EXPECT_EQ(sdo_value_text(Bytes{0xFF, 0xFF}, DataType::unsigned16), "65535");
  EXPECT_EQ(sdo_value_text(Bytes{0x00, 0x00, 0x80}, DataType::integer24), "-8388608");
  EXPECT_EQ(sdo_value_text(Bytes{0x05, 0, 0, 0}, DataType::unsigned8), "5");
}

TEST(SdoValueText, WritesRealsSoThatTheyStayReals) {
  EXPECT_EQ(sdo_value_text(Bytes{0x00, 0x00, 0x40, 0x40}, DataType::real32), "3.0");
  EXPECT_EQ(sdo_value_text(Bytes{0x00, 0x00, 0xC0, 0x7F}, DataType::real32), std::nullopt);
}

TEST(SdoValueText, QuotesText) {
  EXPECT_EQ(sdo_value_text(Bytes{'a', '"', '\\'}, DataType::visible_string), R"("a\"\\")");
  EXPECT_EQ(sdo_value_text(Bytes{'1', '2'}, DataType::visible_string), R"("12")");
  EXPECT_EQ(sdo_value_text(Bytes{'a', 0}, DataType::visible_string), R"("a\x00")");
  EXPECT_EQ(sdo_value_text(Bytes{0, 0x7F}, DataType::domain), R"("\x00\x7F")");
}

TEST(SdoValueText, CutsNothingButFillersOfAValueThatIsLongerThanItsType) {
  EXPECT_EQ(sdo_value_text(Bytes{0xFE, 0xFF, 0xFF, 0xFF}, DataType::integer8), "-2");
  EXPECT_EQ(sdo_value_text(Bytes{0xFE, 0, 0, 0}, DataType::integer8), "-2");
  EXPECT_EQ(sdo_value_text(Bytes{5, 1, 0, 0}, DataType::unsigned8), std::nullopt);
  EXPECT_EQ(sdo_value_text(Bytes{5, 0xFF, 0xFF, 0xFF}, DataType::integer8), std::nullopt);
  EXPECT_EQ(sdo_value_text(Bytes{0, 0, 0x40, 0x40, 1}, DataType::real32), std::nullopt);
  EXPECT_EQ(sdo_value_text(Bytes{2}, DataType::boolean), std::nullopt);
  EXPECT_TRUE(is_longer_than(Bytes{5, 1}, DataType::unsigned8));
  EXPECT_FALSE(is_longer_than(Bytes{'a', 'b'}, DataType::visible_string));
}

TEST(SdoValueText, SaysWhatANetworkFileCannotHold) {
  EXPECT_EQ(sdo_value_text(Bytes{0x00, 0xFF}, DataType::octet_string), std::nullopt);
  EXPECT_EQ(sdo_value_text(Bytes{}, DataType::unsigned8), std::nullopt);
  EXPECT_EQ(sdo_value_text(Bytes(8, 0xFF), DataType::unsigned64), std::nullopt);
}

}  // namespace
}  // namespace takt::learn
