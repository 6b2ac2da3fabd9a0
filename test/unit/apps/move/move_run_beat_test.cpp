#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>

#include "apps/move/move_run.hpp"
#include "master/gateway/motion/motion_text.hpp"
#include "test/unit/apps/move/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using motion::StopCause;
using test::MotionBus;
using test::MotionBusTransport;
using test::MotionDaemon;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string words(StopCause cause) { return std::string{text(cause)}; }

class MoveByTaktd : public ::testing::Test {
 protected:
  MoveByTaktd() {
    options_.to = {5.0};
    options_.sine = false;
    options_.following_limit = 1e9;  // the images of this taktd show no target positions
    options_.wait_seconds = 100.0;
  }
  int run() {
    AxisGroup group{std::make_unique<MotionBusTransport>(bus_), {.bus = "lift", .sender = "move"}};
    ::testing::internal::CaptureStdout();
    const int code = MoveRun{group, options_, stop_}.run();
    output_ = ::testing::internal::GetCapturedStdout();
    return code;
  }
  /// Taktd stops the axes each time that they are at this position or above.
  void stop_at(double position, const std::string& cause, int times = 1000) {
    bus_.daemon.each_cycle = [this, position, cause, times](MotionDaemon& daemon) mutable {
      const MotionDaemon::Drive& shoulder = daemon.drives[0];
      if (shoulder.motion.id == 0 || shoulder.position < position || times == 0) return;
      --times;
      bus_.stop_axes(cause);
    };
  }
  /// Taktd stops the axes each time that they have moved by one step.
  void stop_each_step(const std::string& cause, int times = 1000) {
    bus_.daemon.each_cycle = [this, cause, times, last = 0.0](MotionDaemon& daemon) mutable {
      const MotionDaemon::Drive& shoulder = daemon.drives[0];
      if (shoulder.motion.id == 0 || shoulder.position == last || times == 0) return;
      last = shoulder.position;
      --times;
      bus_.stop_axes(cause);
    };
  }
  /// The target moves away from the axes, so that the move does not end.
  void never_arrive() {
    bus_.daemon.each_cycle = [](MotionDaemon& daemon) {
      for (MotionDaemon::Drive& drive : daemon.drives) drive.target += MotionDaemon::step;
    };
  }
  auto sent(const std::string& kind) const { return std::ranges::count(bus_.sent, kind); }
  bool axes_stand() const {
    return std::ranges::all_of(bus_.daemon.drives,
                               [](const auto& drive) { return drive.motion.id == 0; });
  }
  bool lives_after_stop() const {
    const auto stop = std::ranges::find(bus_.sent, "stop");
    return std::any_of(stop, bus_.sent.end(), [](const auto& kind) { return kind != "stop"; });
  }

  MotionBus bus_;
  MoveOptions options_;
  volatile std::sig_atomic_t stop_ = 0;
  std::string output_;
};

TEST_F(MoveByTaktd, ComesToItsEnd) {
  EXPECT_EQ(run(), 0) << output_;
  EXPECT_THAT(output_, HasSubstr(" s, by taktd"));
  EXPECT_EQ(bus_.daemon.drives[1].position, 5.0);
  EXPECT_EQ(sent("move"), 1);
}

TEST_F(MoveByTaktd, DoesNotBeginAgainAgainstAnObstacle) {
  stop_at(2.0, words(StopCause::following_error));
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_EQ(sent("move"), 1);
  EXPECT_THAT(output_, HasSubstr("because of shoulder: the following error is above its limit"
                                 ": stopping"));
}

TEST_F(MoveByTaktd, BeginsAgainAfterAPause) {
  stop_at(2.0, words(StopCause::no_sync), 1);
  EXPECT_EQ(run(), 0) << output_;
  EXPECT_EQ(sent("move"), 2);
  EXPECT_THAT(output_,
              AllOf(HasSubstr("periods: the move begins again"), HasSubstr("held 1 time")));
}

