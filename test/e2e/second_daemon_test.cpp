#include <array>
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>

#include "master/linux/clock.hpp"
#include "master/linux/unix_bus/unix_bus.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// A private bus for each test. The messages that a daemon listens for before its start almost
/// always come in time. If the machine was too busy for that, the test starts the daemon once more.
class SecondDaemon : public testing::Test {
 protected:
  std::string bus() const { return "unix:" + (folder_ / "bus").string(); }
  std::vector<std::string> start() const {
    return {TAKTD, slow_network(folder_.path()).string(), "--bus", bus(), "--lcm-url", "memq://"};
  }
  static bool before(Time until) { return monotonic_now() < until; }

  const Folder folder_;
  const Time time_limit_ = monotonic_now() + 60s;
};

TEST_F(SecondDaemon, IsRefusedByNameAndDoesNotTouchTheBus) {
  DaemonProcess first{slow_network(folder_.path()), {"--bus", bus()}};
  ASSERT_TRUE(first.hear([&] { return first.bus().images() > 0; }));

  const Ended second = run(start(), folder_.path());

  EXPECT_EQ(second.exit_code, 3);
  EXPECT_NE(second.output.find("is the master of this bus already"), std::string::npos)
      << second.output;
  EXPECT_EQ(first.events_in_file("foreign_nmt"), 0U);
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait(), 0);
}

TEST_F(SecondDaemon, MayObserve) {
  DaemonProcess first{slow_network(folder_.path()), {"--bus", bus()}};
  ASSERT_TRUE(first.hear([&] { return first.bus().images() > 0; }));
  std::vector<std::string> arguments = start();
  arguments.insert(arguments.end(), {"--observe", "--for", "100ms"});

  const Ended second = run(arguments, folder_.path());

  EXPECT_EQ(second.exit_code, 0) << second.output;
}

/// The second daemon uses another bus with the same name, and thus the same channels.
TEST_F(SecondDaemon, OfTheSameBusNameOnLcmIsRefused) {
  DaemonProcess first{slow_network(folder_.path())};
  ASSERT_TRUE(first.hear([&] { return first.all_ready(); }));

  Ended second;
  while (second.exit_code != 3 && before(time_limit_)) {
    second = run({TAKTD, slow_network(folder_.path()).string(), "--bus", "sim", "--lcm-url",
                  first.lcm_url(), "--for", "100ms"},
                 folder_.path());
  }

  EXPECT_EQ(second.exit_code, 3);
  EXPECT_NE(second.output.find("bus 'demo' has a master on LCM already: a taktd on sim"),
            std::string::npos)
      << second.output;
}

/// Anyone on LCM can send a BUS_STATUS.
TEST_F(SecondDaemon, WithKeysIsOnlyWarnedByAStatusOfTheSameBusName) {
  DaemonProcess first{slow_network(folder_.path())};
  ASSERT_TRUE(first.hear([&] { return first.all_ready(); }));
  const std::string keys = (folder_ / "bus.keys").string();
  ASSERT_EQ(run({TAKT, "keys", "new", keys, "--name", "plant"}, folder_.path()).exit_code, 0);
  const fs::path keyed = slow_network(
      folder_.path(), [&](std::string& text) { text += "\nlcm: {keys: " + keys + "}\n"; });

  Ended second;  // exit code 4: the time is over before the nodes are ready
  const auto is_warned = [&] { return second.output.contains("The message is unsigned"); };
  while (second.exit_code != 3 && !is_warned() && before(time_limit_)) {
    second =
        run({TAKTD, keyed.string(), "--bus", "sim", "--lcm-url", first.lcm_url(), "--for", "100ms"},
            folder_.path());
  }

  EXPECT_NE(second.exit_code, 3) << second.output;
  EXPECT_TRUE(is_warned()) << second.output;
}

TEST_F(SecondDaemon, IsRefusedWhereAMasterOfAnotherKindHasAHeartbeat) {
  auto port = UnixBusPort::open({.path = folder_ / "bus"});
  ASSERT_TRUE(port) << port.error().message;
  const Frame heartbeat = make_frame(CobId::base(0x77F), {0x05});
  std::vector<std::string> arguments = start();
  arguments.insert(arguments.end(), {"--for", "100ms"});

  std::optional<int> ended;
  std::string output;
  std::size_t heard = 0;
  while (ended != 3 && before(time_limit_)) {
    Process second{arguments, folder_ / "log"};
    heard = 0;
    ended = second.wait([&] {
      std::array<StampedFrame, 64> some;
      port->send({&heartbeat, 1});
      heard += port->receive(some);
    });
    output = second.output();
  }

  EXPECT_EQ(ended, 3);
  EXPECT_NE(output.find("node 127, the id of the master, has a heartbeat on the bus"),
            std::string::npos)
      << output;
  EXPECT_EQ(heard, 0U) << "frames of a daemon that was refused";
}

}  // namespace
}  // namespace takt::test
