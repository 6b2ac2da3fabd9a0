#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile_device_file;
using test::Compiled;
using test::drv28;
using test::errors_of_entry;
using test::lenze8400;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Signal& signal_of(const Compiled& net, SignalIndex signal) {
  return net.plan.layout.signals[signal];
}

TEST(SpeedAxes, AreTheInvertersOfTheDeviceData) {
  const Compiled pump = drv28("limits: {objects: []}");
  ASSERT_EQ(pump.plan.speed_axes.size(), 1U);
  const SpeedAxisPlan& axis = pump.plan.speed_axes[0];
  EXPECT_EQ(signal_of(pump, axis.control).object, (ObjectKey{0x2101, 1}));
  EXPECT_EQ(signal_of(pump, axis.set_speed).object, (ObjectKey{0x2101, 2}));
  EXPECT_EQ(signal_of(pump, axis.status).object, (ObjectKey{0x2001, 1}));
  ASSERT_TRUE(axis.actual_speed);
  EXPECT_EQ(axis.commands.run, 1);
  EXPECT_EQ(axis.commands.run_reverse, 2);
  EXPECT_EQ(axis.unit, "Hz");
  EXPECT_DOUBLE_EQ(axis.set_scale, 0.01);
  EXPECT_TRUE(axis.states.fault.shows(0x0104)) << "the high byte does not count";
  EXPECT_FALSE(axis.states.fault.shows(0x0403));

  const Compiled conveyor = lenze8400("firmware: \"16.00.00\"");
  ASSERT_EQ(conveyor.plan.speed_axes.size(), 1U);
  EXPECT_FALSE(conveyor.plan.speed_axes[0].commands.run_reverse) << "its set speed has a sign";
  EXPECT_EQ(conveyor.plan.speed_axes[0].unit, "%");
}

TEST(SpeedAxes, StopWhenNobodyCommandsThem) {
  const Compiled net = drv28("heartbeat_producer: 100");
  const SpeedAxisPlan& axis = net.plan.speed_axes.at(0);
  EXPECT_EQ(signal_of(net, axis.control).fallback, Fallback::value);
  EXPECT_EQ(signal_of(net, axis.control).fallback_value, 5) << "stop along the ramp";
  EXPECT_FALSE(signal_of(net, axis.control).safe_value) << "nothing is sent before a command";
  EXPECT_EQ(signal_of(net, axis.set_speed).fallback, Fallback::value);
  EXPECT_EQ(signal_of(net, axis.set_speed).fallback_value, 0);
  EXPECT_EQ(signal_of(net, axis.control).fallback_cycles, 50U) << "500 ms";
}

TEST(SpeedAxes, NeedNoCommandForTheOtherWordsOfTheirRpdo) {
  const Compiled net = drv28("heartbeat_producer: 100");
  const auto other = net.plan.layout.find(0, {0x2101, 3}, true);
  const auto elsewhere = net.plan.layout.find(0, {0x2102, 1}, true);
  ASSERT_TRUE(other && elsewhere);
  EXPECT_EQ(signal_of(net, *other).safe_value, 0);
  EXPECT_FALSE(signal_of(net, *elsewhere).safe_value);
}

TEST(SpeedAxes, DoWhatTheNetworkFileSaysInstead) {
  const Compiled quick = drv28("on_timeout: {fallback: quick_stop, after: 100}");
  EXPECT_THAT(quick.complaints(), IsEmpty());
  const SpeedAxisPlan& axis = quick.plan.speed_axes.at(0);
  EXPECT_EQ(signal_of(quick, axis.control).fallback_value, 6);
  EXPECT_EQ(signal_of(quick, axis.control).fallback_cycles, 10U);

  const Compiled hold = drv28("on_timeout: {fallback: hold}");
  EXPECT_EQ(signal_of(hold, hold.plan.speed_axes.at(0).control).fallback, Fallback::hold);
}

