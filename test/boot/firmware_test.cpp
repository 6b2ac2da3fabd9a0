#include "test/boot/plant.hpp"

// Device data that depends on the firmware, and a device with another firmware.

namespace takt {
namespace {

using namespace test;

LoadedNetwork conveyor(const std::string& firmware) {
  return network_of(
      "bus: {name: plant, interface: can0}\nmaster: {sync_period: 10000}\nnodes:\n"
      "  conveyor: {node_id: 5, dcf: " +
      std::string{TAKT_SOURCE_DIR} +
      "/share/eds/lenze8400.eds, sim: {model: lenze8400}, firmware: \"" + firmware + "\"}\n");
}

sim::Fault revision(std::uint32_t value) {
  sim::Fault fault{.kind = sim::FaultKind::override_value, .node = 5_node};
  fault.object = ObjectKey{0x1018, 3};
  for (unsigned i = 0; i < 4; ++i) fault.value.push_back(std::byte(value >> (8 * i) & 0xFF));
  return fault;
}

TEST(FirmwareOfADevice, ThatIsOlderThanPlannedIsReportedWithWhatFollows) {
  Plant plant{conveyor("16.00.00"), {revision(0x000E'0003)}};

  plant.run(5s);

  EXPECT_EQ(plant.count(EventKind::firmware_differs), 1);
  EXPECT_EQ(
      plant.text_of(EventKind::firmware_differs),
      "node 5 'conveyor': the firmware is 14.03.00 (1018:03), but the plan assumes 16.00.00: "
      "not valid for this firmware: a SYNC that the device sends triggers its own TPDOs; these "
      "objects "
      "are missing: 1403, 1603, 1803, 1A03. Write `firmware: \"14.03.00\"` for this node, and "
      "check the plan with `takt plan`");
}

TEST(FirmwareOfADevice, ThatIsNewerIsReportedAsWell) {
  Plant plant{conveyor("15.02.00"), {revision(0x0010'0000)}};

  plant.run(5s);

  const std::string text = plant.text_of(EventKind::firmware_differs);
  EXPECT_NE(text.find(": a SYNC that the device sends triggers its own TPDOs. Write"),
            std::string::npos)
      << text;
}

TEST(FirmwareOfADevice, ThatIsAsPlannedIsNotWorthAWord) {
  for (const char* version : {"16.00.00", "15.02.00", "15.02.07"}) {
    Plant plant{conveyor(version)};

    plant.run(5s);

    EXPECT_EQ(plant.node().boot, BootState::ready) << version;
    EXPECT_EQ(plant.count(EventKind::firmware_differs), 0) << version;
  }
}

TEST(FirmwareOfADevice, OnWhichNothingDependsIsReportedAsThat) {
  Plant plant{conveyor("15.02.00"), {revision(0x000F'0004)}};

  plant.run(5s);

  const std::string text = plant.text_of(EventKind::firmware_differs);
  EXPECT_NE(text.find("nothing in the device data depends on this difference"), std::string::npos)
      << text;
}

TEST(FirmwareInAText, IsItsFirstVersion) {
  EXPECT_EQ(Firmware::find_in("V16.00 build 7"), (Firmware{{16, 0, 0}}));
  EXPECT_EQ(Firmware::find_in("SW 1.2.3.4"), (Firmware{{1, 2, 3}}));
  EXPECT_EQ(Firmware::find_in("15.02.01"), (Firmware{{15, 2, 1}}));
  EXPECT_EQ(Firmware::find_in("3."), (Firmware{{3, 0, 0}}));
  EXPECT_EQ(Firmware::find_in("99999999"), std::nullopt);
  EXPECT_EQ(Firmware::find_in("none"), std::nullopt);
  EXPECT_EQ(Firmware::find_in(""), std::nullopt);
}

}  // namespace
}  // namespace takt
