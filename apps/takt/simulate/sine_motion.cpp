#include "apps/takt/simulate/sine_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt {
namespace {

constexpr double frequency = 0.5;     // Hz
constexpr double amplitude_si = 0.5;  // in the unit of the position, if the position has a unit
constexpr double amplitude_counts = 5000.0;  // for a position without a unit
constexpr std::int64_t cyclic_position = 8;

double amplitude_of(const Signal& position) {
  return position.unit.empty() || position.scale == 0 ? amplitude_counts
                                                      : std::abs(amplitude_si / position.scale);
}

}  // namespace

SineMotion::SineMotion(const BusPlan& plan) {
  find_axes(plan);
  values_.reserve(plan.layout.outputs());
  for (std::size_t i = plan.layout.inputs; i < plan.layout.signals.size(); ++i) {
    const auto signal = static_cast<SignalIndex>(i);
    const bool used = std::ranges::any_of(axes_, [signal](const Axis& axis) {
      return axis.controlword == signal || axis.target == signal || axis.mode == signal;
    });
    if (!used) others_.push_back(signal);
  }
}

void SineMotion::find_axes(const BusPlan& plan) {
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    if (!plan.nodes[node].cia402) continue;
    const auto controlword = plan.layout.find(node, {0x6040, 0}, true);
    const auto statusword = plan.layout.find(node, {0x6041, 0}, false);
    const auto target = plan.layout.find(node, {0x607A, 0}, true);
    const auto actual = plan.layout.find(node, {0x6064, 0}, false);
    if (!controlword || !statusword || !target || !actual) continue;
    Axis axis{.controlword = *controlword,
              .statusword = *statusword,
              .target = *target,
              .actual = *actual,
              .mode = plan.layout.find(node, {0x6060, 0}, true),
              .amplitude = amplitude_of(plan.layout.signals[*target])};
    axis.sequence.set_goal(DriveGoal::enabled);
    axes_.push_back(axis);
  }
}

void SineMotion::update(const ImageView& image, OutputWriter& outputs) noexcept {
  for (const Value& value : next(image)) outputs.set(value.signal, value.value);
}

std::span<const SineMotion::Value> SineMotion::next(const ImageView& image) noexcept {
  values_.clear();
  for (const SignalIndex signal : others_) set(signal, 0);
  std::size_t moving = 0;
  for (Axis& axis : axes_) {
    lead(axis, image);
    moving += axis.since.has_value();
  }
  most_moving_ = std::max(most_moving_, moving);
  return values_;
}

void SineMotion::lead(Axis& axis, const ImageView& image) noexcept {
  const auto statusword = static_cast<std::uint16_t>(image.values[axis.statusword]);
  set(axis.controlword, axis.sequence.step(statusword));
  if (axis.mode) set(*axis.mode, cyclic_position);
  if (!axis.sequence.enabled()) {
    axis.since.reset();
    set(axis.target, image.values[axis.actual]);
    const bool fault = axis.sequence.in_fault();
    if (fault && !axis.fault) axis.sequence.reset_fault();
    axis.fault = fault;
    if (!fault) axis.sequence.set_goal(DriveGoal::enabled);
    return;
  }
  if (!axis.since) {
    axis.since = image.sync_time;
    axis.centre = static_cast<double>(image.values[axis.actual]);
  }
  const double way = axis.amplitude * stroke(image.sync_time - *axis.since) / 2;
  set(axis.target, std::llround(axis.centre + way));
}

/// Returns 0 to 2. The motion is at rest at the beginning and the end of each period. Axes that
/// began in the same cycle share one computation.
double SineMotion::stroke(Time moved) noexcept {
  if (moved != stroke_at_) {
    const double t = std::chrono::duration<double>(moved).count();
    stroke_ = 1 - std::cos(2 * std::numbers::pi * frequency * t);
    stroke_at_ = moved;
  }
  return stroke_;
}

}  // namespace takt
