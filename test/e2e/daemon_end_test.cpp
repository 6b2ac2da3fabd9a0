#include <csignal>
#include <gtest/gtest.h>

#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// A private bus without any device.
std::string empty_bus(const Folder& folder) { return "unix:" + (folder / "bus").string(); }

TEST(EndOfTaktd, WithoutAMandatoryNodeIs4AfterTheTimeOfFor) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", empty_bus(folder), "--for", "500ms"}};

  EXPECT_EQ(daemon.wait(), 4);
  EXPECT_NE(daemon.log().find("the time of --for is over, and these mandatory nodes were never "
                              "ready: 1 shoulder, 2 elbow"),
            std::string::npos);
}

/// A node with keep_alive may run without a heartbeat, so its silence alone proves nothing.
TEST(EndOfTaktd, WithoutAMandatoryNodeThatIsKeptAliveComesWhenItWasAskedBySdo) {
  const Folder folder;
  const auto network = slow_network(folder.path(), [](std::string& text) {
    const std::string mandatory = "  mandatory: true\n";
    text.insert(text.find(mandatory), "  reset: keep_alive\n");
  });
  DaemonProcess daemon{network, {"--bus", empty_bus(folder)}};

  EXPECT_EQ(daemon.wait(), 4);

  const std::string log = daemon.log();
  const std::size_t silent = log.find("at the next try the master reads it by SDO");
  ASSERT_NE(silent, std::string::npos) << log;
  EXPECT_NE(log.find("boot begins", silent), std::string::npos) << "no next try: " << log;
  EXPECT_NE(log.find("is mandatory and did not boot"), std::string::npos) << log;
}

TEST(EndOfTaktd, OnASignalWhileAMandatoryNodeIsWaitedForIsGood) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path()), {"--bus", empty_bus(folder)}};
  ASSERT_TRUE(daemon.hear([&] { return daemon.bus().images() > 10; }));

  daemon.signal(SIGTERM);

  EXPECT_EQ(daemon.wait(), 0);
}

TEST(EndOfTaktd, IsInOrderWhenItsTerminalCloses) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path())};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  daemon.signal(SIGHUP);

  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_NE(daemon.log().find("a stop was requested; the ordered stop begins"), std::string::npos);
}

/// A program inherits the ignored signals of its parent.
TEST(EndOfTaktd, IsNotBroughtByASighupUnderNohup) {
  const Folder folder;
  const auto before = std::signal(SIGHUP, SIG_IGN);
  DaemonProcess daemon{slow_network(folder.path())};
  std::signal(SIGHUP, before);
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  daemon.signal(SIGHUP);

  const std::int64_t cycle = daemon.bus().cycle();
  EXPECT_TRUE(daemon.hear([&] { return daemon.bus().cycle() > cycle + 50; }));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(EndOfTaktd, OfOneThatOnlyObservesIsGood) {
  const Folder folder;
  DaemonProcess daemon{slow_network(folder.path()),
                       {"--bus", empty_bus(folder), "--for", "500ms", "--observe"}};

  EXPECT_EQ(daemon.wait(), 0);
}

}  // namespace
}  // namespace takt::test
