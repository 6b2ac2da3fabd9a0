// Limits of set-points with the complete master: no set-point outside the limits reaches the wire.
#include <cstring>
#include <gtest/gtest.h>
#include <random>

#include "master/explain/boot_report.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

/// Axes with positions in millimetres, a range of +-2 m, and at most 20 mm per cycle.
BusPlan limited_axes(unsigned nodes = 1) {
  BusPlan plan = test::axes({.nodes = nodes, .fallback_cycles = 50});
  for (unsigned i = 0; i < nodes; ++i) {
    const auto target = static_cast<SignalIndex>(3 * nodes + i);
    plan.layout.signals[target].name = "target_position";
    plan.layout.signals[target].scale = 0.001;
    plan.layout.signals[target].unit = "m";
    plan.limits.outputs.push_back({.signal = target,
                                   .low = -2000,
                                   .high = 2000,
                                   .range = LimitKind::position,
                                   .step = 20,
                                   .wraps = true,
                                   .quantity = AxisQuantity::position,
                                   .controlword = static_cast<SignalIndex>(2 * nodes + i),
                                   .feedback = static_cast<SignalIndex>(nodes + i)});
    plan.limits.lines.push_back({.node_index = static_cast<std::uint8_t>(i),
                                 .axis = 1,
                                 .kind = LimitKind::step,
                                 .source = LimitSource::file,
                                 .high = 0.02,
                                 .unit = "m",
                                 .signals = {target}});
  }
  return plan;
}

std::int32_t position_in(const Frame& frame) {
  std::int32_t position = 0;
  std::memcpy(&position, frame.data.data() + 2, 4);
  return position;
}

TEST(LimitedMaster, SendsNoJumpOfHalfAMetreAndStopsTheAxisInThatCycle) {
  Rig rig{limited_axes()};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 10, 1000);
  rig.run(5);
  rig.command_all(0x000F, 10, 1000);
  rig.run(1);
  rig.recorder.frames.clear();

  rig.command_all(0x000F, 510, 1000);
  rig.run(5);

  const auto frames = rig.recorder.with(0x201);
  ASSERT_GE(frames.size(), 4U);
  for (const sim::WireFrame& wire : frames) EXPECT_EQ(position_in(wire.frame), 10);
  EXPECT_EQ(frames.back().frame.data[0], 0x02);
  EXPECT_EQ(frames[1].frame.data[0], 0x02);
  ASSERT_EQ(rig.count(EventKind::limit_exceeded), 1);
  const auto reported = std::ranges::find(rig.events, EventKind::limit_exceeded, &Event::kind);
  EXPECT_EQ(describe(limited_axes(), *reported),
            "node 1 'axis1': command 0.51 m to target_position (607A:00) is outside its limits: "
            "step 0.5 m, limit 0.02 m; takt does not send it, and the outputs of the node take "
            "their fallback until a command is within the limits again");
}

/// A plan with one axis whose limits come only from its device, where the boot reads 607D.
BusPlan reported_in_the_boot() {
  BusPlan plan = test::axes({.nodes = 1, .fallback_cycles = 50});
  const SignalIndex target = 3;
  plan.limits.outputs = {{.signal = target, .range = LimitKind::position, .wraps = true}};
  plan.limits.lines = {{.axis = 1,
                        .object = {0x607D, 1},
                        .kind = LimitKind::position,
                        .source = LimitSource::device,
                        .signals = {target}}};
  plan.limits.device = {{.object = {0x607D, 1}, .signal = target, .bound = DeviceBound::range}};
  return plan;
}

DeviceTable device_with_range(const BusPlan& plan, std::uint32_t low, std::uint32_t high) {
  DeviceTable device =
      test::loopback_device(plan.nodes[0].id, plan.pdos.tpdos[0], plan.pdos.rpdos[0]);
  for (std::uint8_t sub = 1; sub <= 2; ++sub) {
    device.objects.push_back({.key = {0x607D, sub},
                              .type = DataType::integer32,
                              .access = Access::rw,
                              .value = sim::little_endian(sub == 1 ? low : high, 4),
                              .low_limit = {},
                              .high_limit = {}});
  }
  std::ranges::sort(device.objects, {}, &DeviceObject::key);
  return device;
}

