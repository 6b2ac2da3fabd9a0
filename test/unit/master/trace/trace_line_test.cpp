#include "master/trace/trace_line.hpp"

#include <gtest/gtest.h>

#include "master/trace/recorded_lines.hpp"

namespace takt {
namespace {

const Frame boot_up = make_frame(CobId::base(0x701), {0x00});
const Frame device_type =
    make_frame(CobId::base(0x581), {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00});

TEST(TraceLine, ReadsEveryVersionOfAPcanTrace) {
  for (const char* text :
       {"     2)     46268 0581 8 43 00 10 00 92 01 02 00",                   // 1.0
        "     2)     46268.0  Rx         0581  8  43 00 10 00 92 01 02 00 ",  // 1.1
        "     2)     46268.000 1  Tx         0581  8  43 00 10 00 92 01 02 00",
        "     2)     46268.000 1  Rx         0581 -  8    43 00 10 00 92 01 02 00",
        "      2     46268.000 DT     0581 Rx 8  43 00 10 00 92 01 02 00 ",            // 2.0
        "      2     46268.000 DT 1      0581 Rx -  8    43 00 10 00 92 01 02 00"}) {  // 2.1
    const auto line = parse_recorded(text);

    ASSERT_TRUE(line) << text;
    EXPECT_EQ(line->frame, device_type) << text;
    EXPECT_EQ(line->stamp, "46.268000") << text;
  }
}

TEST(TraceLine, ReadsRemoteAndExtendedFramesOfAPcanTrace) {
  const auto guard = parse_recorded("   3)   1059.9  Rx         0705  1  RTR");
  const auto newer = parse_recorded("   3   1059.900 RR     0705 Rx 1");
  const auto extended = parse_recorded("   3)   1059.9  Rx     00012345  1  7F");

  ASSERT_TRUE(guard && newer && extended);
  EXPECT_TRUE(guard->frame.rtr);
  EXPECT_EQ(guard->frame.length, 1);
  EXPECT_EQ(newer->frame, guard->frame);
  EXPECT_EQ(extended->frame, make_frame(CobId::extended(0x12345), {0x7F}));
  EXPECT_EQ(extended->stamp, "1.059900");
}

TEST(TraceLine, ReadsAVectorLog) {
  const auto line = parse_recorded("   1.001000 2  701             Rx   d 1 00  Length = 112000");
  const auto remote = parse_recorded("   1.002000 1  705             Tx   r");
  const auto extended = parse_recorded("   1.003000 1  12345x          Rx   d 1 7F");

  ASSERT_TRUE(line && remote && extended);
  EXPECT_EQ(line->frame, boot_up);
  EXPECT_EQ(line->stamp, "1.001000");
  EXPECT_EQ(line->interface, "can2");
  EXPECT_TRUE(remote->frame.rtr);
  EXPECT_EQ(extended->frame.id, CobId::extended(0x12345));
}

TEST(TraceLine, ReadsADecimalVectorLog) {
  const auto line = parse_recorded("   1.001000 1  1409  Rx  d 8 67 0 16 00 146 1 2 0", 10);
  const auto hex = parse_recorded("   1.001000 1  1409  Rx  d 1 00");

  ASSERT_TRUE(line);
  EXPECT_EQ(line->frame, device_type);
  EXPECT_FALSE(hex);
  EXPECT_FALSE(parse_recorded("1.0 1 701 Rx d 1 256", 10));
  EXPECT_FALSE(vector_head("base"));
  EXPECT_FALSE(vector_head("base oct"));
  EXPECT_FALSE(vector_head("1.0 1 701 Rx d 1 00"));
}

TEST(TraceLine, KnowsAnErrorFrame) {
  for (const char* text :
       {"3) 1061 0008 4 ERROR 00 19 08 08", "3) 1061.0 Error 0008 4 00 19 08 08",
        "3) 1061.0 1 Error 0008 - 4 00 19 08 08", "5 1061.000 ER          Rx 5  04 00 02 00 00",
        "5 1061.000 ER     -    Rx 5  04 00 02 00 00",
        "5 1061.000 ER 1         - Rx -  5    04 00 02 00 00", "1.061000 1  ErrorFrame",
        "1.061000 1  ErrorFrame Flags = 0xe CodeExt = 0x20a2 ID = 0 DLC = 0"}) {
    const auto line = parse_recorded(text);

    ASSERT_TRUE(line) << text;
    EXPECT_TRUE(line->error_frame) << text;
    EXPECT_EQ(line->stamp, "1.061000") << text;
    EXPECT_EQ(line->frame.length, 0) << text;
  }
}

TEST(TraceLine, OnlyAChannelNamesAnInterface) {
  for (const char* text :
       {"1 1061.0 ER - Rx 5 04 00 02 00 00", "1 1061.0 ER Rx 5 04 00 02 00 00",
        "1 1061.0 ER 0008 Rx 5 04 00 02 00 00", "3) 1061.0 Rx Error 0008 - 4 00 19 08 08",
        "3) 1061 0008 4 ERROR 00 19 08 08", "2 1061.0 DT - 0581 Rx 1 00"}) {
    const auto line = parse_recorded(text);

    ASSERT_TRUE(line) << text;
    EXPECT_EQ(line->interface, "can0") << text;
  }
  EXPECT_EQ(parse_recorded("5 1061.0 ER 2 - Rx - 5 04 00 02 00 00")->interface, "can2");
  EXPECT_EQ(parse_recorded("3) 1061.0 2 Error 0008 - 4 00 19 08 08")->interface, "can2");
}

TEST(RecordedLines, TakeTheNumbersOfAVectorLogAsItsHeadSays) {
  RecordedLines lines;
  EXPECT_EQ(lines.parse("1.0 1  701  Rx  d 1 00")->frame, boot_up);
  EXPECT_FALSE(lines.parse("base dec  timestamps absolute"));
  EXPECT_EQ(lines.parse("2.5 1  1793  Rx  d 1 00")->frame, boot_up);
  EXPECT_EQ(lines.parse("2.5 1  1793  Rx  d 1 00")->stamp, "2.5");
}

// The time of every line counts, even if the line is not a frame.
TEST(RecordedLines, AddUpTheRelativeTimesOfAVectorLog) {
  RecordedLines lines;
  lines.parse("base hex  timestamps relative");
  lines.parse("   0.000000 Start of measurement");

  EXPECT_EQ(lines.parse("   1.500000 1  701  Rx  d 1 00")->stamp, "1.500000");
  EXPECT_FALSE(lines.parse("   0.25 1  Statistic: D 3 R 0 XD 0 XR 0 E 0 O 0 B 0.02%"));
  EXPECT_EQ(lines.parse("   0.250001 1  ErrorFrame")->stamp, "2.000001");
  EXPECT_FALSE(lines.parse("End TriggerBlock"));
  EXPECT_EQ(lines.parse("   0.000009 1  701  Rx  d 1 00")->stamp, "2.000010");
}

TEST(TraceLine, ReadsWhatPythonCanPrints) {
  const auto line = parse_recorded(
      "Timestamp:     1572363931.183001    ID: 0701    S Rx                DL:  1    00    "
      "Channel: vcan0");
  const auto older =
      parse_recorded("Timestamp:        0.000000        ID: 0701    S    DLC:  1  00");

  ASSERT_TRUE(line && older);
  EXPECT_EQ(line->frame, boot_up);
  EXPECT_EQ(line->stamp, "1572363931.183001");
  EXPECT_EQ(line->interface, "vcan0");
  EXPECT_EQ(older->frame, boot_up);
}

TEST(TraceLine, ReadsCandumpToo) {
  const auto line = parse_recorded("(1.0) can0 701#00");

  ASSERT_TRUE(line);
  EXPECT_EQ(line->frame, boot_up);
}

TEST(TraceLine, RefusesWhatIsNoFrame) {
  for (const char* text : {"hello",
                           "2) 46268.0 Rx",
                           "2) 46268.0 Rx 0581",
                           "2) 46268.0 Rx 0581 8 43 00",
                           "2) 46268.0 Rx 0581 9 43 00 10 00 92 01 02 00 00",
                           "2) 46268.0 Rx 0881 1 00",
                           "2) 46268.0 Rx 581 1 00",
                           "2 46268.0 FD 0581 Rx 1 00",
                           "2 46268.0 ST Rx 00 00 00 00",
                           "2) 46268.0  Warng FFFFFFFF 4 00 00 00 08 BUSHEAVY",
                           "1.0 1 701 Rx d 1",
                           "1.0 1 801 Rx d 1 00",
                           "1.0 CANFD 1 Rx 701 1 0 1 1 00",
                           "1.0 ErrorFrame",
                           "Timestamp: 1.0 ID: 0701 S Rx",
                           "Timestamp: 1.0 ID: 0701 S F Rx DL: 1 00",
                           "Timestamp: 1.0 ID: 0701 S Rx DL: 1",
                           "Timestamp: DL: ID: 601 a b c d",
                           "Timestamp: DLC: ID: 601 a b c d",
                           "Timestamp: 1.0 ID: DL: 1 00 S Rx",
                           ") 1 0701 1 00 2)",
                           "1..0 1 701 Rx d 1 00"}) {
    EXPECT_FALSE(parse_recorded(text)) << text;
  }
}

TEST(TraceLine, KnowsWhatStandsBesideFrames) {
  for (const char* text : {"",
                           "  \r",
                           ";$FILEVERSION=1.1",
                           ";   Message   Number",
                           "// version 13.0.0",
                           "date Sat Sep 30 22:06:13.191 2017",
                           "base hex  timestamps absolute",
                           "date Mit Okt 7 03:05:05 pm 2015",
                           "no internal events logged",
                           "internal events logged",
                           "Begin Triggerblock",
                           "End TriggerBlock",
                           "0.000000 Start of measurement",
                           "1.004000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
                           " 2) 1060.0  Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY",
                           "2) 1060.0  Rx  FFFFFFFF  4  00 00 00 08  BUSHEAVY",
                           "2 1283.231 ST Rx 00 00 00 08",
                           "2 1283.231 ST 1 - Rx - 4 00 00 00 08",
                           "4 1323.201 EC Rx 2 02 04",
                           "7 1334.522 EV 1  User-defined event for bus 1",
                           "1.0 CAN 1 Status:chip status error active",
                           "1.0 SV: 2 0 1 ::Env = 1"}) {
    EXPECT_TRUE(is_remark(text)) << text;
  }
  for (const char* text :
       {"2) 46268.0 Rx", "no", "no frame", "date", "date 12", "date of the frame 185 37",
        "Start of", "x Start of measurement", "1.0 1 701 Rx d 1", "2) Warng", "Warng", "1.0 CAN 1",
        "x 1283.231 ST Rx", "1.0 1 ErrorFrame"}) {
    EXPECT_FALSE(is_remark(text)) << text;
  }
}

}  // namespace
}  // namespace takt
