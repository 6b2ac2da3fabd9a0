#include "apps/takt/simulate/program/virtual_daemon.hpp"

#include <array>
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(VirtualDaemon, HearsNothingFromBeforeItsStart) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  sim::World world{network.devices, {.bitrate = network.plan.bitrate}};
  VirtualClocks clocks{world};
  VirtualLcm lcm{world, sim::Random{1}};
  Stage stage;
  StagedPort port{world, {}, stage, [](std::span<const Frame>, Time) {}};
  VirtualDaemon daemon{network.plan, port, lcm, clocks, sim::Random{2}};
  port.sleep_until(2s);
  ASSERT_TRUE(port.wait_frame(2s)) << "boot-up messages";

  daemon.start();

  std::array<StampedFrame, 8> frames;
  EXPECT_EQ(port.receive(frames), 0U);
}

}  // namespace
}  // namespace takt
