// `takt sdo download` and `takt sdo upload` transfer a file through a daemon.
#include <fstream>
#include <gtest/gtest.h>

#include "master/core/node_status.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// At 125 kbit/s a file of this size takes seconds, so there is progress to report.
TEST(FileProgress, IsReportedOnTheWayAndAtTheEnd) {
  const Folder folder;
  std::ofstream{folder / "network.yaml"}
      << "bus: {name: e2e, bitrate_kbit: 125}\n"
         "master: {node_id: 127, sync_period: 10000}\n"
         "nodes: {store: {node_id: 5, dcf: " TAKT_SOURCE_DIR
         "/test/vcan/domain_device.eds,\n"
         "                mandatory: true, heartbeat_producer: 200}}\n";
  DaemonProcess daemon{folder / "network.yaml"};
  const auto ready = [&] {  // the device has no PDO, so no image comes
    const auto& status = daemon.bus().status();
    return status && !status->nodes.empty() &&
           status->nodes[0].boot_state == static_cast<int>(BootState::ready);
  };
  ASSERT_TRUE(daemon.hear(ready)) << daemon.log();
  std::string content(10'000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 7 % 251);
  std::ofstream{folder / "there.bin", std::ios::binary} << content;
  const auto transfer = [&](const std::string& verb, const std::string& file) {
    return run({TAKT, "sdo", verb, "store", "2000", (folder / file).string(), "--lcm-url",
                daemon.lcm_url()},
               folder.path());
  };

  const Ended down = transfer("download", "there.bin");
  EXPECT_EQ(down.exit_code, 0) << down.output;
  EXPECT_NE(down.output.find(" of 10000 bytes, "), std::string::npos) << down.output;
  EXPECT_NE(down.output.find(" %, "), std::string::npos) << down.output;
  EXPECT_NE(down.output.find("10000 bytes in "), std::string::npos) << down.output;

  const Ended up = transfer("upload", "back.bin");
  EXPECT_EQ(up.exit_code, 0) << up.output;
  EXPECT_NE(up.output.find(" of 10000 bytes, "), std::string::npos) << "announced: " << up.output;
  EXPECT_NE(up.output.find(" byte/s\n"), std::string::npos) << "on the way: " << up.output;
  EXPECT_NE(up.output.find("10000 bytes in "), std::string::npos) << up.output;
  EXPECT_EQ(read_file(folder / "back.bin"), content);
}

}  // namespace
}  // namespace takt::test
