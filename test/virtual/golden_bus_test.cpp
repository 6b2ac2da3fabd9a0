// A boot of two nodes and ten cycles with the commands of an application, exact to the microsecond
// and the byte. A person has reviewed the recording; see the remarks in it.
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "test/virtual/rig.hpp"

namespace takt::test {
namespace {

/// Writes `(seconds) id#data` for each frame, with the time of the end of the frame, as a receiver
/// stamps it.
std::string text_of(const std::vector<sim::WireFrame>& frames, Time begin) {
  std::string text;
  for (const sim::WireFrame& wire : frames) {
    std::array<char, 64> line{};
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(wire.end - begin).count();
    std::snprintf(line.data(), line.size(), "(%" PRId64 ".%06" PRId64 ") %03X#", us / 1'000'000,
                  us % 1'000'000, wire.frame.id.id());
    text += line.data();
    for (const std::uint8_t byte : wire.frame.payload()) {
      std::snprintf(line.data(), line.size(), "%02X", byte);
      text += line.data();
    }
    text += '\n';
  }
  return text;
}

/// Reads the recording without blank lines and without remarks after `;`.
std::string golden() {
  std::ifstream in{TAKT_SOURCE_DIR "/test/virtual/data/boot_and_ten_cycles.log"};
  std::string text;
  for (std::string line; std::getline(in, line);) {
    line.erase(std::min(line.find(';'), line.size()));
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) text += line + '\n';
  }
  return text;
}

TEST(GoldenBus, BootOfTwoNodesAndTenCyclesAreThese) {
  Rig rig{axes({.nodes = 2})};
  const Time begin = rig.world->now();
  ASSERT_TRUE(rig.boot());

  for (int i = 0; i < 10; ++i) {
    rig.command_all(0x000F, 1000 + i);
    rig.cycle();
  }

  EXPECT_EQ(text_of(rig.recorder.frames, begin), golden());
}

}  // namespace
}  // namespace takt::test
