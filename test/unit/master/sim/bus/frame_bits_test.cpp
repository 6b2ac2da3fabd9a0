#include "master/sim/bus/frame_bits.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt::sim {
namespace {

struct Vector {
  Frame frame;
  unsigned crc;
  unsigned stuff;
  unsigned total;
};

Frame zeros(std::uint32_t id, std::initializer_list<std::uint8_t> first) {
  Frame frame = make_frame(CobId::base(id), first);
  frame.length = 8;
  return frame;
}

// The lengths of frames come from canframelen.c of can-utils.
TEST(FrameBits, MatchesExactLengthsOfTheReference) {
  const Vector vectors[] = {
      {make_frame(CobId::base(0x080), {}), 0x1C05, 4, 48},
      {make_frame(CobId::base(0x080), {0x01}), 0x0601, 4, 56},
      {make_frame(CobId::base(0x000), {0x01, 0x00}), 0x6197, 5, 65},
      {make_frame(CobId::base(0x000), {0x82, 0x00}), 0x506E, 6, 66},
      {make_frame(CobId::base(0x705), {0x05}), 0x68BF, 4, 56},
      {make_frame(CobId::base(0x701), {0x7F}), 0x72DE, 4, 56},
      {zeros(0x181, {}), 0x4D06, 15, 123},
      {zeros(0x181, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}), 0x2C37, 1, 109},
      {zeros(0x201, {0x0F}), 0x54D2, 13, 121},
      {zeros(0x601, {0x40, 0x18, 0x10, 0x01}), 0x1BF4, 12, 120},
      {zeros(0x581, {0x43, 0x18, 0x10, 0x01, 0x5A, 0x01}), 0x3668, 8, 116},
      {make_frame(CobId::base(0x100), {0xFF, 0x5B, 0x26, 0x05, 0x4D, 0x39}), 0x528B, 4, 96},
      {zeros(0x081, {0x30, 0x81, 0x11, 0x05}), 0x2BD5, 10, 118},
  };

  for (const Vector& vector : vectors) {
    const FrameBits bits = frame_bits(vector.frame);
    SCOPED_TRACE(to_string(vector.frame.id));
    EXPECT_EQ(bits.crc, vector.crc);
    EXPECT_EQ(bits.stuff, vector.stuff);
    EXPECT_EQ(bits.total, vector.total);
  }
}

TEST(FrameBits, CountsNoDataOfARemoteFrame) {
  const Frame request{.id = CobId::base(0x705), .length = 1, .rtr = true};

  EXPECT_EQ(frame_bits(request).total, 46);
}

/// Computes the length bit by bit, as described in the standard.
std::uint32_t slow_length(const Frame& frame) {
  std::vector<int> bits{0};
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bits.push_back(static_cast<int>(value >> i & 1));
  };
  put(frame.id.id() >> 18, 11);
  put(3, 2);
  put(frame.id.id() & 0x3FFFF, 18);
  put(0, 3);
  put(frame.length, 4);
  for (std::size_t i = 0; i < frame.length; ++i) put(frame.data[i], 8);
  std::uint32_t crc = 0;
  for (const int bit : bits) {
    const bool next = (static_cast<std::uint32_t>(bit) ^ (crc >> 14 & 1)) != 0;
    crc = (crc << 1) & 0x7FFF;
    if (next) crc ^= 0x4599;
  }
  put(crc, 15);
  std::uint32_t stuffed = 0;
  int run = 0;
  int last = -1;
  for (const int bit : bits) {
    run = bit == last ? run + 1 : 1;
    last = bit;
    if (run == 5) {
      ++stuffed;
      last = 1 - bit;
      run = 1;
    }
  }
  return static_cast<std::uint32_t>(bits.size()) + stuffed + 10;
}

TEST(FrameBits, OfLongIdentifiersAreTheSameBitByBit) {
  std::uint32_t id = 1;
  for (int i = 0; i < 2000; ++i) {
    id = id * 1664525u + 1013904223u;
    Frame frame{.id = CobId::extended(id & 0x1FFF'FFFF)};
    frame.length = static_cast<std::uint8_t>(i % 9);
    for (std::size_t k = 0; k < 8; ++k) {
      frame.data[k] = static_cast<std::uint8_t>(i % 3 == 0 ? 0 : id >> (3 * k));
    }
    ASSERT_EQ(frame_bits(frame).total, slow_length(frame)) << to_string(frame.id);
  }
}

}  // namespace
}  // namespace takt::sim
