#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <sys/stat.h>
#include <thread>

#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

using namespace std::chrono_literals;

/// A stderr that is full from the start and that nobody reads, as with a paused pager.
class StalledStderr : public testing::Test {
 protected:
  StalledStderr() {
    EXPECT_EQ(::mkfifo((folder_ / "stderr").c_str(), 0600), 0);
    pipe_ = FileDescriptor{::open((folder_ / "stderr").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)};
    EXPECT_GT(::fcntl(pipe_.get(), F_SETPIPE_SZ, 4096), 0);
    const std::string filler(4096, '\n');
    EXPECT_EQ(::write(pipe_.get(), filler.data(), filler.size()), 4096);
  }
  /// Waits for an event of this kind in the file of --events.
  bool happens(const std::string& kind) const {
    const Time until = monotonic_now() + 60s;
    while (read_file(events()).find('"' + kind + '"') == std::string::npos) {
      if (monotonic_now() > until) return false;
      std::this_thread::sleep_for(5ms);
    }
    return true;
  }
  std::string events() const { return folder_ / "events.jsonl"; }

  const Folder folder_;
  FileDescriptor pipe_;
};

TEST_F(StalledStderr, KeepsTheDaemonNeitherFromWorkNorFromStopping) {
  Process daemon{{TAKTD, slow_network(folder_.path()).string(), "--bus", "sim", "--lcm-url",
                  "memq://", "--events", events()},
                 folder_ / "stderr"};
  ASSERT_TRUE(happens("boot_done"));

  daemon.signal(SIGTERM);

  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_TRUE(happens("stopped"));
}

}  // namespace
}  // namespace takt::test
