#include "master/explain/frame/frame_text.hpp"
#include "test/unit/master/explain/frame/frame_text_fixture.hpp"

namespace takt {
namespace {

class SdoTextTest : public test::FrameTextFixture {};

TEST_F(SdoTextTest, AnExpeditedUploadShowsObjectAndValue) {
  EXPECT_EQ(plain(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}),
            "SDO node 5 is asked: read 1000:00 device type");
  EXPECT_EQ(plain(0x585, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}),
            "SDO node 5 answers: read 1000:00 device type = 131474 (0x20192)");
}

TEST_F(SdoTextTest, ADownloadIsShownWithTheTypeOfTheEds) {
  EXPECT_EQ(named(0x605, {0x23, 0x83, 0x60, 0x00, 0x10, 0x27, 0x00, 0x00}),
            "SDO shoulder is asked: write 6083:00 = 10000 (0x2710)");
  EXPECT_EQ(named(0x585, {0x60, 0x83, 0x60, 0x00, 0, 0, 0, 0}),
            "SDO shoulder answers: written 6083:00");
}

TEST_F(SdoTextTest, AnAbortIsReportedInWords) {
  EXPECT_EQ(named(0x585, {0x80, 0x83, 0x60, 0x00, 0x30, 0x00, 0x09, 0x06}).substr(0, 46),
            "SDO shoulder answers: ABORT 6083:00: 0609 0030");
}

