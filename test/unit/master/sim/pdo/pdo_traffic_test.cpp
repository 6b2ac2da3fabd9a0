#include <gtest/gtest.h>

#include "test/unit/master/sim/device/traffic.hpp"

namespace takt::sim {
namespace {

TEST(Tpdo, EndsAtOnceWhenAFaultInvalidatesItsCobId) {
  Traffic device{with_tpdo(1)};
  device.start();
  device.sync();
  ASSERT_EQ(device.of(0x185).size(), 1u);

  device->objects().find({0x1800, 1})->set(0x8000'0185);
  device->look_at_records();
  device.sync();

  EXPECT_EQ(device.of(0x185).size(), 1u);
}

TEST(Tpdo, Type1IsSentAtEachSyncInOperationalOnly) {
  Traffic device{with_tpdo(1)};
  device.sync();
  EXPECT_TRUE(device.of(0x185).empty());

  device.start();
  device.set(0x2011, 0x11223344);
  device.sync();
  device.sync();

  ASSERT_EQ(device.of(0x185).size(), 2u);
  EXPECT_EQ(device.of(0x185)[0].frame, make_frame(CobId::base(0x185), {0x44, 0x33, 0x22, 0x11}));
}

TEST(Tpdo, TypeNIsSentAtEachNthSync) {
  Traffic device{with_tpdo(3)};
  device.start();

  std::vector<int> sent;
  for (int i = 1; i <= 9; ++i) {
    device.clear();
    device.sync();
    if (!device.of(0x185).empty()) sent.push_back(i);
  }
  EXPECT_EQ(sent, (std::vector{3, 6, 9}));
}

// With n = 3, start = 2 and overflow 10 the PDO is sent at the start SYNC, and then at each third
// SYNC by plain counting.
TEST(Tpdo, StartsWithTheSyncOfItsStartValue) {
  SampleDevice table = with_tpdo(3);
  Traffic device{table};
  device->objects().find({0x1800, 6})->set(2);
  device->objects().find({0x1019, 0})->set(10);
  device.start();

  std::vector<int> sent;
  for (int i = 0; i < 21; ++i) {
    const auto counter = static_cast<std::uint8_t>(i % 10 + 1);
    device.clear();
    device.sync(counter);
    if (!device.of(0x185).empty()) sent.push_back(counter);
  }
  EXPECT_EQ(sent, (std::vector{2, 5, 8, 1, 4, 7, 10}));
}

TEST(Tpdo, Type0IsSentOnceAfterAnEvent) {
  Traffic device{with_tpdo(0)};
  device.start();
  device.sync();
  EXPECT_EQ(device.of(0x185).size(), 1u) << "the state on entering OPERATIONAL";

  device.sync();
  EXPECT_EQ(device.of(0x185).size(), 1u) << "no event, no frame";
  device.set(0x2011, 1);
  device.set(0x2011, 2);
  device.sync();
  device.sync();
  ASSERT_EQ(device.of(0x185).size(), 2u) << "two events, one frame";
  EXPECT_EQ(device.of(0x185)[1].frame.data[0], 2);
}

TEST(Tpdo, Type252AnswersWithWhatWasSampled) {
  Traffic device{with_tpdo(252)};
  device.start();
  const Frame request{.id = CobId::base(0x185), .length = 4, .rtr = true};
  device.receive(request);
  EXPECT_TRUE(device.of(0x185).empty()) << "nothing sampled yet";

  device.set(0x2011, 7);
  device.sync();
  device.set(0x2011, 8);
  device.receive(request);
  ASSERT_EQ(device.of(0x185).size(), 1u);
  EXPECT_EQ(device.of(0x185)[0].frame.data[0], 7);
}

TEST(Tpdo, DoesNotAnswerWhereRtrIsNotAllowed) {
  Traffic device{communicating(5_node).pdo(0x1800, 0x4000'0185, 253, {0x20110020})};
  device.start();
  device.receive({.id = CobId::base(0x185), .length = 4, .rtr = true});

  EXPECT_TRUE(device.of(0x185).empty());
}

TEST(Tpdo, IsDroppedAfterTheSynchronousWindow) {
  Traffic device{with_tpdo(1)};
  device.set(0x1007, 500);
  device.start();
  device.sync();

  EXPECT_EQ(device.of(0x185)[0].expires, device.now() + 500us);
}

// The inhibit time is 10 ms, the event timer 50 ms; events come at 0, 3, 7, 12 and 80 ms.
TEST(Tpdo, FollowsTheTimelineOfInhibitTimeAndEventTimer) {
  const DeviceTable table = with_tpdo(255).build();
  ObjectStore store{table};
  store.find({0x1800, 3})->set(100);
  store.find({0x1800, 5})->set(50);
  Tpdo tpdo{PdoRecord{store, PdoDirection::transmit, 1}};
  Transmitter out;
  std::vector<std::int64_t> sent;
  tpdo.start(0ns);
  std::uint64_t value = 0;

  for (Time now = 0ns; now <= 180ms; now += 1ms) {
    for (const Time event : {0ms, 3ms, 7ms, 12ms, 80ms}) {
      if (event != now) continue;
      store.find({0x2011, 0})->set(++value);
      tpdo.notice(now, out);
    }
    tpdo.on_time(now, out);
    for (std::size_t i = 0; i < out.pending().size(); ++i) sent.push_back(now / 1ms);
    out.clear();
  }

  EXPECT_EQ(sent, (std::vector<std::int64_t>{0, 10, 20, 70, 80, 130, 180}));
}

TEST(Rpdo, OfASynchronousTypeActsAtTheNextSync) {
  for (const std::uint8_t type : std::initializer_list<std::uint8_t>{0, 1, 17, 240}) {
    Traffic device{with_rpdo(type)};
    device.start();
    device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0}));
    device.receive(make_frame(CobId::base(0x205), {3, 0, 0, 0, 4, 0}));
    EXPECT_EQ(device.get(0x2010), 0u) << int{type};

    device.sync();
    EXPECT_EQ(device.get(0x2010), 3u) << int{type};
    EXPECT_EQ(device.get(0x2012), 4u) << int{type};
  }
}

TEST(Rpdo, OfAnEventTypeActsAtOnce) {
  for (const std::uint8_t type : std::initializer_list<std::uint8_t>{254, 255}) {
    Traffic device{with_rpdo(type)};
    device.receive(make_frame(CobId::base(0x205), {9, 0, 0, 0, 0, 0}));
    EXPECT_EQ(device.get(0x2010), 0u) << "not OPERATIONAL";

    device.start();
    device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0}));
    EXPECT_EQ(device.get(0x2010), 1u);
  }
}

