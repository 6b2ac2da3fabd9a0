// `takt emcy` reads the EMCY history of a simulated device.
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// A device without 0x1019 does not expect a SYNC with a counter and reports EMCY 8240.
TEST(EmcyHistory, IsReadFromTheDaemon) {
  const Folder folder;
  std::ofstream{folder / "network.yaml"}
      << "bus: {name: e2e, bitrate_kbit: 500}\n"
         "master: {node_id: 127, sync_period: 10000, sync_overflow: 10}\n"
         "nodes: {plain: {node_id: 5, dcf: " TAKT_SOURCE_DIR
         "/share/eds/plain301.eds,\n"
         "                mandatory: true, heartbeat_producer: 200}}\n";
  DaemonProcess daemon{folder / "network.yaml"};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  const auto takt = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {TAKT, "emcy"});
    arguments.insert(arguments.end(), {"--lcm-url", daemon.lcm_url()});
    return run(std::move(arguments), folder.path());
  };
  ASSERT_TRUE(daemon.hear([&] { return daemon.bus().status()->nodes[0].emcy_count != 0; }))
      << daemon.log();

  const Ended reported = takt({"plain"});
  EXPECT_EQ(reported.exit_code, 0) << reported.output;
  EXPECT_NE(reported.output.find("node 5 plain"), std::string::npos) << reported.output;
  EXPECT_NE(reported.output.find("0x8240  SYNC of unexpected length"), std::string::npos)
      << reported.output;

  const auto json = nlohmann::json::parse(takt({"--json"}).output, nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["bus"], "e2e");
  ASSERT_FALSE(json["emcys"].empty()) << json;
  EXPECT_EQ(json["emcys"][0]["node_id"], 5);
  EXPECT_EQ(json["emcys"][0]["code"], 0x8240);
  EXPECT_EQ(json["emcys"][0]["manufacturer"].size(), 5U);

  EXPECT_NE(takt({"nobody"}).exit_code, 0);

  ::setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
  const Ended seen = takt({"--acknowledge"});
  EXPECT_EQ(seen.exit_code, 0) << seen.output;
  EXPECT_NE(seen.output.find("0x8240"), std::string::npos) << seen.output;
  const Ended rest = takt({});
  const Ended all = takt({"--all"});
  const auto marked = nlohmann::json::parse(takt({"--json"}).output, nullptr, false);
  ::unsetenv("XDG_STATE_HOME");
  EXPECT_NE(rest.output.find("are left out"), std::string::npos) << rest.output;
  EXPECT_NE(all.output.find("0x8240"), std::string::npos) << all.output;
  ASSERT_TRUE(marked.is_object() && !marked["emcys"].empty());
  EXPECT_EQ(marked["emcys"][0]["acknowledged"], true) << marked;
}

}  // namespace
}  // namespace takt::test
