#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

// Known peculiarities of devices that need no entry in the device data; see
// share/doc/device_data.md.

namespace takt {
namespace {

using test::compile;
using test::steps_of;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

std::vector<std::byte> bytes(std::initializer_list<unsigned> values) {
  std::vector<std::byte> out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

std::string arm(const std::string& rest) {
  return "master: {sync_period: 10000}\narm: {node_id: 5, dcf: x" + rest + "}\n";
}

// Beckhoff couplers: 0x5500 would enable PDO 5 to 11 with its own identifiers.
TEST(WithoutDeviceData, EveryPdoGetsItsCobIdByItsOwnRecord) {
  const auto net = compile(arm(", tpdo: {5: {transmission: 1, mapping: [{index: 0x6064}]}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  const auto steps = steps_of(net, {0x1804, 1});
  EXPECT_THAT(steps, Contains(Field(&BootStep::action, BootAction::enable_pdo)));
  EXPECT_THAT(steps.back().value,
              ElementsAre(std::byte{0x81}, std::byte{1}, std::byte{0}, std::byte{0}));
}

// SIKO AG06, Pepperl+Fuchs PGV: the identifier is fixed while the PDO exists. Copley: the count
// has to be 0 while entries are written.
TEST(WithoutDeviceData, APdoIsOffWhileItsRecordsAreWritten) {
  const auto net =
      compile(arm(", tpdo: {1: {cob_id: 0x191, transmission: 2, mapping: [{index: 0x6064}]}}"));

  bool off = false;
  bool counted = true;
  unsigned writes = 0;
  for (const BootStep& step : net.plan.nodes.at(0).boot_plan.steps) {
    const bool written =
        step.action == BootAction::write || step.action == BootAction::write_if_differs;
    if (step.object == ObjectKey{0x1800, 1}) {
      EXPECT_FALSE(written) << step.purpose;
      if (step.action == BootAction::disable_pdo) off = true;
      if (step.action == BootAction::enable_pdo) off = false;
    }
    if (step.object == ObjectKey{0x1A00, 0} && written) counted = step.value != bytes({0});
    const bool entry = step.object.index == 0x1A00 && step.object.sub != 0;
    if (!written || (step.object.index != 0x1800 && step.object.index != 0x1A00)) continue;
    EXPECT_TRUE(off) << step.purpose;
    EXPECT_FALSE(entry && counted) << step.purpose;
    ++writes;
  }
  EXPECT_GT(writes, 4u);
  EXPECT_FALSE(off);
}

// Roboteq: the command objects are write-only.
TEST(WithoutDeviceData, AnRpdoCarriesWriteOnlyObjects) {
  const auto net = compile(arm(", rpdo: {1: {mapping: [{index: 0x2001}]}}"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(steps_of(net, {0x1600, 1}).back().value, bytes({0x10, 0x00, 0x01, 0x20}));
}

// ZLAC8030L: 0x6502 is missing or has no useful value.
TEST(WithoutDeviceData, AnAxisNeedsNoSupportedModes) {
  const auto without = compile(arm(""));
  const auto wrong = compile(
      arm(""), test::tiny_eds() + test::entry("6502", "Supported drive modes", 7, "ro", "0"));

  EXPECT_TRUE(without.plan.nodes.at(0).cia402);
  EXPECT_TRUE(wrong.plan.nodes.at(0).cia402);
  EXPECT_THAT(steps_of(wrong, {0x6502, 0}), IsEmpty());
}

// EPOS4 and PRBT: their files give 0x1000 no value.
TEST(WithoutDeviceData, AFileWithoutDeviceTypeIsOfADriveByItsObjects) {
  std::string eds = test::tiny_eds();
  eds.erase(eds.find("0x00020192"), 10);
  std::string other = test::tiny_eds();
  other.replace(other.find("0x00020192"), 10, "0x00000000");

  const auto drive = compile(arm(""), eds);
  const auto stated = compile(arm(""), other);
  const auto denied = compile(arm(", profile: none"), eds);

  EXPECT_TRUE(drive.plan.nodes.at(0).cia402);
  EXPECT_EQ(drive.devices.at(0).model, "drive402");
  EXPECT_THAT(drive.declared("profile"), testing::HasSubstr("has no value for 1000:00"));
  EXPECT_FALSE(stated.plan.nodes.at(0).cia402);
  EXPECT_FALSE(denied.plan.nodes.at(0).cia402);
  EXPECT_EQ(denied.declared("profile"), "");
}

// A file from takt learn has the type UNSIGNED8 for the value it saw, so 253 means -3.
TEST(WithoutDeviceData, AnExponentOfUnsignedTypeHasASign) {
  std::string eds = test::tiny_eds();
  const std::size_t type = eds.find("DataType=", eds.find("[60C2sub2]"));
  eds.replace(type, eds.find('\n', type) - type, "DataType=0x0005");
  const std::string sdo =
      ", sdo: [{index: 0x60C2, sub_index: 1, value: 20}, {index: 0x60C2, sub_index: 2, value: "
      "253}]";

  EXPECT_THAT(compile(arm(sdo), eds).declared("interpolation-period"),
              testing::HasSubstr("sets 20000 us"));
}

// Joystick receivers send TPDOs without NMT start, and an NMT command would silence them.
TEST(WithoutDeviceData, ANodeThatIsNotBootedIsHeardAllTheSame) {
  const auto net = compile(arm(", boot: false"));

  EXPECT_THAT(net.plan.nodes.at(0).boot_plan.steps, IsEmpty());
  EXPECT_THAT(net.plan.pdos.tpdos, testing::SizeIs(1));
}

// Leadshine: the answer to a write of 0x1010 takes more than two seconds.
TEST(WithoutDeviceData, StoringMayTakeFiveSeconds) {
  const auto net = compile(arm(", sdo_timeout_ms: 100"));

  EXPECT_EQ(net.plan.nodes.at(0).sdo.timeout_of({0x1010, 1}, std::chrono::milliseconds{100}),
            std::chrono::seconds{5});
}

// Schneider LXM28A: an RPDO of another length than its mapping is a fault.
TEST(WithoutDeviceData, AnRpdoIsAsLongAsItsMapping) {
  const auto net = compile(arm(", rpdo: {1: {mapping: [{index: 0x6040}, {index: 0x6060}]}}"));

  EXPECT_EQ(net.plan.pdos.rpdos.at(0).length, 3);
}

}  // namespace
}  // namespace takt
