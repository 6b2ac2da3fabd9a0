// The expected times follow the FC5101 user manual, page 45: PDO transmission types.
#include <gtest/gtest.h>

#include "test/unit/master/sim/family/family_device.hpp"

namespace takt::sim {
namespace {

using Times = std::vector<int>;

/// Terminals whose inputs repeat the outputs, so that a test can set the inputs.
FamilyDevice terminals() { return {"beckhoff_io.eds", "beckhoff", {.quirks = {"loopback"}}}; }

void outputs(FamilyDevice& device, std::uint8_t low) {
  device.receive(make_frame(CobId::base(0x205), {low, 0}));
}
std::uint64_t value(FamilyDevice& device, ObjectKey key) {
  return device.device().objects().find(key)->value;
}

TEST(BeckhoffIo, SendsDigitalInputsWithEachSyncAndAnalogueOnesWithEachTenth) {
  FamilyDevice device = terminals();
  device.start();

  Times every;
  for (int ms = 5; ms <= 100; ms += 5) {
    device.at(ms);
    device.sync();
    every.push_back(ms);
  }

  EXPECT_EQ(device.times(0x185), every);
  EXPECT_EQ(device.times(0x285), (Times{50, 100}));
}

TEST(BeckhoffIo, Type0SendsOnlyWhatTheSampleAtSyncFindsChanged) {
  FamilyDevice device = terminals();
  device.write({0x1800, 2}, 0, 1);
  device.write({0x1400, 2}, 255, 1);
  device.start();
  device.at(5);
  device.sync();
  device.clear();

  device.at(11);
  outputs(device, 1);
  device.at(12);
  outputs(device, 0);  // a pulse between two SYNCs
  device.at(15);
  device.sync();
  device.at(17);
  outputs(device, 1);
  for (int ms = 20; ms <= 40; ms += 5) {
    device.at(ms);
    device.sync();
  }

  EXPECT_EQ(device.times(0x185), (Times{20}));
  EXPECT_EQ(device.of(0x185)[0], make_frame(CobId::base(0x185), {0x01, 0x00}));
}

TEST(BeckhoffIo, ValuesOfRpdoTypes0To240AreValidAtTheNextSync) {
  for (const std::uint32_t type : {0u, 1u, 17u, 240u}) {
    FamilyDevice device = terminals();
    device.write({0x1400, 2}, type, 1);
    device.start();

    device.at(5);
    outputs(device, 0x55);
    EXPECT_EQ(value(device, {0x6200, 1}), 0u) << type;
    device.at(10);
    device.sync();
    EXPECT_EQ(value(device, {0x6200, 1}), 0x55u) << type;
  }
}

TEST(BeckhoffIo, OutputsTakeTheirErrorStateWhereSyncStaysAway) {
  FamilyDevice device = terminals();
  device.write({0x1006, 0}, 5000, 4);
  device.write({0x6206, 1}, 0x0F, 1);  // the upper four outputs keep their state
  device.write({0x6207, 1}, 0x03, 1);
  device.start();
  device.at(5);
  outputs(device, 0xF0);
  device.receive(make_frame(CobId::base(0x305), {0x34, 0x12, 0x78, 0x56}));
  device.sync();
  EXPECT_EQ(value(device, {0x6200, 1}), 0xF0u);

  device.at(60);

  EXPECT_EQ(value(device, {0x6200, 1}), 0xF3u);
  EXPECT_EQ(value(device, {0x6411, 1}), 0u);
  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].data[0], 0x00);
  EXPECT_EQ(device.of(0x085)[0].data[1], 0x81) << "8100: communication";
}

}  // namespace
}  // namespace takt::sim
