#include "apps/frame_text/frame_text.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

LoadedNetwork network_with_shoulder() {
  LoadedNetwork network;
  NodePlan node{.name = "shoulder",
                .id = 5_node,
                .description_file = {},
                .product_name = {},
                .boot_plan = {}};
  network.plan.nodes.push_back(std::move(node));
  const auto signal = [&](const char* name, std::uint16_t index, DataType type, std::uint8_t bits) {
    Signal out{.name = name,
               .node = 5_node,
               .object = {},
               .unit = {},
               .safe_value = {},
               .seeded_from = {}};
    out.object.index = index;
    out.type = type;
    out.bits = bits;
    network.plan.layout.signals.push_back(out);
  };
  signal("statusword", 0x6041, DataType::unsigned16, 16);
  signal("position_actual_value", 0x6064, DataType::integer32, 32);
  signal("modes_of_operation_display", 0x6061, DataType::integer8, 8);
  network.plan.layout.signals[1].scale = 0.001;
  network.plan.layout.signals[1].unit = "rad";
  network.plan.pdos.fields = {{.signal = 0, .bit_offset = 0, .bits = 16},
                              {.signal = 1, .bit_offset = 16, .bits = 32, .sign_extend = true},
                              {.signal = 2, .bit_offset = 48, .bits = 8, .sign_extend = true}};
  network.plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x185),
                                     .node = 5_node,
                                     .number = 1,
                                     .length = 7,
                                     .first_field = 0,
                                     .field_count = 3});
  DeviceTable device{.node = 5_node, .name = "shoulder", .objects = {}, .model = {}, .quirks = {}};
  device.objects.push_back({.key = {0x6083, 0},
                            .type = DataType::unsigned32,
                            .value = {},
                            .low_limit = {},
                            .high_limit = {}});
  network.devices.push_back(std::move(device));
  return network;
}

class FrameTextTest : public testing::Test {
 protected:
  std::string read(FrameText& reader, std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    const FrameMeaning meaning = reader.meaning(make_frame(CobId::base(id), bytes));
    return std::string{meaning.service} + " " + meaning.text;
  }
  std::string plain(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    return read(plain_, id, bytes);
  }
  std::string named(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    return read(named_, id, bytes);
  }

  LoadedNetwork network_ = network_with_shoulder();
  FrameText plain_;
  FrameText named_{network_};
};

TEST_F(FrameTextTest, NmtCommandsNameTheirNode) {
  EXPECT_EQ(plain(0x000, {0x01, 0x00}), "NMT start all nodes");
  EXPECT_EQ(plain(0x000, {0x81, 0x05}), "NMT reset node 5");
  EXPECT_EQ(named(0x000, {0x82, 0x05}), "NMT reset communication shoulder");
  EXPECT_EQ(plain(0x000, {0x07, 0x05}), "NMT not a command: 07 05");
}

TEST_F(FrameTextTest, SyncShowsItsCounter) {
  EXPECT_EQ(plain(0x080, {}), "SYNC ");
  EXPECT_EQ(plain(0x080, {0x0A}), "SYNC 10");
}

TEST_F(FrameTextTest, HeartbeatsNameTheState) {
  EXPECT_EQ(plain(0x705, {0x00}), "BOOTUP node 5");
  EXPECT_EQ(named(0x705, {0x05}), "HEARTBEAT shoulder operational");
  EXPECT_EQ(plain(0x705, {0xFF}), "HEARTBEAT node 5 pre-operational (toggle)");
  EXPECT_EQ(plain(0x705, {0x42}), "HEARTBEAT node 5 unknown state 0x42");
}

TEST_F(FrameTextTest, AnEmcyIsToldInWords) {
  const std::string text = named(0x085, {0x30, 0x81, 0x11, 0x05, 0, 0, 0, 0});

  EXPECT_TRUE(text.starts_with("EMCY shoulder 8130 ")) << text;
  EXPECT_NE(text.find("error register 11 ("), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("vendor 05 00 00 00 00")) << text;
}

TEST_F(FrameTextTest, AMappedPdoShowsNamesValuesAndUnits) {
  EXPECT_EQ(named(0x185, {0x37, 0x06, 0x18, 0xFC, 0xFF, 0xFF, 0x08}),
            "TPDO 1 shoulder  statusword=0x0637  position_actual_value=-1 rad  "
            "modes_of_operation_display=8");
}

TEST_F(FrameTextTest, APdoThatIsTooShortSaysSo) {
  EXPECT_EQ(named(0x185, {0x37, 0x06}), "TPDO 1 shoulder: 2 bytes, its mapping has 7");
}

TEST_F(FrameTextTest, WithoutANetworkPdosAreThoseOfThePredefinedSet) {
  EXPECT_EQ(plain(0x185, {1}), "TPDO 1 node 5");
  EXPECT_EQ(plain(0x206, {1}), "RPDO 1 node 6");
  EXPECT_EQ(plain(0x4FF, {1}), "TPDO 4 node 127");
  EXPECT_EQ(plain(0x57F, {1}), "RPDO 4 node 127");
}

