#include "master/gateway/message/value_text.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using Bytes = std::vector<std::byte>;

std::string error_of(DataType type, const std::string& text) {
  const auto bytes = value_bytes(type, text);
  return bytes ? "" : bytes.error();
}

TEST(ValueBytes, RefusesANumberThatItsTypeDoesNotHold) {
  EXPECT_EQ(error_of(DataType::integer8, "128"), "128 does not fit INTEGER8");
  EXPECT_EQ(error_of(DataType::unsigned16, "65536"), "65536 does not fit UNSIGNED16");
  EXPECT_EQ(error_of(DataType::unsigned32, "0x100000000"), "0x100000000 does not fit UNSIGNED32");
  EXPECT_EQ(error_of(DataType::real32, "1e39"), "1e39 does not fit REAL32");
  EXPECT_EQ(error_of(DataType::real32, "-3.5e38"), "-3.5e38 does not fit REAL32");
}

TEST(ValueBytes, TakesInfinityWhereItIsMeant) {
  EXPECT_EQ(value_bytes(DataType::real32, "inf"),
            (Bytes{std::byte{0}, std::byte{0}, std::byte{0x80}, std::byte{0x7F}}));
  EXPECT_EQ(error_of(DataType::real64, "1e39"), "");
}

}  // namespace
}  // namespace takt
