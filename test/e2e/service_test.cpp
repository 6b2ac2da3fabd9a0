#include <chrono>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>

#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A socket that receives notifications in place of systemd, and the environment variables that
/// name it to a service.
class FakeSystemd {
 public:
  FakeSystemd(const std::filesystem::path& path, std::chrono::microseconds watchdog)
      : fd_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ::setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
  }
  ~FakeSystemd() {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }
  FakeSystemd(const FakeSystemd&) = delete;
  FakeSystemd& operator=(const FakeSystemd&) = delete;

  /// Returns the next message within `limit`; empty if none comes.
  std::string next(Time limit) const {
    pollfd input{.fd = fd_.get(), .events = POLLIN, .revents = 0};
    const timespec pause = to_timespec(limit);
    char bytes[512];
    if (::ppoll(&input, 1, &pause, nullptr) <= 0) return {};
    const ssize_t count = ::recv(fd_.get(), bytes, sizeof bytes, 0);
    return count > 0 ? std::string(bytes, static_cast<std::size_t>(count)) : std::string{};
  }

 private:
  FileDescriptor fd_;
};

TEST(Service, ReportsSystemdThatItIsReadyAliveInTimeAndStopping) {
  constexpr seconds watchdog{4};
  const Folder folder;
  const FakeSystemd systemd{folder / "notify", watchdog};
  DaemonProcess daemon{slow_network(folder.path())};

  const std::string first = systemd.next(seconds{60});
  EXPECT_TRUE(first.starts_with("READY=1\nSTATUS=bus demo on sim")) << first;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(systemd.next(watchdog), "WATCHDOG=1");
  daemon.signal(SIGTERM);
  std::string last = systemd.next(watchdog);
  while (last == "WATCHDOG=1") last = systemd.next(watchdog);
  EXPECT_EQ(last, "STOPPING=1\nEXTEND_TIMEOUT_USEC=10000000");  // 5 s, plus later steps
  EXPECT_EQ(daemon.wait(), 0);
}

/// A network with such a slow SYNC that an ordered stop of a few cycles takes half a second.
std::filesystem::path sleepy_network(const Folder& folder) {
  return slow_network(folder.path(), [](std::string& text) {
    const std::string period = "sync_period: " + std::to_string(slow_period) + " ";
    text.replace(text.find(period), period.size(), "sync_period: 100000 ");
  });
}

class StopSignals : public testing::TestWithParam<int> {};

TEST_P(StopSignals, ASecondOneStopsAtOnceAndSaysWhatWasNotDone) {
  const Folder folder;
  DaemonProcess daemon{sleepy_network(folder)};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); }));

  daemon.signal(SIGTERM);
  ASSERT_TRUE(daemon.says("the ordered stop begins"));
  daemon.signal(GetParam());

  EXPECT_EQ(daemon.wait(), 6);
  EXPECT_NE(daemon.log().find("stopped at once"), std::string::npos);
  EXPECT_EQ(daemon.events("stopped"), 0U);
}

INSTANTIATE_TEST_SUITE_P(Each, StopSignals, testing::Values(SIGTERM, SIGINT),
                         [](const auto& number) {
                           return number.param == SIGINT ? "SIGINT" : "SIGTERM";
                         });

/// True if this machine allows SCHED_FIFO for the test, and therefore for taktd.
bool grants_real_time() {
  const sched_param wanted{.sched_priority = 80};
  if (::sched_setscheduler(0, SCHED_FIFO, &wanted) != 0) return false;
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  return true;
}

std::filesystem::path strict_network(const Folder& folder) {
  return slow_network(folder.path(), [](std::string& text) {
    text += "\nrealtime: {spin_us: 0, late_limit_us: 1}\n";
  });
}

TEST(RealtimeLimit, EndsAnEnforcedRunInOrderWithExitCode5) {
  const Folder folder;
  DaemonProcess daemon{strict_network(folder), {"--bus", "sim", "--rt", "enforce", "--for", "60s"}};

  const auto exit_code = daemon.wait();

  if (!grants_real_time()) {
    EXPECT_EQ(exit_code, 1) << "no start without the real time asked for";
    return;
  }
  EXPECT_EQ(exit_code, 5);
  EXPECT_NE(daemon.log().find("us late, but the limit is 1 us; the ordered stop begins"),
            std::string::npos);
}

TEST(RealtimeLimit, EndsNoRunThatDoesNotEnforceIt) {
  const Folder folder;
  DaemonProcess daemon{strict_network(folder), {"--bus", "sim", "--rt", "try", "--for", "1s"}};

  EXPECT_EQ(daemon.wait(), 0);
}

}  // namespace
}  // namespace takt::test
