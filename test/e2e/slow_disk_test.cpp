#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "master/linux/file_descriptor.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// The --events file is a pipe that fills up at once and that nobody reads.
TEST(SlowDisk, KeepsTheDaemonFromNothing) {
  const Folder folder;
  const std::string events = folder / "stalled";
  ASSERT_EQ(::mkfifo(events.c_str(), 0600), 0);
  const FileDescriptor pipe{::open(events.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)};
  ASSERT_GT(::fcntl(pipe.get(), F_SETPIPE_SZ, 4096), 0);
  const std::string filler(4096, '\n');
  ASSERT_EQ(::write(pipe.get(), filler.data(), filler.size()), 4096);

  Process daemon{{TAKTD, slow_network(folder.path()).string(), "--bus", "sim", "--lcm-url",
                  "memq://", "--events", events, "--for", "2s"},
                 folder / "log"};

  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  EXPECT_NE(daemon.output().find("the file takes no more lines"), std::string::npos)
      << daemon.output();
}

}  // namespace
}  // namespace takt::test
