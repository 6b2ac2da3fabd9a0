#include "apps/takt/trajectory/trajectory_plot.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <utility>

namespace takt {
namespace {

constexpr double width = 800.0;
constexpr double left = 90.0;
constexpr double right = 20.0;
constexpr double panel_height = 130.0;
constexpr double panel_gap = 30.0;
constexpr double top = 40.0;
constexpr std::size_t points = 400;

// Colours that people with a weak sense of colour can tell from each other.
constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                             "#e69f00", "#56b4e9", "#000000", "#999999"};

/// One curve of a panel.
struct Curve {
  std::vector<double> values;
};

/// A quantity of all axes over the time.
struct Panel {
  const char* title;
  double (*value)(const motion::Profile&, const motion::State& from, double time);
};

double jerk_at(const motion::Profile& profile, const motion::State&, double time) {
  for (const motion::Segment& segment : profile.segments()) {
    if (time < segment.duration) return segment.jerk;
    time -= segment.duration;
  }
  return 0.0;
}

constexpr std::array<Panel, 4> panels{
    {{"position", [](const auto& p, const auto& from, double t) { return p.at(from, t).position; }},
     {"velocity", [](const auto& p, const auto& from, double t) { return p.at(from, t).velocity; }},
     {"acceleration",
      [](const auto& p, const auto& from, double t) { return p.at(from, t).acceleration; }},
     {"jerk", jerk_at}}};

class Picture {
 public:
  explicit Picture(const TrajectoryAnswer& answer) : answer_{answer} {
    const double height = top + static_cast<double>(panels.size()) * (panel_height + panel_gap);
    write(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
        "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height);
    write_legend();
    for (std::size_t i = 0; i < panels.size(); ++i) {
      write_panel(panels[i], top + static_cast<double>(i) * (panel_height + panel_gap));
    }
    write("</svg>\n");
  }

  std::string text() && { return std::move(text_); }

 private:
  template <class... Arguments>
  void write(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
  }

  double time_of(std::size_t point) const {
    return answer_.duration * static_cast<double>(point) / static_cast<double>(points - 1);
  }

  void write_legend() {
    for (std::size_t i = 0; i < answer_.axes.size(); ++i) {
      write("<text x=\"{:.1f}\" y=\"20\" fill=\"{}\">axis {}</text>\n",
            left + 70.0 * static_cast<double>(i), colours[i % colours.size()], i);
    }
  }

  void write_panel(const Panel& panel, double y) {
    std::vector<Curve> curves;
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < answer_.axes.size(); ++i) {
      Curve& curve = curves.emplace_back();
      for (std::size_t point = 0; point < points; ++point) {
        const double value =
            panel.value(answer_.axes[i].profile, answer_.request.tasks[i].from, time_of(point));
        curve.values.push_back(value);
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    const double range = high > low ? high - low : 1.0;
    write(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#cccccc\"/>\n"
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g}</text>\n"
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g}</text>\n"
        "<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n"
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.4g} s</text>\n",
        left, y, width - left - right, panel_height, left - 6, y + 10, high, left - 6,
        y + panel_height, low, left, y - 6, panel.title, width - right, y + panel_height + 14,
        answer_.duration);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      write("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"",
            colours[i % colours.size()]);
      for (std::size_t point = 0; point < points; ++point) {
        const double x = left + (width - left - right) * static_cast<double>(point) /
                                    static_cast<double>(points - 1);
        const double part = (curves[i].values[point] - low) / range;
        write("{:.1f},{:.1f} ", x, y + panel_height * (1.0 - part));
      }
      write("\"/>\n");
    }
  }

  const TrajectoryAnswer& answer_;
  std::string text_;
};

}  // namespace

std::string trajectory_svg(const TrajectoryAnswer& answer) { return Picture{answer}.text(); }

}  // namespace takt
