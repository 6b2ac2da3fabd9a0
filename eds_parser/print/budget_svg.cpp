#include <algorithm>
#include <fmt/format.h>
#include <ostream>

#include "eds_parser/print/budget_bars.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_budget.hpp"

namespace takt {
namespace {

constexpr double letter = 6.6;  // mean width of a character at a font size of 11 pixels
constexpr double plot_width = 760;
constexpr double edge = 16;
constexpr double top = 112;
constexpr double row_height = 18;
constexpr double bar_height = 12;
constexpr double numbers_width = 62;
constexpr double most_svg_ticks = 10;

/// Escapes a text. Names come from the network file and may contain any character.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < ' ';
    out += c == '<'   ? "&lt;"
           : c == '&' ? "&amp;"
           : c == '>' ? "&gt;"
                      : std::string(1, is_control ? ' ' : c);
  }
  return out;
}

constexpr std::string_view sync_colour = "#444444";
constexpr std::string_view tpdo_colour = "#2e7d32";
constexpr std::string_view rpdo_colour = "#1f5fa8";
constexpr std::string_view late_colour = "#c0392b";
constexpr std::string_view behind_colour = "#e08a00";
constexpr std::string_view mark_colour = "#b26a00";

std::string_view colour(const BudgetRow& row) {
  if (!row.fits()) return late_colour;
  if (row.is_behind_sync()) return behind_colour;
  if (row.frame.kind == Traffic::sync) return sync_colour;
  return row.frame.kind == Traffic::tpdo ? tpdo_colour : rpdo_colour;
}

class Svg {
 public:
  Svg(std::ostream& out, const BusPlan& plan, const BusBudget& budget, const CyclePicture& picture)
      : out_{out}, plan_{plan}, budget_{budget}, picture_{picture} {
    std::size_t longest = 0;
    for (const auto& bar : picture.bars) longest = std::max(longest, bar.row->frame.name.size());
    left_ = edge + 50 + letter * static_cast<double>(longest);
    bottom_ = top + row_height * static_cast<double>(picture.bars.size());
  }

  void run() {
    const double height = bottom_ + 22 + 15 * static_cast<double>(picture_.marks.size());
    out_ << fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"Helvetica, Arial, sans-serif\" "
        "font-size=\"11\" fill=\"#222222\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        left_ + plot_width + 2 * numbers_width + edge, height);
    head();
    if (plan_.cycle.sync) cycle();
    out_ << "</svg>\n";
  }

 private:
  void cycle() {
    legend();
    phases();
    axis();
    double y = top;
    for (const auto& bar : picture_.bars) {
      draw(bar, y);
      y += row_height;
    }
    marks();
  }

  double x(Time at) const { return left_ + plot_width * us(at) / us(picture_.end); }

