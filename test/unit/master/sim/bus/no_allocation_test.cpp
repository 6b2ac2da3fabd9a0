#include <gtest/gtest.h>

#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"
#include "test/support/counted_new.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

TEST(WorldAllocation, HappensOnlyInTheConstructorHoweverOftenDevicesBoot) {
  std::vector<DeviceTable> tables;
  for (std::uint8_t id = 1; id <= 8; ++id) {
    tables.push_back(communicating(*NodeId::from(id))
                         .pdo(0x1800, 0x180u + id, 1, {0x20100020})
                         .pdo(0x1400, 0x200u + id, 1, {0x20100020})
                         .build());
  }
  World world{tables, {}};
  SimPort port{world};
  const std::uint64_t before = allocations();

  std::size_t frames = 0;
  std::array<StampedFrame, 64> received;
  for (int boot = 0; boot < 5; ++boot) {
    const Frame reset = make_frame(CobId::base(0), {0x81, 0});
    port.sleep_until(port.now() + 200ms);
    frames += port.receive(received);
    port.send({&reset, 1});
  }

  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(frames, 5U * 8U) << "a boot-up message of each device, each time";
}

}  // namespace
}  // namespace takt::sim
