#include "eds_parser/plan/cycle_compiler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using std::chrono::microseconds;
using test::compile;
using test::Compiled;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Compiles a network with `count` drives; each has a TPDO and an RPDO of 8 bytes.
Compiled drives(int count, std::string_view master) {
  std::string yaml = "master: {" + std::string{master} +
                     "}\n"
                     "defaults:\n"
                     "  dcf: x\n"
                     "  tpdo: {1: {mapping: [{index: 0x6064}, {index: 0x606C}]}}\n"
                     "  rpdo: {1: {mapping: [{index: 0x607A}, {index: 0x60FF}]}}\n"
                     "nodes:\n";
  for (int i = 1; i <= count; ++i) {
    yaml += "  d" + std::to_string(i) + ": {node_id: " + std::to_string(i) + "}\n";
  }
  return compile(yaml);
}

TEST(CycleCompiler, FourDrivesAtTwoMilliseconds) {
  const auto net = drives(4, "sync_period: 2000");

  EXPECT_THAT(net.complaints(), IsEmpty());
  const CyclePlan& cycle = net.plan.cycle;
  const TimeBudget budget = time_budget(net.plan);
  EXPECT_EQ(budget.inputs_wire, microseconds{55 + 4 * 135});
  EXPECT_EQ(budget.outputs_wire, microseconds{4 * 135});
  EXPECT_EQ(cycle.quiet_before_sync, microseconds{135 + 40});
  EXPECT_EQ(cycle.output_deadline, microseconds{2000 - 175 - 540});
  EXPECT_EQ(budget.earliest, microseconds{730});
  EXPECT_EQ(cycle.receive_window, microseconds{(730 + 1285) / 2} + std::chrono::nanoseconds{500});
  EXPECT_EQ(cycle.service_frames, 2);
  EXPECT_TRUE(budget.next_sync);
}

TEST(CycleCompiler, SaysKPlusTwoWhereNoTimeIsLeft) {
  const auto net = drives(6, "sync_period: 1900");

  EXPECT_THAT(net.complaints(), ElementsAre("1:23 warning [no-time-budget]"));
  EXPECT_THAT(net.declared("no-time-budget"), HasSubstr("acts at SYNC k+2"));
}

TEST(CycleCompiler, RefusesWhatCanNotFit) {
  const auto net = drives(4, "sync_period: 1000");

  EXPECT_THAT(net.complaints(), ElementsAre("1:23 error [does-not-fit]"));
  EXPECT_THAT(net.declared("does-not-fit"),
              HasSubstr("595 us of SYNC and TPDOs and 540 us of RPDOs"));
}

TEST(CycleCompiler, SlowBusesHaveLongFrames) {
  EXPECT_THAT(drives(4, "sync_period: 2000, baudrate: 500").complaints(),
              testing::Contains("1:23 error [does-not-fit]"));
  const auto net = drives(1, "sync_period: 10000, baudrate: 500");
  EXPECT_EQ(time_budget(net.plan).inputs_wire, microseconds{2 * (55 + 135)});
}

TEST(CycleCompiler, TheCounterMakesSyncLonger) {
  EXPECT_EQ(time_budget(drives(1, "sync_period: 2000, sync_overflow: 10").plan).inputs_wire,
            microseconds{65 + 135});
}

TEST(CycleCompiler, WarnsWhereTheWindowOfADeviceEndsBeforeTheOutputs) {
  const auto net = drives(1, "sync_period: 2000, sync_window: 1000");

  EXPECT_THAT(net.complaints(), ElementsAre("1:42 warning [sync-window]"));
  EXPECT_THAT(net.declared("sync-window"), HasSubstr("until 1000 us after SYNC (0x1007)"));
}

TEST(CycleCompiler, ASynchronousPdoWithoutSyncIsWarnedOf) {
  const auto net = compile("arm: {node_id: 5, dcf: x}\n");

  EXPECT_FALSE(net.plan.cycle.sync);
  EXPECT_EQ(net.plan.cycle.period, std::chrono::milliseconds{10});
  EXPECT_THAT(net.complaints(), ElementsAre("1:1 warning [no-sync]", "1:1 warning [no-sync]"));
}

TEST(CycleCompiler, HeartbeatsGrowSlowerOnACrowdedBus) {
  EXPECT_EQ(drives(1, "sync_period: 50000").plan.nodes[0].heartbeat_timeout,
            std::chrono::milliseconds{300});
  // The heartbeats of 100 nodes with 65 bits each take 52 ms at 125 kbit/s and may use at most 2 %
  // of the bus.
  const auto slow = drives(100, "sync_period: 1000000, baudrate: 125");
  EXPECT_EQ(slow.plan.nodes[0].heartbeat_timeout, std::chrono::milliseconds{3 * 2650});
}

TEST(CycleCompiler, ABitRateThatTheDeviceDoesNotKnowIsWarnedOf) {
  EXPECT_THAT(drives(1, "sync_period: 50000, baudrate: 250").declared("bit-rate"),
              HasSubstr("supports 500, 1000 kbit/s"));
}

}  // namespace
}  // namespace takt
