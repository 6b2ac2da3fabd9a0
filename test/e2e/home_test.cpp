#include <cmath>
#include <csignal>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// The shoulder homes at its present position. The elbow homes by a switch, or by a method that its
/// drive does not have; it leaves the switch at `speed_zero`, rad/s.
std::filesystem::path homing_network(const std::filesystem::path& folder,
                                     const std::string& method_of_elbow,
                                     const std::string& speed_zero) {
  return slow_network(folder, [&](std::string& text) {
    const auto add = [&](const std::string& node, const std::string& homing) {
      const std::size_t at = text.find(node);
      text.insert(at + node.size(), ", homing: " + homing);
    };
    add("shoulder: {<<: *axis, node_id: 1", "37");
    add("elbow: {<<: *axis, node_id: 2", "{method: " + method_of_elbow +
                                             ", speed_switch: 2, speed_zero: " + speed_zero +
                                             ", "
                                             "acceleration: 20}");
  });
}

/// At this speed, the homing run lasts longer than a busy machine needs for the rest of the test.
const std::string slow = "0.001";

class Home : public ::testing::Test {
 protected:
  void start(const std::string& method_of_elbow, const std::string& speed_zero = "0.5") {
    daemon_.emplace(homing_network(folder_.path(), method_of_elbow, speed_zero));
    ASSERT_TRUE(daemon_->hear([this] { return daemon_->all_ready(); }));
  }
  /// With a timeout of 10 s, a busy machine does not end the homing.
  Process home(std::vector<std::string> more) {
    std::vector<std::string> line{TAKT_HOME,   "demo", "--lcm-url", daemon_->lcm_url(),
                                  "--timeout", "10s",  "--wait",    "100s"};
    line.insert(line.end(), more.begin(), more.end());
    return {line, folder_ / "home"};
  }
  std::optional<int> wait(Process& program) {
    return program.wait([this] { hear_once(); });
  }
  void hear_once() {
    int rounds = 0;
    daemon_->hear([&] { return rounds++ == 1; });
  }
  std::int64_t position(const std::string& node) {
    return daemon_->value(node, "position_actual_value");
  }
  bool is_enabled(const std::string& node) {
    return (daemon_->value(node, "statusword") & 0x6F) == 0x27;
  }
  bool comes_to_rest(const std::string& node) {
    std::int64_t before = position(node) - 1;
    int same = 0;
    return daemon_->hear([&] {
      same = position(node) == before ? same + 1 : 0;
      before = position(node);
      return same > 50;
    });
  }

  Folder folder_;
  std::optional<DaemonProcess> daemon_;
};

TEST_F(Home, HomesAxesAndDisablesThem) {
  start("17");
  Process program = home({"shoulder", "elbow"});
  EXPECT_EQ(wait(program), 0) << program.output();
  EXPECT_NE(program.output().find("shoulder is homed, its position is 0.00"), std::string::npos)
      << program.output();
  EXPECT_NE(program.output().find("elbow is homed, its position is"), std::string::npos);
  EXPECT_TRUE(daemon_->hear([&] { return !is_enabled("shoulder") && !is_enabled("elbow"); }));
  EXPECT_GE(daemon_->events("homed"), 2U);
  EXPECT_EQ(daemon_->events("fallback_begun"), 0U);
}

TEST_F(Home, SaysWhatIsWrongWithAnAxis) {
  start("36");
  Process program = home({"shoulder", "elbow"});
  EXPECT_EQ(wait(program), 1);
  EXPECT_NE(program.output().find("elbow: the drive reports a homing error: bit 13"),
            std::string::npos)
      << program.output();
  EXPECT_NE(program.output().find("shoulder is homed"), std::string::npos);
  EXPECT_NE(program.output().find("elbow is not homed"), std::string::npos);
  EXPECT_TRUE(daemon_->hear([&] { return !is_enabled("elbow"); }));
  Process wrong = home({"wrist"});
  EXPECT_EQ(wait(wrong), 2) << wrong.output();
}

TEST_F(Home, ASignalStopsTheAxis) {
  start("17", slow);
  Process program = home({"elbow"});
  ASSERT_TRUE(daemon_->hear([&] { return std::abs(position("elbow")) > 100; }));
  program.signal(SIGINT);
  EXPECT_EQ(wait(program), 1) << program.output();
  EXPECT_NE(program.output().find("interrupted"), std::string::npos) << program.output();
  EXPECT_TRUE(daemon_->hear([&] { return !is_enabled("elbow"); }));
  EXPECT_TRUE(comes_to_rest("elbow"));
}

/// The program dies in the middle: the drive takes the fallback of `on_timeout`.
TEST_F(Home, WithoutTheProgramTheAxisStops) {
  start("17", slow);
  {
    Process program = home({"elbow"});
    ASSERT_TRUE(daemon_->hear([&] { return std::abs(position("elbow")) > 100; }));
  }
  EXPECT_TRUE(daemon_->hear([&] { return daemon_->events("fallback_begun") > 0; }));
  EXPECT_TRUE(daemon_->hear([&] { return !is_enabled("elbow"); }));
  EXPECT_TRUE(comes_to_rest("elbow"));
}

}  // namespace
}  // namespace takt::test
