#include "master/explain/frame/frame_text.hpp"
#include "test/unit/master/explain/frame/frame_text_fixture.hpp"

namespace takt {
namespace {

class BlockTextTest : public test::FrameTextFixture {};

TEST_F(BlockTextTest, ABlockUploadKeepsItsSegmentsApart) {
  plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0});
  plain(0x585, {0xC2, 0x08, 0x10, 0x00, 0x0A, 0, 0, 0});
  plain(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});

  EXPECT_EQ(plain(0x585, {0x01, 'S', 'e', 'r', 'v', 'o', ' ', 'd'}),
            "SDO node 5 answers: block segment 1 of 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x82, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: block segment 2 of 1008:00 manufacturer device name, the last");
}

TEST_F(BlockTextTest, ABlockUploadShowsItsValueAndItsCrc) {
  EXPECT_EQ(
      plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0x1C, 0, 0}),
      "SDO node 5 is asked: block upload 1008:00 manufacturer device name, 127 segments a block, "
      "in segments up to 28 bytes");
  EXPECT_EQ(plain(0x585, {0xC6, 0x08, 0x10, 0x00, 0x09, 0, 0, 0}),
            "SDO node 5 answers: block upload 1008:00 manufacturer device name accepted, 9 bytes, "
            "with CRC");
  plain(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});
  plain(0x585, {0x01, '1', '2', '3', '4', '5', '6', '7'});
  plain(0x585, {0x82, '8', '9', 0, 0, 0, 0, 0});
  EXPECT_EQ(plain(0x605, {0xA2, 0x02, 0x7F, 0, 0, 0, 0, 0}),
            "SDO node 5 is asked: block upload: 2 segments taken");
  EXPECT_EQ(plain(0x585, {0xD5, 0xC3, 0x31, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: end of block upload 1008:00 manufacturer device name, CRC 31C3");
  EXPECT_EQ(
      plain(0x605, {0xA1, 0, 0, 0, 0, 0, 0, 0}),
      "SDO node 5 is asked: block upload 1008:00 manufacturer device name done = \"123456789\"");
  EXPECT_EQ(plain(0x605, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}),
            "SDO node 5 is asked: read 1018:01 vendor id");
}

TEST_F(BlockTextTest, ABlockDownloadReportsWhatIsRepeatedAndAWrongCrc) {
  plain(0x605, {0xC6, 0x50, 0x1F, 0x01, 0x09, 0, 0, 0});
  EXPECT_EQ(plain(0x585, {0xA4, 0x50, 0x1F, 0x01, 0x02, 0, 0, 0}),
            "SDO node 5 answers: block download 1F50:01 program data accepted, 2 segments a block");
  EXPECT_EQ(plain(0x605, {0x01, '1', '2', '3', '4', '5', '6', '7'}),
            "SDO node 5 is asked: block segment 1 of 1F50:01 program data");
  plain(0x605, {0x82, '8', '9', 0, 0, 0, 0, 0});
  EXPECT_EQ(plain(0x585, {0xA2, 0x01, 0x02, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: block download: 1 segments taken, 1 to be repeated");
  plain(0x605, {0x81, '8', '9', 0, 0, 0, 0, 0});
  plain(0x585, {0xA2, 0x01, 0x02, 0, 0, 0, 0, 0});
  EXPECT_EQ(
      plain(0x605, {0xD5, 0xC4, 0x31, 0, 0, 0, 0, 0}),
      "SDO node 5 is asked: end of block download 1F50:01 program data, CRC 31C4 is wrong, 31C3 "
      "would be right");
  EXPECT_EQ(plain(0x585, {0x80, 0x50, 0x1F, 0x01, 0x04, 0x00, 0x04, 0x05}),
            "SDO node 5 answers: ABORT 1F50:01 program data: 0504 0004 CRC error in a block "
            "transfer");
  EXPECT_EQ(plain(0x605, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}),
            "SDO node 5 is asked: read 1018:01 vendor id");
}

TEST_F(BlockTextTest, ARecordingWithAGapDoesNotCallTheCrcWrong) {
  plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0});
  plain(0x585, {0xC6, 0x08, 0x10, 0x00, 0x10, 0, 0, 0});
  plain(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});
  plain(0x585, {0x01, '1', '2', '3', '4', '5', '6', '7'});
  // segment 2 is not in the recording
  plain(0x585, {0x83, '8', '9', 0, 0, 0, 0, 0});
  plain(0x605, {0xA2, 0x03, 0x7F, 0, 0, 0, 0, 0});

  EXPECT_EQ(plain(0x585, {0xD5, 0xC3, 0x31, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: end of block upload 1008:00 manufacturer device name, CRC 31C3 "
            "can't be checked: some segments are not in this recording");
  EXPECT_EQ(plain(0x605, {0xA1, 0, 0, 0, 0, 0, 0, 0}),
            "SDO node 5 is asked: block upload 1008:00 manufacturer device name done");
}

TEST_F(BlockTextTest, AnEndIsKnownWhereTheLastSegmentsAreMissing) {
  plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0});
  plain(0x585, {0xC6, 0x08, 0x10, 0x00, 0x09, 0, 0, 0});
  plain(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});
  plain(0x585, {0x01, '1', '2', '3', '4', '5', '6', '7'});
  plain(0x605, {0xA2, 0x02, 0x7F, 0, 0, 0, 0, 0});

  EXPECT_EQ(plain(0x585, {0xD5, 0xC3, 0x31, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: end of block upload 1008:00 manufacturer device name, CRC 31C3 "
            "can't be checked: some segments are not in this recording");
}

}  // namespace
}  // namespace takt
