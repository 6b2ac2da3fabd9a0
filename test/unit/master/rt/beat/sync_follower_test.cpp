#include "master/rt/beat/sync_follower.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <vector>

#include "test/unit/master/rt/bus_loop_rig.hpp"

namespace takt {
namespace {

CyclePlan followed(std::uint8_t overflow = 0) {
  CyclePlan plan;
  plan.period = 10ms;
  plan.sync_followed = true;
  plan.sync_timeout = 15ms;
  plan.sync_overflow = overflow;
  return plan;
}

class SyncFollowerTest : public testing::Test {
 protected:
  void use(const CyclePlan& plan) { follower = std::make_unique<SyncFollower>(plan, *events); }
  bool sync(Time when, int counter = -1) {
    Frame frame{.id = CobId::base(0x080)};
    if (counter >= 0) frame = make_frame(CobId::base(0x080), {static_cast<std::uint8_t>(counter)});
    follower->on_sync({.frame = frame, .when = when});
    if (!follower->arrived()) return false;
    EXPECT_EQ(follower->take(), when);
    return true;
  }
  std::vector<Event> reported() {
    std::vector<Event> all;
    for (Event event; events->pop(event);) all.push_back(event);
    return all;
  }
  std::vector<EventKind> kinds() {
    std::vector<EventKind> all;
    for (const Event& event : reported()) all.push_back(event.kind);
    return all;
  }

  using Kinds = std::vector<EventKind>;
  std::unique_ptr<EventQueue> events = std::make_unique<EventQueue>();
  std::unique_ptr<SyncFollower> follower;
};

TEST_F(SyncFollowerTest, LocksToTheFirstSync) {
  use(followed());
  EXPECT_FALSE(follower->locked());
  EXPECT_TRUE(sync(100ms));
  EXPECT_TRUE(follower->locked());
  EXPECT_EQ(kinds(), Kinds{EventKind::sync_back});
}

TEST_F(SyncFollowerTest, MeasuresThePeriodOfAnotherClock) {
  use(followed());
  for (int i = 0; i < 200; ++i) sync(100ms + i * Time{10'002'000});
  EXPECT_GE(follower->period(), Time{10'001'900});
  EXPECT_LE(follower->period(), Time{10'002'000});
}

TEST_F(SyncFollowerTest, IsLostAfterItsTimeOutOnly) {
  use(followed());
  sync(100ms);
  follower->on_silence(114ms, {});
  EXPECT_FALSE(follower->lost());
  follower->on_silence(115ms, {});
  EXPECT_TRUE(follower->lost());
  follower->on_silence(125ms, {});

  const auto all = reported();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].kind, EventKind::sync_lost);
  EXPECT_EQ(all[1].value, 15'000'000);

  EXPECT_TRUE(sync(130ms));
  EXPECT_FALSE(follower->lost());
  const auto back = reported();
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].kind, EventKind::sync_back);
  EXPECT_EQ(back[0].value, 30'000'000);
}

TEST_F(SyncFollowerTest, WaitsForTheFirstSyncWhileNodesBoot) {
  use(followed());
  const std::vector<NodeStatus> booting{{.boot = BootState::booting}};
  const std::vector<NodeStatus> ready{{.boot = BootState::ready}};
  follower->on_silence(0s, booting);
  follower->on_silence(30s, booting);
  EXPECT_FALSE(follower->lost());
  follower->on_silence(30s + 900ms, ready);
  EXPECT_FALSE(follower->lost());
  follower->on_silence(31s, ready);
  EXPECT_TRUE(follower->lost());
  EXPECT_EQ(reported().at(0).value, 0);
}

TEST_F(SyncFollowerTest, ReportsOnceWhereItsCounterJumps) {
  use(followed(4));
  sync(100ms, 3);
  sync(110ms, 4);
  sync(120ms, 1);
  reported();
  sync(130ms, 3);
  const auto all = reported();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].kind, EventKind::sync_jump);
  EXPECT_EQ(all[0].value, 3);
  EXPECT_EQ(all[0].detail, 2u);
  sync(140ms, 4);
  EXPECT_EQ(kinds(), Kinds{});
}

TEST_F(SyncFollowerTest, ReportsOnceThatACounterIsMissingOrTooMuch) {
  use(followed(4));
  sync(100ms);
  sync(110ms);
  EXPECT_EQ(kinds(), (Kinds{EventKind::sync_jump, EventKind::sync_back}));
  use(followed());
  sync(100ms, 1);
  sync(110ms, 2);
  EXPECT_EQ(kinds(), (Kinds{EventKind::sync_jump, EventKind::sync_back}));
}

