#include "master/wire/sdo_block_codec.hpp"

#include <array>
#include <gtest/gtest.h>
#include <numeric>
#include <string_view>

#include "master/wire/sdo_crc.hpp"

namespace takt {
namespace {

constexpr CobId request = CobId::base(0x605);
constexpr CobId answer = CobId::base(0x585);

std::uint16_t crc_of(std::string_view text) { return sdo_crc(std::as_bytes(std::span{text})); }

std::array<std::uint8_t, 256> counting(std::uint8_t first) {
  std::array<std::uint8_t, 256> bytes{};
  std::iota(bytes.begin(), bytes.end(), first);
  return bytes;
}

TEST(SdoCrc, IsTheOneOfTheKnownVectors) {
  EXPECT_EQ(crc_of(""), 0x0000);
  EXPECT_EQ(crc_of(std::string_view{"\0", 1}), 0x0000);
  EXPECT_EQ(crc_of("\xFF"), 0x1EF0);
  EXPECT_EQ(crc_of("123456789"), 0x31C3);
  EXPECT_EQ(crc_of("Hello CANopen block transfer!"), 0xBAC3);
  const auto from0 = counting(0);
  const auto from1 = counting(1);
  EXPECT_EQ(sdo_crc(std::span{from1}.first(7)), 0x26B3);
  EXPECT_EQ(sdo_crc(std::span{from0}.first(20)), 0xACCC);
  EXPECT_EQ(sdo_crc(std::span{from0}), 0x7E55);
}

TEST(SdoCrc, ContinuesWhereItStopped) {
  const auto bytes = counting(0);
  const std::span all{bytes};
  EXPECT_EQ(sdo_crc(all.subspan(100), sdo_crc(all.first(100))), 0x7E55);
}

TEST(SdoBlockCodec, WritesTheFramesOfADownload) {
  EXPECT_EQ(block_initiate(request, {.object = {0x1F50, 1}, .crc = true, .size = 29}),
            make_frame(request, {0xC6, 0x50, 0x1F, 0x01, 0x1D, 0, 0, 0}));
  EXPECT_EQ(block_accept(answer, {.object = {0x1F50, 1}, .crc = true, .segments = 127}),
            make_frame(answer, {0xA4, 0x50, 0x1F, 0x01, 0x7F, 0, 0, 0}));
  const std::string_view text = "Hello CANopen block transfer!";
  const auto bytes = std::as_bytes(std::span{text});
  EXPECT_EQ(block_segment(request, 1, bytes),
            make_frame(request, {0x01, 0x48, 0x65, 0x6C, 0x6C, 0x6F, 0x20, 0x43}));
  EXPECT_EQ(block_segment(request, 5, bytes.subspan(28)),
            make_frame(request, {0x85, 0x21, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(block_confirm(answer, {.received = 5, .segments = 127}),
            make_frame(answer, {0xA2, 0x05, 0x7F, 0, 0, 0, 0, 0}));
  EXPECT_EQ(block_end(request, {.unused = 6, .crc = 0xBAC3}),
            make_frame(request, {0xD9, 0xC3, 0xBA, 0, 0, 0, 0, 0}));
  EXPECT_EQ(block_end_confirm(answer), make_frame(answer, {0xA1, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(SdoBlockCodec, WritesTheFramesOfAnUpload) {
  EXPECT_EQ(block_accept(request, {.object = {0x1021, 0}, .crc = true, .segments = 4}),
            make_frame(request, {0xA4, 0x21, 0x10, 0x00, 0x04, 0, 0, 0}));
  EXPECT_EQ(block_accept(request, {.object = {0x1021, 0}, .segments = 4, .threshold = 28}),
            make_frame(request, {0xA0, 0x21, 0x10, 0x00, 0x04, 0x1C, 0, 0}));
  EXPECT_EQ(block_upload_start(request), make_frame(request, {0xA3, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(block_initiate(answer, {.object = {0x1021, 0}}),
            make_frame(answer, {0xC0, 0x21, 0x10, 0x00, 0, 0, 0, 0}));
}

TEST(SdoBlockCodec, ReadsWhatItIs) {
  const Frame begin = make_frame(answer, {0xC6, 0x21, 0x10, 0x00, 0x1D, 0, 0, 0});
  ASSERT_TRUE(is_block_initiate(begin));
  EXPECT_FALSE(is_block_end(begin));
  EXPECT_EQ(decode_block_initiate(begin).size, 29U);
  EXPECT_TRUE(decode_block_initiate(begin).crc);

  const Frame end = make_frame(answer, {0xD9, 0xC3, 0xBA, 0, 0, 0, 0, 0});
  ASSERT_TRUE(is_block_end(end));
  EXPECT_EQ(decode_block_end(end).unused, 6);
  EXPECT_EQ(decode_block_end(end).crc, 0xBAC3);

  const Frame last = make_frame(answer, {0x85, 0x21, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(decode_block_segment(last).number, 5);
  EXPECT_TRUE(decode_block_segment(last).last);

  EXPECT_TRUE(is_block_confirm(make_frame(answer, {0xA2, 5, 127})));
  EXPECT_TRUE(is_block_end_confirm(make_frame(answer, {0xA1})));
  EXPECT_TRUE(is_block_upload_start(make_frame(request, {0xA3})));
  EXPECT_TRUE(is_block_accept(make_frame(answer, {0xA4})));
}

}  // namespace
}  // namespace takt
