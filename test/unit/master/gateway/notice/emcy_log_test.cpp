#include "master/gateway/notice/emcy_log.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

Event emcy(std::uint8_t node, std::uint8_t detail) {
  Event event{.kind = EventKind::emcy, .node = node};
  event.bytes = {0x10, 0x73, 0x21, detail, 2, 3, 4, 5};
  return event;
}

TEST(EmcyLog, KeepsTheNewestOfEachNode) {
  EmcyLog history;
  for (int i = 0; i < 40; ++i) history.take(emcy(5, static_cast<std::uint8_t>(i)), 1000 + i);
  history.take(emcy(6, 77), 2000);
  history.take({.kind = EventKind::heartbeat_lost, .node = 6}, 3000);

  ASSERT_EQ(history.of(5).size(), 32u);
  EXPECT_EQ(history.of(5).front().utime, 1008);
  EXPECT_EQ(history.of(5).back().bytes[3], 39);
  EXPECT_EQ(history.of(6).size(), 1u);
  EXPECT_TRUE(history.of(7).empty());
}

TEST(EmcyLog, TravelsInSixteenBytesARecord) {
  const std::vector<EmcyRecord> records{{0x0102030405060708, {0x30, 0x81, 0x11, 1, 2, 3, 4, 5}}};
  const std::vector<std::uint8_t> bytes{8, 7, 6, 5, 4, 3, 2, 1, 0x30, 0x81, 0x11, 1, 2, 3, 4, 5};
  EXPECT_EQ(pack(records), bytes);
  EXPECT_EQ(unpack_emcys(bytes), records);
  EXPECT_EQ(records[0].code(), 0x8130);
  EXPECT_TRUE(unpack_emcys(std::span{bytes}.first(15)).empty());
}

TEST(EmcyLog, CarriesTheDevicesOwnWordsForCodesThatCame) {
  const std::vector<EmcyRecord> records{{1, {0x00, 0x10, 0x01}}, {2, {0x10, 0x23, 0x01}}};
  const std::vector<EmcyText> texts{{0x1000, "error of the drive"}, {0x5000, "another"}};

  const std::string lines = pack_texts(records, texts);

  EXPECT_EQ(lines, "0x1000 error of the drive\n");
  EXPECT_EQ(unpack_texts(lines),
            (std::map<std::uint16_t, std::string>{{0x1000, "error of the drive"}}));
  EXPECT_TRUE(unpack_texts("\n0x10\nxyz words\n0xZZZZ words\n").empty());
}

}  // namespace
}  // namespace takt