TEST(SpeedAxes, TakeTheirWordsFromTheNodeWhereItStatesThem) {
  const Compiled net = drv28(
      "speed_axis: {commands: {run: 0x11, stop: 0x10}, "
      "set_speed: {index: 0x2101, sub_index: 3, scale: 0.3, unit: rpm}}");
  const SpeedAxisPlan& axis = net.plan.speed_axes.at(0);
  EXPECT_EQ(axis.commands.run, 0x11);
  EXPECT_EQ(axis.commands.run_reverse, 2) << "from the device data";
  EXPECT_EQ(signal_of(net, axis.set_speed).object, (ObjectKey{0x2101, 3}));
  EXPECT_EQ(axis.unit, "rpm");

  EXPECT_THAT(drv28("speed_axis: {enabled: false}").plan.speed_axes, IsEmpty());
}

TEST(SpeedAxes, ReportWordsThatNoPdoCarries) {
  const Compiled wrong = drv28("speed_axis: {control: {index: 0x2109, sub_index: 1}}");
  EXPECT_THAT(wrong.plan.speed_axes, IsEmpty());
  EXPECT_THAT(wrong.declared("speed-axis"), HasSubstr("no RPDO carries 2109:01"));
  const Compiled partial = compile_device_file(
      "drive: {node_id: 4, dcf: x, speed_axis: {ramps: none}}\n", "takt_drive402.eds");
  EXPECT_THAT(partial.declared("speed-axis"), HasSubstr("lacks `control`"));
}

TEST(SpeedAxes, LimitTheSpeedInBothDirections) {
  const Compiled net = drv28("limits: {velocity: 50, acceleration: 20}");
  EXPECT_THAT(net.complaints(), IsEmpty());
  const SpeedAxisPlan& axis = net.plan.speed_axes.at(0);
  EXPECT_EQ(axis.max_speed, 50.0);
  EXPECT_EQ(axis.max_acceleration, 20.0);
  const auto row = std::ranges::find(net.plan.limits.outputs, axis.set_speed, &OutputLimit::signal);
  ASSERT_NE(row, net.plan.limits.outputs.end());
  EXPECT_EQ(row->low, -5000.0);
  EXPECT_EQ(row->high, 5000.0);
  EXPECT_DOUBLE_EQ(row->rate, 20.0);  // 20 Hz/s are 2000 counts/s, in 10 ms
  ASSERT_TRUE(row->orders);
  EXPECT_EQ(row->orders->factor(0x0101), 1.0);
  EXPECT_EQ(row->orders->factor(0x0002), -1.0);
  EXPECT_EQ(row->orders->factor(0x0005), 0.0);
  EXPECT_EQ(row->orders->factor(0x0003), 1.0) << "an unknown command may make it run";

  const Compiled position = drv28("limits: {position: [0, 1]}");
  EXPECT_THAT(position.declared("limits"), HasSubstr("a speed axis has no position"));
}

TEST(SpeedAxes, AreDrivesInVelocityModeToo) {
  SpeedAxisPlan axis;
  const SpeedAxisSpec words = velocity_mode_axis();
  EXPECT_EQ(missing_part(words), "");
  axis.sequence = *words.sequence;
  axis.commands.mask = *words.commands.mask;
  axis.commands.run = *words.commands.run;
  axis.commands.stop = *words.commands.stop;
  const SpeedOrders orders = orders_of(axis);
  EXPECT_EQ(orders.factor(0x007F), 1.0);
  EXPECT_EQ(orders.factor(0x010F), 0.0) << "the ramp gets no set speed";
}

TEST(SpeedAxes, OfTheDeviceDataAreCheckedWithTheirLines) {
  EXPECT_THAT(errors_of_entry("name: x\n"
                              "match: none\n"
                              "speed_axis:\n"
                              "  control: {index: 0x2000}\n"),
              ElementsAre("4 missing-key"));
  EXPECT_THAT(errors_of_entry("name: x\n"
                              "match: none\n"
                              "speed_axis:\n"
                              "  control: {index: 0x2000}\n"
                              "  status: {index: 0x2001}\n"
                              "  set_speed: {index: 0x2002, scale: 0}\n"
                              "  commands: {run: 0x10000, stop: 0}\n"
                              "  states: {fault: {mask: 0x0F, values: [0x10]}}\n"
                              "  fault_reset: sometimes\n"),
              ElementsAre("6 out-of-range", "7 out-of-range", "8 out-of-range", "9 unknown-value"));
}

}  // namespace
}  // namespace takt
