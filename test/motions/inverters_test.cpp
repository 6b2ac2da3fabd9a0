// Inverters that lose their program, with the complete master and the simulated devices in virtual
// time.
#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <string>

#include "eds_parser/network_file/load_network.hpp"
#include "master/attach.hpp"
#include "master/master_run.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {
namespace {

/// A demo network with one speed axis.
class Inverter {
 public:
  explicit Inverter(const std::string& demo)
      : net_{load_network(TAKT_SOURCE_DIR "/share/demo/" + demo + ".yaml")},
        axis_{net_.plan.speed_axes.at(0)},
        world_{net_.devices, sim::WorldOptions{}},
        port_{world_, sim::RemotePortOptions{}},
        master_{net_.plan, MasterRunOptions{}} {
    master_.attach(port_);
    master_.begin();
  }

  const SpeedAxisPlan& axis() const { return axis_; }
  bool boot() {
    for (int i = 0; i < 2000; ++i) {
      cycle();
      StatusSnapshot snapshot;
      master_.status(snapshot);
      if (snapshot.nodes[0].boot == BootState::ready) return true;
    }
    return false;
  }
  void command(std::int64_t order, std::int64_t speed) {
    master_.set(axis_.control, order, time_to_live);
    master_.set(axis_.set_speed, speed, time_to_live);
    master_.publish_outputs(world_.now());
    cycle();
  }
  void cycle() {
    master_.cycle();
    for (Event event; master_.take(event);) fallbacks_ += event.kind == EventKind::fallback_begun;
    ImageView image;
    while (master_.take(image)) {
      speed_ = image.values[*axis_.actual_speed];
      order_ = image.values[axis_.control];
    }
  }
  std::int64_t speed() const { return speed_; }
  std::int64_t order() const { return order_; }
  int fallbacks() const { return fallbacks_; }

  static constexpr std::uint32_t time_to_live = 50;

 private:
  LoadedNetwork net_;
  SpeedAxisPlan axis_;
  sim::World world_;
  sim::SimPort port_;
  MasterRun master_;
  std::int64_t speed_ = 0;
  std::int64_t order_ = 0;
  int fallbacks_ = 0;
};

class Inverters : public testing::TestWithParam<const char*> {};

TEST_P(Inverters, RunWhileTheyAreCommandedAndStopWithoutTheirProgram) {
  Inverter inverter{GetParam()};
  ASSERT_TRUE(inverter.boot());
  const SpeedCommands& commands = inverter.axis().commands;
  std::int64_t set_speed = 0;
  for (int i = 0; i < 300; ++i) {
    set_speed = std::min<std::int64_t>(set_speed + 40, 2000);
    inverter.command(commands.run, set_speed);
  }
  EXPECT_EQ(inverter.speed(), 2000);
  EXPECT_EQ(inverter.fallbacks(), 0);

  for (std::uint32_t i = 0; i + 5 < Inverter::time_to_live; ++i) inverter.cycle();
  EXPECT_EQ(inverter.speed(), 2000) << "the newest command still lives";
  for (int i = 0; i < 10; ++i) inverter.cycle();
  EXPECT_EQ(inverter.fallbacks(), 1);
  EXPECT_EQ(inverter.order(), commands.stop);
  EXPECT_GT(inverter.speed(), 0) << "along the ramp of the drive";
  for (int i = 0; i < 100; ++i) inverter.cycle();
  EXPECT_EQ(inverter.speed(), 0);
}

TEST_P(Inverters, GetNothingBeforeTheFirstCommand) {
  Inverter inverter{GetParam()};
  ASSERT_TRUE(inverter.boot());
  for (int i = 0; i < 200; ++i) inverter.cycle();
  EXPECT_EQ(inverter.speed(), 0);
  EXPECT_EQ(inverter.fallbacks(), 0);
}

INSTANTIATE_TEST_SUITE_P(Families, Inverters, testing::Values("astraada_drv28", "lenze8400"));

}  // namespace
}  // namespace takt
