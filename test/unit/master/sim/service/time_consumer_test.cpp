#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "master/wire/bytes.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

class DeviceTimeOfDay : public testing::Test {
 protected:
  static DeviceTable table(std::uint32_t cob_id) {
    return communicating(5_node)
        .object(0x1012, 0, DataType::unsigned32, Access::rw, cob_id)
        .build();
  }
  void use(std::uint32_t cob_id) {
    device.emplace(table(cob_id), Random{1});
    device->power_on(0ns);
    device->on_time(50ms);
    device->out().clear();
  }
  void hear(Time when) {  // 2000-03-01 12:00:00.000
    device->on_frame(make_frame(CobId::base(0x100), {0x00, 0x2E, 0x93, 0x02, 0x10, 0x17}), when);
  }
  /// Returns the abort code of a write to 0x1012; 0 means success.
  std::uint32_t write(std::array<std::uint8_t, 4> value) {
    device->on_frame(make_frame(CobId::base(0x605),
                                {0x23, 0x12, 0x10, 0x00, value[0], value[1], value[2], value[3]}),
                     100ms);
    const auto& answer = device->out().pending().front().frame.data;
    const std::uint32_t code =
        answer[0] == 0x80 ? load_le<std::uint32_t>(std::span{answer}.subspan(4)) : 0U;
    device->out().clear();
    return code;
  }
  std::optional<Device> device;
};

TEST_F(DeviceTimeOfDay, IsSetByTimeAndGoesOn) {
  use(0x8000'0100);
  EXPECT_FALSE(device->time_of_day().now_ms(60ms));
  hear(60ms);
  // 5904 days and 12 hours
  EXPECT_EQ(device->time_of_day().now_ms(60ms), 510'148'800'000u);
  EXPECT_EQ(device->time_of_day().now_ms(2060ms), 510'148'802'000u);
}

TEST_F(DeviceTimeOfDay, IsNotSetWithoutBit31) {
  use(0x0000'0100);
  hear(60ms);
  EXPECT_FALSE(device->time_of_day().now_ms(60ms));
  EXPECT_EQ(write({0x00, 0x01, 0x00, 0x80}), 0u);
  hear(110ms);
  EXPECT_TRUE(device->time_of_day().now_ms(110ms));
}

TEST_F(DeviceTimeOfDay, KeepsItsIdentifierWhileItListens) {
  use(0x8000'0100);
  EXPECT_EQ(write({0x20, 0x02, 0x00, 0x80}), 0x0609'0030u);
  EXPECT_EQ(write({0x00, 0x01, 0x00, 0x00}), 0u);
  EXPECT_EQ(write({0x20, 0x02, 0x00, 0x80}), 0u);
  EXPECT_EQ(write({0x00, 0x01, 0x00, 0x40}), 0x0609'0030u) << "it makes no TIME";
}

}  // namespace
}  // namespace takt::sim
