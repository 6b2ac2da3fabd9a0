#pragma once
#include <gtest/gtest.h>
#include <vector>

#include "master/rt/motion/driven_axis.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::test {

struct BenchOptions {
  bool commands_controlword = true;  ///< otherwise RPDO1 has an object without a value
  bool mode = false;                 ///< RPDO2 has the mode of operation (6060)
};

/// One axis with a velocity offset (60B1) in RPDO2. A count is 0.01 rad, and 0.1 rad/s.
inline BusPlan one_axis(bool mode = false) {
  BusPlan plan = axes({.nodes = 1, .fallback_cycles = 0});
  for (Signal& signal : plan.layout.signals) {
    if (signal.object.index != 0x6064 && signal.object.index != 0x607A) continue;
    signal.scale = 0.01;
    signal.unit = "rad";
  }
  Signal offset = make_signal(1_node, 0, {0x60B1, 0});
  offset.type = DataType::integer32;
  offset.bits = 32;
  offset.output = true;
  offset.row = 1;
  offset.scale = 0.1;
  offset.unit = "rad/s";
  plan.layout.signals.push_back(offset);
  add_pdo(plan, false, {.cob_id = CobId::base(0x301), .node = 1_node, .transmission = 1},
          {{.signal = 4, .bit_offset = 0, .bits = 32, .sign_extend = true}});
  if (!mode) return plan;
  Signal modes = make_signal(1_node, 0, {0x6060, 0});
  modes.type = DataType::integer8;
  modes.bits = 8;
  modes.output = true;
  modes.row = 2;
  plan.layout.signals.push_back(modes);
  add_pdo(plan, false, {.cob_id = CobId::base(0x401), .node = 1_node, .transmission = 1},
          {{.signal = 5, .bit_offset = 0, .bits = 8, .sign_extend = true}});
  return plan;
}

class Bench {
 public:
  explicit Bench(BenchOptions options = {}) : Bench{one_axis(options.mode), options} {}
  explicit Bench(BusPlan made, BenchOptions options = {})
      : plan{std::move(made)}, pdos{plan, events}, axis{motion_axes(plan).at(0), plan} {
    pdos.inputs().set_reception(0, Reception::full);
    pdos.outputs().open(0, points);
    if (options.commands_controlword) command(0, 0x000F);
    if (options.mode) command(3, 8);
    hear(0x0023, 0);
    pack();
  }
  void hear(std::uint16_t statusword, std::int32_t position) {
    ++cycle;
    pdos.inputs().begin(cycle, Time{cycle * 2'000'000});
    StampedFrame stamped{.frame = {}, .when = Time{cycle * 2'000'000 + 100'000}};
    stamped.frame.id = CobId::base(0x181);
    stamped.frame.length = 6;
    for (unsigned i = 0; i < 2; ++i) {
      stamped.frame.data[i] = static_cast<std::uint8_t>(statusword >> 8 * i);
    }
    for (unsigned i = 0; i < 4; ++i) {
      stamped.frame.data[2 + i] = static_cast<std::uint8_t>(position >> 8 * i);
    }
    ASSERT_TRUE(pdos.inputs().receive(stamped));
    pdos.inputs().close(stamped.when);
  }
  /// Sends the outputs of the cycle, or only packs them. Without a controlword, RPDO1 has a value
  /// that is not known.
  void pack(bool sends = true) {
    const OutputMoment moment{.cycle = cycle, .now = Time{cycle * 2'000'000}};
    const std::size_t count = pdos.outputs().pack(points, moment).size();
    pdos.outputs().sent(sends ? count : 0, moment);
  }
  void command(std::size_t output, std::int64_t value) {
    SetPoint& point = points[output];
    point = {
        .value = value, .generation = point.generation + 1, .when = Time{(cycle + 1) * 2'000'000}};
  }
  void hear_nothing() {
    ++cycle;
    pdos.inputs().begin(cycle, Time{cycle * 2'000'000});
    pdos.inputs().close(Time{cycle * 2'000'000 + 1'000'000});
  }
  motion::AxisCondition condition(bool exchanging = true) {
    return axis.read(pdos, exchanging, last).condition;
  }
  bool write(motion::AxisState state, motion::State commanded) {
    last.state = state;
    last.commanded = commanded;
    return axis.write(pdos.outputs(), last, {.cycle = cycle, .now = Time{cycle * 2'000'000}});
  }
  std::int64_t target() const { return pdos.image().values[3]; }
  std::int64_t offset() const { return pdos.image().values[4]; }

  BusPlan plan;
  EventQueue events;
  PdoExchange pdos;
  DrivenAxis axis;
  motion::AxisReport last;
  std::vector<SetPoint> points = std::vector<SetPoint>(4);
  std::uint64_t cycle = 0;
};

}  // namespace takt::test