/// taktd discards what comes in the first 20 ms after a pause in which taktd did not run.
TEST_F(MoveByTaktd, WaitsBeforeItBeginsAgain) {
  stop_at(2.0, words(StopCause::no_sync), 1);
  run();
  ASSERT_EQ(sent("move"), 2);
  const std::int64_t between =
      bus_.daemon.commands.back().cycle - bus_.daemon.commands.front().cycle;
  EXPECT_GE(static_cast<double>(between) * 0.002, 0.1);
}

TEST_F(MoveByTaktd, BeginsAgainAsLongAsItComesNearer) {
  stop_each_step(words(StopCause::not_sent), 7);
  EXPECT_EQ(run(), 0) << output_;
  EXPECT_EQ(sent("move"), 8);
  EXPECT_THAT(output_,
              AllOf(HasSubstr("the move begins again (7 of 10)"), HasSubstr("held 7 times")));
}

TEST_F(MoveByTaktd, BeginsAgainTenTimesAtMost) {
  options_.to = {20.0};
  stop_each_step(words(StopCause::sender_silent));
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_EQ(sent("move"), 11);
  EXPECT_THAT(output_, HasSubstr("the move has already begun again 10 times: stopping"));
}

TEST_F(MoveByTaktd, EndsIfItComesNoNearer) {
  bus_.daemon.each_cycle = [this](MotionDaemon& daemon) {
    if (daemon.drives[0].motion.id == 0 || daemon.drives[0].position < 2.0) return;
    for (MotionDaemon::Drive& drive : daemon.drives) drive.position = drive.motion.position = 2.0;
    bus_.stop_axes(words(StopCause::no_sync));
  };
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_EQ(sent("move"), 5) << "the first try has come nearer";
  EXPECT_THAT(output_, HasSubstr("the move has begun again 3 times and has not come nearer to its "
                                 "target: stopping"));
}

TEST_F(MoveByTaktd, DoesNotBeginAgainWithoutAReason) {
  stop_at(2.0, "");
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_EQ(sent("move"), 1);
  EXPECT_THAT(output_, HasSubstr("has not said why: stopping"));
}

TEST_F(MoveByTaktd, DoesNotBeginAgainWhereNoTimeIsLeft) {
  options_.seconds = 0.5;
  bus_.daemon.each_cycle = [this, moved = 0](MotionDaemon& daemon) mutable {
    for (MotionDaemon::Drive& drive : daemon.drives) drive.target += MotionDaemon::step;
    moved += daemon.drives[0].motion.id != 0 ? 1 : 0;
    if (moved == 245) bus_.stop_axes(words(StopCause::no_sync));
  };
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_EQ(sent("move"), 1);
  EXPECT_THAT(output_, HasSubstr("--for leaves no time to begin again: stopping"));
}

TEST_F(MoveByTaktd, StopsWhenItsTimeIsOver) {
  options_.seconds = 0.5;
  never_arrive();
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_GE(sent("stop"), 1);
  EXPECT_TRUE(axes_stand());
  EXPECT_THAT(output_, HasSubstr("the move does not end in the time of --for: stopping"));
  const double seconds = 0.002 / MotionDaemon::step * bus_.daemon.drives[0].position;
  EXPECT_GE(seconds, 0.5);
  EXPECT_LE(seconds, 0.53);
}

TEST_F(MoveByTaktd, EndsIfNoImageComes) {
  bus_.daemon.each_cycle = [](MotionDaemon& daemon) {
    if (daemon.drives[0].position > 2.0) daemon.cyclic = false;
  };
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_THAT(output_, HasSubstr("no image of bus lift has come for "));
}

TEST_F(MoveByTaktd, EndsIfNoReportComes) {
  bus_.daemon.each_cycle = [this](MotionDaemon& daemon) {
    if (daemon.drives[0].position > 2.0) bus_.reports = false;
  };
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_THAT(output_, HasSubstr("taktd has reported nothing new about the move for 2 s: stop"));
  EXPECT_GE(sent("stop"), 1);
}

