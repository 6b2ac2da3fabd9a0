// Additional SDO channels of devices: 0x1201..0x127F.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile;
using test::entry;
using test::record;
using testing::HasSubstr;

/// Makes the EDS of a device whose second channel is enabled by default.
std::string eds(const std::string& request = "$NODEID+0x640",
                const std::string& answer = "$NODEID+0x5C0") {
  return test::tiny_objects() + record("1201", "SDO server 2", 3) +
         entry("1201sub0", "highest", 5, "const", "2") +
         entry("1201sub1", "client to server", 7, "rw", request) +
         entry("1201sub2", "server to client", 7, "rw", answer);
}

std::string two(int first, int second, const std::string& keys = "") {
  return "master: {node_id: 127}\nnodes:\n  arm: {node_id: " + std::to_string(first) + ", dcf: x" +
         keys + "}\n  leg: {node_id: " + std::to_string(second) +
         ", dcf: x, sdo: [{index: 0x1201, sub_index: 2, value: 0x80000000}]}\n";
}

const std::string off = ", sdo: [{index: 0x1201, sub_index: 1, value: 0x80000641}]";

TEST(SdoServers, ASecondChannelOnTheFirstOfAnotherNodeIsAnError) {
  const auto net = compile(two(1, 65), eds());

  EXPECT_THAT(net.declared("cob-id-clash"),
              HasSubstr("SDO channel 2 (0x1201) of node `arm` is on: 0x641 is in the SDO channel "
                        "of node `leg` (0x641, 0x5C1)"));
  EXPECT_THAT(net.declared("cob-id-clash"),
              HasSubstr("`sdo: [{index: 0x1201, sub_index: 1, value: 0x80000000}]`"));
  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("0x5C1 is in"));
}

TEST(SdoServers, NothingIsDeclaredWhereTheyDoNotMeet) {
  EXPECT_EQ(compile(two(1, 64), eds()).declared("cob-id-clash"), "");
}

TEST(SdoServers, OneThatIsSwitchedOffIsNotInUse) {
  EXPECT_EQ(compile(two(1, 65, off), eds()).declared("cob-id-clash"), "");
  EXPECT_EQ(compile(two(1, 65), eds("$NODEID+0x80000640")).declared("cob-id-clash"), "");
  EXPECT_EQ(compile(two(1, 65), eds("0")).declared("cob-id-clash"), "");
}

TEST(SdoServers, OneThatTheNetworkFileSwitchesOnIsInUse) {
  const std::string on =
      ", sdo: [{index: 0x1201, sub_index: 1, value: 0x6E0}, "
      "{index: 0x1201, sub_index: 2, value: 0x5C1}]";
  const auto net = compile(two(1, 65, on), eds("0x80000000", "0x80000000"));

  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("0x5C1 is in the SDO channel of node `leg`"));
  EXPECT_EQ(net.complaints().at(0).substr(0, 2), "3:") << "where it is written";
}

TEST(SdoServers, TheOneThatTheMasterUsesIsNoClash) {
  const auto net = compile(
      "nodes: {arm: {node_id: 1, dcf: x, sdo_channel: {request: 0x641, answer: 0x5C1}}}\n", eds());

  EXPECT_EQ(net.declared("cob-id-clash"), "");
}

TEST(SdoServers, OtherServicesAreMetToo) {
  const auto net = compile(
      "nodes: {arm: {node_id: 1, dcf: x}, leg: {node_id: 2, dcf: x, emcy_cob_id: 0x641}}\n", eds());

  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("0x641 is EMCY of node `leg`"));
}

/// Makes a network with node 1, which has `keys`, and node 65. The second channel of node 1 has the
/// identifiers of the first channel of node 65.
std::string lenzes(const std::string& keys = "") {
  return "nodes:\n  pump: {node_id: 1, dcf: x" + keys +
         "}\n  fan: {node_id: 65, dcf: x, sdo: [{index: 0x1201, sub_index: 1, value: "
         "0x80000000}]}\n";
}

