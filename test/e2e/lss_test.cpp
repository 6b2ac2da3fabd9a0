#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

class TaktLss : public testing::Test {
 protected:
  std::filesystem::path network() {
    const std::string eds = TAKT_SOURCE_DIR "/share/eds/takt_io401.eds";
    const auto node = [&eds](int id, const std::string& more) {
      return "  n" + std::to_string(id) + ": {dcf: " + eds + ", node_id: " + std::to_string(id) +
             ", revision_number: 0x10000, serial_number: " + std::to_string(id + 100) + ", " +
             more + "}\n";
    };
    const auto path = folder_ / "lss.yaml";
    std::ofstream{path} << "bus: {name: lss}\nmaster: {node_id: 127, cycle: 10000}\nnodes:\n"
                        << node(5, "sim: {quirks: [lss]}")
                        << node(6, "lss: true, sim: {quirks: [no_node_id]}")
                        << node(7, "boot: false, sim: {quirks: [no_node_id]}");
    return path;
  }
  Ended lss(const DaemonProcess& daemon, std::vector<std::string> words) {
    words.insert(words.begin(), {TAKT, "lss"});
    words.insert(words.end(), {"--lcm-url", daemon.lcm_url()});
    return run(words, folder_.path());
  }

  Folder folder_;
};

TEST_F(TaktLss, GivesIdsThroughTheDaemon) {
  DaemonProcess daemon{network()};
  ASSERT_TRUE(daemon.hear([&] { return daemon.events_in_file("boot_done") == 2; }))
      << "node 6 has got its id";
  EXPECT_EQ(daemon.events_in_file("lss_assigned"), 1U);

  const Ended found = lss(daemon, {"find"});
  EXPECT_EQ(found.exit_code, 0) << found.output;
  EXPECT_EQ(found.output,
            "vendor 0x0000ABCD  product 0x00000401  revision 0x00010000  serial 0x0000006B\n");
  EXPECT_EQ(lss(daemon, {"set-id", "7", "--store"}).exit_code, 0);
  const Ended nobody = lss(daemon, {"find"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_NE(nobody.output.find("no device without node id"), std::string::npos) << nobody.output;
  const Ended asked = lss(daemon, {"inquire", "--vendor", "0xABCD", "--product", "0x401",
                                   "--revision", "0x10000", "--serial", "107"});
  EXPECT_NE(asked.output.find("node id 7"), std::string::npos) << asked.output;
}

TEST_F(TaktLss, RefusesToActivateABitRateUnderARunningDaemon) {
  DaemonProcess daemon{network()};
  const Ended refused = lss(daemon, {"set-bitrate", "500", "--all", "--activate", "500"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.output.find("stop taktd, and give --all and --bus"), std::string::npos)
      << refused.output;
}

}  // namespace
}  // namespace takt::test