TEST_F(MoveByTaktd, StopsTheAxesAfterASignal) {
  bus_.daemon.each_cycle = [this](MotionDaemon& daemon) {
    if (daemon.drives[0].position > 2.0) stop_ = 1;
  };
  EXPECT_EQ(run(), 0) << output_;
  EXPECT_TRUE(axes_stand());
  EXPECT_LT(bus_.daemon.drives[0].position, 5.0);
  EXPECT_FALSE(lives_after_stop());
}

/// The command is still on its way to taktd when the signal comes.
TEST_F(MoveByTaktd, StopsAMoveThatBeginsAfterTheSignal) {
  bus_.moves = MotionBus::Moves::late;
  bus_.daemon.each_cycle = [this](MotionDaemon&) { stop_ = bus_.on_the_way.empty() ? stop_ : 1; };
  run();
  EXPECT_EQ(sent("move"), 1);
  EXPECT_EQ(bus_.daemon.commands.back().kind, "stop");
  EXPECT_TRUE(axes_stand());
  EXPECT_LT(bus_.daemon.drives[0].position, 5.0);
  EXPECT_FALSE(lives_after_stop());
}

TEST_F(MoveByTaktd, StopsAMoveThatIsNotAnswered) {
  bus_.moves = MotionBus::Moves::lost;
  EXPECT_EQ(run(), 1) << output_;
  EXPECT_GT(sent("stop"), 20);
  EXPECT_THAT(output_, HasSubstr("taktd does not answer the move: stopping"));
  EXPECT_FALSE(lives_after_stop());
}

TEST_F(MoveByTaktd, DoesNotBeginAfterASignal) {
  bus_.daemon.each_cycle = [this](MotionDaemon& daemon) {
    if (daemon.drives[1].statusword == 0x0237 && daemon.active) stop_ = 1;
  };
  run();
  EXPECT_EQ(sent("move"), 0);
}

TEST_F(MoveByTaktd, IsSilentAfterAStop) {
  AxisGroup group{std::make_unique<MotionBusTransport>(bus_), {.bus = "lift", .sender = "move"}};
  while (group.wait(1ms) != Input::fresh) {
  }
  BeatMove move{group};
  move.keep_alive();
  ASSERT_EQ(bus_.sent, std::vector<std::string>{"alive"});
  move.stop();
  std::this_thread::sleep_for(60ms);
  move.keep_alive();
  EXPECT_EQ(bus_.sent, (std::vector<std::string>{"alive", "stop"}));
}

TEST(StopReasons, KnowOnlyThePausesOfTaktd) {
  int pauses = 0;
  for (int i = 0; i <= static_cast<int>(StopCause::application); ++i) {
    const auto cause = static_cast<StopCause>(i);
    StopReasons reasons;
    event_t event{};
    event.kind = "motion_stopped";
    event.text = "elbow: motion 7 has stopped because of shoulder (axis 2): " + words(cause);
    reasons.take(event);
    EXPECT_EQ(reasons.of(7), event.text);
    EXPECT_EQ(reasons.of(77), "");
    EXPECT_FALSE(reasons.only_paused(77));
    const bool pause = cause == StopCause::sender_silent || cause == StopCause::no_sync ||
                       cause == StopCause::not_sent;
    EXPECT_EQ(reasons.only_paused(7), pause) << words(cause);
    pauses += reasons.only_paused(7) ? 1 : 0;
  }
  EXPECT_EQ(pauses, 3);
}

TEST(StopReasons, CountTheOneThatIsNoPause) {
  StopReasons reasons;
  for (const StopCause cause : {StopCause::no_sync, StopCause::fault, StopCause::no_sync}) {
    event_t event{};
    event.kind = "motion_stopped";
    event.text = "motion 7 has stopped because of elbow: " + words(cause);
    reasons.take(event);
  }
  EXPECT_FALSE(reasons.only_paused(7));
  EXPECT_THAT(reasons.of(7), HasSubstr("the drive is in fault"));
}

}  // namespace
}  // namespace takt
