#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// The elbow follows the shoulder: with a timeout of 10 s, a busy machine does not end it.
std::vector<std::string> follow(const DaemonProcess& daemon, std::vector<std::string> more) {
  std::vector<std::string> line{TAKT_FOLLOW,      "demo",  "--lcm-url",  daemon.lcm_url(),
                                "--axis",         "elbow", "--velocity", "3",
                                "--timeout",      "10s",   "--wait",     "100s",
                                "--acceleration", "20"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

class Follow : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([this] { return daemon_.all_ready(); }));
  }
  void hear_once() {
    int rounds = 0;
    daemon_.hear([&] { return rounds++ == 1; });
  }

  Folder folder_;
  DaemonProcess daemon_{slow_network(folder_.path())};
};

TEST_F(Follow, TheAxisLocksToAnInputAndIsDisabledAtTheEnd) {
  std::optional<int> code;
  std::string output;
  do {
    Process program{
        follow(daemon_, {"--leader", "shoulder", "--signal", "position_actual_value", "--ratio",
                         "-1/2", "--for", "500ms", "--plot", folder_ / "follow.svg"}),
        folder_ / "follow"};
    code = program.wait([this] { hear_once(); });
    output = program.output();
  } while (code != 0 && missed_cycles(output));
  EXPECT_EQ(code, 0) << output;
  EXPECT_NE(output.find("elbow follows at"), std::string::npos) << output;
  const std::string picture = read_file(folder_ / "follow.svg");
  EXPECT_NE(picture.find(">elbow commanded</text>"), std::string::npos) << picture;
  EXPECT_NE(picture.find("(rad/s²)"), std::string::npos) << picture;
  EXPECT_TRUE(daemon_.hear([&] { return (daemon_.value("elbow", "statusword") & 0x6F) != 0x27; }));
}

TEST_F(Follow, WhatIsWrongIsSaid) {
  Process no_node{follow(daemon_, {"--leader", "wrist", "--for", "1s"}), folder_ / "no_node"};
  EXPECT_EQ(no_node.wait([this] { hear_once(); }), 1);
  EXPECT_NE(no_node.output().find("'wrist' is no node of the bus"), std::string::npos)
      << no_node.output();
  Process no_input{follow(daemon_, {"--leader", "io", "--signal", "light", "--for", "1s"}),
                   folder_ / "no_input"};
  EXPECT_EQ(no_input.wait([this] { hear_once(); }), 1);
  EXPECT_NE(no_input.output().find("has no input 'light'"), std::string::npos) << no_input.output();
  Process no_ratio{follow(daemon_, {"--leader", "shoulder", "--ratio", "1/0"}),
                   folder_ / "no_ratio"};
  EXPECT_EQ(no_ratio.wait([this] { hear_once(); }), 2);
  EXPECT_NE(no_ratio.output().find("1/0 is neither a finite number nor a finite ratio"),
            std::string::npos);
}

}  // namespace
}  // namespace takt::test
