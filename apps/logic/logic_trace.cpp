#include "apps/logic/logic_trace.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

constexpr double low_panel = 26.0;

}  // namespace

void LogicTrace::take(double time, const std::vector<double>& values) {
  end_ = time;
  if (changes_.size() >= most_changes) return;
  if (changes_.empty() || changes_.back().values != values) changes_.push_back({time, values});
}

Plot LogicTrace::plot(std::string title, const std::vector<std::string>& names) const {
  Plot plot{.title = std::move(title)};
  for (std::size_t i = 0; i < names.size(); ++i) {
    plot.panels.push_back({.quantity = names[i], .curves = {Curve{}}, .height = low_panel});
  }
  const auto add = [&](double time, const Change& change) {
    plot.times.push_back(time);
    const std::size_t count = std::min(names.size(), change.values.size());
    for (std::size_t i = 0; i < count; ++i) {
      plot.panels[i].curves.front().values.push_back(change.values[i]);
    }
  };
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    add(changes_[i].time, changes_[i]);
    add(i + 1 < changes_.size() ? changes_[i + 1].time : end_, changes_[i]);
  }
  if (changes_.size() >= most_changes) plot.note = "The first 20,000 changes are drawn.";
  return plot;
}

}  // namespace takt
