#include <algorithm>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt::test {
namespace {

constexpr std::uint32_t all = 0xFFFF'FFFF;

TEST(LssCompiler, TakesTheIdentityOfNetworkAndDeviceFile) {
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  axis: {node_id: 5, dcf: tiny.eds, lss: true, revision_number: 0x10003, serial_number: 17}
  other: {node_id: 6, dcf: tiny.eds}
)");
  ASSERT_TRUE(net.complaints().empty());
  ASSERT_TRUE(net.plan.nodes[0].lss);
  EXPECT_EQ(net.plan.nodes[0].lss->address, (LssAddress{0xABCD, 0x402, 0x10003, 17}));
  EXPECT_EQ(net.plan.nodes[0].lss->known, (LssAddress{all, all, all, all}));
  EXPECT_TRUE(net.plan.nodes[0].lss->store);
  EXPECT_FALSE(net.plan.nodes[1].lss);
}

TEST(LssCompiler, LeavesWhatIsNotGivenToTheScan) {
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  axis: {node_id: 5, dcf: tiny.eds, lss: {store: false}}
)");
  ASSERT_TRUE(net.plan.nodes[0].lss);
  EXPECT_EQ(net.plan.nodes[0].lss->known, (LssAddress{all, all, 0, 0}));
  EXPECT_FALSE(net.plan.nodes[0].lss->store);
}

TEST(LssCompiler, AVendorIdOfZeroIsOneBesideAProductCode) {
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  axis: {node_id: 5, dcf: tiny.eds, lss: true, vendor_id: 0}
)");
  ASSERT_TRUE(net.plan.nodes[0].lss);
  EXPECT_EQ(net.plan.nodes[0].lss->address[0], 0u);
  EXPECT_EQ(net.plan.nodes[0].lss->known, (LssAddress{all, all, 0, 0}));
  EXPECT_EQ(net.declared("lss"), "");
}

TEST(LssCompiler, WarnsOfDevicesThatItCannotReportApart) {
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  left: {node_id: 5, dcf: tiny.eds, lss: true}
  right: {node_id: 6, dcf: tiny.eds, lss: true}
  third: {node_id: 7, dcf: tiny.eds, lss: true, vendor_id: 9}
)");
  EXPECT_EQ(net.complaints(), std::vector<std::string>{"5:43 warning [lss]"});
  EXPECT_NE(net.declared("lss").find("`left` and `right`"), std::string::npos);
}

TEST(LssCompiler, GivesTheSimulatedDeviceItsSerialNumber) {
  const std::string eds = tiny_eds() + entry("1018sub4", "Serial number", 7, "ro", "0");
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  axis: {node_id: 5, dcf: tiny.eds, serial_number: 0x1234}
)",
                               eds);
  const auto& objects = net.devices[0].objects;
  const auto serial = std::ranges::find(objects, ObjectKey{0x1018, 4},
                                        [](const auto& object) { return object.key; });
  ASSERT_NE(serial, objects.end());
  EXPECT_EQ(serial->value, (std::vector<std::byte>{std::byte{0x34}, std::byte{0x12}, {}, {}}));
}

TEST(LssCompiler, RefusesANodeThatItCannotFind) {
  const Compiled net = compile(R"(
master: {sync_period: 10000}
nodes:
  nobody: {node_id: 5, dcf: tiny.eds, lss: true, product_code: 0}
  watched: {node_id: 6, dcf: tiny.eds, lss: true, boot: false, serial_number: 1}
  typo: {node_id: 7, dcf: tiny.eds, lss: {stores: true}, serial_number: 2}
)");
  EXPECT_NE(net.declared("lss").find("write `vendor_id` and `product_code`"), std::string::npos);
  EXPECT_NE(net.declared("lss").find("`watched` is only watched"), std::string::npos);
  EXPECT_NE(net.declared("unknown-key").find("did you mean `store`"), std::string::npos);
}

}  // namespace
}  // namespace takt::test
