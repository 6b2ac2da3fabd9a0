#include "apps/taktd/other_master.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Time now = 1'700'000'000s;

BusPlan plan_of_master_127() {
  BusPlan plan;
  plan.name = "lift";
  plan.master_id = NodeId::from(127).value();
  plan.cycle.sync = true;
  plan.cycle.sync_cob_id = CobId::base(0x080);
  plan.master_heartbeat = 400ms;
  return plan;
}

/// Of a taktd that runs a bus of the same name.
status_t status_of_another() {
  status_t status{};
  status.utime = now / 1us - 100'000;
  status.session = 7;
  status.bus = "lift";
  status.interface = "can1";
  status.frames_sent = 12;
  return status;
}

class OtherMasterTest : public testing::Test {
 protected:
  BusPlan plan = plan_of_master_127();
  OtherMaster other{plan, "can0", 8};
};

TEST_F(OtherMasterTest, IsKnownByAHeartbeatOfTheMastersNodeId) {
  other.on_frame(make_frame(CobId::base(0x705), {0x05}));
  EXPECT_FALSE(other.refusal());

  other.on_frame(make_frame(CobId::base(0x77F), {0x05}));

  ASSERT_TRUE(other.refusal());
  EXPECT_THAT(*other.refusal(), HasSubstr("can0: node 127, the id of the master, has a heartbeat"));
}

TEST_F(OtherMasterTest, IsNotAskedForByARemoteRequest) {
  Frame request = make_frame(CobId::base(0x77F), {});
  request.rtr = true;

  other.on_frame(request);

  EXPECT_FALSE(other.refusal());
}

TEST_F(OtherMasterTest, IsOnlyWarnedOfWhereSomebodyElseMakesSync) {
  other.on_frame(make_frame(CobId::base(0x080), {}));

  EXPECT_FALSE(other.refusal());
  ASSERT_TRUE(other.warning());
  EXPECT_THAT(*other.warning(), HasSubstr("somebody else makes SYNC (COB-ID 0x80)"));
}

TEST_F(OtherMasterTest, MayMakeTheSyncThatThisOneFollows) {
  plan.cycle.sync_followed = true;

  other.on_frame(make_frame(CobId::base(0x080), {}));

  EXPECT_FALSE(other.warning());
}

TEST_F(OtherMasterTest, IsKnownByItsStatusOnLcm) {
  other.on_status(status_of_another(), now);

  ASSERT_TRUE(other.refusal());
  EXPECT_THAT(*other.refusal(),
              HasSubstr("bus 'lift' has a master on LCM already: a taktd on can1, session 7"));
}

TEST_F(OtherMasterTest, IsNoOldStatusNoObserverNoOtherBusAndNotThisOne) {
  status_t replayed = status_of_another();
  replayed.utime -= 3600'000'000;
  status_t observes = status_of_another();
  observes.frames_sent = 0;
  status_t pump = status_of_another();
  pump.bus = "pump";
  status_t own = status_of_another();
  own.session = 8;

  for (const status_t& status : {replayed, observes, pump, own}) other.on_status(status, now);

  EXPECT_FALSE(other.refusal());
}

TEST_F(OtherMasterTest, IsListenedForLongerThanItsHeartbeatTakesAndNotForEver) {
  EXPECT_EQ(other.listening_time(), 600ms);
  plan.master_heartbeat = 0ms;
  EXPECT_EQ(other.listening_time(), 150ms);
  plan.master_heartbeat = 60s;
  EXPECT_EQ(other.listening_time(), 1500ms);
}

}  // namespace
}  // namespace takt
