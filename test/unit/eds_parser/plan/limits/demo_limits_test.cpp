// The networks that people copy from declare what may be commanded.
#include <algorithm>
#include <array>
#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

/// Outputs of these kinds have no range: each of their bits or numbers has a meaning of its own.
enum class NeedsNoLimit : std::uint8_t { controlword, mode_of_operation, digital_output };

struct Kind {
  NeedsNoLimit why;
  std::uint16_t first;  ///< the first and the last index
  std::uint16_t last;
  std::uint8_t sub = any_sub;
  static constexpr std::uint8_t any_sub = 0xFF;
};

constexpr std::array kinds{
    Kind{NeedsNoLimit::controlword, 0x6040, 0x6040},        // CiA 402
    Kind{NeedsNoLimit::controlword, 0x5C9D, 0x5C9D, 1},     // Lenze 8400
    Kind{NeedsNoLimit::controlword, 0x2101, 0x2101, 1},     // Astraada DRV-28
    Kind{NeedsNoLimit::mode_of_operation, 0x6060, 0x6060},  // CiA 402
    Kind{NeedsNoLimit::digital_output, 0x6200, 0x63FF},     // CiA 401
};

bool needs_limit(const Signal& output) {
  return std::ranges::none_of(kinds, [&](const Kind& kind) {
    return output.object.index >= kind.first && output.object.index <= kind.last &&
           (kind.sub == Kind::any_sub || kind.sub == output.object.sub);
  });
}

class Demos : public testing::Test {
 protected:
  Demos() {
    const std::filesystem::path folder = std::string{TAKT_SOURCE_DIR} + "/share/demo";
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    }
  }

  std::vector<std::filesystem::path> files;
};

TEST_F(Demos, DeclareALimitForEachSetPoint) {
  ASSERT_GE(files.size(), 8U);
  for (const auto& file : files) {
    const BusPlan plan = load_network(file).plan;
    const auto& limits = plan.limits.outputs;
    for (std::size_t i = plan.layout.inputs; i < plan.layout.signals.size(); ++i) {
      const Signal& output = plan.layout.signals[i];
      const auto row = std::ranges::find(limits, i, &OutputLimit::signal);
      const bool limited = row != limits.end() && row->high != OutputLimit::none;
      EXPECT_EQ(limited, needs_limit(output))
          << file << ": " << plan.nodes[output.node_index].name << " " << output.name << " "
          << to_string(output.object);
    }
  }
}

TEST_F(Demos, HaveNoLimitThatThePlanProposes) {
  for (const auto& file : files) {
    std::vector<std::string> proposals;
    for (const LimitLine& line : load_network(file).plan.limits.lines) {
      if (line.source == LimitSource::none) proposals.push_back(line.proposal);
    }
    EXPECT_THAT(proposals, testing::IsEmpty()) << file;
  }
}

}  // namespace
}  // namespace takt
