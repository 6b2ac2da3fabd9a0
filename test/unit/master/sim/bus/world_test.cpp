#include "master/sim/bus/world.hpp"

#include <gtest/gtest.h>

#include "master/sim/bus/sim_port.hpp"
#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

std::vector<StampedFrame> take_all(SimPort& port) {
  std::array<StampedFrame, 64> frames;
  const std::size_t count = port.receive(frames);
  return {frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(World, DeliversTheBootUpMessageAtItsExactTime) {
  const DeviceTable tables[] = {communicating(5_node).build()};
  World world{tables, {}};
  SimPort port{world};

  ASSERT_TRUE(port.wait_frame(1s));

  const auto frames = take_all(port);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].frame, make_frame(CobId::base(0x705), {0x00}));
  EXPECT_EQ(frames[0].when, 50ms + 55us);  // 52 bits and 3 stuff bits
}

TEST(World, AnswersAnSdoRequestInVirtualTime) {
  const DeviceTable tables[] = {communicating(5_node).build()};
  World world{tables, {}};
  SimPort port{world};
  port.sleep_until(100ms);
  take_all(port);

  const Frame request = make_frame(CobId::base(0x605), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0});
  ASSERT_EQ(port.send({&request, 1}).sent, 1u);

  ASSERT_TRUE(port.wait_frame(1s));
  EXPECT_EQ(take_all(port)[0].frame,
            make_frame(CobId::base(0x585), {0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0, 0}));
  EXPECT_GT(world.now(), 100ms + 200us + 230us);
}

}  // namespace
}  // namespace takt::sim
