#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::compile_with_entry;
using test::errors_of_entry;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string two_products =
    "name: Pair\nmatch:\n"
    "  - {vendor_id: 0xABCD, product_code: 0x402}\n"
    "  - {vendor_id: 0x77, product_code: [1, 2]}\n";

std::string beckhoff(const std::string& rest) {
  return "terminals: {dcf: x, vendor_id: 2, " + rest + "}\n";
}
std::string entry_of(const test::Compiled& net) { return net.plan.nodes.at(0).device_data; }

TEST(DeviceDataIdentity, IsAnyOfAList) {
  const auto found = [](const std::string& identity) {
    return entry_of(
        compile_with_entry(two_products, "arm: {node_id: 5, dcf: x" + identity + "}\n"));
  };

  EXPECT_EQ(found(""), "Pair");
  EXPECT_EQ(found(", vendor_id: 0x77, product_code: 2"), "Pair");
  EXPECT_EQ(found(", vendor_id: 0x77"), "") << "the vendor of one with the product of the other";
  EXPECT_EQ(found(", product_code: 2"), "");
}

TEST(DeviceDataIdentity, OfAListHasToBeCompleteInEachItem) {
  EXPECT_THAT(errors_of_entry("name: x\nmatch:\n  - {vendor_id: 1}\n  - {product_code: 2}\n"),
              ElementsAre("4 missing-key"));
  EXPECT_THAT(errors_of_entry("name: x\nmatch: []\n"), ElementsAre("2 wrong-type"));
  EXPECT_THAT(errors_of_entry("name: x\nmatch: [none]\n"), ElementsAre("2 wrong-type"));
}

TEST(DeviceDataIdentity, OfBeckhoffIsByTheProductCodesOfItsManual) {
  const auto entry = [](const std::string& code) {
    return entry_of(
        compile_device_file(beckhoff("node_id: 11, product_code: " + code), "takt_drive402.eds"));
  };

  for (const char* coupler : {"0x11400", "0x113F6", "0x113EC", "5120"}) {
    EXPECT_EQ(entry(coupler), "Beckhoff bus terminals") << coupler;
  }
  for (const char* box : {"0x21000", "0x22301", "0x2008FD"}) {
    EXPECT_EQ(entry(box), "Beckhoff Fieldbus Box") << box;
  }
  EXPECT_EQ(entry("0x1A5F3052"), "") << "an EL6751";
}

TEST(DeviceDataIdentity, LimitsTheNodeIdToThatOfItsSwitches) {
  const auto declared = [](const std::string& id, const std::string& code) {
    return compile_device_file(beckhoff("node_id: " + id + ", product_code: " + code),
                               "takt_drive402.eds")
        .declared("device-data");
  };

  EXPECT_EQ(declared("63", "0x11400"), "");
  EXPECT_THAT(declared("64", "0x11400"),
              HasSubstr("node `terminals` can't have node id 64 as Beckhoff bus terminals, which "
                        "allows only 1..63: its switches set no other address (beckhoff_io.yaml:"));
  EXPECT_EQ(declared("99", "0x22301"), "");
  EXPECT_THAT(declared("100", "0x22301"), HasSubstr("only 1..99: its two rotary switches"));
}

TEST(DeviceDataIdentity, OfABootRomHasOneNodeId) {
  const auto declared = [](const std::string& id) {
    return compile_device_file(
               "rom: {dcf: x, boot: false, device: nxp_lpc_boot, node_id: " + id + "}\n",
               "takt_drive402.eds")
        .declared("device-data");
  };

  EXPECT_EQ(declared("125"), "");
  EXPECT_THAT(
      declared("5"),
      HasSubstr("can't have node id 5 as NXP LPC boot ROM, which allows only 125: the boot ROM"));
}

TEST(DeviceDataIdentity, OfNodeIdsNeedsItsRange) {
  const std::string entry = "name: x\nmatch: none\n";
  EXPECT_THAT(errors_of_entry(entry + "node_ids: {reason: switches}\n"),
              ElementsAre("3 missing-key"));
  EXPECT_THAT(errors_of_entry(entry + "node_ids: {range: [0, 63]}\n"),
              ElementsAre("3 out-of-range"));
  EXPECT_THAT(errors_of_entry(entry + "node_ids: {range: [64, 63]}\n"),
              ElementsAre("3 out-of-range"));
}

TEST(DeviceDataIdentity, OfNodeIdsIsANoteOfThePlan) {
  const auto net =
      compile_with_entry("name: Box\nmatch: {vendor_id: 0xABCD}\nnode_ids: {range: [3, 9]}\n",
                         "arm: {node_id: 5, dcf: x}\n");

  EXPECT_EQ(net.declared("device-data"), "");
  EXPECT_THAT(net.plan.nodes.at(0).device_notes, ElementsAre("node ids 3..9"));
}

}  // namespace
}  // namespace takt
