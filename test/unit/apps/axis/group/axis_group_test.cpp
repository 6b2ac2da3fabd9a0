#include <gtest/gtest.h>
#include <takt/axis.hpp>

#include "master/lcm/messages.hpp"
#include "test/unit/apps/axis/fake_lcm.hpp"
#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::FakeLcm;
using test::FakeTransport;
using test::image;
using test::status;
using test::two_axes;

class Group : public ::testing::Test {
 protected:
  FakeLcm lcm_;
  AxisGroup group_{std::make_unique<FakeTransport>(lcm_),
                   {.bus = "lift", .sender = "test", .stale_cycles = 5, .time_to_live = 7}};
};

TEST_F(Group, LearnsItsAxesFromTheLayout) {
  EXPECT_EQ(group_.wait(0ns), Input::nothing);
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  EXPECT_EQ(group_.wait(0ns), Input::restarted);
  EXPECT_EQ(group_.axes().size(), 2);
  EXPECT_EQ(group_.period(), 2ms);
}

TEST_F(Group, TakesOnlyTheNewestImageOfAQueue) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  for (std::int64_t cycle = 1; cycle <= 50; ++cycle) {
    lcm_.arrive("LIFT_IMAGE", image(cycle, {0, 0, cycle * 1000, 0}));
  }

  EXPECT_EQ(group_.wait(0ns), Input::fresh);
  EXPECT_DOUBLE_EQ(group_.axes().positions()(0), 50.0);
  EXPECT_EQ(group_.wait(0ns), Input::nothing);
}

TEST_F(Group, CommandsOnItsBusInItsName) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  lcm_.arrive("LIFT_IMAGE", image(3, {0, 0, 0, 0}));
  group_.wait(0ns);

  ASSERT_TRUE(group_.send());
  ASSERT_EQ(lcm_.published.size(), 1U);
  EXPECT_EQ(lcm_.published[0].first, "LIFT_COMMAND");
  const auto command = decode<command_t>(lcm_.published[0].second);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->sender, group_.sender());
  EXPECT_EQ(command->time_to_live, 7);
  EXPECT_EQ(command->cycle, 3);
  EXPECT_NE(command->instance, 0);
}

TEST(GroupThatEnds, ReleasesWhatItCommandedOnce) {
  FakeLcm lcm;
  {
    AxisGroup group{std::make_unique<FakeTransport>(lcm), {.bus = "lift", .sender = "test"}};
    lcm.arrive("LIFT_LAYOUT", two_axes());
    group.wait(0ns);
    lcm.arrive("LIFT_IMAGE", image(3, {0, 0, 0, 0}));
    group.wait(0ns);
    group.send();
    group.release();
  }

  ASSERT_EQ(lcm.published.size(), 2U);
  const auto command = decode<command_t>(lcm.published[0].second);
  const auto release = decode<command_t>(lcm.published[1].second);
  ASSERT_TRUE(command && release);
  EXPECT_EQ(command->release, 0);
  EXPECT_EQ(release->release, 1);
  EXPECT_EQ(release->instance, command->instance);
  EXPECT_EQ(release->session, command->session);
  EXPECT_TRUE(release->signals.empty());
}

TEST_F(Group, ReportsOnceThatTheDaemonIsOfAnOlderTakt) {
  layout_t old = two_axes();
  old.schema = 1;
  for (int i = 0; i < 3; ++i) lcm_.arrive("LIFT_LAYOUT", old);
  EXPECT_EQ(group_.wait(0ns), Input::nothing);

  const auto events = group_.take_events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, "other_schema");
  EXPECT_EQ(
      events[0].text,
      "the daemon sends messages of schema 1 and this program uses schema 2: update the daemon");
}

TEST_F(Group, ReportsThatTheDaemonHasRestarted) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  group_.axes().set_goal(DriveGoal::enabled);
  layout_t again = two_axes();
  again.session = 78;
  lcm_.arrive("LIFT_LAYOUT", again);

  EXPECT_EQ(group_.wait(0ns), Input::restarted);
  EXPECT_EQ(group_.axes().drive(0).goal(), DriveGoal::disabled);
}

TEST_F(Group, IsNotRestartedByAForgedLayoutBetweenImages) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  group_.axes().set_goal(DriveGoal::enabled);
  layout_t forged = two_axes();
  forged.session = 78;
  lcm_.arrive("LIFT_IMAGE", image(3, {0, 0, 1000, 0}));
  lcm_.arrive("LIFT_LAYOUT", forged);

  EXPECT_EQ(group_.wait(0ns), Input::fresh);
  EXPECT_EQ(group_.axes().drive(0).goal(), DriveGoal::enabled);
}

TEST_F(Group, GoesOverToAnotherSessionWhenTheImagesOfTheFirstHaveCeased) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  lcm_.arrive("LIFT_IMAGE", image(3, {0, 0, 1000, 0}));
  group_.wait(0ns);
  layout_t again = two_axes();
  again.session = 78;

  Input input = Input::nothing;
  const auto limit = std::chrono::steady_clock::now() + 60s;
  while (input != Input::restarted && std::chrono::steady_clock::now() < limit) {
    lcm_.arrive("LIFT_LAYOUT", again);
    input = group_.wait(5ms);
  }
  EXPECT_EQ(input, Input::restarted);
  EXPECT_EQ(group_.input().session(), 78);
}

