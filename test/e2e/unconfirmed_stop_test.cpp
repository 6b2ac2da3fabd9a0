// Exit code 6 means that the ordered stop was not confirmed.
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

/// A daemon and its simulated drives on a unix bus.
class UnconfirmedStop : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));
  }
  /// Kills the drives, so that the daemon does not know whether they move.
  void lose_drives() {
    devices.signal(SIGKILL);
    ASSERT_TRUE(daemon.hear([&] { return daemon.events("heartbeat_lost") >= 2; }));
  }
  /// Loses the drives while an application has enabled and moves them.
  void lose_enabled_drives() {
    const Process move{{TAKT_MOVE, "--lcm-url", daemon.lcm_url(), "--sine", "--for", "60s"},
                       folder / "move"};
    ASSERT_TRUE(move.says("sine of")) << move.output();
    lose_drives();
  }
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const std::filesystem::path network = slow_network(folder.path());
  DaemonProcess daemon{network, {"--bus", bus}};
  const Process devices{{TAKT, "sim", network.string(), "--bus", bus}, folder / "devices"};
};

TEST_F(UnconfirmedStop, OfTaktdIs6WithALineForEachAxis) {
  ASSERT_NO_FATAL_FAILURE(lose_enabled_drives());

  daemon.signal(SIGTERM);

  EXPECT_EQ(daemon.wait(), 6);
  EXPECT_NE(daemon.log().find("the ordered stop was not confirmed: node 1 'shoulder': the drive is "
                              "lost, no answer for "),
            std::string::npos)
      << daemon.log();
  EXPECT_EQ(daemon.events_in_file("axis_not_stopped"), 2U);
}

TEST_F(UnconfirmedStop, IsNoneOfDrivesThatWereNeverEnabled) {
  ASSERT_NO_FATAL_FAILURE(lose_drives());

  daemon.signal(SIGTERM);

  EXPECT_EQ(daemon.wait(), 0) << daemon.log();
  EXPECT_EQ(daemon.events_in_file("axis_not_stopped"), 0U);
}

/// The answer to an NMT stop of the master itself comes after the stop of the axes.
TEST_F(UnconfirmedStop, IsDeclaredByNmtStopOfTheMaster) {
  ASSERT_NO_FATAL_FAILURE(lose_enabled_drives());

  const Ended stop =
      run({TAKT, "nmt", "stop", "127", "--lcm-url", daemon.lcm_url()}, folder.path());

  EXPECT_EQ(stop.exit_code, 1) << stop.output;
  EXPECT_NE(stop.output.find("shoulder: the drive is lost, no answer for "), std::string::npos)
      << stop.output;
}

/// The ramp takes minutes, but the stop may take only one second.
TEST(UnconfirmedStopOfASimulation, HasExitCode6) {
  const Folder folder;
  const auto network = slow_network(folder.path(), [](std::string& text) {
    replace(text, "heartbeat_producer: 100    # ms",
            "heartbeat_producer: 100\n  stop_timeout: 1000");
    replace(text, "{index: 0x6081, value: 100000}",
            "{index: 0x6085, value: 10}\n    - {index: 0x6081, value: 100000}");
  });

  const Ended moving =
      run({TAKT, "simulate", network.string(), "--for", "6s", "--move"}, folder.path());
  EXPECT_EQ(moving.exit_code, 6) << moving.output;
  EXPECT_NE(moving.output.find("shoulder was disabled at "), std::string::npos) << moving.output;

  const Ended resting = run({TAKT, "simulate", network.string(), "--for", "6s"}, folder.path());
  EXPECT_EQ(resting.exit_code, 0) << resting.output;
}

}  // namespace
}  // namespace takt::test
