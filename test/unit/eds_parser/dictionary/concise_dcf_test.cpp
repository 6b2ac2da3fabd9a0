#include "eds_parser/dictionary/concise_dcf.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

std::vector<std::byte> bytes(std::initializer_list<unsigned> values) {
  std::vector<std::byte> out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

// CiA 302-3: 1017:00 = 500, 1800:01 = 0x80000185, 6060:00 = 8.
const std::vector<std::byte> three =
    bytes({0x03, 0x00, 0x00, 0x00,                                //
           0x17, 0x10, 0x00, 0x02, 0, 0, 0, 0xF4, 0x01,           //
           0x00, 0x18, 0x01, 0x04, 0, 0, 0, 0x85, 1,    0, 0x80,  //
           0x60, 0x60, 0x00, 0x01, 0, 0, 0, 0x08});

TEST(ConciseDcf, IsReadInItsOrder) {
  const auto entries = decode_concise_dcf(three);
  ASSERT_TRUE(entries.has_value());
  ASSERT_EQ(entries->size(), 3u);
  EXPECT_EQ((*entries)[0], (ConciseEntry{{0x1017, 0}, bytes({0xF4, 0x01})}));
  EXPECT_EQ((*entries)[1], (ConciseEntry{{0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x80})}));
  EXPECT_EQ((*entries)[2], (ConciseEntry{{0x6060, 0}, bytes({0x08})}));
  EXPECT_EQ(encode_concise_dcf(*entries), three);
}

TEST(ConciseDcf, EmptyOnesHoldNothing) {
  EXPECT_TRUE(decode_concise_dcf({})->empty());
  EXPECT_TRUE(decode_concise_dcf(bytes({0, 0, 0, 0}))->empty());
}

TEST(ConciseDcf, EveryTruncationIsAnError) {
  for (std::size_t size = 1; size < three.size(); ++size) {
    EXPECT_FALSE(decode_concise_dcf(std::span{three}.first(size)).has_value()) << size;
  }
  EXPECT_EQ(decode_concise_dcf(std::span{three}.first(20)).error(), "ends within entry 2 of 3");
}

TEST(ConciseDcf, CountAndLengthBeyondTheEndAllocateNothing) {
  EXPECT_FALSE(decode_concise_dcf(bytes({0xFF, 0xFF, 0xFF, 0xFF})).has_value());
  EXPECT_FALSE(
      decode_concise_dcf(bytes({1, 0, 0, 0, 0, 0x20, 0, 0xFF, 0xFF, 0xFF, 0xFF, 1})).has_value());
}

}  // namespace
}  // namespace takt
