#include "master/linux/bus/intruder_watch.hpp"

#include <gtest/gtest.h>
#include <memory>

namespace takt {
namespace {

constexpr Time ms = std::chrono::milliseconds{1};
const Frame sync_frame = make_frame(CobId::base(0x080), {});
const Frame rpdo = make_frame(CobId::base(0x205), {0x0F, 0x00});
const Frame tpdo = make_frame(CobId::base(0x185), {0x37, 0x06});
const Frame start_all = make_frame(CobId::base(0x000), {0x01, 0x00});

/// A plan with SYNC, RPDO1 and TPDO1 (type 1) of node 5, and the master's heartbeat as node 127.
BusPlan plan_of_node_5() {
  BusPlan plan;
  plan.pdos.rpdos.push_back({.cob_id = CobId::base(0x205), .node = 5_node});
  plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x185), .node = 5_node, .transmission = 1});
  return plan;
}

class IntruderWatchTest : public testing::Test {
 protected:
  void see(const Frame& frame, Origin origin = Origin::this_machine) {
    watch_.on_frame({.frame = frame, .when = now_}, origin);
  }
  /// The bus thread sends a frame, and the diagnostic socket receives it.
  void send(const Frame& frame) {
    sent_->add({&frame, 1});
    see(frame);
  }
  std::vector<Event> events() {
    watch_.on_drained(*sent_, now_);
    std::vector<Event> all;
    for (Event event; watch_.take(event);) all.push_back(event);
    return all;
  }

  std::unique_ptr<SentFrames> sent_ = std::make_unique<SentFrames>();
  IntruderWatch watch_{plan_of_node_5()};
  Time now_ = 1000 * ms;
};

TEST_F(IntruderWatchTest, IsSilentOverItsOwnTraffic) {
  events();

  for (int cycle = 0; cycle < 1000; ++cycle) {
    now_ += 4 * ms;
    send(sync_frame);
    see(tpdo, Origin::wire);
    send(rpdo);
    EXPECT_TRUE(events().empty()) << cycle;
  }
}

TEST_F(IntruderWatchTest, ReportsASyncFromTheWireAtOnce) {
  events();

  see(sync_frame, Origin::wire);

  const auto reported = events();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::foreign_sync);
  EXPECT_EQ(reported[0].when, 1000 * ms);
}

TEST_F(IntruderWatchTest, ReportsASyncOfAnotherProgramHereByCounting) {
  events();
  send(sync_frame);
  EXPECT_TRUE(events().empty());

  send(sync_frame);
  see(sync_frame);

  const auto reported = events();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::foreign_sync);
}

TEST_F(IntruderWatchTest, ReportsTheCommandOfAForeignNmtMaster) {
  events();

  see(start_all);

  const auto reported = events();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::foreign_nmt);
  EXPECT_EQ(reported[0].bytes[0], 0x01);
}

TEST_F(IntruderWatchTest, ReportsASecondSenderOfAnRpdoWithItsCobId) {
  events();
  send(rpdo);

  see(rpdo, Origin::wire);

  const auto reported = events();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::duplicate_cob_id);
  EXPECT_EQ(reported[0].value, 0x205);
}

TEST_F(IntruderWatchTest, DoesNotMistakeFramesUnderWayForIntruders) {
  events();
  const std::array<Frame, 3> batch{rpdo, rpdo, rpdo};
  sent_->add(batch);  // counted, but still in the queue of the controller

  EXPECT_TRUE(events().empty());
  for (const Frame& frame : batch) see(frame);

  EXPECT_TRUE(events().empty());
}

TEST_F(IntruderWatchTest, StillFindsIntrudersAfterTheSocketHasLostFrames) {
  events();
  const std::array<Frame, 50> lost = [] {
    std::array<Frame, 50> all;
    all.fill(sync_frame);
    return all;
  }();
  sent_->add(lost);  // sent, but never received
  for (int i = 0; i < 30; ++i) {
    now_ += 100 * ms;
    EXPECT_TRUE(events().empty());
  }

  send(sync_frame);
  see(sync_frame);

  EXPECT_EQ(events().size(), 1U);
}

