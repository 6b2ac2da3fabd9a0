#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "test/e2e/daemon_process.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// An inverter of a demo network, and the names of its values.
struct Inverter {
  const char* demo;
  const char* node;
  const char* actual_speed;
  const char* speed;  ///< for takt-jog
  std::int64_t counts;
};

/// A copy of a demo network in which a busy machine does not make the commands too old.
std::filesystem::path slow_demo(const std::filesystem::path& folder, const std::string& demo) {
  const std::string shared = TAKT_SOURCE_DIR "/share/";
  std::string text = read_file(shared + "demo/" + demo + ".yaml");
  const auto replace = [&text](const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, text.npos) << what;
    text.replace(at, what.size(), with);
  };
  replace("../eds/", shared + "eds/");
  replace("    mandatory: true\n", "    mandatory: true\n    on_timeout: {after: 10000}\n");
  std::ofstream{folder / "network.yaml"} << text;
  return folder / "network.yaml";
}

class Speed : public testing::TestWithParam<Inverter> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon_.hear([this] { return daemon_.all_ready(); })) << daemon_.log();
  }
  /// A jog that a busy machine does not end.
  std::vector<std::string> jog(const std::string& speed, const std::string& time) const {
    return {TAKT_JOG, daemon_bus_, "--lcm-url", daemon_.lcm_url(), "--velocity", speed, "--for",
            time,     "--wait",    "100s",      "--timeout",       "10s"};
  }
  std::int64_t value(const char* name) { return daemon_.value(GetParam().node, name); }
  bool comes_to(std::int64_t counts) {
    return daemon_.hear([&] { return value(GetParam().actual_speed) == counts; });
  }
  void hear_once() {
    int rounds = 0;
    daemon_.hear([&] { return rounds++ == 1; });
  }

  Folder folder_;
  DaemonProcess daemon_{slow_demo(folder_.path(), GetParam().demo)};
  std::string daemon_bus_ = std::string{GetParam().demo} == "lenze8400" ? "lenze" : "pump";
};

TEST_P(Speed, JogsAnInverterAndStopsIt) {
  Process program{jog(GetParam().speed, "100s"), folder_ / "jog"};
  EXPECT_TRUE(comes_to(GetParam().counts)) << program.output();
  program.signal(SIGINT);
  EXPECT_EQ(program.wait([this] { hear_once(); }), 0) << program.output();
  EXPECT_TRUE(comes_to(0));
  EXPECT_EQ(daemon_.events("fallback_begun"), 0U);
}

TEST_P(Speed, RunsBackward) {
  Process program{jog("-" + std::string{GetParam().speed}, "100s"), folder_ / "jog"};
  const bool has_sign = GetParam().demo != std::string{"astraada_drv28"};
  EXPECT_TRUE(comes_to(has_sign ? -GetParam().counts : GetParam().counts)) << program.output();
  program.signal(SIGINT);
  EXPECT_EQ(program.wait([this] { hear_once(); }), 0) << program.output();
}

TEST_P(Speed, StopsWhenItsProgramDies) {
  {
    Process program{jog(GetParam().speed, "100s"), folder_ / "jog"};
    ASSERT_TRUE(comes_to(GetParam().counts)) << program.output();
    program.signal(SIGKILL);
    program.wait([this] { hear_once(); });
  }
  EXPECT_TRUE(daemon_.hear([this] { return daemon_.events("fallback_begun") > 0; }));
  EXPECT_TRUE(comes_to(0));
}

TEST_P(Speed, SaysWhatItCanNotDo) {
  Process program{jog("120", "1s"), folder_ / "jog"};
  EXPECT_EQ(program.wait([this] { hear_once(); }), 1);
  EXPECT_NE(program.output().find("is above the limit of"), std::string::npos) << program.output();
}

INSTANTIATE_TEST_SUITE_P(
    Families, Speed,
    testing::Values(Inverter{"astraada_drv28", "pump", "output_frequency", "20", 2000},
                    Inverter{"lenze8400", "conveyor", "actual_speed", "25", 4096}),
    [](const auto& inverter) { return std::string{inverter.param.demo}; });

}  // namespace
}  // namespace takt::test
