#pragma once
#include <array>
#include <cstring>
#include <vector>

#include "master/core/pdo/pdo_exchange.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::test {

using namespace std::chrono_literals;

inline constexpr std::int64_t enable_operation = 0x000F;
inline constexpr std::int64_t quick_stop = 0x0002;

/// Axes with positions of 1 mrad per count and a cycle of 2 ms, and the outputs that the master
/// sends to them.
class LimitedAxes {
 public:
  explicit LimitedAxes(unsigned axes, const OutputLimit& limit, void (*change)(BusPlan&) = nullptr)
      : axes_{axes}, plan_{make_plan(axes, limit, change)}, pdos_{plan_, events_} {
    points_.resize(plan_.layout.outputs());
    for (unsigned i = 0; i < axes; ++i) {
      pdos_.inputs().set_reception(i, Reception::full);
      pdos_.outputs().open(i, points_);
      feedback(i, 0);
    }
  }

  void feedback(unsigned axis, std::int32_t position, std::uint16_t statusword = 0x0027) {
    Frame frame{.id = CobId::base(0x181 + axis), .length = 6};
    std::memcpy(frame.data.data(), &statusword, 2);
    std::memcpy(frame.data.data() + 2, &position, 4);
    pdos_.inputs().receive({.frame = frame, .when = now_});
  }
  void command(unsigned axis, std::int64_t position, std::int64_t controlword = enable_operation) {
    set(axis, controlword);
    set(axes_ + axis, position);
  }
  void set(std::size_t output, std::int64_t value) {
    points_[output] = {value, points_[output].generation + 1, 0, now_ + Time{1ms}};
  }
  void release(std::size_t output) {
    points_[output] = {0, points_[output].generation + 1, output_released, now_ + Time{1ms}};
  }
  /// Writes an output from within the bus thread.
  void write(std::size_t output, std::int64_t value) {
    pdos_.outputs().command(static_cast<SignalIndex>(plan_.layout.inputs + output), value, 0,
                            next_moment());
  }
  /// Runs one cycle; controlword() and position() then give the sent values.
  void cycle() {
    const OutputMoment moment = next_moment();
    ++cycle_;
    now_ = moment.now;
    for (const Frame& frame : pdos_.outputs().pack(points_, moment)) {
      for (unsigned i = 0; i < axes_; ++i) {
        if (goes_out_ && frame.id == plan_.pdos.rpdos[i].cob_id) sent_[i] = frame;
      }
    }
    pdos_.outputs().sent(goes_out_ ? 100 : 0, moment);
  }
  void cycle_with(unsigned axis, std::int64_t position) {
    command(axis, position);
    cycle();
  }
  /// The node exchanges PDOs again; its boot has reported no limits.
  void open(unsigned axis) { pdos_.outputs().open(axis, points_); }
  /// The node has booted again and has not sent a TPDO since.
  void boot(unsigned axis) {
    pdos_.inputs().set_reception(axis, Reception::off);
    pdos_.inputs().set_reception(axis, Reception::full);
    open(axis);
  }
  void learn(unsigned axis, std::span<const LimitReading> readings) {
    pdos_.outputs().learn(axis, readings, next_moment());
  }
  const BusPlan& plan() const { return plan_; }
  void lose_frames(bool lost) { goes_out_ = !lost; }

  std::int64_t controlword(unsigned axis = 0) const {
    std::uint16_t word = 0;
    std::memcpy(&word, sent_[axis].data.data(), 2);
    return word;
  }
  std::int64_t position(unsigned axis = 0) const {
    std::int32_t position = 0;
    std::memcpy(&position, sent_[axis].data.data() + 2, 4);
    return position;
  }
  std::vector<Event> reported() {
    std::vector<Event> all;
    for (Event event; events_.pop(event);) all.push_back(event);
    return all;
  }
  unsigned refusals() {
    unsigned count = 0;
    for (const Event& event : reported()) count += event.kind == EventKind::limit_exceeded;
    return count;
  }

 private:
  static BusPlan make_plan(unsigned axes, OutputLimit limit, void (*change)(BusPlan&)) {
    BusPlan plan = test::axes({.nodes = axes, .fallback_cycles = 50});
    for (unsigned i = 0; i < axes; ++i) {
      limit.signal = static_cast<SignalIndex>(3 * axes + i);
      limit.quantity = AxisQuantity::position;
      limit.controlword = static_cast<SignalIndex>(2 * axes + i);
      limit.statusword = static_cast<SignalIndex>(i);
      limit.feedback = static_cast<SignalIndex>(axes + i);
      plan.layout.signals[limit.signal].scale = 0.001;
      plan.layout.signals[limit.signal].unit = "rad";
      plan.limits.outputs.push_back(limit);
    }
    if (change != nullptr) change(plan);
    return plan;
  }
  OutputMoment next_moment() const {
    return {.cycle = cycle_ + 1, .now = static_cast<std::int64_t>(cycle_ + 1) * Time{2ms}};
  }

  unsigned axes_;
  BusPlan plan_;
  EventQueue events_;
  PdoExchange pdos_;
  std::vector<SetPoint> points_;
  std::array<Frame, 4> sent_{};
  std::uint64_t cycle_ = 0;
  Time now_{};
  bool goes_out_ = true;
};

inline const OutputLimit stepping{.step = 10, .wraps = true};

}  // namespace takt::test
