#include "apps/takt/init/proposed_network.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/takt/init/proposed_pdos.hpp"
#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/network_report.hpp"
#include "test/support/folder.hpp"

namespace takt::init {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

std::string messages(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (finding.severity == Severity::error) text += to_string(finding) + '\n';
  }
  return text;
}

/// Devices of takt's own EDS files on a bus.
class InitTest : public testing::Test {
 protected:
  void add(std::uint8_t id, const std::string& name) {
    const fs::path path = fs::path{TAKT_SOURCE_DIR "/share/eds"} / name;
    EdsFile eds = read_eds_file(path, NodeId::from(id));
    ASSERT_TRUE(eds.readable) << path;
    DeviceToWrite& device = devices.emplace_back();
    device.found.id = id;
    device.found.node.answers = true;
    device.found.node.name = name;
    device.found.file.path = path;
    device.found.file.dictionary =
        std::make_shared<const ObjectDictionary>(std::move(eds.dictionary));
    device.file = '"' + path.string() + '"';
    Findings ignored;
    NetworkReport report{name, ignored};
    device.data = find_device_data(families, NodeSpec{}, *device.found.file.dictionary, report);
  }

  /// Writes the proposal and reads it as taktd would.
  LoadedNetwork propose() {
    const fs::path file = folder / "machine.yaml";
    proposed = proposed_network(devices, {.file = file, .interface = "can0"});
    std::ofstream{file} << proposed.text;
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator{folder.path()}) ++files;
    EXPECT_EQ(files, 1U) << "tries are removed";
    return load_network(file);
  }

  Findings findings;
  std::vector<DeviceData> families = load_device_data(device_folders(), findings);
  test::Folder folder;
  std::vector<DeviceToWrite> devices;
  ProposedNetwork proposed;
};

TEST_F(InitTest, ADriveMovesByPositionsAndHasAUnitFromTheDevice) {
  add(5, "takt_drive402.eds");
  devices[0].counts_a_turn = 10'000;

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  ASSERT_EQ(network.plan.nodes.size(), 1U);
  EXPECT_EQ(network.plan.nodes[0].name, "axis_5");
  EXPECT_TRUE(network.plan.nodes[0].cia402);
  for (const ObjectKey key : {ObjectKey{0x6040, 0}, ObjectKey{0x607A, 0}, ObjectKey{0x6060, 0}}) {
    EXPECT_TRUE(network.plan.layout.find(0, key, true)) << to_string(key);
  }
  for (const ObjectKey key : {ObjectKey{0x6041, 0}, ObjectKey{0x6064, 0}, ObjectKey{0x6061, 0}}) {
    EXPECT_TRUE(network.plan.layout.find(0, key, false)) << to_string(key);
  }
  EXPECT_THAT(proposed.text, HasSubstr("unit: rad}"));
  EXPECT_THAT(proposed.text, HasSubstr("10000 counts a turn of the shaft"));
}

TEST_F(InitTest, EachDeviceOfTaktGetsAnEntryThatPlansWithoutAnError) {
  add(1, "takt_drive402.eds");
  add(2, "takt_servo402.eds");
  add(3, "lenze8400.eds");
  add(4, "astraada_drv28.eds");
  add(6, "takt_encoder406.eds");
  add(7, "plain301.eds");
  add(10, "takt_io401.eds");
  add(11, "beckhoff_io.eds");

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  EXPECT_EQ(network.plan.nodes.size(), devices.size()) << proposed.text;
  EXPECT_EQ(proposed.missing, 0U) << proposed.text;
  for (const char* const name : {"axis_1:", "inverter_3:", "inverter_4:", "encoder_6:", "io_10:"}) {
    EXPECT_THAT(proposed.text, HasSubstr(name));
  }
  EXPECT_THAT(proposed.text, HasSubstr("PDO1 is the parameter channel"));
}

TEST_F(InitTest, ThePeriodLeavesRoomOnTheBus) {
  for (std::uint8_t id = 1; id <= 12; ++id) add(id, "takt_drive402.eds");

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  EXPECT_GT(proposed.period_us, 1000U);
  EXPECT_FALSE(proposed.too_slow);
  EXPECT_LE(bus_budget(network.plan).load.worst, 0.6);
  EXPECT_THAT(proposed.text, HasSubstr("process data fill"));
}

/// Channel 2 of node 3 answers as node 67 would.
TEST_F(InitTest, ASecondSdoChannelIsNoDevice) {
  add(3, "lenze8400.eds");
  add(67, "lenze8400.eds");
  add(66, "lenze8400.eds");

  EXPECT_TRUE(is_second_channel(devices[0], devices[1]));
  EXPECT_FALSE(is_second_channel(devices[1], devices[0]));
  EXPECT_FALSE(is_second_channel(devices[0], devices[2]));
  devices[1].found.node.identity[3] = 1;
  EXPECT_FALSE(is_second_channel(devices[0], devices[1])) << "another serial number";
}

TEST_F(InitTest, ADeviceThatDoesNotGoWithTheOthersIsAComment) {
  add(3, "lenze8400.eds");
  add(67, "lenze8400.eds");

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  EXPECT_EQ(network.plan.nodes.size(), 1U);
  EXPECT_EQ(proposed.missing, 1U);
  EXPECT_THAT(proposed.text, HasSubstr("# taktd does not accept it with"));
}

TEST_F(InitTest, ADeviceWithoutAFileGetsACommentThatSaysWhatIsMissing) {
  add(1, "takt_io401.eds");
  DeviceToWrite& unknown = devices.emplace_back();
  unknown.found.id = 9;
  unknown.found.node.answers = true;
  unknown.found.node.identity[0] = 0x1234;
  unknown.found.node.name = "made\nby: nobody";
  DeviceToWrite& silent = devices.emplace_back();
  silent.found.id = 12;

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  EXPECT_EQ(network.plan.nodes.size(), 1U);
  EXPECT_EQ(proposed.missing, 2U);
  EXPECT_THAT(proposed.text, HasSubstr("# node 9: made by: nobody, vendor 0x00001234"));
  EXPECT_THAT(proposed.text, HasSubstr("No device file of --eds-dir fits it"));
  EXPECT_THAT(proposed.text, HasSubstr("# node_9: {node_id: 9, dcf: FILE.eds}"));
  EXPECT_THAT(proposed.text, HasSubstr("does not answer SDO requests"));
}

TEST_F(InitTest, WithoutAnyDeviceFileOnlyTheNodesAreMissing) {
  devices.emplace_back().found.id = 127;

  const LoadedNetwork network = propose();

  EXPECT_THAT(messages(network.findings), HasSubstr("the file describes no node"));
  EXPECT_THAT(proposed.text, HasSubstr("node_id: 126\n")) << "the master takes a free node-ID";
}

TEST_F(InitTest, LimitsHaveTheirSource) {
  add(10, "takt_io401.eds");

  const LoadedNetwork network = propose();

  EXPECT_EQ(messages(network.findings), "") << proposed.text;
  EXPECT_THAT(proposed.text, HasSubstr("limits:"));
  EXPECT_THAT(proposed.text, HasSubstr("index: 0x6411"));
}

}  // namespace
}  // namespace takt::init