TEST_F(SyncFollowerTest, BeginsNoCycleWithASecondProducersSync) {
  use(followed());
  sync(100ms);
  reported();
  EXPECT_FALSE(sync(103ms));
  EXPECT_TRUE(sync(110ms));
  EXPECT_FALSE(sync(113ms));
  EXPECT_EQ(kinds(), Kinds{EventKind::sync_early}) << "told once";
}

TEST_F(SyncFollowerTest, ReportsAPeriodThatIsNotTheDeclaredOne) {
  use(followed());
  for (int i = 0; i < 40; ++i) sync(100ms + i * 8ms);
  EXPECT_EQ(kinds(), (Kinds{EventKind::sync_back, EventKind::sync_period}));
  EXPECT_EQ(follower->period(), 10ms);
}

TEST_F(SyncFollowerTest, KeepsTheBeatWhereOneSyncIsLate) {
  use(followed());
  for (int i = 0; i < 5; ++i) sync(100ms + i * 10ms);
  EXPECT_TRUE(sync(153ms));
  EXPECT_EQ(follower->beat(), 150ms);
  EXPECT_TRUE(sync(160ms));
  EXPECT_EQ(follower->beat(), 160ms);
}

TEST_F(SyncFollowerTest, KeepsTheBeatOverASyncThatIsMissing) {
  use(followed());
  for (int i = 0; i < 5; ++i) sync(100ms + i * 10ms);
  sync(163ms);
  EXPECT_EQ(follower->beat(), 160ms);
}

