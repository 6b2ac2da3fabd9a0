#include "apps/axis/axis_group.hpp"

#include <deque>
#include <gtest/gtest.h>
#include <utility>

#include "master/lcm/messages.hpp"
#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using testing::image;
using testing::two_axes;

/// An LCM that the test controls.
struct FakeLcm {
  std::deque<std::pair<std::string, std::vector<std::byte>>> arriving;
  std::vector<std::pair<std::string, std::vector<std::byte>>> published;
  std::vector<std::string> patterns;

  template <class T>
  void arrive(const std::string& channel, const T& message) {
    std::vector<std::byte> buffer;
    encode(message, buffer);
    arriving.emplace_back(channel, buffer);
  }
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(FakeLcm& lcm) : lcm_{lcm} {}
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    lcm_.published.emplace_back(channel, std::vector<std::byte>{data.begin(), data.end()});
    return true;
  }
  void subscribe(const std::string& pattern) override { lcm_.patterns.push_back(pattern); }
  void serve(const MessageHandler& handler) override {
    while (!lcm_.arriving.empty()) {
      handler(lcm_.arriving.front().first, lcm_.arriving.front().second);
      lcm_.arriving.pop_front();
    }
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "test"; }

 private:
  FakeLcm& lcm_;
};

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
  EXPECT_EQ(command->sender, "test");
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

TEST_F(Group, TellsOnceThatTheDaemonIsOfAnOlderTakt) {
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

TEST_F(Group, TellsThatTheDaemonHasRestarted) {
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

TEST_F(Group, KeepsWhatTheDaemonTells) {
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
