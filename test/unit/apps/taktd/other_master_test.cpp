#include "apps/taktd/other_master.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

/// Makes the status of another taktd that runs a bus with the same name.
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
  EXPECT_THAT(other.warnings(), ElementsAre(HasSubstr("another node produces SYNC (COB-ID 0x80)")));
}

TEST_F(OtherMasterTest, MayMakeTheSyncThatThisOneFollows) {
  plan.cycle.sync_followed = true;

  other.on_frame(make_frame(CobId::base(0x080), {}));

  EXPECT_THAT(other.warnings(), IsEmpty());
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

TEST_F(OtherMasterTest, IsOnlyWarnedOfByAStatusWhereTheBusHasKeys) {
  OtherMaster keyed{plan, "can0", 8, OtherMaster::StatusCounts::as_warning};

  keyed.on_frame(make_frame(CobId::base(0x080), {}));
  for (int i = 0; i < 3; ++i) keyed.on_status(status_of_another(), now);

  EXPECT_FALSE(keyed.refusal());
  EXPECT_THAT(
      keyed.warnings(),
      ElementsAre(
          HasSubstr("produces SYNC"),
          HasSubstr("a taktd on can1, session 7. The message is unsigned, so this master starts")));
}

TEST_F(OtherMasterTest, ShowsAForeignInterfaceWithoutControlCharactersAndCutToSize) {
  status_t status = status_of_another();
  status.interface = "\x1b[2Jcan\n" + std::string(1000, 'x');

  other.on_status(status, now);

  ASSERT_TRUE(other.refusal());
  EXPECT_THAT(*other.refusal(), HasSubstr("a taktd on ?[2Jcan?xxx"));
  EXPECT_EQ(other.refusal()->find('\x1b'), std::string::npos);
  EXPECT_LT(other.refusal()->size(), 300U);
}

TEST_F(OtherMasterTest, IsListenedForAtLeastASecondWhateverTheHeartbeatOfThisOneIs) {
  for (const Time heartbeat : {0ms, 100ms, 400ms}) {
    plan.master_heartbeat = heartbeat;
    EXPECT_EQ(other.listening_time(), 1100ms);
  }
}

TEST_F(OtherMasterTest, IsListenedForLongerThanItsHeartbeatTakesAndNotForEver) {
  plan.master_heartbeat = 3s;
  EXPECT_EQ(other.listening_time(), 3300ms);
  plan.master_heartbeat = 60s;
  EXPECT_EQ(other.listening_time(), 5s);
}

}  // namespace
}  // namespace takt