TEST_F(SyncFollowerTest, MovesTheBeatAsFarAsItsTolerance) {
  use(followed());
  sync(100ms);
  sync(110'500us);
  EXPECT_EQ(follower->beat(), 110'500us);
  sync(118ms);
  EXPECT_EQ(follower->beat(), 118ms) << "nothing is early for long";
}

TEST_F(SyncFollowerTest, TakesTheSecondLateSyncInARowForTheBeat) {
  use(followed());
  for (int i = 0; i < 5; ++i) sync(100ms + i * 10ms);
  sync(153ms);
  EXPECT_EQ(follower->beat(), 150ms);
  sync(163ms);
  EXPECT_EQ(follower->beat(), 163ms);
  sync(173ms);
  EXPECT_EQ(follower->beat(), 173ms);
}

TEST_F(SyncFollowerTest, TakesTheFirstSyncAfterALossForTheBeat) {
  use(followed());
  for (int i = 0; i < 5; ++i) sync(100ms + i * 10ms);
  follower->on_silence(170ms, {});
  ASSERT_TRUE(follower->lost());
  sync(173ms);
  EXPECT_EQ(follower->beat(), 173ms);
}

// A bus loop that follows an external SYNC, with two axes and a cycle of 2 ms.

class FollowingLoop : public testing::Test {
 protected:
  explicit FollowingLoop(SyncLoss on_loss = SyncLoss::hold) : loop{plan(on_loss)} {}

  static BusPlan plan(SyncLoss on_loss) {
    BusPlan plan = test::axes();
    plan.cycle.sync_followed = true;
    plan.cycle.sync_timeout = 3ms;
    plan.cycle.on_sync_loss = on_loss;
    return plan;
  }
  /// Queues a SYNC at this time and the two TPDOs 300 and 400 us after SYNC.
  void sync(Time when) {
    loop.port.inbox.push_back({.frame = Frame{.id = CobId::base(0x080)}, .when = when});
    for (const test::FakePort::Answer& answer : loop.port.answers) {
      loop.port.inbox.push_back({.frame = answer.frame, .when = when + answer.after});
    }
  }
  Loop loop;
  Time first = loop.start + 2500us;
};

TEST_F(FollowingLoop, SendsNoSyncAndOutputsAtTheirTimeAfterTheForeignOne) {
  for (int i = 0; i < 20; ++i) {
    sync(first + i * 2001us);  // 500 ppm slow
    loop.run(1);
    if (i == 1) loop.command_all(0x0F, 5000);
  }

  EXPECT_TRUE(loop.port.sent_with(0x080).empty());
  const auto outputs = loop.port.sent_with(0x201);
  ASSERT_GT(outputs.size(), 15u);
  const Time last_sync = first + 19 * 2001us;
  EXPECT_EQ(outputs.back().when, last_sync + loop.plan.cycle.output_deadline);
  EXPECT_EQ(loop.status().cycles_missed, 0u);
  EXPECT_LE(loop.most_calls, 7u);
}

TEST_F(FollowingLoop, SendsOutputsBeforeTheNextSyncWhereOneIsLate) {
  const auto when = [&](int i) { return first + i * 2ms + (i % 3 == 2 ? 500us : 0us); };
  for (int i = 0; i < 30; ++i) {
    sync(when(i));
    loop.run(1);
    if (i == 1) loop.command_all(0x0F, 5000);
  }

  std::vector<Time> outputs;
  for (const auto& sent : loop.port.sent_with(0x201)) outputs.push_back(sent.when);
  for (int i = 3; i < 30; ++i) {
    const Time due = first + i * 2ms + loop.plan.cycle.output_deadline;
    EXPECT_EQ(std::ranges::count(outputs, due), 1) << "SYNC " << i;
  }
  EXPECT_EQ(loop.status().cycles_missed, 0u);
  EXPECT_EQ(loop.status().outputs_skipped, 0u);
}

TEST_F(FollowingLoop, LeavesFramesBehindSyncToTheCycleThatItBegins) {
  for (int i = 0; i < 10; ++i) sync(first + i * 2ms);
  loop.run(10);

  ImageView image;
  ASSERT_TRUE(loop.newest(image));
  EXPECT_EQ(image.missing, 0u);
  EXPECT_EQ(image.sync_time, first + 9 * 2ms);
}

TEST_F(FollowingLoop, HoldsItsOutputsWithoutSyncAndGoesOnWithIt) {
  for (int i = 0; i < 10; ++i) sync(first + i * 2ms);
  loop.run(2);
  loop.command_all(0x0F, 5000);
  loop.run(8);
  const std::size_t before = loop.port.sent_with(0x201).size();
  loop.run(10);
  EXPECT_LE(loop.port.sent_with(0x201).size(), before + 1);
  EXPECT_GE(loop.status().cycles_missed, 1u);

  const Time again = loop.port.now() + 1ms;
  for (int i = 0; i < 5; ++i) sync(again + i * 2ms);
  loop.run(5);
  EXPECT_GT(loop.port.sent_with(0x201).size(), before + 2);
  const auto reported = loop.reported();
  EXPECT_EQ(std::ranges::count(reported, EventKind::sync_lost), 1);
  EXPECT_EQ(std::ranges::count(reported, EventKind::sync_back), 2);
}

class FallingLoop : public FollowingLoop {
 protected:
  FallingLoop() : FollowingLoop{SyncLoss::fallback} {
    for (int i = 0; i < 6; ++i) sync(first + i * 2ms);
    loop.run(2);
    loop.command_all(0x0F, 5000);
    loop.run(10);  // the last cycles have no SYNC
  }
};

TEST_F(FallingLoop, CallsOffTheWritesOfFallbacksWhenSyncIsBack) {
  ASSERT_EQ(loop.network->submitted.size(), 2u);
  EXPECT_EQ(loop.network->submitted[0].object, (ObjectKey{0x6040, 0}));
  EXPECT_TRUE(loop.network->withdrawn.empty());

  sync(loop.port.now() + 1ms);
  loop.run(1);

  EXPECT_EQ(loop.network->withdrawn, std::vector{loop.network->submitted[0].id});
}

TEST_F(FallingLoop, CallsOffTheWritesOfFallbacksWhenItIsToStop) {
  loop.loop->request_stop();
  loop.run(1);
  EXPECT_EQ(loop.network->withdrawn, std::vector{loop.network->submitted.at(0).id});
}

TEST_F(FollowingLoop, TakesTheNewestOfSyncsThatWaitedForIt) {
  for (int i = 0; i < 3; ++i) sync(first + i * 2ms);
  loop.run(3);
  for (int i = 3; i < 9; ++i) sync(first + i * 2ms);
  loop.port.sleep_until(first + 8 * 2ms + 100us);  // the thread was away for six cycles
  loop.run(1);

  ImageView image;
  ASSERT_TRUE(loop.newest(image));
  EXPECT_EQ(image.sync_time, first + 8 * 2ms);
  EXPECT_EQ(loop.status().cycles_missed, 5u);
  EXPECT_GE(loop.exchange->timing.sync_lateness.snapshot().maximum(), 5 * 2ms);
}

}  // namespace
}  // namespace takt
