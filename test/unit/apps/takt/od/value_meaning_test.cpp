#include "apps/takt/od/value_meaning.hpp"

#include <array>
#include <gtest/gtest.h>

namespace takt {
namespace {

KnownDevice drive() { return device_of_eds(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", {}); }

template <std::size_t N>
std::array<std::byte, N> bytes(std::uint64_t value) {
  std::array<std::byte, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
  return out;
}

std::string meaning_of(std::uint16_t index, std::uint8_t sub, DataType type, std::uint64_t value) {
  const auto all = bytes<8>(value);
  return value_meaning(drive(), {index, sub}, type, std::span{all}.first(byte_width(type)));
}

TEST(ValueMeaning, OfDrives) {
  using enum DataType;
  EXPECT_EQ(meaning_of(0x6041, 0, unsigned16, 0x0637), "operation enabled, target reached");
  EXPECT_EQ(meaning_of(0x6041, 0, unsigned16, 0x0250), "switch on disabled");
  EXPECT_EQ(meaning_of(0x6041, 0, unsigned16, 0x0298), "fault, warning");
  EXPECT_EQ(meaning_of(0x6040, 0, unsigned16, 0x000F), "enable operation");
  EXPECT_EQ(meaning_of(0x6040, 0, unsigned16, 0x0107), "switch on, halt");
  EXPECT_EQ(meaning_of(0x6040, 0, unsigned16, 0x0002), "quick stop");
  EXPECT_EQ(meaning_of(0x6040, 0, unsigned16, 0x0006), "shutdown");
  EXPECT_EQ(meaning_of(0x6040, 0, unsigned16, 0x0080), "fault reset");
  EXPECT_EQ(meaning_of(0x6061, 0, integer8, 8), "cyclic synchronous position");
  EXPECT_EQ(meaning_of(0x6861, 0, integer8, 1), "profile position");
  EXPECT_EQ(meaning_of(0x6061, 0, integer8, 0xFD), "");
  EXPECT_EQ(meaning_of(0x6502, 0, unsigned32, 0x1A5), "pp pv hm csp csv");
  EXPECT_EQ(meaning_of(0x605A, 0, integer16, 2), "quick stop ramp, then disabled");
  EXPECT_EQ(meaning_of(0x603F, 0, unsigned16, 0), "no error");
}

TEST(ValueMeaning, OfCommunication) {
  using enum DataType;
  EXPECT_EQ(meaning_of(0x1000, 0, unsigned32, 0x00020192), "CiA 402");
  EXPECT_EQ(meaning_of(0x1016, 1, unsigned32, 0x007F012C), "node 127, 300 ms");
  EXPECT_EQ(meaning_of(0x1017, 0, unsigned16, 0), "off");
  EXPECT_EQ(meaning_of(0x1017, 0, unsigned16, 100), "100 ms");
  EXPECT_EQ(meaning_of(0x1800, 1, unsigned32, 0x8000'0185), "0x185, off");
  EXPECT_EQ(meaning_of(0x1A00, 1, unsigned32, 0x60410010), "6041:00, 16 bits");
  EXPECT_EQ(meaning_of(0x1A00, 0, unsigned8, 2), "");
}

TEST(ValueMeaning, IndicesOfTheProfileMeanNothingWithoutADrive) {
  const KnownDevice io = device_of_eds(TAKT_SOURCE_DIR "/share/eds/takt_io401.eds", {});
  const auto word = bytes<2>(0x0637);

  EXPECT_EQ(value_meaning(io, {0x6041, 0}, DataType::unsigned16, word), "");
}

TEST(ValueMeaning, ValuesHaveTheUnitOfTheirQuantity) {
  const KnownDevice elbow = device_of_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml", "elbow");
  const auto turn = bytes<4>(10'000);
  const auto speed = bytes<4>(5'000);

  EXPECT_EQ(value_meaning(elbow, {0x6064, 0}, DataType::integer32, turn), "6.28319 rad");
  EXPECT_EQ(value_meaning(elbow, {0x6081, 0}, DataType::unsigned32, speed), "3.14159 rad/s");
  EXPECT_EQ(value_meaning(elbow, {0x6864, 0}, DataType::integer32, turn), "")
      << "the second axis has no unit";
}

TEST(ShownValue, WordsAndIdentitiesAreHexadecimal) {
  const auto word = bytes<2>(0x0637);
  const auto number = bytes<4>(0xFFFF'FFFE);

  EXPECT_EQ(shown_value({0x6041, 0}, DataType::unsigned16, word), "0x0637");
  EXPECT_EQ(shown_value({0x1018, 1}, DataType::unsigned32, number), "0xFFFFFFFE");
  EXPECT_EQ(shown_value({0x607A, 0}, DataType::integer32, number), "-2");
  EXPECT_EQ(shown_value({0x607A, 0}, DataType::integer32, word), "1591  0x0637")
      << "a value of another size is shown as it came";
}

}  // namespace
}  // namespace takt
