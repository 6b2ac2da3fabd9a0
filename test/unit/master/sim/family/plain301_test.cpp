// The expected times follow the ars-informatica page on TPDO communication parameters and the
// reference timelines of CiA 301.
#include <gtest/gtest.h>

#include "test/unit/master/sim/family/family_device.hpp"

namespace takt::sim {
namespace {

using Times = std::vector<int>;

FamilyDevice plain(std::vector<std::string> quirks = {}) {
  return {"plain301.eds", "plain301", {.quirks = std::move(quirks)}};
}

void change(FamilyDevice& device, std::uint8_t value) {
  device.receive(make_frame(CobId::base(0x205), {value, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Plain301, HasTheFourParametersOfATpdoAndNoOther) {
  FamilyDevice device = plain();

  for (std::uint8_t sub = 0; sub <= 5; ++sub) {
    EXPECT_EQ(device.read({0x1800, sub}), sub == 4 ? 0x06090011u : 0u);
  }
  EXPECT_EQ(device.write({0x1800, 4}, 0, 1), 0x06090011u);
  EXPECT_EQ(device.read({0x1800, 6}), 0x06090011u);
}

TEST(Plain301, EveryTransmissionRestartsTheEventTimer) {
  FamilyDevice device = plain();
  device.write({0x1800, 5}, 50, 2);
  device.start();

  device.at(20);
  change(device, 1);
  device.at(130);

  EXPECT_EQ(device.times(0x185), (Times{0, 20, 70, 120}));
}

TEST(Plain301, OnlyItsExpiryRestartsTheEventTimerByTheOtherReading) {
  FamilyDevice device = plain({"event_timer_raster"});
  device.write({0x1800, 5}, 50, 2);
  device.start();

  device.at(20);
  change(device, 1);
  device.at(130);

  EXPECT_EQ(device.times(0x185), (Times{0, 20, 50, 100}));
}

TEST(Plain301, SendsBetweenInhibitTimeAndEventTime) {
  FamilyDevice device = plain();
  device.write({0x1800, 1}, 0x80000185, 4);
  device.write({0x1800, 3}, 100, 2);
  device.write({0x1800, 5}, 50, 2);
  device.write({0x1800, 1}, 0x00000185, 4);
  device.start();

  std::uint8_t value = 0;
  for (const int ms : {3, 7, 12, 80}) {
    device.at(ms);
    change(device, ++value);
  }
  device.at(200);

  EXPECT_EQ(device.times(0x185), (Times{0, 10, 20, 70, 80, 130, 180}));
}

TEST(Plain301, IsSentAfterEach34thSync) {
  FamilyDevice device = plain();
  device.write({0x1800, 2}, 34, 1);
  device.start();

  for (int ms = 1; ms <= 100; ++ms) {
    device.at(ms);
    device.sync();
  }

  EXPECT_EQ(device.times(0x185), (Times{34, 68}));
}

TEST(Plain301, UpdatesType252AtSyncAndType253AtTheRequest) {
  FamilyDevice device = plain();
  device.write({0x1800, 2}, 252, 1);
  device.start();

  device.at(10);
  device.sync();
  device.at(250);
  change(device, 8);
  device.request(0x185);
  device.request(0x385);

  ASSERT_EQ(device.times(0x185), (Times{250}));
  EXPECT_EQ(device.of(0x185)[0].data[0], 0);
  ASSERT_EQ(device.times(0x385), (Times{250})) << "type 253, the counter of tenths";
}

TEST(Plain301, RefusesTheTypesThatAreNotUsed) {
  FamilyDevice device = plain();

  for (std::uint32_t type = 241; type <= 251; ++type) {
    EXPECT_EQ(device.write({0x1800, 2}, type, 1), 0x06090030u) << type;
  }
}

}  // namespace
}  // namespace takt::sim