TEST(LimitedMaster, SendsNoJumpBeyondALimitThatOnlyTheDeviceKnows) {
  const BusPlan plan = reported_in_the_boot();
  Rig rig{plan, {.devices = {device_with_range(plan, 0, 300)}}};
  ASSERT_TRUE(rig.boot());
  EXPECT_EQ(rig.count(EventKind::limit_read), 1);
  rig.command_all(0x000F, 10, 1000);
  rig.run(5);
  rig.recorder.frames.clear();

  rig.command_all(0x000F, 510, 1000);
  rig.run(5);

  const auto frames = rig.recorder.with(0x201);
  ASSERT_GE(frames.size(), 4U);
  for (const sim::WireFrame& wire : frames) EXPECT_EQ(position_in(wire.frame), 10);
  EXPECT_EQ(frames.back().frame.data[0], 0x02);
  EXPECT_EQ(rig.count(EventKind::limit_exceeded), 1);
}

TEST(LimitedMaster, TakesWhatTheDeviceSaysAfterEachOfItsBoots) {
  const BusPlan plan = reported_in_the_boot();
  Rig rig{plan, {.devices = {device_with_range(plan, 0, 0)}}};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 510, 1000);
  rig.run(5);
  EXPECT_EQ(position_in(rig.recorder.with(0x201).back().frame), 510);

  rig.world->add({.kind = sim::FaultKind::override_value,
                  .node = plan.nodes[0].id,
                  .object = ObjectKey{0x607D, 2},
                  .value = sim::little_endian(300, 4)});
  rig.world->add({.kind = sim::FaultKind::reset, .node = plan.nodes[0].id});
  rig.run(200);
  ASSERT_TRUE(rig.boot());
  EXPECT_EQ(rig.count(EventKind::limit_read), 2);
  rig.recorder.frames.clear();
  rig.command_all(0x000F, 510, 1000);
  rig.run(5);

  EXPECT_EQ(rig.count(EventKind::limit_exceeded), 1);
  for (const sim::WireFrame& wire : rig.recorder.with(0x201)) {
    EXPECT_NE(position_in(wire.frame), 510);
  }
}

TEST(LimitedMaster, HoldsAControllerInTheBusThreadToTheSameLimits) {
  struct Jumper final : Controller {
    void update(const ImageView&, OutputWriter& out) noexcept override {
      out.set(2, 0x000F);
      out.set(3, jumps ? 510 : 10);
    }
    bool jumps = false;
  } jumper;
  Rig rig{limited_axes(), {.master = {.controller = &jumper}}};
  ASSERT_TRUE(rig.boot());
  rig.run(5);
  rig.recorder.frames.clear();

  jumper.jumps = true;
  rig.run(20);

  for (const sim::WireFrame& wire : rig.recorder.with(0x201)) {
    EXPECT_EQ(position_in(wire.frame), 10);
  }
  EXPECT_EQ(rig.recorder.with(0x201).back().frame.data[0], 0x02);
  EXPECT_EQ(rig.count(EventKind::limit_exceeded), 1);

  jumper.jumps = false;
  rig.run(5);
  EXPECT_EQ(rig.recorder.with(0x201).back().frame.data[0], 0x0F);
}

TEST(LimitedMaster, LetsNothingOutsideOntoTheWireWhateverIsCommanded) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Rig rig{limited_axes(2)};
    ASSERT_TRUE(rig.boot());
    rig.run(5);
    rig.recorder.frames.clear();
    std::mt19937 random{seed};
    std::array<std::int64_t, 2> wanted{};
    for (int i = 0; i < 500; ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (random() % 5 == 0) continue;
        wanted[axis] += static_cast<std::int64_t>(random() % 45) - 22;
        if (random() % 50 == 0) wanted[axis] = static_cast<std::int32_t>(random());
        if (random() % 10 == 0) wanted[axis] = rig.last_image[2 + axis];
        rig.command(axis, 0x000F, wanted[axis]);
      }
      rig.cycle();
    }
    for (const std::uint32_t id : {0x201U, 0x202U}) {
      std::int64_t last = 0;
      int since = 1;
      for (const sim::WireFrame& wire : rig.recorder.with(id)) {
        const std::int64_t position = position_in(wire.frame);
        EXPECT_LE(std::abs(position), 2000);
        EXPECT_LE(std::abs(position - last), 20 * std::min(since, 25)) << "seed " << seed;
        since = position == last ? since + 1 : 1;
        last = position;
      }
    }
    EXPECT_GT(rig.count(EventKind::limit_exceeded), 0);
  }
}

}  // namespace
}  // namespace takt
