#include <fstream>
#include <gtest/gtest.h>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// RPDO1 of the io device has five bytes: 0x6200:1, a dummy byte, 0x6200:2.
TEST(DummyEntry, LeavesTheValuesAroundItInTheirPlaces) {
  const Folder folder;
  std::ofstream{folder / "network.yaml"}
      << "bus: {name: e2e, bitrate_kbit: 500}\n"
         "master: {node_id: 127, sync_period: 10000}\n"
         "nodes:\n  io:\n    node_id: 10\n"
         "    dcf: " TAKT_SOURCE_DIR
         "/share/eds/takt_io401.eds\n"
         "    mandatory: true\n    heartbeat_producer: 200\n"
         "    rpdo: {1: {transmission: 1, mapping: [\n"
         "      {index: 0x6200, sub_index: 1}, {index: 0x0005},\n"
         "      {index: 0x6200, sub_index: 2}]}}\n";
  DaemonProcess daemon{folder / "network.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  const auto outputs = [&](const std::string& object) {
    return run({TAKT, "sdo", "read", "io", object, "u8", "--lcm-url", daemon.lcm_url()},
               folder.path())
        .output;
  };
  EXPECT_EQ(outputs("1600:0"), "3\n");
  EXPECT_EQ(run({TAKT, "sdo", "read", "io", "1600:2", "u32", "--lcm-url", daemon.lcm_url()},
                folder.path())
                .output,
            std::to_string(0x0005'0008) + "\n");

  const auto command = [&] {
    daemon.command(
        daemon.command_for("e2e", {{"io.outputs_1_to_8", 0x5A}, {"io.outputs_9_to_16", 0xC3}}));
  };
  const std::string first = std::to_string(0x5A) + "\n";
  const std::string second = std::to_string(0xC3) + "\n";
  EXPECT_TRUE(daemon.work(
      command, [&] { return outputs("6200:1") == first && outputs("6200:2") == second; }))
      << outputs("6200:1") << outputs("6200:2") << daemon.log();
}

}  // namespace
}  // namespace takt::test