  void text(double at, double y, std::string_view anchor, std::string_view what,
            std::string_view style = "") {
    out_ << fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}{}>{}</text>\n", at, y,
                        anchor, style.empty() ? "" : " ", style, escaped(what));
  }

  void rect(double from, double to, double y, std::string_view style) {
    out_ << fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.0f}\" {}/>\n",
                        from, y, std::max(to - from, 1.0), bar_height, style);
  }

  std::string_view verdict() const {
    if (!budget_.fits()) return "It does not fit.";
    if (budget_.fits_but_for_changes()) return "It fits, unless all outputs change at once.";
    return budget_.sync_delay() > Time{0} ? "It fits; outputs may delay SYNC." : "It fits.";
  }

  void head() {
    text(edge, 24, "start",
         fmt::format("{}: {} kbit/s, {} {:g} ms", plan_.name, plan_.bitrate / 1000,
                     plan_.cycle.sync ? "SYNC every" : "no SYNC, a cycle of",
                     us(plan_.cycle.period) / 1000),
         "font-size=\"15\" font-weight=\"bold\"");
    text(edge, 43, "start",
         fmt::format("Bus load {:.0f} % typical, {:.0f} % with worst stuffing. {} {}",
                     100 * budget_.load.typical, 100 * budget_.load.worst, verdict(),
                     plan_.cycle.sync
                         ? "Each frame is drawn at its latest time."
                         : "No frame has a fixed place in the cycle, so there is no picture."));
  }

  void legend() {
    double at = edge;
    const auto entry = [&](std::string_view fill, std::string_view what) {
      rect(at, at + 16, 56, fill);
      text(at + 21, 66, "start", what);
      at += 36 + letter * static_cast<double>(what.size());
    };
    entry("fill=\"#888888\" fill-opacity=\"0.25\"", "may wait for the bus");
    entry(fmt::format("fill=\"{}\"", sync_colour), "SYNC");
    entry(fmt::format("fill=\"{}\"", tpdo_colour), "TPDO (input)");
    entry(fmt::format("fill=\"{}\"", rpdo_colour), "RPDO (output)");
    entry(fmt::format("fill=\"{}\"", behind_colour), "may delay SYNC");
    entry(fmt::format("fill=\"{}\"", late_colour), "can be too late");
  }

  /// Draws the phases of the master in the background.
  void phases() {
    const auto& cycle = plan_.cycle;
    const Time inputs = std::min(cycle.receive_window, cycle.output_deadline);
    phase(Time{0}, inputs, "inputs", "#f1f8f1");
    phase(inputs, cycle.output_deadline, "services (SDO)", "#fafafa");
    phase(cycle.output_deadline, cycle.period, "outputs", "#eef4fb");
  }

  void phase(Time from, Time to, std::string_view name, std::string_view fill) {
    out_ << fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
        x(from), top - 8, std::max(x(to) - x(from), 0.0), bottom_ - top + 8, fill);
    const bool room = x(to) - x(from) > letter * static_cast<double>(name.size());
    if (room) text((x(from) + x(to)) / 2, top - 12, "middle", name, "fill=\"#777777\"");
  }

  void axis() {
    const double end = us(picture_.end);
    const double step = tick_step(end, most_svg_ticks);
    text(left_ - 8, top - 26, "end", "us after SYNC");
    for (double at = 0; at <= end; at += step) {
      const double where = left_ + plot_width * at / end;
      out_ << fmt::format(
          "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" "
          "stroke=\"#dddddd\"/>\n",
          where, top - 8, bottom_);
      text(where, top - 26, "middle", fmt::format("{:.0f}", at));
    }
    text(numbers(1), top - 12, "end", "latest", "font-weight=\"bold\"");
    text(numbers(2), top - 12, "end", "margin", "font-weight=\"bold\"");
  }

  double numbers(int column) const { return left_ + plot_width + column * numbers_width; }

  void draw(const CycleBar& bar, double y) {
    const auto& row = *bar.row;
    text(left_ - 8, y + 10, "end",
         fmt::format("{} {}", to_string(row.frame.cob_id), row.frame.name));
    const auto fill = fmt::format("fill=\"{}\"", colour(row));
    rect(x(bar.ready), x(bar.begin), y, fill + " fill-opacity=\"0.25\"");
    rect(x(bar.begin), x(bar.end), y, fill);
    text(numbers(1), y + 10, "end", fmt::format("{:.0f}", us(bar.end)));
    const auto left = row.margin();
    if (!left) return;
    text(numbers(2), y + 10, "end", fmt::format("{:.0f}", us(*left)),
         *left < Time{0} ? fmt::format("fill=\"{}\"", late_colour) : "");
  }

  /// Draws the marks. Each label is below the previous one, because marks may be near each other,
  /// and has a white background where a line crosses it.
  void marks() {
    double y = bottom_ + 18;
    for (const auto& mark : picture_.marks) {
      out_ << fmt::format(
          "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" "
          "stroke-dasharray=\"4 3\"/>\n",
          x(mark.at), top - 8, y + 2, mark_colour);
      y += 15;
    }
    y = bottom_ + 18;
    for (const auto& mark : picture_.marks) {
      label(mark, y);
      y += 15;
    }
  }

  void label(const CycleMark& mark, double y) {
    const auto what = fmt::format("{} {:.0f} us", mark.text, us(mark.at));
    const bool right = us(mark.at) > us(picture_.end) / 2;
    const double long_as = letter * static_cast<double>(what.size());
    const double from = right ? x(mark.at) - 2 - long_as : x(mark.at) + 2;
    rect(from, from + long_as, y - 9, "fill=\"white\"");
    text(x(mark.at) + (right ? -4 : 4), y, right ? "end" : "start", what,
         fmt::format("fill=\"{}\"", mark_colour));
  }

  std::ostream& out_;
  const BusPlan& plan_;
  const BusBudget& budget_;
  const CyclePicture& picture_;
  double left_ = 0;
  double bottom_ = 0;
};

}  // namespace

void print_budget_svg(std::ostream& out, const BusPlan& plan, const BusBudget& budget) {
  Svg{out, plan, budget, cycle_picture(plan, budget)}.run();
}

}  // namespace takt
