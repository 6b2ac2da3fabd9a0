#include "master/core/node/duplicate_node_watch.hpp"

#include <gtest/gtest.h>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

constexpr CobId own_request = CobId::base(0x605);

TEST(DuplicateNodeWatch, ReportsTwiceAsManyHeartbeats) {
  DuplicateNodeWatch watch{100ms, own_request};
  int reported = 0;
  for (Time now = 10s; now < 14s; now += 50ms) reported += watch.on_heartbeat(now).has_value();
  EXPECT_EQ(reported, 1) << "once in ten seconds";
}

TEST(DuplicateNodeWatch, TakesHeartbeatsOfOneDeviceForOne) {
  DuplicateNodeWatch watch{100ms, own_request};
  for (Time now = 10s; now < 60s; now += 100ms)
    EXPECT_FALSE(watch.on_heartbeat(now)) << now.count();
}

TEST(DuplicateNodeWatch, KnowsNothingWithoutAPeriod) {
  DuplicateNodeWatch watch{Time{}, own_request};
  for (Time now = 10s; now < 11s; now += 1ms) EXPECT_FALSE(watch.on_heartbeat(now));
}

TEST(DuplicateNodeWatch, SegmentsOfABlockUploadAreNoSecondAnswers) {
  DuplicateNodeWatch watch{Time{}, own_request};
  watch.on_sdo_requests(std::array{tx({0xA4, 0x08, 0x10, 0x00, 0x7F})});
  for (std::uint8_t segment = 1; segment < 127; ++segment) {
    EXPECT_FALSE(watch.on_sdo_answer(rx({segment, 1, 2, 3, 4, 5, 6, 7}), 10s)) << int{segment};
  }
}

TEST(DuplicateNodeWatch, CountsTheRequestsOfTheChannelThatIsUsed) {
  DuplicateNodeWatch watch{Time{}, CobId::base(0x688)};  // 0x640 + node 72
  for (int i = 0; i < 20; ++i) {
    watch.on_sdo_requests(std::array{make_frame(CobId::base(0x688), {0x40, 0x00, 0x10})});
    EXPECT_FALSE(watch.on_sdo_answer(rx({0x43, 0x00, 0x10, 0, 1, 2, 3, 4}), 10s)) << i;
  }
}

class Twins : public testing::Test, public NetworkRig {
 protected:
  void boot() {
    Steps steps;
    for (int i = 0; i < 10; ++i) {
      steps.object(BootAction::expect, 'C', {0x1000, 0}, bytes({0x92, 0x01, 0x02, 0x00}));
    }
    add(5, std::move(steps.plan));
    device().objects[{0x1000, 0}] = bytes({0x92, 0x01, 0x02, 0x00});
  }
};

TEST_F(Twins, AreReportedByTheirAnswersToOneRequest) {
  boot();
  devices.push_back(devices[0]);
  devices[1].latency = 3ms;
  start();
  run(1s);
  ASSERT_EQ(count(EventKind::duplicate_node), 1);
  EXPECT_NE(describe(plan, *find(EventKind::duplicate_node)).find("two devices have this node id"),
            std::string::npos);
}

TEST_F(Twins, AreNotSeenInOneDevice) {
  boot();
  start();
  run(1s);
  EXPECT_EQ(count(EventKind::duplicate_node), 0);
  EXPECT_EQ(status().boot, BootState::ready);
}

}  // namespace
}  // namespace takt
