#include <gtest/gtest.h>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

// The default of `service_frames` leaves room for what has to come in time.

namespace takt {
namespace {

std::string drives(unsigned count, unsigned period_us, const std::string& master) {
  std::string text =
      "bus: {name: big, bitrate_kbit: 1000}\nmaster: {sync_period: " + std::to_string(period_us) +
      ", heartbeat_producer: 100" + master +
      "}\n.axis: &axis\n  dcf: " TAKT_SOURCE_DIR
      "/share/eds/takt_drive402.eds\n"
      "  profile: cia402\n  heartbeat_producer: 100\n"
      "  tpdo:\n"
      "    1: {transmission: 1, cob_id: auto, mapping: [0x6041, 0x6064]}\n"
      "    2: {transmission: 1, cob_id: auto, mapping: [0x606C, 0x6077, 0x6061]}\n"
      "    3: {enabled: false}\n    4: {enabled: false}\n"
      "  rpdo:\n"
      "    1: {transmission: 1, cob_id: auto, mapping: [0x6040, 0x607A]}\n"
      "    2: {transmission: 1, cob_id: auto, mapping: [0x6060]}\n"
      "    3: {enabled: false}\n    4: {enabled: false}\n"
      "nodes:\n";
  for (unsigned node = 1; node <= count; ++node) {
    const std::string number = std::to_string(node);
    text += "  a" + number + ": {<<: *axis, node_id: " + number + "}\n";
  }
  return text;
}

BusPlan plan_of(unsigned count, unsigned period_us, const std::string& master = "") {
  const test::Folder folder;
  LoadedNetwork network =
      load_network(folder.write("network.yaml", drives(count, period_us, master)));
  EXPECT_FALSE(has_error(network.findings));
  return network.plan;
}

TEST(ServiceFrames, OfTheDefaultNeverMakeADriveTooLate) {
  for (const unsigned period_us : {60'000U, 70'000U, 80'000U, 100'000U}) {
    const BusPlan plan = plan_of(120, period_us);
    EXPECT_TRUE(bus_fits(plan)) << period_us;
    EXPECT_GE(plan.cycle.service_frames, 4) << period_us;
    EXPECT_LE(plan.cycle.service_frames, 16) << period_us;
  }
  EXPECT_TRUE(bus_fits(plan_of(32, 16'000)));
  EXPECT_TRUE(bus_fits(plan_of(32, 20'000)));
}

TEST(ServiceFrames, OfTheNetworkFileStayAsTheyAreWritten) {
  const BusPlan plan = plan_of(120, 80'000, ", service_frames: 16");

  EXPECT_EQ(plan.cycle.service_frames, 16);
  EXPECT_FALSE(bus_fits(plan));
}

}  // namespace
}  // namespace takt
