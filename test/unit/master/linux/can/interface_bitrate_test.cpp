// The checks of `takt lss set-bitrate --activate` before it sends the first frame.
#include "master/linux/can/interface_bitrate.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

using testing::HasSubstr;

/// A fake `ip` program that records its arguments and ends with a given exit code.
class InterfaceRights : public testing::Test {
 protected:
  InterfaceRights() { ::setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1); }
  ~InterfaceRights() override { ::setenv("PATH", path_.c_str(), 1); }
  void ip_ends_with(int code) {
    const auto ip = folder_.write("ip", "#!/bin/sh\necho \"$@\" >>" + (folder_ / "asked").string() +
                                            "\nexit " + std::to_string(code) + "\n");
    ::chmod(ip.c_str(), 0755);
  }
  std::string asked() {
    std::ifstream in{folder_ / "asked"};
    return {std::istreambuf_iterator<char>{in}, {}};
  }

  const CanLink link{.name = "can7", .kind = "can", .tx_queue_length = 10};

 private:
  const test::Folder folder_;
  const std::string path_ = std::getenv("PATH");
};

TEST_F(InterfaceRights, AreTriedByACommandThatChangesNothing) {
  ip_ends_with(0);
  EXPECT_EQ(interface_bitrate_error(link), "");
  EXPECT_EQ(asked(), "link set can7 txqueuelen 10\n");
}

TEST_F(InterfaceRights, ThatAreMissingAreExplainedBeforeAnyDeviceChanges) {
  ip_ends_with(2);  // RTNETLINK answers: Operation not permitted
  const std::string declared = interface_bitrate_error(link);
  EXPECT_THAT(declared, HasSubstr("the bit rate of can7 can't be changed"));
  EXPECT_THAT(declared, HasSubstr("needs root, or CAP_NET_ADMIN"));
  EXPECT_THAT(declared, HasSubstr("no device was changed"));
  EXPECT_EQ(asked(), "link set can7 txqueuelen 10\n");
}

}  // namespace
}  // namespace takt
