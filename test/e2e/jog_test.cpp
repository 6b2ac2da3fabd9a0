#include <csignal>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/e2e/terminal.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// Slow enough for the range of positions not to end the jog within the time limit of a test.
const std::string velocity = "0.3";

/// A jog of the shoulder. With a timeout of 10 s, a busy machine does not end it.
std::vector<std::string> jog(const DaemonProcess& daemon, std::vector<std::string> more) {
  std::vector<std::string> line{TAKT_JOG,    "demo",     "--lcm-url",  daemon.lcm_url(),
                                "--axis",    "shoulder", "--velocity", velocity,
                                "--timeout", "10s",      "--wait",     "100s"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

class Jog : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([this] { return daemon_.all_ready(); }));
  }
  std::int64_t position() { return daemon_.value("shoulder", "position_actual_value"); }
  bool is_enabled() { return (daemon_.value("shoulder", "statusword") & 0x6F) == 0x27; }
  /// Waits until the terminal shows this text. The daemon's hub cuts off a test that does not read.
  bool shows(Terminal& terminal, const std::string& text) {
    return terminal.shows(text, [this] { hear_once(); });
  }
  void hear_once() {
    int rounds = 0;
    daemon_.hear([&] { return rounds++ == 1; });
  }
  /// Waits until the position has been the same in several images.
  bool comes_to_rest() {
    std::int64_t before = position() - 1;
    int same = 0;
    return daemon_.hear([&] {
      same = position() == before ? same + 1 : 0;
      before = position();
      return same > 50;
    });
  }

  Folder folder_;
  DaemonProcess daemon_{slow_network(folder_.path())};
};

TEST_F(Jog, MovesWhileTheKeyIsRepeatedAndStopsAfterwards) {
  Terminal terminal{jog(daemon_, {"--first", "2s", "--dead-man", "1s"})};
  ASSERT_TRUE(shows(terminal, "shoulder is stopped at 0.0000 rad"));
  const std::int64_t begin = position();

  EXPECT_TRUE(
      daemon_.work([&] { terminal.press("\033[C"); }, [&] { return position() > begin + 200; }));
  EXPECT_TRUE(shows(terminal, "shoulder moves at"));
  EXPECT_TRUE(shows(terminal, "shoulder is stopped at")) << "nobody presses a key";
  EXPECT_TRUE(comes_to_rest());
  EXPECT_TRUE(is_enabled());

  const std::int64_t middle = position();
  EXPECT_TRUE(
      daemon_.work([&] { terminal.press("h"); }, [&] { return position() < middle - 100; }));
  terminal.press("q");
  EXPECT_TRUE(shows(terminal, "shoulder is disabled at"));
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_TRUE(terminal.is_as_before());
  EXPECT_TRUE(daemon_.hear([&] { return !is_enabled(); }));
}

TEST_F(Jog, EndsWithASignalAndStopsTheAxisFirst) {
  Terminal terminal{jog(daemon_, {"--first", "100s", "--dead-man", "100s"})};
  ASSERT_TRUE(shows(terminal, "shoulder is stopped at"));
  terminal.press("l");
  EXPECT_TRUE(shows(terminal, "shoulder moves at"));
  terminal.signal(SIGINT);
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_TRUE(terminal.is_as_before());
  EXPECT_TRUE(comes_to_rest());
  EXPECT_FALSE(is_enabled());
  EXPECT_EQ(daemon_.events("fallback_begun"), 0U);
}

TEST_F(Jog, MovesForATimeWithoutAKeyboard) {
  std::optional<int> code;
  std::string output;
  do {
    Process program{jog(daemon_, {"--for", "500ms"}), folder_ / "jog"};
    code = program.wait([this] { hear_once(); });
    output = program.output();
  } while (code != 0 && missed_cycles(output));
  EXPECT_EQ(code, 0) << output;
  EXPECT_TRUE(daemon_.hear([&] { return position() > 0 && !is_enabled(); }));
}

/// The program dies with the key still pressed: taktd stops the axis. On a busy machine, missed
/// cycles may stop it earlier. It never moves on to the end of its range.
TEST_F(Jog, StopsWithoutTheProgram) {
  {
    Terminal terminal{jog(daemon_, {"--first", "100s", "--dead-man", "100s"})};
    ASSERT_TRUE(shows(terminal, "shoulder is stopped at"));
    EXPECT_TRUE(daemon_.work([&] { terminal.press("l"); }, [&] { return position() > 50; }));
  }
  EXPECT_TRUE(daemon_.hear([&] { return daemon_.events("motion_stopped") > 0; }));
  EXPECT_EQ(daemon_.events("motion_stopped", "the end of the range of positions is near"), 0U);
  EXPECT_TRUE(comes_to_rest());
}

TEST_F(Jog, SaysWhyItDoesNotMove) {
  Process wrong_axis{{TAKT_JOG, "demo", "--lcm-url", daemon_.lcm_url(), "--axis", "wrist",
                      "--velocity", "1", "--for", "1s", "--wait", "100s"},
                     folder_ / "wrong_axis"};
  EXPECT_EQ(wrong_axis.wait(), 2);
  EXPECT_NE(wrong_axis.output().find("the axes are: shoulder, elbow"), std::string::npos);
  Process too_fast{{TAKT_JOG, "demo", "--lcm-url", daemon_.lcm_url(), "--axis", "elbow",
                    "--velocity", "4000", "--for", "1s", "--wait", "100s"},
                   folder_ / "too_fast"};
  EXPECT_EQ(too_fast.wait(), 1);
  EXPECT_NE(too_fast.output().find("refused"), std::string::npos) << too_fast.output();
}

}  // namespace
}  // namespace takt::test
