// Limits together with the modes of an axis, and limits against random commands.
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "test/unit/master/core/pdo/limited_axes.hpp"

namespace takt::test {
namespace {

/// Adds the mode behind the target in the RPDO of the axis, and the displayed mode in its TPDO.
void add_modes(BusPlan& plan) {
  const std::size_t inputs = plan.layout.inputs;
  Signal shown = make_signal(NodeId::from(1).value(), 0, {0x6061, 0});
  shown.type = DataType::integer8;
  shown.bits = 8;
  Signal mode = shown;
  mode.object = {0x6060, 0};
  mode.output = true;
  mode.fallback_cycles = 50;
  plan.layout.signals.insert(plan.layout.signals.begin() + static_cast<std::ptrdiff_t>(inputs),
                             shown);
  plan.layout.signals.push_back(mode);
  ++plan.layout.inputs;
  const auto last = static_cast<SignalIndex>(plan.layout.signals.size() - 1);
  plan.pdos.fields.clear();
  plan.pdos.tpdos.clear();
  plan.pdos.rpdos.clear();
  const NodeId node = NodeId::from(1).value();
  add_pdo(plan, true, {.cob_id = CobId::base(0x181), .node = node, .transmission = 1},
          {{.signal = 0, .bit_offset = 0, .bits = 16},
           {.signal = 1, .bit_offset = 16, .bits = 32, .sign_extend = true},
           {.signal = 2, .bit_offset = 48, .bits = 8, .sign_extend = true}});
  add_pdo(plan, false, {.cob_id = CobId::base(0x201), .node = node, .transmission = 1},
          {{.signal = 3, .bit_offset = 0, .bits = 16},
           {.signal = 4, .bit_offset = 16, .bits = 32, .sign_extend = true},
           {.signal = last, .bit_offset = 48, .bits = 8, .sign_extend = true}});
  OutputLimit& limit = plan.limits.outputs[0];
  limit.signal = 4;
  limit.controlword = SignalIndex{3};
  limit.statusword = SignalIndex{0};
  limit.mode = last;
  limit.mode_display = SignalIndex{2};
}

TEST(OutputLimits, LetAProfiledMoveGoFarAndNoModeMakeAJumpOfIt) {
  BusPlan plan = axes({.nodes = 1, .fallback_cycles = 50});
  plan.limits.outputs.push_back(
      {.signal = 3, .high = 1000, .step = 10, .quantity = AxisQuantity::position, .feedback = 1});
  add_modes(plan);
  plan.layout.signals[4].seeded_from = SignalIndex{1};
  EventQueue events;
  PdoExchange pdos{plan, events};
  std::vector<SetPoint> points(3);
  pdos.inputs().set_reception(0, Reception::full);
  pdos.outputs().open(0, points);
  std::uint64_t cycle = 0;
  std::vector<std::uint8_t> sent;
  const auto run = [&](std::int64_t target, std::int64_t mode, std::uint8_t shown) {
    const OutputMoment moment{.cycle = ++cycle,
                              .now = static_cast<std::int64_t>(cycle) * Time{2ms}};
    pdos.inputs().receive({.frame = make_frame(CobId::base(0x181), {0x27, 0, 0, 0, 0, 0, shown}),
                           .when = moment.now});
    const std::array<std::int64_t, 3> values{enable_operation, target, mode};
    for (std::size_t i = 0; i < 3; ++i)
      points[i] = {values[i], points[i].generation + 1, 0, moment.now};
    const auto frames = pdos.outputs().pack(points, moment);
    sent.assign(frames[0].data.begin(), frames[0].data.begin() + 7);
    pdos.outputs().sent(1, moment);
  };

  run(0, 1, 8);
  run(500, 1, 8);  // the drive isn't there yet
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{2, 0, 0, 0, 0, 0, 1}));
  run(500, 1, 1);
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{0x0F, 0, 0xF4, 1, 0, 0, 1}));
  run(1500, 1, 1);  // the range holds in each mode
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{2, 0, 0xF4, 1, 0, 0, 1}));
  run(400, 1, 1);
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{0x0F, 0, 0x90, 1, 0, 0, 1}));
  run(400, 8, 1);  // the axis stands at 0
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{2, 0, 0x90, 1, 0, 0, 1}));
  run(4, 8, 1);
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{0x0F, 0, 4, 0, 0, 0, 8}));
}

TEST(OutputLimits, LetNoRandomSetPointPutAnythingOutsideOntoTheWire) {
  std::mt19937 random{1};
  const auto below = [&random](unsigned n) { return static_cast<std::int64_t>(random() % n); };
  for (int run = 0; run < 30; ++run) {
    LimitedAxes axes{1, {.low = -500, .high = 500, .step = 20, .rate = 15, .wraps = true}};
    std::int64_t last = 0;
    std::int64_t since = 1;  // cycles since a command was sent
    std::int64_t wanted = 0;
    for (int i = 0; i < 2000; ++i) {
      const bool commands = below(4) != 0;
      if (commands) {
        wanted = below(20) == 0 ? static_cast<std::int32_t>(random()) : wanted + below(36) - 18;
        if (below(10) == 0) wanted = last;
        if (below(2) == 0) {
          axes.command(0, wanted);
        } else {
          axes.write(0, enable_operation);
          axes.write(1, wanted);
        }
      }
      axes.lose_frames(below(30) == 0);
      axes.feedback(0, static_cast<std::int32_t>(last));
      axes.cycle();
      EXPECT_LE(std::abs(axes.position()), 500);
      EXPECT_LE(std::abs(axes.position() - last), 15 * std::min<std::int64_t>(since, 25));
      since = axes.position() != last ? 1 : since + 1;
      last = axes.position();
    }
    EXPECT_GT(axes.refusals(), 0U);
  }
}

}  // namespace
}  // namespace takt::test
