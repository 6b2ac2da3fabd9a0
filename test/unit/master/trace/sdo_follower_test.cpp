#include "master/trace/sdo_follower.hpp"

#include <gtest/gtest.h>
#include <initializer_list>

namespace takt {
namespace {

using Bytes = std::vector<std::uint8_t>;

Frame sent(std::initializer_list<std::uint8_t> bytes) {
  return make_frame(CobId::base(0x605), bytes);
}
Frame answered(std::initializer_list<std::uint8_t> bytes) {
  return make_frame(CobId::base(0x585), bytes);
}

TEST(SdoFollower, SeesAnExpeditedWriteWhenItIsConfirmed) {
  SdoFollower sdo;

  EXPECT_FALSE(sdo.request(sent({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0x00, 0x00})));
  const auto done = sdo.answer(answered({0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->kind, SeenTransfer::Kind::write);
  EXPECT_EQ(done->object, (ObjectKey{0x1017, 0}));
  EXPECT_EQ(done->value, (Bytes{0xE8, 0x03}));
  EXPECT_FALSE(done->abort_code);
}

TEST(SdoFollower, KeepsTheAbortCodeOfARefusedWrite) {
  SdoFollower sdo;

  sdo.request(sent({0x23, 0x00, 0x1A, 0x01, 0x10, 0x00, 0x41, 0x60}));
  const auto done = sdo.answer(answered({0x80, 0x00, 0x1A, 0x01, 0x00, 0x00, 0x01, 0x06}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->abort_code, 0x0601'0000U);
}

TEST(SdoFollower, PutsSegmentsTogether) {
  SdoFollower sdo;

  sdo.request(sent({0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  sdo.answer(answered({0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0}));
  sdo.request(sent({0x60, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(sdo.answer(answered({0x00, 'T', 'i', 'n', 'y', ' ', 'n', 'o'})));
  sdo.request(sent({0x70, 0, 0, 0, 0, 0, 0, 0}));
  const auto done = sdo.answer(answered({0x1B, 'd', 'e', 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ((std::string{done->value.begin(), done->value.end()}), "Tiny node");
}

TEST(SdoFollower, SeesASegmentedWriteWhenItsLastSegmentIsConfirmed) {
  SdoFollower sdo;

  sdo.request(sent({0x21, 0x00, 0x20, 0x00, 5, 0, 0, 0}));
  sdo.answer(answered({0x60, 0x00, 0x20, 0x00, 0, 0, 0, 0}));
  EXPECT_FALSE(sdo.request(sent({0x05, 1, 2, 3, 4, 5, 0, 0})));
  const auto done = sdo.answer(answered({0x20, 0, 0, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->value, (Bytes{1, 2, 3, 4, 5}));
}

TEST(SdoFollower, SeesABlockDownload) {
  SdoFollower sdo;

  sdo.request(sent({0xC2, 0x00, 0x20, 0x00, 10, 0, 0, 0}));
  sdo.answer(answered({0xA0, 0x00, 0x20, 0x00, 127, 0, 0, 0}));
  sdo.request(sent({0x01, 1, 2, 3, 4, 5, 6, 7}));
  sdo.request(sent({0x82, 8, 9, 10, 0, 0, 0, 0}));
  sdo.answer(answered({0xA2, 2, 127, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(sdo.request(sent({0xD1, 0, 0, 0, 0, 0, 0, 0})));
  const auto done = sdo.answer(answered({0xA1, 0, 0, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->kind, SeenTransfer::Kind::write);
  EXPECT_EQ(done->value, (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST(SdoFollower, SeesABlockUpload) {
  SdoFollower sdo;

  sdo.request(sent({0xA0, 0x08, 0x10, 0x00, 127, 0, 0, 0}));
  sdo.answer(answered({0xC2, 0x08, 0x10, 0x00, 3, 0, 0, 0}));
  sdo.request(sent({0xA3, 0, 0, 0, 0, 0, 0, 0}));
  sdo.answer(answered({0x81, 'a', 'b', 'c', 0, 0, 0, 0}));
  sdo.request(sent({0xA2, 1, 127, 0, 0, 0, 0, 0}));
  sdo.answer(answered({0xD1, 0, 0, 0, 0, 0, 0, 0}));
  const auto done = sdo.request(sent({0xA1, 0, 0, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->kind, SeenTransfer::Kind::read);
  EXPECT_EQ(done->value, (Bytes{'a', 'b', 'c'}));
}

TEST(SdoFollower, TakesASegmentedAnswerToABlockUpload) {
  SdoFollower sdo;

  sdo.request(sent({0xA0, 0x08, 0x10, 0x00, 127, 21, 0, 0}));
  const auto done = sdo.answer(answered({0x4F, 0x08, 0x10, 0x00, 7, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->value, (Bytes{7}));
}

TEST(SdoFollower, CountsFramesWhoseBeginningIsMissing) {
  SdoFollower sdo;

  EXPECT_FALSE(sdo.answer(answered({0x1B, 'd', 'e', 0, 0, 0, 0, 0})));
  EXPECT_FALSE(sdo.answer(answered({0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0})));
  EXPECT_FALSE(sdo.request(sent({0x0D, 1, 0, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(sdo.answer(answered({0x80, 0, 0, 0, 0, 0, 0, 0})));

  EXPECT_EQ(sdo.strays(), 4u);
}

TEST(SdoFollower, AnAnswerOfAnotherObjectEndsNothing) {
  SdoFollower sdo;

  sdo.request(sent({0x40, 0x17, 0x10, 0x00, 0, 0, 0, 0}));

  EXPECT_FALSE(sdo.answer(answered({0x4B, 0x18, 0x10, 0x00, 0xE8, 0x03, 0, 0})));
  EXPECT_TRUE(sdo.answer(answered({0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0})));
}

TEST(SdoFollower, CountsTransfersThatASecondClientCutsOff) {
  SdoFollower sdo;

  sdo.request(sent({0x40, 0x17, 0x10, 0x00, 0, 0, 0, 0}));
  sdo.request(sent({0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));

  EXPECT_EQ(sdo.cut_off(), 1u);
  EXPECT_TRUE(sdo.answer(answered({0x43, 0x18, 0x10, 0x01, 1, 0, 0, 0})));
}

TEST(SdoFollower, ASegmentThatCameTwiceIsKeptOnce) {
  SdoFollower sdo;
  sdo.request(sent({0x20, 0x50, 0x1F, 0x01, 0, 0, 0, 0}));
  sdo.answer(answered({0x60, 0x50, 0x1F, 0x01, 0, 0, 0, 0}));

  sdo.request(sent({0x00, 1, 2, 3, 4, 5, 6, 7}));
  sdo.request(sent({0x00, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_TRUE(sdo.repeats_toggle());
  sdo.request(sent({0x1D, 8, 0, 0, 0, 0, 0, 0}));
  const auto done = sdo.answer(answered({0x20, 0, 0, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->value, (Bytes{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(done->extent, SeenTransfer::Extent::in_parts);
}

TEST(SdoFollower, AnAnswerWithoutItsRequestNamesItsObjectItself) {
  SdoFollower sdo;

  const auto done = sdo.answer(answered({0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->object, (ObjectKey{0x1017, 0}));
  EXPECT_EQ(done->value, (Bytes{0xE8, 0x03}));
  EXPECT_EQ(sdo.strays(), 1U);
}

TEST(SdoFollower, ALongValueIsNotKeptWhole) {
  SdoFollower sdo;
  sdo.request(sent({0x20, 0x50, 0x1F, 0x01, 0, 0, 0, 0}));
  sdo.answer(answered({0x60, 0x50, 0x1F, 0x01, 0, 0, 0, 0}));

  for (int i = 0; i < 10'000; ++i) {
    sdo.request(sent({0x00, 1, 2, 3, 4, 5, 6, 7}));
    sdo.request(sent({0x10, 1, 2, 3, 4, 5, 6, 7}));
  }
  sdo.request(sent({0x01, 1, 2, 3, 4, 5, 6, 7}));
  const auto done = sdo.answer(answered({0x20, 0, 0, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(done);
  EXPECT_EQ(done->extent, SeenTransfer::Extent::too_long);
  EXPECT_LE(done->value.size(), SdoFollower::most_kept);
}

/// Downloads a value of so many segments by block transfer. `lost` of them are not in the
/// recording.
std::optional<SeenTransfer> block_download(int segments, int lost) {
  SdoFollower sdo;
  sdo.request(sent({0xC0, 0x50, 0x1F, 0x01, 0, 0, 0, 0}));
  sdo.answer(answered({0xA0, 0x50, 0x1F, 0x01, 100, 0, 0, 0}));
  for (int i = 1; i <= segments; ++i) {
    const auto number = static_cast<std::uint8_t>((i - 1) % 100 + 1);
    const auto last = static_cast<std::uint8_t>(i == segments ? 0x80 : 0);
    const bool is_lost = i % 100 > 0 && i % 100 <= lost;
    if (!is_lost)
      sdo.request(sent({static_cast<std::uint8_t>(number | last), 1, 2, 3, 4, 5, 6, 7}));
    if (number == 100 || last != 0) sdo.answer(answered({0xA2, number, 100, 0, 0, 0, 0, 0}));
  }
  sdo.request(sent({0xC1, 0, 0, 0, 0, 0, 0, 0}));
  return sdo.answer(answered({0xA1, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(SdoFollower, ReportsABlockThatIsTooLongFromOneWithGaps) {
  const auto whole = block_download(500, 0);
  const auto too_long = block_download(600, 0);  // 4200 bytes
  const auto in_parts = block_download(500, 3);

  ASSERT_TRUE(whole && too_long && in_parts);
  EXPECT_EQ(whole->extent, SeenTransfer::Extent::whole);
  EXPECT_EQ(whole->value.size(), 3500U);
  EXPECT_EQ(too_long->extent, SeenTransfer::Extent::too_long);
  EXPECT_EQ(in_parts->extent, SeenTransfer::Extent::in_parts);
}

}  // namespace
}  // namespace takt
