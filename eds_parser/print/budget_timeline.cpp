#include <fmt/format.h>
#include <ostream>

#include "eds_parser/print/budget_bars.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_budget.hpp"

namespace takt {
namespace {

constexpr std::size_t most_time_columns = 72;
constexpr std::size_t least_time_columns = 20;
/// Columns beside the name and the bar: spaces and two numbers.
constexpr std::size_t other_columns = 20;
constexpr double columns_per_tick = 9;

class Timeline {
 public:
  Timeline(std::ostream& out, const CyclePicture& picture, std::size_t width)
      : out_{out}, picture_{picture} {
    for (const auto& bar : picture.bars) {
      width_ = std::max(width_, bar.row->frame.name.size());
    }
    const std::size_t used = width_ + other_columns;
    columns_ = std::clamp(width > used ? width - used : 0, least_time_columns, most_time_columns);
  }

  void run() {
    out_ << fmt::format(
        "\none cycle, {:.0f} us per column: `.` the frame may wait, `#` latest time on the wire,\n"
        "`+` time on the wire after SYNC is due, `!` the frame is too late; `:` see below\n",
        us(picture_.end) / static_cast<double>(columns_));
    print("us", axis(), "latest", "margin");
    for (const auto& bar : picture_.bars) {
      std::string line = limits();
      fill(line, bar.ready, bar.begin, '.');
      fill(line, bar.begin, bar.end, bar.row->fits() ? '#' : '!');
      if (bar.row->is_behind_sync()) fill(line, std::max(bar.begin, bar.row->cycle), bar.end, '+');
      const auto left = bar.row->margin();
      print(bar.row->frame.name, line, fmt::format("{:.0f}", us(bar.end)),
            left ? fmt::format("{:.0f}", us(*left)) : "");
    }
    for (const auto& mark : picture_.marks) print_mark(mark);
  }

 private:
  std::size_t column(Time at) const {
    const auto part = static_cast<double>(at.count()) / static_cast<double>(picture_.end.count());
    return std::min(columns_, static_cast<std::size_t>(part * static_cast<double>(columns_)));
  }

  static void put(std::string& line, std::size_t at, std::string_view text) {
    if (line.size() < at + text.size()) line.resize(at + text.size(), ' ');
    line.replace(at, text.size(), text);
  }

  /// Returns the axis with ticks at round times.
  std::string axis() const {
    const double end = us(picture_.end);
    const double step = tick_step(end, static_cast<double>(columns_) / columns_per_tick);
    std::string line;
    for (double at = 0; at <= end; at += step) {
      const auto where = static_cast<std::size_t>(at / end * static_cast<double>(columns_));
      const std::string tick = fmt::format("{:.0f}", at);
      if (where + tick.size() <= columns_ + 1) put(line, where, tick);
    }
    return line;
  }

  /// Prints a label to the left of its column if there is no room on the right.
  void print_mark(const CycleMark& mark) {
    const auto label = fmt::format("{} {:.0f}", mark.text, us(mark.at));
    const std::size_t at = column(mark.at);
    std::string line(at, ' ');
    if (at > columns_ / 2 && at > label.size() + 1) {
      put(line, at - label.size() - 1, label + " ^");
    } else {
      line += "^ " + label;
    }
    print("", line);
  }

  std::string limits() const {
    std::string line(columns_ + 1, ' ');
    for (const auto& mark : picture_.marks) line[column(mark.at)] = ':';
    return line;
  }

  /// Fills the columns of a time span, at least one.
  void fill(std::string& line, Time begin, Time end, char sign) const {
    if (end <= begin) return;
    const std::size_t first = column(begin);
    const std::size_t last = std::max(column(end), first + 1);
    for (std::size_t i = first; i < std::min(last, line.size()); ++i) line[i] = sign;
  }

  void print(std::string_view name, std::string_view line, std::string_view latest = "",
             std::string_view margin = "") {
    std::string text = fmt::format("  {:<{}} {:<{}} {:>7} {:>7}", name, width_, line, columns_ + 1,
                                   latest, margin);
    text.erase(text.find_last_not_of(' ') + 1);
    out_ << text << '\n';
  }

  std::ostream& out_;
  const CyclePicture& picture_;
  std::size_t width_ = 4;
  std::size_t columns_ = most_time_columns;
};

}  // namespace

void print_budget_timeline(std::ostream& out, const BusPlan& plan, const BusBudget& budget,
                           std::size_t width) {
  if (!plan.cycle.sync) {
    out << "\nno SYNC: no frame has a fixed place in the cycle, so there is no picture\n";
    return;
  }
  const auto picture = cycle_picture(plan, budget);
  if (!picture.bars.empty()) Timeline{out, picture, width}.run();
}

}  // namespace takt