TEST(SdoServers, TwoLenze8400Meet64NodeIdsApart) {
  const auto net = test::compile_device_file(lenzes(), "lenze8400.eds");

  EXPECT_TRUE(has_error(net.findings));
  EXPECT_THAT(net.declared("cob-id-clash"),
              HasSubstr("the SDO channel 2 (0x1201) of node `pump` is on: 0x641 is in the SDO "
                        "channel of node `fan` (0x641, 0x5C1)"));
  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("0x5C1 is in the SDO channel of node `fan`"));
  EXPECT_EQ(test::compile_device_file(lenzes(off), "lenze8400.eds").declared("cob-id-clash"), "");
}

/// Makes an EDS like that of the manufacturer, in which the second channel is disabled or missing.
std::string lenze_eds(const std::string& request) {
  return eds(request, "0x80000000") + entry("1018sub1", "Vendor-ID", 7, "ro", "0x3B") +
         entry("1018sub2", "Product code", 7, "ro", "0x84003");
}
const std::string identity = ", vendor_id: 0x3B, product_code: 0x84003";

TEST(SdoServers, OneThatOnlyTheDeviceDataHaveOnIsAWarning) {
  for (const bool there : {true, false}) {
    const auto net = test::compile_with_shipped(
        lenzes(identity), there ? lenze_eds("0x80000000") : test::tiny_objects());
    const std::string declared = net.declared("cob-id-clash");

    EXPECT_THAT(declared,
                HasSubstr("the SDO channel 2 (0x1201) of node `pump` may be on: parameter "
                          "channel 2 listens on 0x640"));
    EXPECT_THAT(declared, HasSubstr("(lenze8400.yaml:"));
    EXPECT_THAT(declared,
                HasSubstr("and then the two would collide: 0x641 is in the SDO channel of node "
                          "`fan` (0x641, 0x5C1)"));
    EXPECT_THAT(declared,
                HasSubstr(there ? "`sdo: [{index: 0x1201, sub_index: 1, value: 0x80000000}]`"
                                : "switch it off in the device (bit 31 of 1201:01)"));
    EXPECT_TRUE(std::ranges::none_of(net.findings, [](const Finding& finding) {
      return finding.rule == "cob-id-clash" && finding.severity == Severity::error;
    }));
  }
}

TEST(SdoServers, AChannelThatOnlyTheDeviceDataHaveIsTaken) {
  const auto declared = [](const std::string& channel, const std::string& eds) {
    return test::compile_with_shipped("nodes:\n  arm: {node_id: 5, dcf: x" + identity +
                                          ", sdo_channel: " + channel + "}\n",
                                      eds)
        .declared("no-sdo-server");
  };
  const std::string second = "{request: 0x645, answer: 0x5C5}";

  EXPECT_EQ(declared(second, test::tiny_objects()), "");
  EXPECT_EQ(declared(second, lenze_eds("0x80000000")), "");
  EXPECT_THAT(declared("{request: 0x646, answer: 0x5C5}", test::tiny_objects()),
              HasSubstr("has no SDO server besides the first"));
}

TEST(SdoServers, OfTheDeviceDataNeedIndexAndBothIdentifiers) {
  const std::string entry = "name: x\nmatch: none\nsdo_servers:\n";

  EXPECT_THAT(test::errors_of_entry(entry + "  - {index: 0x1200, request: 0x640, answer: 0x5C0}\n"),
              testing::ElementsAre("4 out-of-range"));
  EXPECT_THAT(test::errors_of_entry(entry + "  - {index: 0x1201, request: 0x640}\n"),
              testing::ElementsAre("4 missing-key"));
}

TEST(SdoServers, OneOfTheDeviceDataThatTheNetworkFileSwitchesOffIsNotInUse) {
  const auto net = test::compile_with_shipped(lenzes(identity + off), lenze_eds("0x80000000"));

  EXPECT_EQ(net.declared("cob-id-clash"), "");
}

TEST(SdoServers, APlainNumberOfAnEdsIsThatOfAnotherNode) {
  EXPECT_EQ(compile(two(1, 65), eds("0x641", "0x5C1")).declared("cob-id-clash"), "");
}

}  // namespace
}  // namespace takt
