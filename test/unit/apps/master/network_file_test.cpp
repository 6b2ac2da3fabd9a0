#include <chrono>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <takt/network.hpp>

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(NetworkFile, ListsTheNodesAndSignalsOfTheBus) {
  const NetworkFile network = NetworkFile::load(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");

  ASSERT_TRUE(network.usable());
  EXPECT_EQ(network.bus(), "demo");
  EXPECT_EQ(network.interface(), "");
  EXPECT_EQ(network.period(), 2ms);
  ASSERT_EQ(network.nodes().size(), 3U);
  EXPECT_EQ(network.nodes()[0].name, "shoulder");
  ASSERT_EQ(network.signals().size(), 26U);
  const auto position = network.find_input("elbow", 0x6064);
  ASSERT_TRUE(position);
  const ImageSignal& signal = network.signals()[*position];
  EXPECT_EQ(signal.node, "elbow");
  EXPECT_EQ(signal.name, "position_actual_value");
  EXPECT_EQ(signal.unit, "rad");
  EXPECT_EQ(signal.bits, 32);
  EXPECT_FALSE(signal.output);
}

TEST(NetworkFile, FindsAnObjectOnlyInItsDirection) {
  const NetworkFile network = NetworkFile::load(TAKT_SOURCE_DIR "/share/demo/one_axis.yaml");

  EXPECT_TRUE(network.find_input("axis", 0x6041));
  EXPECT_FALSE(network.find_output("axis", 0x6041));
  EXPECT_TRUE(network.find_output("axis", 0x607A));
  EXPECT_FALSE(network.find_output("axis", 0x607A, 1));
  EXPECT_FALSE(network.find_output("other", 0x607A));
}

TEST(NetworkFile, ReportsAllErrorsWithTheirPlaces) {
  const std::string path = testing::TempDir() + "network_file_test.yaml";
  std::ofstream{path} << "master: {node_id: 200}\nnodes:\n  axis: {node_id: 1, dcf: none.eds}\n";

  const NetworkFile network = NetworkFile::load(path);

  EXPECT_FALSE(network.usable());
  ASSERT_GE(network.findings().size(), 2U);
  const NetworkFinding& first = network.findings().front();
  EXPECT_EQ(first.file, path);
  EXPECT_EQ(first.line, 1U);
  EXPECT_TRUE(first.error);
  EXPECT_NE(first.text.find(": error: "), std::string::npos) << first.text;
}

}  // namespace
}  // namespace takt
