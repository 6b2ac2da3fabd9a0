#include "master/trace/candump_line.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(CandumpLine, ReadsALogLine) {
  const auto line = parse_candump("(1436509052.249713) vcan0 185#3706AA");

  ASSERT_TRUE(line);
  EXPECT_EQ(line->stamp, "1436509052.249713");
  EXPECT_EQ(line->interface, "vcan0");
  EXPECT_EQ(line->frame, make_frame(CobId::base(0x185), {0x37, 0x06, 0xAA}));
}

TEST(CandumpLine, ReadsWhatTheTerminalShows) {
  const auto line = parse_candump("  can0  705   [1]  7F\n");
  const auto stamped =
      parse_candump(" (009.123456)  can0  585   [8]  43 00 10 00 92 01 02 00   'C...'");

  ASSERT_TRUE(line && stamped);
  EXPECT_EQ(line->frame, make_frame(CobId::base(0x705), {0x7F}));
  EXPECT_EQ(line->stamp, "");
  EXPECT_EQ(stamped->stamp, "009.123456");
  EXPECT_EQ(stamped->frame.data[6], 0x02);
}

TEST(CandumpLine, ReadsDatesDirectionsAndColours) {
  const auto date = parse_candump(" (2026-01-31 23:59:58.000250)  can0  705   [1]  7F");
  const auto direction = parse_candump(" (1.5)  can0  RX - -  185   [2]  37 06");
  const auto sent = parse_candump(" (1.5)  can0  TX B E  705   [0]  remote request");
  const auto colour =
      parse_candump(" \x1b[32m(1.5)\x1b[0m  \x1b[31mcan0\x1b[0m  705   [1]  7F\x1b[0m");

  ASSERT_TRUE(date && direction && sent && colour);
  EXPECT_EQ(date->stamp, "2026-01-31 23:59:58.000250");
  EXPECT_EQ(date->frame, make_frame(CobId::base(0x705), {0x7F}));
  EXPECT_EQ(direction->interface, "can0");
  EXPECT_EQ(direction->frame, make_frame(CobId::base(0x185), {0x37, 0x06}));
  EXPECT_TRUE(sent->frame.rtr);
  EXPECT_EQ(colour->stamp, "1.5");
  EXPECT_EQ(colour->interface, "can0");
  EXPECT_EQ(colour->frame, make_frame(CobId::base(0x705), {0x7F}));
}

TEST(CandumpLine, ReadsRemoteAndExtendedFrames) {
  const auto remote = parse_candump("(1.0) can0 705#R1");
  const auto extended = parse_candump("(1.0) can0 00012345#");

  ASSERT_TRUE(remote && extended);
  EXPECT_TRUE(remote->frame.rtr);
  EXPECT_EQ(remote->frame.length, 1);
  EXPECT_EQ(extended->frame.id, CobId::extended(0x12345));
  EXPECT_EQ(extended->frame.length, 0);
}

TEST(CandumpLine, KnowsAnErrorFrame) {
  const auto line = parse_candump("(1.0) can0 20000004#0020000000008003");

  ASSERT_TRUE(line);
  EXPECT_TRUE(line->error_frame);
}

TEST(CandumpLine, RefusesWhatIsNoFrame) {
  for (const char* text : {"",
                           "hello",
                           "(1.0) can0",
                           "(1.0) can0 185#1",
                           "(1.0) can0 185#ZZ",
                           "can0 185##0112233",
                           "can0 185#112233445566778899",
                           "can0 1855#11",
                           "can0 185 [9] 11",
                           "can0 185 [2] 11",
                           "can0 185 [2] 11 2",
                           "can0 185#R9",
                           "(2023-01-02",
                           "(1 2 can0 705#7F",
                           "can0 RX - -",
                           "(1.0) can0 185#.",
                           "can0 #",
                           "can0 185 [x]",
                           "(1.0 can0 185#11",
                           "\x1b",
                           "\x1b[32"}) {
    EXPECT_FALSE(parse_candump(text)) << text;
  }
}

TEST(CandumpLine, WritesWhatItHasRead) {
  EXPECT_EQ(to_string(*parse_candump("(1.5) can0 185#3706")), "(1.5)  can0  185   [2]  37 06");
  EXPECT_EQ(to_string(*parse_candump("can0 00012345#R")), "can0  00012345   [0]  remote request");
}

}  // namespace
}  // namespace takt
