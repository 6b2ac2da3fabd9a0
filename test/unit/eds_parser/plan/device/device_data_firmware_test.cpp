#include <algorithm>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::lenze8400;

TEST(DeviceDataFirmware, RefusesALenzeBeforeFirmware16AsProducerOfItsOwnSync) {
  const std::string producer =
      "tpdo: {1: {transmission: 1}}, sdo: [{index: 0x1005, value: 0x40000080}], ";

  const auto old = lenze8400(producer + "firmware: \"15.02\"");
  EXPECT_NE(
      old.declared("device-data").find("firmware 15.02.00 does not send the TPDO in this case"),
      std::string::npos);
  EXPECT_TRUE(has_error(old.findings));
  EXPECT_TRUE(
      has_error(lenze8400(producer + "sim: {model: lenze8400, firmware: \"15.99\"}").findings));
  EXPECT_TRUE(has_error(lenze8400(producer + "revision_number: 0x000F0002").findings));
  EXPECT_TRUE(has_error(lenze8400("tpdo: {1: {transmission: 252}}, firmware: \"15.02\", "
                                  "sdo: [{index: 0x1005, value: 0x40000080}]")
                            .findings))
      << "sampled at SYNC";
  EXPECT_FALSE(has_error(lenze8400(producer + "firmware: \"16\"").findings));
  EXPECT_FALSE(has_error(lenze8400(producer + "revision_number: 0x00100000").findings));
}

TEST(DeviceDataFirmware, RefusesALenzeThatSendsItsSyncOnAnotherIdentifierThanItReceives) {
  const auto producer = [](const std::string& code, const std::string& type = "1") {
    return lenze8400(
        "firmware: \"16\", tpdo: {1: {transmission: " + type +
        "}}, sdo: [{index: 0x1005, value: 0x40000080}, {index: 0x5E8F, value: " + code + "}]");
  };
  const std::string declared = producer("0x81").declared("device-data");
  EXPECT_NE(declared.find("this node produces the SYNC on 0x081, but receives it on 0x080"),
            std::string::npos)
      << declared;
  EXPECT_EQ(producer("0x80").declared("device-data"), "");
  EXPECT_EQ(producer("0x81", "254").declared("device-data"), "") << "needs no SYNC";
}

TEST(DeviceDataFirmware, LeavesOutObjectsThatAnOlderFirmwareLacks) {
  const auto newer = lenze8400("firmware: \"15.00\"");
  const auto older = lenze8400("firmware: \"14.01\"");

  const auto has_pdo4 = [](const test::Compiled& net) {
    return std::ranges::any_of(net.devices.at(0).objects, [](const DeviceObject& object) {
      return object.key.index == 0x1803;
    });
  };
  EXPECT_TRUE(has_pdo4(newer));
  EXPECT_FALSE(has_pdo4(older));
  EXPECT_TRUE(has_error(lenze8400("firmware: \"14.01\", tpdo: {4: {transmission: 1}}").findings));
}

TEST(DeviceDataFirmware, GivesTheSimulatedDeviceItsFirmwareAndRevision) {
  const auto net = lenze8400("sim: {model: lenze8400, firmware: \"15.02\"}");

  EXPECT_EQ(net.devices.at(0).firmware, "15.02.00");
  const auto& objects = net.devices.at(0).objects;
  const auto revision = std::ranges::find(objects, ObjectKey{0x1018, 3}, &DeviceObject::key);
  ASSERT_NE(revision, objects.end());
  EXPECT_EQ(revision->value,
            (std::vector{std::byte{2}, std::byte{0}, std::byte{15}, std::byte{0}}));
}

TEST(DeviceDataFirmware, KnowsFromWhichFirmwareAKostalInverterConsumesHeartbeats) {
  const auto consumes = [](const std::string& firmware) {
    const auto net = compile_device_file(
        "pump: {node_id: 4, dcf: x, vendor_id: 0x337, firmware: \"" + firmware + "\"}\n",
        "takt_drive402.eds");
    EXPECT_EQ(net.plan.nodes.at(0).device_data, "Kostal INVEOR");
    return std::ranges::any_of(net.devices.at(0).objects, [](const DeviceObject& object) {
      return object.key.index == 0x1016;
    });
  };
  EXPECT_TRUE(consumes("03.85"));
  EXPECT_FALSE(consumes("03.84"));
}

}  // namespace
}  // namespace takt
