#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_with_shipped;
using testing::ElementsAre;
using testing::HasSubstr;

/// A controller whose default mapping can only be reduced, with three TPDOs of one object each.
const std::string three_tpdos =
    test::tiny_objects() + test::pdo(false, 1, "$NODEID+0x200", 1, {"0x60400010", "0x60600008"}) +
    test::pdo(true, 1, "$NODEID+0x40000180", 1, {"0x60410010", "0x60610008"}) +
    test::pdo(true, 2, "$NODEID+0xC0000280", 1, {"0x60640020"}) +
    test::pdo(true, 3, "$NODEID+0xC0000380", 1, {"0x606C0020"});

test::Compiled controller(const std::string& rest) {
  return compile_with_shipped(
      "master: {sync_period: 10000}\n"
      "plc: {node_id: 5, dcf: x, device: lenze_plc_designer" +
          rest + "}\n",
      three_tpdos);
}

TEST(DeviceDataMapping, OfALenzeControllerMayBeReduced) {
  EXPECT_EQ(controller("").declared("device-data"), "");
  EXPECT_EQ(controller(", tpdo: {1: {mapping: [{index: 0x6041}]}}").declared("device-data"), "");
  EXPECT_EQ(controller(", tpdo: {2: {mapping: [{index: 0x606C}]}}").declared("device-data"), "");
}

TEST(DeviceDataMapping, OfALenzeControllerTakesNoMoreObjectsThanByDefault) {
  const auto net = controller(", tpdo: {2: {mapping: [{index: 0x6064}, {index: 0x6061}]}}");

  EXPECT_THAT(net.declared("device-data"),
              HasSubstr("TPDO2 of node `plc` can't map 2 objects on Lenze PLC Designer, CanDevice, "
                        "only the 1 of its default mapping: the master can't add"));
  EXPECT_THAT(net.complaints(), ElementsAre("2:75 error [device-data]"));
  EXPECT_THAT(
      controller(", rpdo: {1: {mapping: [{index: 0x6040}, {index: 0x6060}, {index: 0x607A}]}}")
          .declared("device-data"),
      HasSubstr("RPDO1 of node `plc` can't map 3 objects"));
}

TEST(DeviceDataMapping, OfALenzeControllerIsUsedWithoutGaps) {
  const std::string third = "3: {mapping: [{index: 0x606C}]}";

  EXPECT_THAT(controller(", tpdo: {" + third + "}").declared("device-data"),
              HasSubstr("TPDO3 of node `plc` can't be used without TPDO2 on Lenze PLC Designer"));
  EXPECT_EQ(controller(", tpdo: {2: {mapping: [{index: 0x6064}]}, " + third + "}")
                .declared("device-data"),
            "");
  EXPECT_THAT(controller(", tpdo: {1: {enabled: false}, 2: {mapping: [{index: 0x6064}]}}")
                  .declared("device-data"),
              HasSubstr("TPDO2 of node `plc` can't be used without TPDO1"));
}

TEST(DeviceDataMapping, OfALenzeControllerIsDeclaredByThePlan) {
  EXPECT_THAT(
      controller("").plan.nodes.at(0).device_notes,
      ElementsAre(
          "TPDOs: no more objects than its default mapping has, only together with the PDO before",
          "RPDOs: no more objects than its default mapping has, only together with the PDO "
          "before"));
}

}  // namespace
}  // namespace takt
