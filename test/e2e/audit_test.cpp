#include <gtest/gtest.h>

#include "master/linux/clock.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"
#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

TEST(AuditOnTheBus, ReportsOfDevicesThatNobodyHasConfigured) {
  const Folder folder;
  const std::string bus = "unix:" + (folder / "bus").string();
  const std::string network = slow_network(folder.path()).string();
  const Process devices{{TAKT, "sim", network, "--bus", bus}, folder / "devices"};
  ASSERT_TRUE(devices.says("3 devices on"));

  Ended ended;
  const Time until = monotonic_now() + time_limit;
  do {  // the devices need time to boot
    ended = run({TAKT, "audit", network, "--bus", bus}, folder.path());
  } while (ended.output.find("answer") != std::string::npos && monotonic_now() < until);

  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("present values of the devices, read by SDO"), std::string::npos)
      << ended.output;
  EXPECT_NE(ended.output.find("node 1 shoulder (drive): KEEPS ITS LAST SET-POINTS"),
            std::string::npos)
      << ended.output;
  EXPECT_NE(ended.output.find("1016:01 is 0x00 in the device"), std::string::npos) << ended.output;
}

TEST(AuditOnTheBus, ExitsWith3WhereNobodyAnswers) {
  const Folder folder;
  const std::string network = slow_network(folder.path()).string();

  const Ended ended = run(
      {TAKT, "audit", network, "--timeout", "20", "--bus", "unix:" + (folder / "empty").string()},
      folder.path());

  EXPECT_EQ(ended.exit_code, 3) << ended.output;
}

TEST(AuditOnTheBus, AsksThroughARunningDaemon) {
  const Folder folder;
  const std::string network = slow_network(folder.path()).string();
  DaemonProcess daemon{network};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  const Ended ended =
      run({TAKT, "audit", network, "--live", "--lcm-url", daemon.lcm_url()}, folder.path());

  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  EXPECT_NE(
      ended.output.find("3 safe without the master\npresent values of the devices, read by SDO"),
      std::string::npos)
      << ended.output;
  EXPECT_EQ(ended.output.find("in the device,"), std::string::npos) << ended.output;
}

}  // namespace
}  // namespace takt::test
