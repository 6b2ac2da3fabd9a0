#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>
#include <vector>

#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

struct TimeFrame {
  double when = 0;   // time in the log, in seconds
  std::string data;  // hex
};

std::vector<TimeFrame> time_frames(const SimulationOptions& options) {
  LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/plain301.yaml");
  network.plan.time.period = 1s;
  SimulationOptions with_log = options;
  const test::Folder folder;
  const auto log = folder / "log";
  with_log.candump = log.string();
  simulate(network, with_log);
  std::vector<TimeFrame> frames;
  std::ifstream in{log};
  for (std::string line; std::getline(in, line);) {
    const std::size_t id = line.rfind(' ') + 1;
    if (line.compare(id, 4, "100#") != 0) continue;
    frames.push_back({std::stod(line.substr(1)), line.substr(id + 4)});
  }
  return frames;
}

/// Returns the milliseconds since midnight from the first four bytes, least significant byte first.
long milliseconds_of(const std::string& hex) {
  long value = 0;
  for (int byte = 3; byte >= 0; --byte) {
    value = value << 8 | std::stol(hex.substr(static_cast<std::size_t>(2 * byte), 2), nullptr, 16);
  }
  return value;
}

TEST(TimeOnTheBus, ComesAtOnceAndThenEachSecondAndIsRight) {
  const auto frames = time_frames({.duration = 3500ms});

  ASSERT_EQ(frames.size(), 4u);
  for (const TimeFrame& frame : frames) {
    ASSERT_EQ(frame.data.size(), 12u);
    EXPECT_EQ(frame.data.substr(8), "ED3B") << "2026-01-01 is day 15341";
    EXPECT_EQ(milliseconds_of(frame.data) / 1000, std::lround(std::floor(frame.when)) % 86'400)
        << "the simulated world begins at midnight";
  }
  EXPECT_NEAR(frames[1].when - frames[0].when, 1.0, 0.011) << "in the slack of a cycle of 10 ms";
  EXPECT_NEAR(frames[3].when - frames[0].when, 3.0, 0.011) << "and without drift";
}

TEST(TimeOnTheBus, IsTheSameInEachRun) {
  const auto first = time_frames({.duration = 2500ms});
  const auto second = time_frames({.duration = 2500ms});

  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].data, second[i].data);
}

}  // namespace
}  // namespace takt
