#include "apps/takt/trajectory/trajectory_plot.hpp"

#include <array>
#include <fmt/format.h>

#include "apps/plot/plot.hpp"

namespace takt {
namespace {

constexpr std::size_t points = 700;

/// A quantity of all axes over the time.
struct Quantity {
  const char* name;
  const char* unit;
  double (*value)(const motion::Profile&, const motion::State& from, double time);
};

double jerk_at(const motion::Profile& profile, const motion::State&, double time) {
  for (const motion::Segment& segment : profile.segments()) {
    if (time < segment.duration) return segment.jerk;
    time -= segment.duration;
  }
  return 0.0;
}

constexpr std::array<Quantity, 4> quantities{
    {{"position", "unit",
      [](const auto& p, const auto& from, double t) { return p.at(from, t).position; }},
     {"velocity", "unit/s",
      [](const auto& p, const auto& from, double t) { return p.at(from, t).velocity; }},
     {"acceleration", "unit/s²",
      [](const auto& p, const auto& from, double t) { return p.at(from, t).acceleration; }},
     {"jerk", "unit/s³", jerk_at}}};

}  // namespace

std::string trajectory_svg(const TrajectoryAnswer& answer) {
  Plot plot{.title = fmt::format("trajectory of {:.4g} s", answer.duration)};
  for (std::size_t point = 0; point < points; ++point) {
    plot.times.push_back(answer.duration * static_cast<double>(point) /
                         static_cast<double>(points - 1));
  }
  for (std::size_t i = 0; i < answer.axes.size(); ++i) {
    plot.legend.push_back({.text = fmt::format("axis {}", i), .colour = i});
  }
  for (const Quantity& quantity : quantities) {
    Panel& panel =
        plot.panels.emplace_back(Panel{.quantity = quantity.name, .unit = quantity.unit});
    for (std::size_t i = 0; i < answer.axes.size(); ++i) {
      Curve& curve = panel.curves.emplace_back(Curve{.colour = i});
      for (const double time : plot.times) {
        curve.values.push_back(
            quantity.value(answer.axes[i].profile, answer.request.tasks[i].from, time));
      }
    }
  }
  return plot_svg(plot);
}

}  // namespace takt
