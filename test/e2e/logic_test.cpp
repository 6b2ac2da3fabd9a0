#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

class LogicProgramOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([this] { return daemon_.all_ready(); }));
  }
  /// The command line of takt-logic with these rules.
  std::vector<std::string> logic(const std::string& rules, std::vector<std::string> more = {}) {
    std::ofstream{folder_ / "rules.yaml"} << "rules:\n" << rules;
    std::vector<std::string> line{
        TAKT_LOGIC,       (folder_ / "rules.yaml").string(), "demo", "--wait", "100s", "--lcm-url",
        daemon_.lcm_url()};
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }
  std::int64_t output() {
    for (std::size_t i = 0; i < daemon_.bus().signals().size(); ++i) {
      if (daemon_.bus().signals()[i].name == "outputs_1_to_8") return daemon_.bus().values()[i];
    }
    return 0;
  }
  void hear_once() {
    int rounds = 0;
    daemon_.hear([&] { return rounds++ == 1; });
  }

  Folder folder_;
  DaemonProcess daemon_{slow_network(folder_.path())};
};

TEST_F(LogicProgramOnBus, SetsOutputsAndReleasesThemAtTheEnd) {
  Process program{logic("  - {set: io.outputs_1_to_8.3, when: not shoulder.enabled}\n"
                        "  - {set: io.outputs_1_to_8.0, when: true, on_delay: 100ms}\n"),
                  folder_ / "logic"};
  EXPECT_TRUE(daemon_.hear([&] { return output() == 0b1001; })) << program.output();
  program.signal(SIGINT);
  EXPECT_EQ(program.wait([this] { hear_once(); }), 0) << program.output();
  EXPECT_NE(program.output().find("io.outputs_1_to_8.3 on"), std::string::npos);
  EXPECT_TRUE(daemon_.hear([&] { return daemon_.events("outputs_released") > 0; }))
      << daemon_.log();
}

/// The inputs of the simulated device change by themselves.
TEST_F(LogicProgramOnBus, FollowsInputs) {
  std::string rules;
  for (int i = 0; i < 8; ++i) {
    const std::string bit = std::to_string(i);
    rules += "  - {set: io.outputs_1_to_8." + bit + ", when: io.inputs_1_to_8." + bit + "}\n";
  }
  const Process program{logic(rules), folder_ / "logic"};
  std::int64_t seen = 0;
  EXPECT_TRUE(daemon_.hear([&] {
    seen |= output();
    return (seen & (seen - 1)) != 0;  // at least two bits
  })) << program.output();
}

TEST_F(LogicProgramOnBus, SaysWhatIsWrong) {
  Process wrong{logic("  - {set: io.outputs_1_to_8.0, when: io.light}\n"), folder_ / "wrong"};
  EXPECT_EQ(wrong.wait([this] { hear_once(); }), 2);
  EXPECT_NE(wrong.output().find("rules.yaml:2:38: error: the bus has no signal `io.light`"),
            std::string::npos)
      << wrong.output();
  Process axis{logic("  - {set: shoulder.controlword, when: true}\n"), folder_ / "axis"};
  EXPECT_EQ(axis.wait([this] { hear_once(); }), 2);
  EXPECT_NE(axis.output().find("`shoulder` is an axis"), std::string::npos) << axis.output();
}

}  // namespace
}  // namespace takt::test