TEST_F(FrameTextTest, AnExpeditedUploadShowsObjectAndValue) {
  EXPECT_EQ(plain(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}),
            "SDO node 5 asked: read 1000:00 device type");
  EXPECT_EQ(plain(0x585, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}),
            "SDO node 5 answers: read 1000:00 device type = 131474 (0x20192)");
}

TEST_F(FrameTextTest, ADownloadIsShownWithTheTypeOfTheEds) {
  EXPECT_EQ(named(0x605, {0x23, 0x83, 0x60, 0x00, 0x10, 0x27, 0x00, 0x00}),
            "SDO shoulder asked: write 6083:00 = 10000 (0x2710)");
  EXPECT_EQ(named(0x585, {0x60, 0x83, 0x60, 0x00, 0, 0, 0, 0}),
            "SDO shoulder answers: written 6083:00");
}

TEST_F(FrameTextTest, AnAbortIsToldInWords) {
  EXPECT_EQ(named(0x585, {0x80, 0x83, 0x60, 0x00, 0x30, 0x00, 0x09, 0x06}).substr(0, 46),
            "SDO shoulder answers: ABORT 6083:00: 0609 0030");
}

TEST_F(FrameTextTest, SegmentsAreJoinedToTheirValue) {
  EXPECT_EQ(plain(0x605, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}),
            "SDO node 5 asked: read 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x41, 0x08, 0x10, 0x00, 0x0A, 0, 0, 0}),
            "SDO node 5 answers: read 1008:00 manufacturer device name, 10 bytes in segments");
  EXPECT_EQ(plain(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}),
            "SDO node 5 asked: next segment of 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x00, 'S', 'e', 'r', 'v', 'o', ' ', 'd'}),
            "SDO node 5 answers: segment of 1008:00 manufacturer device name, 7 bytes");
  EXPECT_EQ(plain(0x585, {0x19, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: read 1008:00 manufacturer device name = \"Servo drv1\" (last "
            "segment)");
}

TEST_F(FrameTextTest, ASegmentWithoutItsBeginningIsNotInvented) {
  EXPECT_EQ(plain(0x585, {0x19, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: segment of 3 bytes, beginning not seen");
}

TEST_F(FrameTextTest, ABlockUploadKeepsItsSegmentsApart) {
  plain(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0});
  plain(0x585, {0xC2, 0x08, 0x10, 0x00, 0x0A, 0, 0, 0});
  plain(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0});

  EXPECT_EQ(plain(0x585, {0x01, 'S', 'e', 'r', 'v', 'o', ' ', 'd'}),
            "SDO node 5 answers: block segment 1 of 1008:00 manufacturer device name");
  EXPECT_EQ(plain(0x585, {0x82, 'r', 'v', '1', 0, 0, 0, 0}),
            "SDO node 5 answers: block segment 2 of 1008:00 manufacturer device name, the last");
}

TEST_F(FrameTextTest, AnSdoFrameOfAnotherLengthIsNotRead) {
  EXPECT_EQ(plain(0x605, {0x40, 0x00}), "SDO node 5 asked: of 2 bytes (always 8)");
}

TEST_F(FrameTextTest, LssIsNamed) {
  EXPECT_EQ(plain(0x7E5, {0x04, 0x01, 0, 0, 0, 0, 0, 0}), "LSS all to configuration");
  EXPECT_EQ(plain(0x7E5, {0x40, 0x5A, 0x01, 0, 0, 0, 0, 0}), "LSS select vendor id 0x0000015A");
  EXPECT_EQ(plain(0x7E5, {0x11, 0x05, 0, 0, 0, 0, 0, 0}), "LSS node id := 5");
  EXPECT_EQ(plain(0x7E4, {0x11, 0x01, 0, 0, 0, 0, 0, 0}), "LSS node id: refused, error 1");
  EXPECT_EQ(plain(0x7E4, {0x5A, 0x5A, 0x01, 0, 0, 0, 0, 0}), "LSS vendor id is 0x0000015A");
  EXPECT_EQ(plain(0x7E5, {0x99, 0, 0, 0, 0, 0, 0, 0}), "LSS unknown command 0x99");
}

TEST_F(FrameTextTest, TimeIsShown) {
  // 12:00:00.000 is 43,200,000 ms = 0x02932E00; day 15000 = 0x3A98
  EXPECT_EQ(plain(0x100, {0x00, 0x2E, 0x93, 0x02, 0x98, 0x3A}),
            "TIME day 15000 since 1984, 12:00:00.000");
}

TEST_F(FrameTextTest, EveryIdentifierAndEveryFirstByteIsReadWithoutHarm) {
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    for (unsigned first = 0; first < 256; ++first) {
      Frame frame = make_frame(CobId::base(id), {static_cast<std::uint8_t>(first), 1, 2, 3});
      frame.length = static_cast<std::uint8_t>((id + first) % 9);
      frame.rtr = first % 16 == 7;
      named_.meaning(frame);
    }
  }
}

}  // namespace
}  // namespace takt
