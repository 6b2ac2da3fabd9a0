// What a program finds after another one that has died while its axes moved: a whole master, its
// gateway and simulated drives in virtual time.
#include <gtest/gtest.h>
#include <takt/motion.hpp>

#include "test/motions/link_in_virtual_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::LinkInVirtualTime;
using test::MotionBus;

class AxesAfterADeadProgram : public ::testing::TestWithParam<DriveMode> {
 protected:
  AxesAfterADeadProgram() {
    bus_.run(1000);  // until both nodes have booted
    bus_.clocks.offset = std::chrono::system_clock::now().time_since_epoch() - bus_.world.now();
  }
  std::optional<Axes> open(LinkInVirtualTime** link = nullptr) {
    auto made = std::make_unique<LinkInVirtualTime>(bus_);
    if (link != nullptr) *link = made.get();
    auto axes = Axes::open(std::move(made), {.bus = "demo", .longest = 5s, .timeout = 10s});
    if (!axes) return std::nullopt;
    return std::move(*axes);
  }
  static Done move(Axes& axes) {
    const Eigen::Vector2d fast{10.0, 10.0};
    if (Done enabled = axes.enable(); !enabled) return enabled;
    if (Done set = axes.set_mode(GetParam()); !set) return set;
    if (GetParam() != DriveMode::profile_position) return axes.command_velocities(fast);
    return axes.profile_move(8.0 * fast, {.velocity = fast, .acceleration = fast}, {.wait = false});
  }

  MotionBus bus_{{}, TAKT_SOURCE_DIR "/test/motions/data/all_modes.yaml"};
};

TEST_P(AxesAfterADeadProgram, AreEnabledWithoutAJump) {
  {
    LinkInVirtualTime* link = nullptr;
    auto dead = open(&link);
    ASSERT_TRUE(dead);
    const Done moves = move(*dead);
    ASSERT_TRUE(moves) << moves.error().text;
    link->loses = [](const std::string&) { return true; };
    ASSERT_TRUE(bus_.run_until([&] { return !bus_.enabled(0) && !bus_.enabled(1); }, 10'000));
    bus_.run(500);
  }
  ASSERT_GT(bus_.position(0), 10.0);
  auto axes = open();
  ASSERT_TRUE(axes);
  const double before = bus_.position(0);
  double farthest = 0.0;
  bus_.each_cycle = [&] { farthest = std::max(farthest, std::abs(bus_.position(0) - before)); };
  const Done enabled = axes->enable();
  bus_.run(100);
  bus_.each_cycle = {};
  EXPECT_TRUE(enabled) << enabled.error().text;
  EXPECT_LT(farthest, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Modes, AxesAfterADeadProgram,
                         ::testing::Values(DriveMode::profile_position,
                                           DriveMode::cyclic_velocity));

}  // namespace
}  // namespace takt
