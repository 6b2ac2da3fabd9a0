#include "apps/plot/motion/motion_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace takt {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// Velocities and accelerations are computed from means of actual values over this time, in
/// seconds. The difference of two cycles would show mainly the steps of the encoder.
constexpr double window = 0.04;

using Values = std::vector<double>;

/// Sums of values, for means over many of them. A missing value counts as the previous value.
class Sums {
 public:
  explicit Sums(const Values& values) : sums_{0.0} {
    double newest = 0.0;
    for (const double value : values) {
      if (!std::isnan(value)) newest = value;
      sums_.push_back(sums_.back() + newest);
    }
  }
  double mean(std::size_t first, std::size_t end) const {
    return (sums_[end] - sums_[first]) / static_cast<double>(end - first);
  }

 private:
  Values sums_;
};

/// Returns the slope at each time, from the means of the values in the window after it and in the
/// window before it. The slope is NaN at the ends.
Values slopes(const Values& values, const Values& times) {
  Values slopes(values.size(), none);
  const Sums sums{values};
  const Sums of_times{times};
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (times[i] - times[first] > window) ++first;
    while (end < values.size() && times[end] - times[i] <= window) ++end;
    if (first == i || end == i + 1) continue;
    const double time = of_times.mean(i, end) - of_times.mean(first, i);
    slopes[i] = (sums.mean(i, end) - sums.mean(first, i)) / time;
  }
  return slopes;
}

/// The curves of one axis.
struct Curves {
  Values position;
  Values velocity;
  Values acceleration;
  Values actual_position;
  Values actual_velocity;
  Values actual_acceleration;
  Values following_error;
};

/// One panel: the commanded values, which may be missing, and the actual ones.
struct Quantity {
  const char* name;
  const char* per_time;
  Values Curves::* commanded;
  Values Curves::* actual;
};

constexpr std::array<Quantity, 4> quantities{
    {{"position", "", &Curves::position, &Curves::actual_position},
     {"velocity", "/s", &Curves::velocity, &Curves::actual_velocity},
     {"acceleration", "/s²", &Curves::acceleration, &Curves::actual_acceleration},
     {"following error", "", nullptr, &Curves::following_error}}};

std::string unit_of(const TracedAxis& axis) { return axis.unit.empty() ? "counts" : axis.unit; }

}  // namespace

void MotionTrace::take(const motion_t& message) {
  if (message.session != session_) {  // taktd has restarted, and counts cycles anew
    session_ = message.session;
    cycles_.clear();
    every_ = 1;
  }
  if (message.cycle % every_ != 0) return;
  const bool same = !cycles_.empty() && cycles_.back().number == message.cycle;
  if (!same && !cycles_.empty() && cycles_.back().number > message.cycle) return;
  if (!same && cycles_.size() >= most_cycles) thin_out();
  if (message.cycle % every_ != 0) return;
  Cycle& cycle = same ? cycles_.back() : cycles_.emplace_back(Cycle{message.cycle, {}});
  for (const axis_motion_t& axis : message.axes) {
    cycle.reports.push_back({.node_id = axis.node_id,
                             .axis = axis.axis,
                             .position = axis.position,
                             .velocity = axis.velocity,
                             .acceleration = axis.acceleration,
                             .actual_position = axis.actual_position,
                             .actual_velocity = axis.actual_velocity,
                             .following_error = axis.following_error});
  }
}

void MotionTrace::thin_out() {
  every_ *= 2;
  std::erase_if(cycles_, [this](const Cycle& cycle) { return cycle.number % every_ != 0; });
}

const MotionTrace::Report* MotionTrace::find(const Cycle& cycle, const TracedAxis& axis) const {
  const auto found = std::ranges::find_if(cycle.reports, [&](const Report& report) {
    return report.node_id == axis.node_id && report.axis == axis.axis;
  });
  return found == cycle.reports.end() ? nullptr : &*found;
}

Plot MotionTrace::plot(std::string title, std::span<const TracedAxis> axes, double period) const {
  Plot plot{.title = std::move(title)};
  for (const Cycle& cycle : cycles_) {
    plot.times.push_back(static_cast<double>(cycle.number - cycles_.front().number) * period);
  }
  std::vector<Curves> curves;
  std::vector<std::string> units;
  for (const TracedAxis& axis : axes) {
    Curves& drawn = curves.emplace_back();
    for (const Cycle& cycle : cycles_) {
      const Report* report = find(cycle, axis);
      drawn.position.push_back(report ? report->position : none);
      drawn.velocity.push_back(report ? report->velocity : none);
      drawn.acceleration.push_back(report ? report->acceleration : none);
      drawn.actual_position.push_back(report ? report->actual_position : none);
      drawn.actual_velocity.push_back(report ? report->actual_velocity : none);
      drawn.following_error.push_back(report ? report->following_error : none);
    }
    if (!axis.has_velocity) {
      drawn.actual_velocity = slopes(drawn.actual_position, plot.times);
    }
    drawn.actual_acceleration = slopes(drawn.actual_velocity, plot.times);
    const std::string unit = unit_of(axis);
    if (std::ranges::find(units, unit) == units.end()) units.push_back(unit);
    const std::size_t colour = curves.size() - 1;
    plot.legend.push_back({.text = axis.name + " commanded", .colour = colour});
    plot.legend.push_back({.text = "actual", .colour = colour, .stroke = Stroke::broad});
  }
  if (cycles_.empty()) return plot;
  for (const Quantity& quantity : quantities) {
    for (const std::string& unit : units) {
      Panel& panel = plot.panels.emplace_back(
          Panel{.quantity = quantity.name, .unit = unit + quantity.per_time});
      for (std::size_t i = 0; i < axes.size(); ++i) {
        if (unit_of(axes[i]) != unit) continue;
        const Stroke stroke = quantity.commanded ? Stroke::broad : Stroke::thin;
        panel.curves.push_back(
            {.values = curves[i].*quantity.actual, .colour = i, .stroke = stroke});
        if (!quantity.commanded) continue;
        panel.curves.push_back({.values = curves[i].*quantity.commanded, .colour = i});
      }
    }
  }
  plot.note = "The actual acceleration is computed from means of the actual velocity over 40 ms.";
  if (every_ > 1) plot.note += fmt::format(" A long run: each {}th cycle is drawn.", every_);
  return plot;
}

}  // namespace takt
