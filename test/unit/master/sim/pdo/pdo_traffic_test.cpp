#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

/// One device that is stepped by hand. Frames come out with the time at which they are ready.
class Traffic {
 public:
  explicit Traffic(SampleDevice device) : device_{device.build(), Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    run(100ms);
    clear();
  }

  Device& operator*() { return device_; }
  Device* operator->() { return &device_; }
  void run(Time end) {
    while (device_.deadline() <= end) {
      now_ = std::max(now_ + Time{1}, device_.deadline());
      device_.on_time(now_);
      collect();
    }
    now_ = end;
  }
  void receive(const Frame& frame) {
    device_.on_frame(frame, now_);
    collect();
  }
  void start() { receive(make_frame(CobId::base(0), {1, 5})); }
  void sync(std::uint8_t counter = 0) {
    run(now_ + 1ms);
    Frame frame{.id = CobId::base(0x080)};
    if (counter != 0) frame = make_frame(CobId::base(0x080), {counter});
    receive(frame);
  }
  void set(std::uint16_t index, std::uint64_t value) {
    device_.objects().find({index, 0})->set(value);
  }
  std::uint64_t get(std::uint16_t index) { return device_.objects().find({index, 0})->value; }
  void clear() { frames_.clear(); }
  /// Returns the frames with this identifier since clear().
  std::vector<Transmission> of(std::uint32_t id) const {
    std::vector<Transmission> found;
    for (const Transmission& item : frames_) {
      if (item.frame.id == CobId::base(id)) found.push_back(item);
    }
    return found;
  }
  Time now() const { return now_; }

 private:
  void collect() {
    for (const Transmission& item : device_.out().pending()) frames_.push_back(item);
    device_.out().clear();
  }

  Device device_;
  Time now_{};
  std::vector<Transmission> frames_;
};

SampleDevice with_tpdo(std::uint8_t type) {
  return communicating(5_node).pdo(0x1800, 0x185, type, {0x20110020});
}
SampleDevice with_rpdo(std::uint8_t type) {
  return communicating(5_node).pdo(0x1400, 0x205, type, {0x20100020, 0x20120010});
}

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
