// SYNC, heartbeat, NMT and EMCY of a simulated device.
#include <gtest/gtest.h>

#include "test/unit/master/sim/device/traffic.hpp"

namespace takt::sim {
namespace {

TEST(Sync, OfAnUnexpectedLengthIsReportedOnce) {
  Traffic device{with_tpdo(1)};
  device.start();
  for (int i = 0; i < 5; ++i) device.sync(5);

  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].frame,
            make_frame(CobId::base(0x085), {0x40, 0x82, 0x11, 0, 0, 0, 0, 0}));
  EXPECT_EQ(device.of(0x185).size(), 5u) << "it counts as SYNC all the same";
}

TEST(Sync, IsMissedAfterOneAndAHalfPeriods) {
  Traffic device{with_tpdo(1)};
  device.set(0x1006, 100'000);
  device.start();
  device.run(device.now() + 1s);
  EXPECT_TRUE(device.of(0x085).empty()) << "supervision begins with the first SYNC";

  device.sync();
  device.run(device.now() + 149ms);
  EXPECT_TRUE(device.of(0x085).empty());
  device.run(device.now() + 2ms);
  EXPECT_EQ(device.of(0x085).size(), 1u);
}

TEST(Heartbeat, ComesWithThePeriodAfterTheBootUp) {
  SampleDevice table = communicating(5_node);
  DeviceTable built = table.build();
  for (DeviceObject& object : built.objects) {
    if (object.key == ObjectKey{0x1017, 0}) object.value = little_endian(100, 2);
  }
  Device device{built, Random{1}};
  device.power_on(0ns);

  device.on_time(50ms);
  EXPECT_EQ(device.out().pending()[0].frame, make_frame(CobId::base(0x705), {0x00}));
  EXPECT_EQ(device.deadline(), 150ms);
  device.out().clear();
  device.on_time(150ms);
  EXPECT_EQ(device.out().pending()[0].frame, make_frame(CobId::base(0x705), {0x7F}));
}

TEST(Heartbeat, ThatStaysAwayLeadsToPreOperational) {
  Traffic device{with_tpdo(1)};
  device.start();
  device.receive(make_frame(CobId::base(0x605),
                            {0x23, 0x16, 0x10, 0x01, 0x64, 0x00, 0x7F, 0x00}));  // 127, 100 ms
  device.clear();
  device.run(device.now() + 1s);
  EXPECT_EQ(device->state(), DeviceState::operational) << "not yet heard";

  device.receive(make_frame(CobId::base(0x77F), {0x05}));
  device.run(device.now() + 99ms);
  EXPECT_EQ(device->state(), DeviceState::operational);
  device.run(device.now() + 10ms);
  EXPECT_EQ(device->state(), DeviceState::preoperational);
  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].frame,
            make_frame(CobId::base(0x085), {0x30, 0x81, 0x11, 0x7F, 0, 0, 0, 0}));

  device.receive(make_frame(CobId::base(0x77F), {0x05}));
  EXPECT_EQ(device.of(0x085).size(), 2u) << "and is told when it is back";
}

TEST(Heartbeat, LossLeavesTheStateAloneWith1029Of1) {
  Traffic device{with_tpdo(1)};
  device->objects().find({0x1029, 1})->set(1);
  device.start();
  device.receive(make_frame(CobId::base(0x605), {0x23, 0x16, 0x10, 0x01, 0x64, 0x00, 0x7F, 0x00}));
  device.receive(make_frame(CobId::base(0x77F), {0x05}));
  device.run(device.now() + 1s);

  EXPECT_EQ(device->state(), DeviceState::operational);
}

TEST(Nmt, FollowsOnlyCommandsForItself) {
  Traffic device{with_tpdo(1)};
  device.receive(make_frame(CobId::base(0), {1, 6}));
  EXPECT_EQ(device->state(), DeviceState::preoperational);
  device.receive(make_frame(CobId::base(0), {1, 5, 0}));
  EXPECT_EQ(device->state(), DeviceState::preoperational) << "three bytes";
  device.receive(make_frame(CobId::base(0), {1, 0}));
  EXPECT_EQ(device->state(), DeviceState::operational);
  device.receive(make_frame(CobId::base(0), {2, 5}));
  EXPECT_EQ(device->state(), DeviceState::stopped);
  device.clear();
  device.receive(make_frame(CobId::base(0x605), {0x40, 0x18, 0x10, 1, 0, 0, 0, 0}));
  EXPECT_TRUE(device.of(0x585).empty()) << "no SDO when stopped";
}

TEST(Nmt, ResetCommunicationBringsBackTheCommunicationObjectsOnly) {
  Traffic device{with_tpdo(1)};
  device.set(0x1006, 5000);
  device.set(0x2000, 77);
  device.receive(make_frame(CobId::base(0), {0x82, 5}));
  device.run(device.now() + 100ms);

  EXPECT_EQ(device.of(0x705).size(), 1u) << "boot-up";
  EXPECT_EQ(device.get(0x1006), 0u);
  EXPECT_EQ(device.get(0x2000), 77u);

  device.receive(make_frame(CobId::base(0), {0x81, 5}));
  device.run(device.now() + 100ms);
  EXPECT_EQ(device.get(0x2000), 0x1234u);
}

TEST(Emcy, KeepsItsInhibitTime) {
  Traffic device{with_rpdo(255)};
  device.set(0x1015, 100);  // 10 ms
  device.start();
  device.receive(make_frame(CobId::base(0x205), {1}));
  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0}));

  EXPECT_EQ(device.of(0x085).size(), 1u);
  device.run(device.now() + 11ms);
  EXPECT_EQ(device.of(0x085).size(), 2u);
}

TEST(Emcy, FillsTheHistoryNewestFirst) {
  Traffic device{with_rpdo(255)};
  device.start();
  device->fail(0x5000, device.now());
  device->fail(0x6000, device.now());
  device->fail(0x7000, device.now());

  EXPECT_EQ(device->objects().number({0x1003, 0}), 2);
  EXPECT_EQ(device->objects().number({0x1003, 1}), 0x7000);
  EXPECT_EQ(device->objects().number({0x1003, 2}), 0x6000);
  EXPECT_EQ(device->objects().number({0x1001, 0}), 0x81);
}

}  // namespace
}  // namespace takt::sim
