// Touch probes by the library of applications, with a whole master, its gateway and simulated
// drives in virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <takt/motion.hpp>

#include "test/motions/link_in_virtual_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::LinkInVirtualTime;
using test::MotionBus;
using testing::HasSubstr;
using Kind = Obstacle::Kind;
using Edge = ProbeOptions::Edge;

class AxesProbe : public ::testing::Test {
 protected:
  static constexpr const char* network = TAKT_SOURCE_DIR "/test/motions/data/servos.yaml";
  static constexpr double near = 5e-3;  // m; the axis still moves until the drive samples the input

  AxesProbe() {
    bus_.run(1000);  // until all nodes have booted
    bus_.clocks.offset = std::chrono::system_clock::now().time_since_epoch() - bus_.world.now();
    auto opened = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                             {.bus = "demo", .longest = 20s, .timeout = 10s});
    EXPECT_TRUE(opened) << opened.error().text;
    axes_.emplace(std::move(*opened));
  }
  void jog(double velocity) {
    const Done enabled = axes_->enable();
    ASSERT_TRUE(enabled) << enabled.error().text;
    const Done begun = axes_->jog(Eigen::Vector2d{velocity, velocity});
    ASSERT_TRUE(begun) << begun.error().text;
  }
  std::int64_t function(std::size_t axis) {
    const NodeId node = bus_.network.plan.nodes[bus_.axes[axis].node_index].id;
    return bus_.world.device(node)->objects().number({0x60B8, 0});
  }

  MotionBus bus_{{}, network};
  std::optional<Axes> axes_;
};

TEST_F(AxesProbe, ReturnsThePositionAtTheEdgeBySdoAndByPdo) {
  for (const Eigen::Index axis : {0, 1}) {
    SCOPED_TRACE(axes_->name(axis));
    ASSERT_NO_FATAL_FAILURE(jog(0.3));
    const auto found = axes_->touch_probe(axis);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(*found, 0.4, near);
    EXPECT_TRUE(axes_->moving());
    bus_.run(5);
    EXPECT_EQ(function(static_cast<std::size_t>(axis)), 0) << "it is not armed any more";
    const auto falling = axes_->touch_probe(axis, {.edge = Edge::falling});
    ASSERT_TRUE(falling) << falling.error().text;
    EXPECT_NEAR(*falling, 0.45, near);
    ASSERT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}));
  }
}

TEST_F(AxesProbe, SaysThatNoEdgeHasCome) {
  const auto none = axes_->touch_probe(0, {.longest = 10ms});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, Kind::time_over);
  EXPECT_THAT(none.error().text, HasSubstr("by_sdo: no edge has come in 0.0 s: 0x60B9 is 0x000"));
  EXPECT_EQ(function(0), 0);
  EXPECT_EQ(axes_->touch_probe(2).error().kind, Kind::wrong_use);
  EXPECT_EQ(axes_->touch_probe(0, {.input = 3}).error().kind, Kind::wrong_use);
}

}  // namespace
}  // namespace takt
