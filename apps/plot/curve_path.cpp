#include "apps/plot/curve_path.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace takt {
namespace {

/// Largest distance from the line at which a point is left out, in pixels.
constexpr double flat = 0.15;

/// Width of a column, pixels.
constexpr double column = 2.0;

/// Returns the outermost points of each column, in their order.
std::vector<PlotPoint> outermost(const std::vector<PlotPoint>& points) {
  std::vector<PlotPoint> kept;
  for (auto first = points.begin(); first != points.end();) {
    const auto next = std::find_if(first, points.end(), [&](const PlotPoint& point) {
      return std::floor(point.x / column) != std::floor(first->x / column) || std::isnan(point.y);
    });
    if (next == first) {
      kept.push_back(*first++);  // a gap
      continue;
    }
    auto [low, high] = std::minmax_element(
        first, next, [](const PlotPoint& a, const PlotPoint& b) { return a.y < b.y; });
    if (high < low) std::swap(low, high);
    kept.push_back(*low);
    if (high->y != low->y) kept.push_back(*high);
    first = next;
  }
  return kept;
}

/// Returns how far a point is above or below the line between two others.
double apart(const PlotPoint& point, const PlotPoint& from, const PlotPoint& to) {
  if (to.x <= from.x) return 1e9;
  const double part = (point.x - from.x) / (to.x - from.x);
  return std::abs(point.y - (from.y + part * (to.y - from.y)));
}

}  // namespace

std::string path_along(const std::vector<PlotPoint>& points) {
  std::vector<PlotPoint> all = outermost(points);
  if (!points.empty() && !all.empty() && !std::isnan(points.back().y)) all.push_back(points.back());
  std::string text;
  const char* command = "M";
  for (std::size_t i = 0; i < all.size();) {
    if (std::isnan(all[i].y)) {
      command = "M";
      ++i;
      continue;
    }
    fmt::format_to(std::back_inserter(text), "{}{:.1f} {:.1f}", command, all[i].x, all[i].y);
    command = "L";
    std::size_t end = i + 1;
    const auto straight = [&](std::size_t to) {
      for (std::size_t k = i + 1; k < to; ++k) {
        if (apart(all[k], all[i], all[to]) > flat) return false;
      }
      return true;
    };
    while (end + 1 < all.size() && !std::isnan(all[end].y) && !std::isnan(all[end + 1].y) &&
           straight(end + 1)) {
      ++end;
    }
    i = end;
  }
  return text;
}

}  // namespace takt
