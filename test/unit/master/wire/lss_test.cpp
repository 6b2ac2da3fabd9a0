#include "master/wire/lss.hpp"

#include <array>
#include <cstdint>
#include <gtest/gtest.h>

namespace takt {
namespace {

using Bytes = std::array<std::uint8_t, 8>;

TEST(Lss, SelectsAndIdentifiesANumberWithTheBytesOfCia305) {
  const Frame select = lss::request(lss::Service::select, 0x12345678, 3);
  EXPECT_EQ(select.id, CobId::base(0x7E5));
  EXPECT_EQ(select.length, 8);
  EXPECT_EQ(select.data, (Bytes{0x43, 0x78, 0x56, 0x34, 0x12, 0x00, 0x00, 0x00}));
  EXPECT_EQ(lss::request(lss::Service::identify, 0xA1B2C3D4, 5).data,
            (Bytes{0x4B, 0xD4, 0xC3, 0xB2, 0xA1, 0x00, 0x00, 0x00}));
}

TEST(Lss, AsksAQuestionOfTheFastscanWithTheBytesOfCia305) {
  const lss::FastScan scan{.number = 0x12345678, .bit_check = 31, .part = 2, .next = 3};
  EXPECT_EQ(lss::request(scan).data, (Bytes{0x51, 0x78, 0x56, 0x34, 0x12, 0x1F, 0x02, 0x03}));
}

}  // namespace
}  // namespace takt
