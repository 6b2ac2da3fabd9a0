#include "master/explain/frame/frame_text.hpp"
#include "test/unit/master/explain/frame/frame_text_fixture.hpp"

namespace takt {
namespace {

class PdoTextTest : public test::FrameTextFixture {};

TEST_F(PdoTextTest, AMappedPdoShowsNamesValuesAndUnits) {
  EXPECT_EQ(named(0x185, {0x37, 0x06, 0x18, 0xFC, 0xFF, 0xFF, 0x08}),
            "TPDO 1 shoulder  statusword=0x0637  position_actual_value=-1 rad  "
            "modes_of_operation_display=8");
}

TEST_F(PdoTextTest, APdoThatIsTooShortSaysSo) {
  EXPECT_EQ(named(0x185, {0x37, 0x06}), "TPDO 1 shoulder: 2 bytes, but the mapping has 7");
}

TEST_F(PdoTextTest, WithoutANetworkPdosAreThoseOfThePredefinedSet) {
  EXPECT_EQ(plain(0x185, {1}), "TPDO 1 node 5");
  EXPECT_EQ(plain(0x206, {1}), "RPDO 1 node 6");
  EXPECT_EQ(plain(0x4FF, {1}), "TPDO 4 node 127");
  EXPECT_EQ(plain(0x57F, {1}), "RPDO 4 node 127");
}

TEST_F(PdoTextTest, APdoThatIsTooLongShowsItsMappedPart) {
  EXPECT_EQ(named(0x185, {0x37, 0x06, 0, 0, 0, 0, 0x08, 0xFF}),
            "TPDO 1 shoulder  statusword=0x0637  position_actual_value=0 rad  "
            "modes_of_operation_display=8  (8 bytes, but the mapping has 7)");
}

TEST_F(PdoTextTest, MultiplexedPdosNameTheirObject) {
  network_.plan.pdos.fields.push_back({.signal = 0, .bit_offset = 32, .bits = 16});
  network_.plan.pdos.tpdos.push_back({.cob_id = CobId::extended(0x385),
                                      .node = 5_node,
                                      .number = 3,
                                      .length = 8,
                                      .first_field = 3,
                                      .field_count = 1,
                                      .header = 0x00604105});  // SAM, node 5, 6041:00
  network_.plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x485),
                                      .node = 5_node,
                                      .number = 4,
                                      .length = 8,
                                      .first_field = 3,
                                      .field_count = 1,
                                      .header = 0x006041FF});  // DAM to node 127
  const auto sam = named_.meaning(
      make_frame(CobId::extended(0x385), {0x05, 0x41, 0x60, 0x00, 0x37, 0x06, 0, 0}));

  EXPECT_EQ(sam.text, "3 shoulder MPDO SAM from shoulder  statusword=0x0637");
  EXPECT_EQ(named(0x485, {0xFF, 0x41, 0x60, 0x00, 0x31, 0x02, 0, 0}),
            "TPDO 4 shoulder MPDO DAM to master  statusword=0x0231");
  EXPECT_EQ(named(0x485, {0x80, 0x41, 0x60, 0x00, 0x31, 0x02, 0, 0}),
            "TPDO 4 shoulder MPDO DAM to all nodes  statusword=0x0231");
  EXPECT_EQ(named(0x485, {0xFF, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0}),
            "TPDO 4 shoulder MPDO DAM to master  1000:00 device type = 92 01 02 00 (not in the "
            "plan)");
}

TEST_F(PdoTextTest, TheParameterChannelOfAConverterIsReported) {
  network_.plan.nodes[0].device_data = "Astraada DRV-28";
  const PdoRow row{.cob_id = CobId::base(0x205), .node = 5_node, .length = 8, .on_request = true};
  network_.plan.pdos.rpdos.push_back(row);
  network_.plan.pdos.tpdos[0] = row;
  network_.plan.pdos.tpdos[0].cob_id = CobId::base(0x185);

  EXPECT_EQ(named(0x205, {0x01, 0, 0x0A, 0x00, 0, 0, 0, 0}),
            "RPDO 1 shoulder: read parameter 0x000A");
  EXPECT_EQ(named(0x205, {0x02, 0, 0x0A, 0x00, 0x88, 0x13, 0, 0}),
            "RPDO 1 shoulder: write parameter 0x000A = 5000");
  EXPECT_EQ(named(0x185, {0x01, 0, 0, 0, 0x88, 0x13, 0, 0}), "TPDO 1 shoulder: done, value 5000");
  EXPECT_EQ(named(0x185, {0x03, 0, 0x03, 0, 0, 0, 0, 0}),
            "TPDO 1 shoulder: refused, value out of range (3)");
}

}  // namespace
}  // namespace takt