TEST_F(Group, KeepsWhatTheDaemonReports) {
  event_t event{};
  event.kind = "command_refused";
  event.text = "another sender holds node 5";
  lcm_.arrive("LIFT_EVENT", event);
  group_.wait(0ns);

  const auto events = group_.take_events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, "command_refused");
  EXPECT_TRUE(group_.take_events().empty());
}

TEST_F(Group, NamesTheProgramThatHoldsAnAxis) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  group_.wait(0ns);
  EXPECT_EQ(group_.holder(0).name, "");
  EXPECT_FALSE(group_.holder(0).is_other());

  lcm_.arrive("LIFT_STATUS", status(group_.sender(), "other 12"));
  group_.wait(0ns);

  EXPECT_TRUE(group_.holder(0).own);
  EXPECT_FALSE(group_.holder(0).is_other());
  EXPECT_EQ(group_.holder(1).name, "other 12");
  EXPECT_FALSE(group_.holder(1).own);
  EXPECT_TRUE(group_.holder(1).is_other());
}

TEST_F(Group, CountsTheStatusesInSequenceThatShowTheSameHolder) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  for (int i = 0; i < 3; ++i) lcm_.arrive("LIFT_STATUS", status("other 12", "other 12"));
  lcm_.arrive("LIFT_STATUS", status(group_.sender(), "other 12"));
  group_.wait(0ns);

  EXPECT_EQ(group_.holder(0).statuses, 1);
  EXPECT_EQ(group_.holder(1).statuses, 4);
  EXPECT_TRUE(group_.holder(1).is_other(4));
  EXPECT_FALSE(group_.holder(1).is_other(5));
}

TEST_F(Group, BelievesNoStatusOfAnotherSession) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  status_t late = status("other 12", "other 12");
  late.session = 76;
  lcm_.arrive("LIFT_STATUS", late);
  group_.wait(0ns);

  EXPECT_EQ(group_.holder(0).name, "");
}

TEST_F(Group, ForgetsWhoHeldItsAxesBeforeTheDaemonRestarted) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  lcm_.arrive("LIFT_STATUS", status("other 12", "other 12"));
  group_.wait(0ns);
  ASSERT_EQ(group_.holder(0).name, "other 12");
  layout_t again = two_axes();
  again.session = 78;
  lcm_.arrive("LIFT_LAYOUT", again);

  EXPECT_EQ(group_.wait(0ns), Input::restarted);
  EXPECT_EQ(group_.holder(0).name, "");
}

TEST_F(Group, SurvivesAStatusOfNodesThatDoNotExist) {
  lcm_.arrive("LIFT_LAYOUT", two_axes());
  status_t forged = status("other 12", "other 12");
  forged.nodes[0].node_id = -1;
  forged.nodes[1].node_id = 128;
  lcm_.arrive("LIFT_STATUS", forged);
  group_.wait(0ns);

  EXPECT_EQ(group_.holder(0).name, "");
  EXPECT_EQ(group_.holder(1).name, "");
}

TEST(AxisGroup, CommandsWithTheInstanceOfItsOptions) {
  FakeLcm lcm;
  AxisGroup group{std::make_unique<FakeTransport>(lcm),
                  {.bus = "lift", .sender = "test", .instance = 0xAB12}};
  group.send();
  ASSERT_EQ(lcm.published.size(), 1U);
  const auto command = decode<command_t>(lcm.published[0].second);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->instance, 0xAB12);
  EXPECT_EQ(command->sender, "test 0000ab12");
}

TEST(AxisGroup, ReportsItselfFromAnotherProgramOfTheSameName) {
  FakeLcm lcm;
  AxisGroup group{std::make_unique<FakeTransport>(lcm), {.bus = "lift", .sender = "test"}};
  FakeLcm of_other;
  const AxisGroup other{std::make_unique<FakeTransport>(of_other),
                        {.bus = "lift", .sender = "test"}};
  lcm.arrive("LIFT_LAYOUT", two_axes());
  lcm.arrive("LIFT_STATUS", status(group.sender(), other.sender()));
  group.wait(0ns);

  EXPECT_TRUE(group.holder(0).own);
  EXPECT_TRUE(group.holder(1).is_other());
  EXPECT_EQ(group.holder(1).name, other.sender());
}

TEST(AxisGroup, HasASenderOfAtMost64Bytes) {
  FakeLcm lcm;
  const AxisGroup group{std::make_unique<FakeTransport>(lcm),
                        {.bus = "lift", .sender = std::string(64, 'x'), .instance = -1}};
  EXPECT_EQ(group.sender(), std::string(55, 'x') + " ffffffff");
}

TEST_F(Group, SurvivesGarbage) {
  lcm_.arriving.emplace_back("LIFT_IMAGE", std::vector<std::byte>(300, std::byte{0xFF}));
  lcm_.arriving.emplace_back("LIFT_LAYOUT", std::vector<std::byte>{});
  lcm_.arrive("LIFT_LAYOUT", image(1, {0, 0, 0, 0}));
  EXPECT_EQ(group_.wait(0ns), Input::nothing);
}

TEST(AxisGroup, ChoosesTheFirstBusThatItHears) {
  FakeLcm lcm;
  AxisGroup group{std::make_unique<FakeTransport>(lcm), {}};
  lcm.arrive("PRESS_LAYOUT", two_axes());
  group.wait(0ns);
  EXPECT_EQ(group.bus(), "PRESS");
  lcm.arrive("PRESS_LAYOUT", two_axes());
  EXPECT_EQ(group.wait(0ns), Input::restarted);
}

}  // namespace
}  // namespace takt
