#include "apps/plot/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "apps/plot/curve_path.hpp"
#include "apps/plot/ticks.hpp"

namespace takt {
namespace {

constexpr double width = 800.0;
constexpr double left = 84.0;
constexpr double right = 16.0;
constexpr double inner_width = width - left - right;
constexpr double lowest_high_panel = 60.0;
constexpr double panel_gap = 22.0;
constexpr double title_height = 30.0;
constexpr double legend_line = 18.0;
constexpr double letter_width = 7.2;  // width of an ordinary letter of the legend
constexpr double legend_mark = 24.0;
constexpr double below_panels = 44.0;  // ticks and title of the time
constexpr double note_height = 20.0;
constexpr int ticks_of_panel = 4;
constexpr int ticks_of_time = 8;

/// Colours that people with a colour vision deficiency can distinguish, on a light and on a dark
/// background.
constexpr std::array colours{"#2a7fc1", "#d55e00", "#009e73", "#cc79a7",
                             "#c99700", "#56b4e9", "#8a6bbe", "#909090"};

constexpr const char* styles =
    "<style>\n"
    "text{fill:#222;font:12px sans-serif}\n"
    ".title{font-size:14px;font-weight:bold}\n"
    ".ground{fill:#fff}.frame{fill:none;stroke:#777}.grid{fill:none;stroke:#e2e2e2}\n"
    ".zero{fill:none;stroke:#777}.curve{fill:none;stroke-linejoin:round}\n"
    ".thin{stroke-width:1.4}.broad{stroke-width:5;stroke-opacity:.38}\n"
    "@media (prefers-color-scheme:dark){text{fill:#ddd}.ground{fill:#16181c}\n"
    ".grid{stroke:#33363c}.frame,.zero{stroke:#999}}\n"
    "</style>\n";

const char* colour(std::size_t number) { return colours[number % colours.size()]; }
const char* style(Stroke stroke) { return stroke == Stroke::thin ? "thin" : "broad"; }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    if (letter == '&') {
      out += "&amp;";
    } else if (letter == '<') {
      out += "&lt;";
    } else if (letter == '>') {
      out += "&gt;";
    } else if (letter == '"') {
      out += "&quot;";
    } else {
      out += static_cast<unsigned char>(letter) < 0x20 ? '?' : letter;
    }
  }
  return out;
}

class Picture {
 public:
  explicit Picture(const Plot& plot)
      : plot_{plot},
        time_{enclosing_ticks(plot.times.empty() ? 0.0 : plot.times.front(),
                              plot.times.empty() ? 1.0 : plot.times.back(), ticks_of_time)} {
    const double top = write_legend(title_height + 4.0) + 14.0;
    const std::string legend = std::exchange(text_, {});
    double y = top;
    for (const Panel& panel : plot_.panels) {
      write_panel(panel, y);
      y += panel.height + panel_gap;
    }
    y -= panel_gap;
    write_times(y);
    y += below_panels;
    if (!plot_.note.empty()) {
      write("<text x=\"{}\" y=\"{:.0f}\">{}</text>\n", left, y + 6.0, escaped(plot_.note));
      y += note_height;
    }
    const std::string panels = std::exchange(text_, {});
    write(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0} {1:.0f}\">\n{2}"
        "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n"
        "<text class=\"title\" x=\"{3}\" y=\"20\">{4}</text>\n{5}{6}</svg>\n",
        width, y, styles, left, escaped(plot_.title), legend, panels);
  }

  std::string text() && { return std::move(text_); }

 private:
  template <class... Arguments>
  void write(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
  }

  double x_of(double time) const {
    return left + inner_width * (time - time_.low()) / (time_.high() - time_.low());
  }

  /// Returns the y of the newest line of the legend.
  double write_legend(double y) {
    double x = left;
    for (const LegendEntry& entry : plot_.legend) {
      const double wide =
          legend_mark + 8.0 + letter_width * static_cast<double>(entry.text.size()) + 14.0;
      if (x > left && x + wide > width - right) {
        x = left;
        y += legend_line;
      }
      write(
          "<path class=\"curve {}\" stroke=\"{}\" d=\"M{:.1f} {:.1f}h{}\"/>"
          "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
          style(entry.stroke), colour(entry.colour), x, y, legend_mark, x + legend_mark + 6.0,
          y + 4.0, escaped(entry.text));
      x += wide;
    }
    return y;
  }

  void write_panel(const Panel& panel, double top) {
    double low = 0.0;
    double high = 0.0;
    bool any = false;
    for (const Curve& curve : panel.curves) {
      for (const double value : curve.values) {
        if (!std::isfinite(value)) continue;
        low = any ? std::min(low, value) : value;
        high = any ? std::max(high, value) : value;
        any = true;
      }
    }
    const bool is_low = panel.height < lowest_high_panel;
    const Ticks ticks = enclosing_ticks(low, high, is_low ? 1 : ticks_of_panel);
    const double range = ticks.high() - ticks.low();
    const auto y_of = [&](double value) {
      return top + panel.height * (ticks.high() - value) / range;
    };
    for (const double tick : ticks.values) {
      const double y = y_of(tick);
      write(
          "<path class=\"{}\" d=\"M{} {:.1f}h{}\"/>"
          "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
          std::abs(tick) < ticks.step / 2.0 ? "zero" : "grid", left, y, inner_width, left - 6.0,
          y + 4.0, ticks.text(tick));
    }
    for (const double tick : time_.values) {
      write("<path class=\"grid\" d=\"M{:.1f} {:.1f}v{}\"/>", x_of(tick), top, panel.height);
    }
    write_name(panel, top);
    for (const Curve& curve : panel.curves) write_curve(curve, y_of);
    write("<rect class=\"frame\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>\n", left, top,
          inner_width, panel.height);
  }

  void write_name(const Panel& panel, double top) {
    const std::string unit = panel.unit.empty() ? "" : "(" + escaped(panel.unit) + ")";
    if (panel.height < lowest_high_panel) {
      write("\n<text x=\"{}\" y=\"{:.1f}\">{} {}</text>\n", left, top - 5.0,
            escaped(panel.quantity), unit);
      return;
    }
    write("\n<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}",
          top + panel.height / 2.0, escaped(panel.quantity));
    write("<tspan x=\"0\" dy=\"13\">{}</tspan></text>\n", unit);
  }

  template <class YOf>
  void write_curve(const Curve& curve, YOf y_of) {
    std::vector<PlotPoint> points;
    for (std::size_t i = 0; i < std::min(curve.values.size(), plot_.times.size()); ++i) {
      points.push_back({x_of(plot_.times[i]), y_of(curve.values[i])});
    }
    write("<path class=\"curve {}\" stroke=\"{}\" d=\"{}\"/>\n", style(curve.stroke),
          colour(curve.colour), path_along(points));
  }

  void write_times(double y) {
    for (const double tick : time_.values) {
      write("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x_of(tick),
            y + 16.0, time_.text(tick));
    }
    write("\n<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">time (s)</text>\n",
          left + inner_width / 2.0, y + 34.0);
  }

  const Plot& plot_;
  Ticks time_;
  std::string text_;
};

}  // namespace

std::string plot_svg(const Plot& plot) { return Picture{plot}.text(); }

}  // namespace takt
