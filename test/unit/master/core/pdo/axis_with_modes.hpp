#pragma once
#include <cstring>
#include <string>
#include <vector>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/pdo/limited_axes.hpp"

namespace takt::test {

// Statuswords.
inline constexpr std::uint16_t switched_on = 0x0023;
inline constexpr std::uint16_t disabled = 0x0040;
inline constexpr std::uint16_t enabled = 0x0027;
inline constexpr std::uint16_t in_fault = 0x0008;

// Outputs of AxisWithModes.
inline constexpr SignalIndex order_output = 3;
inline constexpr SignalIndex target_output = 4;
inline constexpr SignalIndex mode_output = 5;
inline constexpr SignalIndex offset_output = 6;

/// The objects of a target and of the offset that a drive adds to it.
struct AxisPair {
  AxisQuantity quantity = AxisQuantity::position;
  std::uint16_t target = 0x607A;
  std::uint16_t offset = 0x60B0;
  LimitKind kind = LimitKind::position;
};

/// One axis with 6041, 6064 and 6061 in TPDO1, with 6040, 607A and 6060 in RPDO1, and with 60B0 in
/// RPDO2. Positions are 1 mrad per count. `pair` may name another target and its offset. The limit
/// applies to both.
class AxisWithModes {
 public:
  explicit AxisWithModes(OutputLimit limit, AxisPair pair = {})
      : plan_{make_plan(limit, pair)}, pdos_{plan_, events_} {
    pdos_.inputs().set_reception(0, Reception::full);
    pdos_.outputs().open(0, points_);
  }
  void feedback(std::int32_t position, std::uint16_t statusword, std::int8_t mode) {
    Frame frame{.id = CobId::base(0x181), .length = 7};
    std::memcpy(frame.data.data(), &statusword, 2);
    std::memcpy(frame.data.data() + 2, &position, 4);
    std::memcpy(frame.data.data() + 6, &mode, 1);
    pdos_.inputs().receive({.frame = frame, .when = now_});
  }
  void set(SignalIndex output, std::int64_t value) {
    points_[output - 3U] = {value, points_[output - 3U].generation + 1, 0, now_ + Time{1ms}};
  }
  void write(SignalIndex output, std::int64_t value) {
    pdos_.outputs().command(output, value, 0, {.cycle = cycle_ + 1, .now = now_ + Time{2ms}});
  }
  void cycle() {
    now_ += 2ms;
    const OutputMoment moment{.cycle = ++cycle_, .now = now_};
    for (const Frame& frame : pdos_.outputs().pack(points_, moment)) {
      (frame.id == CobId::base(0x201) ? sent_ : offset_) = frame;
    }
    pdos_.outputs().sent(100, moment);
  }
  std::int64_t controlword() const { return sent_.data[0]; }
  std::int32_t target() const {
    std::int32_t value = 0;
    std::memcpy(&value, sent_.data.data() + 2, 4);
    return value;
  }
  std::int32_t offset() const {
    std::int32_t value = 0;
    std::memcpy(&value, offset_.data.data(), 4);
    return value;
  }
  std::vector<std::string> refusals() {
    std::vector<std::string> all;
    for (Event event; events_.pop(event);) {
      if (event.kind == EventKind::limit_exceeded) all.push_back(describe(plan_, event));
    }
    return all;
  }

 private:
  static BusPlan make_plan(OutputLimit limit, AxisPair pair) {
    BusPlan plan = test::axes({.nodes = 1, .fallback_cycles = 50});
    const NodeId node = NodeId::from(1).value();
    const auto signal = [&](std::uint16_t index, DataType type, std::uint8_t bits) {
      Signal made = make_signal(node, 0, {index, 0});
      made.type = type;
      made.bits = bits;
      made.output = index != 0x6061;
      made.fallback_cycles = made.output ? 50 : 0;
      return made;
    };
    auto& signals = plan.layout.signals;
    signals.insert(signals.begin() + 2, signal(0x6061, DataType::integer8, 8));
    signals.push_back(signal(0x6060, DataType::integer8, 8));
    signals.push_back(signal(pair.offset, DataType::integer32, 32));
    signals[4].object = {pair.target, 0};
    for (const std::size_t position : {1U, 4U, 6U}) {
      signals[position].scale = 0.001;
      signals[position].unit = "rad";
    }
    plan.layout.inputs = 3;
    plan.pdos.fields.clear();
    plan.pdos.tpdos.clear();
    plan.pdos.rpdos.clear();
    add_pdo(plan, true, {.cob_id = CobId::base(0x181), .node = node, .transmission = 1},
            {{.signal = 0, .bit_offset = 0, .bits = 16},
             {.signal = 1, .bit_offset = 16, .bits = 32, .sign_extend = true},
             {.signal = 2, .bit_offset = 48, .bits = 8, .sign_extend = true}});
    add_pdo(plan, false, {.cob_id = CobId::base(0x201), .node = node, .transmission = 1},
            {{.signal = 3, .bit_offset = 0, .bits = 16},
             {.signal = 4, .bit_offset = 16, .bits = 32, .sign_extend = true},
             {.signal = 5, .bit_offset = 48, .bits = 8, .sign_extend = true}});
    add_pdo(plan, false, {.cob_id = CobId::base(0x301), .node = node, .transmission = 1},
            {{.signal = 6, .bit_offset = 0, .bits = 32, .sign_extend = true}});
    signals[6].row = 1;
    limit.quantity = pair.quantity;
    limit.range = pair.kind;
    limit.mode = SignalIndex{5};
    limit.mode_display = SignalIndex{2};
    OutputLimit own = limit;
    limit.signal = 4;
    limit.offset = SignalIndex{6};
    own.signal = 6;
    own.target = SignalIndex{4};
    if (pair.quantity == AxisQuantity::position) {
      limit.controlword = SignalIndex{3};
      limit.feedback = SignalIndex{1};
      limit.statusword = SignalIndex{0};
      own.low = -OutputLimit::none;
      own.high = OutputLimit::none;
      own.bend = OutputLimit::none;
    }
    plan.limits.outputs = {limit, own};
    return plan;
  }

  BusPlan plan_;
  EventQueue events_;
  PdoExchange pdos_;
  std::vector<SetPoint> points_{4};
  Frame sent_{};
  Frame offset_{};
  std::uint64_t cycle_ = 0;
  Time now_{};
};

}  // namespace takt::test