TEST_F(SdoTextTest, SegmentsAreJoinedToTheirValue) {
  EXPECT_EQ(plain(0x605, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}),
            "SDO node 5 is asked: read 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x41, 0x08, 0x10, 0x00, 0x0A, 0, 0, 0}),
            "SDO node 5 answers: read 1008:00 manufacturer device name, 10 bytes in segments");
  EXPECT_EQ(plain(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}),
            "SDO node 5 is asked: next segment of 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x00, 'S', 'e', 'r', 'v', 'o', ' ', 'd'}),
            "SDO node 5 answers: segment of 1008:00 manufacturer device name, 7 bytes");
  EXPECT_EQ(plain(0x585, {0x19, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: read 1008:00 manufacturer device name = \"Servo drv1\" (last "
            "segment)");
}

TEST_F(SdoTextTest, ASegmentWithoutItsBeginningIsNotInvented) {
  EXPECT_EQ(plain(0x585, {0x19, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: segment of 3 bytes, beginning not seen");
}

TEST_F(SdoTextTest, ASecondSdoChannelIsOfItsNode) {
  network_.plan.nodes[0].sdo.channel = {.request = CobId::base(0x645),
                                        .answer = CobId::base(0x5C5)};
  FrameText reader{network_.plan, network_.devices};

  EXPECT_EQ(read(reader, 0x645, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}),
            "SDO shoulder (channel 2) is asked: read 1018:01 vendor id");
  EXPECT_EQ(read(reader, 0x5C5, {0x80, 0x18, 0x10, 0x01, 0, 0, 0x02, 0x06}),
            "SDO shoulder (channel 2) answers: ABORT 1018:01 vendor id: 0602 0000 object "
            "does not exist in the dictionary");
}

TEST_F(SdoTextTest, ATransferThatBeginsInTheMiddleOfSegmentsEndsTheOneBefore) {
  const auto half_a_download = [this] {
    plain(0x605, {0xC6, 0x50, 0x1F, 0x01, 0x40, 0, 0, 0});
    plain(0x585, {0xA4, 0x50, 0x1F, 0x01, 0x7F, 0, 0, 0});
    plain(0x605, {0x01, '1', '2', '3', '4', '5', '6', '7'});
  };
  half_a_download();
  EXPECT_EQ(
      plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0}),
      "SDO node 5 is asked: block upload 1008:00 manufacturer device name, 127 segments a block");
  half_a_download();
  EXPECT_EQ(plain(0x605, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}),
            "SDO node 5 is asked: read 1018:01 vendor id");
  EXPECT_EQ(plain(0x585, {0x21, 0xA4, 0xD7, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: segment taken, beginning not seen");
}

TEST_F(SdoTextTest, AnSdoFrameOfAnotherLengthIsNotRead) {
  EXPECT_EQ(plain(0x605, {0x40, 0x00}), "SDO node 5 is asked: frame of 2 bytes instead of 8");
}

TEST_F(SdoTextTest, SdoChannelsOfTheDescriptionAreFollowedApart) {
  const auto server = [&](std::uint8_t sub, std::array<int, 4> bytes) {
    std::vector<std::byte> value;
    for (const int byte : bytes) value.push_back(static_cast<std::byte>(byte));
    network_.devices[0].objects.insert(network_.devices[0].objects.begin() + (sub - 1),
                                       {.key = {0x1201, sub},
                                        .type = DataType::unsigned32,
                                        .value = value,
                                        .low_limit = {},
                                        .high_limit = {}});
  };
  server(1, {0x45, 0x06, 0x00, 0x20});  // 29 bits
  server(2, {0xC5, 0x05, 0x00, 0x20});
  FrameText reader{network_.plan, network_.devices};
  const auto long_id = [&](std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    const FrameMeaning reported = reader.meaning(make_frame(CobId::extended(id), bytes));
    return std::string{reported.service} + " " + reported.text;
  };

  EXPECT_EQ(long_id(0x645, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0}),
            "SDO shoulder (channel 2) is asked: read 1008:00 manufacturer device name");
  long_id(0x5C5, {0x41, 0x08, 0x10, 0, 0x02, 0, 0, 0});
  EXPECT_EQ(read(reader, 0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}),
            "SDO shoulder is asked: read 1000:00 device type");
  EXPECT_EQ(read(reader, 0x585, {0x43, 0x00, 0x10, 0, 0x92, 0x01, 0x02, 0}),
            "SDO shoulder answers: read 1000:00 device type = 131474 (0x20192)");
  long_id(0x645, {0x60, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(long_id(0x5C5, {0x0B, 'O', 'K', 0, 0, 0, 0, 0}),
            "SDO shoulder (channel 2) answers: read 1008:00 manufacturer device name = \"OK\" "
            "(last segment)");
}

TEST_F(SdoTextTest, ParametersOfAPdoHaveItsNumber) {
  const auto asked = [&](std::uint16_t index, std::uint8_t sub) {
    return plain(0x605, {0x40, static_cast<std::uint8_t>(index),
                         static_cast<std::uint8_t>(index >> 8), sub, 0, 0, 0, 0});
  };

  EXPECT_EQ(asked(0x1803, 5), "SDO node 5 is asked: read 1803:05 TPDO4 event timer");
  EXPECT_EQ(asked(0x15FF, 3), "SDO node 5 is asked: read 15FF:03 RPDO512 inhibit time");
  EXPECT_EQ(asked(0x1601, 0), "SDO node 5 is asked: read 1601:00 RPDO2 mapped objects");
  EXPECT_EQ(asked(0x1A1F, 8), "SDO node 5 is asked: read 1A1F:08 TPDO32 mapping entry 8");
  EXPECT_EQ(asked(0x1018, 4), "SDO node 5 is asked: read 1018:04 serial number");
  EXPECT_EQ(asked(0x1016, 1), "SDO node 5 is asked: read 1016:01 consumer heartbeat time");
}

TEST_F(SdoTextTest, ARepeatedToggleBitOfSegmentsIsReported) {
  plain(0x605, {0x21, 0x08, 0x10, 0, 0x0E, 0, 0, 0});
  EXPECT_EQ(plain(0x585, {0x60, 0x08, 0x10, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: write 1008:00 manufacturer device name accepted, segments follow");
  EXPECT_EQ(plain(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}),
            "SDO node 5 is asked: segment of 1008:00 manufacturer device name, 7 bytes");
  EXPECT_EQ(plain(0x585, {0x30, 0, 0, 0, 0, 0, 0, 0}),
            "SDO node 5 answers: segment taken, the toggle bit is wrong");
  EXPECT_EQ(plain(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}),
            "SDO node 5 is asked: segment of 1008:00 manufacturer device name, 7 bytes, the toggle "
            "bit is wrong");
}

TEST_F(SdoTextTest, AnAnswerOfAnotherLengthThanAnnouncedIsReported) {
  plain(0x605, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0});
  plain(0x585, {0x41, 0x08, 0x10, 0, 0x05, 0, 0, 0});
  plain(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(plain(0x585, {0x09, 'a', 'b', 'c', 0, 0, 0, 0}),
            "SDO node 5 answers: read 1008:00 manufacturer device name = \"abc\" (last segment, 3 "
            "bytes, but 5 were announced)");
}

TEST_F(SdoTextTest, ValuesOfTheCommunicationProfileAreExplained) {
  EXPECT_EQ(plain(0x605, {0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0xC0}),
            "SDO node 5 is asked: write 1800:01 TPDO1 COB-ID = 3221225861 "
            "(0xC0000185): 0x185, not valid, no RTR");
  EXPECT_EQ(named(0x605, {0x23, 0x00, 0x1A, 0x01, 0x10, 0x00, 0x41, 0x60}),
            "SDO shoulder is asked: write 1A00:01 TPDO1 mapping entry 1 = 1614872592 (0x60410010): "
            "6041:00 statusword, 16 bits");
  EXPECT_EQ(plain(0x605, {0x2F, 0x00, 0x14, 0x02, 0x0A, 0, 0, 0}),
            "SDO node 5 is asked: write 1400:02 RPDO1 transmission type = 10 (0xA): every 10 "
            "SYNCs");
  EXPECT_EQ(named(0x605, {0x23, 0x16, 0x10, 0x01, 0xC8, 0x00, 0x05, 0x00}),
            "SDO shoulder is asked: write 1016:01 consumer heartbeat time = 327880 (0x500C8): "
            "shoulder, 200 ms");
  EXPECT_EQ(plain(0x605, {0x23, 0x10, 0x10, 0x01, 's', 'a', 'v', 'e'}),
            "SDO node 5 is asked: write 1010:01 store parameters = 1702257011 (0x65766173): "
            "\"save\"");
}

TEST_F(SdoTextTest, AByteAtSubIndexTwoOfAnotherObjectIsNoTransmissionType) {
  EXPECT_EQ(plain(0x605, {0x2F, 0x00, 0x20, 0x02, 0x0A, 0, 0, 0}),
            "SDO node 5 is asked: write 2000:02 = 10 (0xA)");
}

}  // namespace
}  // namespace takt