TEST(Rpdo, LeavesOutItsDummies) {
  Traffic device{communicating(5_node).pdo(0x1400, 0x205, 255, {0x0005'0008, 0x2012'0010})};
  device.start();
  device.receive(make_frame(CobId::base(0x205), {0xAA, 0x34, 0x12}));
  EXPECT_EQ(device.get(0x2012), 0x1234u);
}

TEST(Rpdo, ThatIsShortIsThrownAwayAndReportedOnce) {
  Traffic device{with_rpdo(255)};
  device.start();
  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2}));
  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2}));

  EXPECT_EQ(device.get(0x2010), 0u);
  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].frame,
            make_frame(CobId::base(0x085), {0x10, 0x82, 0x11, 1, 0, 0, 0, 0}));

  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0}));
  ASSERT_EQ(device.of(0x085).size(), 2u) << "and that it is over";
  EXPECT_EQ(device.of(0x085)[1].frame, make_frame(CobId::base(0x085), {0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Rpdo, ThatIsLongIsUsedAndReported) {
  Traffic device{with_rpdo(255)};
  device.start();
  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0, 3}));

  EXPECT_EQ(device.get(0x2010), 1u);
  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].frame.data[0], 0x20);
}

TEST(Rpdo, IsMissedAfterItsDeadlineOnceItHasCome) {
  Traffic device{with_rpdo(255)};
  device->objects().find({0x1400, 5})->set(20);
  device.start();
  device.run(device.now() + 1s);
  EXPECT_TRUE(device.of(0x085).empty()) << "armed by the first frame only";

  device.receive(make_frame(CobId::base(0x205), {1, 0, 0, 0, 2, 0}));
  device.run(device.now() + 19ms);
  EXPECT_TRUE(device.of(0x085).empty());
  device.run(device.now() + 1s);
  ASSERT_EQ(device.of(0x085).size(), 1u);
  EXPECT_EQ(device.of(0x085)[0].frame.data[0], 0x50);
  EXPECT_EQ(device.of(0x085)[0].frame.data[1], 0x82);
}

}  // namespace
}  // namespace takt::sim