TEST_F(IntruderWatchTest, ReportsTheSameIntruderOnlyOnceInTenSeconds) {
  events();
  int reported = 0;
  for (int i = 0; i < 2100; ++i) {  // 21 s
    now_ += 10 * ms;
    see(sync_frame, Origin::wire);
    reported += static_cast<int>(events().size());
  }
  EXPECT_EQ(reported, 3);
}

TEST_F(IntruderWatchTest, ReportsTwoSendersOfOneTpdo) {
  events();
  std::vector<Event> reported;
  for (int cycle = 0; cycle < 40; ++cycle) {
    now_ += 4 * ms;
    send(sync_frame);
    see(tpdo, Origin::wire);
    see(tpdo, Origin::wire);
    for (const Event& event : events()) reported.push_back(event);
  }

  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::duplicate_cob_id);
  EXPECT_EQ(reported[0].value, 0x185);
  EXPECT_EQ(reported[0].node, 5);
}

TEST_F(IntruderWatchTest, ATpdoThatIsLateAndThenTwiceInACycleIsNoDuplicate) {
  events();
  for (int cycle = 0; cycle < 200; ++cycle) {
    now_ += 4 * ms;
    send(sync_frame);
    if (cycle % 2 == 1) {
      see(tpdo, Origin::wire);
      see(tpdo, Origin::wire);
    }
    EXPECT_TRUE(events().empty());
  }
}

TEST_F(IntruderWatchTest, ReportsTwoNodesThatBothAnswerSdoRequests) {
  events();
  for (int i = 0; i < 3; ++i) {
    send(make_frame(CobId::base(0x605), {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
    see(make_frame(CobId::base(0x585), {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}),
        Origin::wire);
    see(make_frame(CobId::base(0x585), {0x43, 0x00, 0x10, 0x00, 0x91, 0x01, 0x0F, 0x00}),
        Origin::wire);
  }

  const auto reported = events();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::duplicate_cob_id);
  EXPECT_EQ(reported[0].value, 0x585);
  EXPECT_EQ(reported[0].node, 5);
}

TEST_F(IntruderWatchTest, LateAnswersOfASlowNodeAreNoSecondNode) {
  events();
  const Frame request = make_frame(CobId::base(0x605), {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0});
  const Frame answer =
      make_frame(CobId::base(0x585), {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00});
  for (int i = 0; i < 4; ++i) {
    send(request);
    send(request);
    see(answer, Origin::wire);
    see(answer, Origin::wire);
  }

  EXPECT_TRUE(events().empty());
}

TEST_F(IntruderWatchTest, ASdoBlockUploadIsNoSecondNode) {
  events();
  send(make_frame(CobId::base(0x605), {0xA0, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0}));
  for (std::uint8_t segment = 1; segment < 20; ++segment) {
    see(make_frame(CobId::base(0x585), {segment, 1, 2, 3, 4, 5, 6, 7}), Origin::wire);
  }

  EXPECT_TRUE(events().empty());
}

TEST_F(IntruderWatchTest, AbortsOfADeviceByItselfAreNoSecondNode) {
  events();
  for (int i = 0; i < 5; ++i) {
    see(make_frame(CobId::base(0x585), {0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}),
        Origin::wire);
  }

  EXPECT_TRUE(events().empty());
}

TEST(IntruderWatch, WithoutOurSyncSomebodyElseMayBeTheProducer) {
  BusPlan plan;
  plan.cycle.sync = false;
  IntruderWatch watch{plan};

  watch.on_frame({.frame = sync_frame, .when = ms}, Origin::wire);

  Event event;
  EXPECT_FALSE(watch.take(event));
}

}  // namespace
}  // namespace takt
