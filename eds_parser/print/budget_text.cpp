#include <algorithm>
#include <fmt/format.h>
#include <ostream>
#include <utility>
#include <vector>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_budget.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

/// Formats a time, for example "2000 us", "100 ms" or "1 s".
std::string period_text(Time time) {
  using namespace std::chrono_literals;
  if (time >= 1s && time % 1s == Time{0}) return fmt::format("{} s", time / 1s);
  if (time >= 10ms && time % 1ms == Time{0}) return fmt::format("{} ms", time / 1ms);
  return fmt::format("{:.0f} us", us(time));
}

std::string every(const BudgetRow& row) {
  const auto& frame = row.frame;
  std::string text = "SYNC";
  if (!frame.in_cycle || frame.period_assumed) {
    text = (frame.period_assumed ? "~" : "") + period_text(frame.period);
  } else if (frame.every > 1) {
    text = fmt::format("{} SYNCs", frame.every);
  } else if (frame.on_change) {
    text = "change";
  }
  return frame.burst > 1 ? fmt::format("{} x {}", frame.burst, text) : text;
}

/// Returns a time as whole microseconds.
std::string number(Time time) { return fmt::format("{:.0f}", us(time)); }

std::string bound_text(const std::optional<Time>& worst) { return worst ? number(*worst) : "none"; }

std::string to_limit(const BudgetRow& row) {
  if (!row.worst || row.why == BudgetLimit::none || row.frame.kind == Traffic::sync) return "";
  return number(row.limit - *row.worst);
}

std::string limit(const BudgetRow& row) {
  return row.why == BudgetLimit::none ? "" : number(row.limit);
}

std::string to_cycle(const BudgetRow& row) {
  return !row.worst || row.cycle == Time{0} ? "" : number(row.cycle - *row.worst);
}

class BudgetText {
 public:
  BudgetText(std::ostream& out, const BusPlan& plan, const BusBudget& budget)
      : out_{out}, plan_{plan}, budget_{budget} {
    for (const auto& row : budget.rows) width_ = std::max(width_, row.frame.name.size());
    width_ += 10;  // room for " (16 such)"
  }

  void run() {
    verdict();
    out_ << '\n';
    head();
    if (plan_.cycle.sync) cycle_frames();
    other_frames();
  }

 private:
  void head() {
    const auto& load = budget_.load;
    out_ << fmt::format("bus {}: {} kbit/s, {} {}\n", plan_.name, plan_.bitrate / 1000,
                        plan_.cycle.sync ? "SYNC every" : "no SYNC, a cycle of",
                        period_text(plan_.cycle.period));
    out_ << fmt::format(
        "load: {:.1f} % typical, {:.1f} % with worst stuffing; SDO takes {:.1f} % more at most "
        "({} dialogues in {})\n",
        100 * load.typical, 100 * load.worst, 100 * load.services, budget_.service_dialogues,
        period_text(budget_.service_round));
    for (const auto& sentence : budget_.assumptions) out_ << "assumed: " << sentence << '\n';
  }

  /// Prints the frames of the cycle in the order of their latest ends.
  void cycle_frames() {
    const auto& cycle = plan_.cycle;
    out_ << fmt::format(
        "\nthe cycle, in us after SYNC: the master waits for TPDOs until {:.0f} and sends outputs "
        "at {:.0f}\n",
        us(std::min(cycle.receive_window, cycle.output_deadline)), us(cycle.output_deadline));
    line("COB-ID", "frame", "bytes", "every", "on wire", "latest", "to window", "to SYNC",
         "with EMCYs", "behind SDO", "");
    std::vector<const BudgetRow*> rows;
    for (const auto& row : budget_.rows) {
      if (row.frame.in_cycle) rows.push_back(&row);
    }
    std::ranges::stable_sort(rows, {}, [](const BudgetRow* row) {
      return std::pair{row->frame.kind == Traffic::rpdo, row->worst.value_or(Time::max())};
    });
    for (const auto* row : rows) line(*row, row->frame.name, to_cycle(*row));
  }

  /// Prints the other frames. Similar frames share one line, which shows the worst of them.
  void other_frames() {
    out_ << "\nother frames, in us from queueing to the end of the frame\n";
    line("COB-ID", "frame", "bytes", "every", "on wire", "worst", "margin", "limit", "with EMCYs",
         "behind SDO", "");
    for (const auto& row : budget_.rows) {
      if (row.frame.in_cycle) continue;
      const std::size_t alike = count_alike(row);
      if (alike < many) {
        line(row, row.frame.name, limit(row));
      } else if (&row == worst_alike(row)) {
        line(row, fmt::format("{} ({} such)", row.frame.name, alike), limit(row));
      }
    }
  }

  void line(const BudgetRow& row, const std::string& name, const std::string& eighth) {
    line(to_string(row.frame.cob_id), name, row.frame.bytes, every(row), number(row.frame.frame),
         bound_text(row.worst), to_limit(row), eighth, bound_text(row.worst_in_burst),
         bound_text(row.worst_behind_services), mark(row));
  }
  template <class... Columns>
  void line(std::string_view cob_id, std::string_view name, const Columns&... columns) {
    out_ << fmt::format("  {:<8} {:<{}} {:>5} {:>12} {:>8} {:>8} {:>10} {:>9} {:>11} {:>10}{}\n",
                        cob_id, name, width_, columns...);
  }

  static bool alike(const BudgetRow& a, const BudgetRow& b) {
    const bool same = a.frame.kind == b.frame.kind && a.frame.from_master == b.frame.from_master &&
                      a.frame.period == b.frame.period && a.frame.limit == b.frame.limit &&
                      a.fits() == b.fits();
    return same && (a.frame.kind == Traffic::emcy || a.frame.kind == Traffic::error_control ||
                    a.frame.kind == Traffic::remote);
  }
  std::size_t count_alike(const BudgetRow& row) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        budget_.rows, [&](const BudgetRow& other) { return alike(row, other); }));
  }
  const BudgetRow* worst_alike(const BudgetRow& row) const {
    const BudgetRow* worst = &row;
    for (const auto& other : budget_.rows) {
      if (alike(row, other) && other.worst_in_burst >= worst->worst_in_burst) worst = &other;
    }
    return worst;
  }

  /// Returns for example " or up to 96 us late".
  std::string steady_delay() const {
    Time delay{};
    for (const auto& row : budget_.rows) {
      if (row.tolerance == Time{0} || !row.worst_steady) continue;
      delay = std::max(delay, *row.worst_steady - row.cycle);
    }
    return delay > Time{0} ? fmt::format(" or up to {:.0f} us late", us(delay)) : "";
  }

  static std::string_view mark(const BudgetRow& row) {
    if (!row.fits()) return "  TOO LATE";
    if (row.is_late_by_changes_only()) return "  late if all change";
    if (row.is_behind_sync()) return "  behind SYNC";
    return row.fits_in_burst() ? "" : "  late with EMCYs";
  }

  void verdict() {
    out_ << verdict_text() << '\n';
    if (!budget_.fits()) {
      if (budget_.refused) refusal();
      list([](const BudgetRow& row) { return row.fits(); }, &BudgetRow::worst);
      return;
    }
    if (budget_.fits_but_for_changes()) {
      out_ << fmt::format(
          "warning: if all event-driven outputs change in one cycle and all other frames come at "
          "once, SYNC is {:.0f} us\nlate behind the outputs; without such changes SYNC is in "
          "time{}\n",
          us(budget_.sync_delay()), steady_delay());
    }
    warn_of_services();
    if (budget_.fits_in_burst()) return;
    out_ << "warning: if every node sends an EMCY at once, these frames can be late:\n";
    list([](const BudgetRow& row) { return row.fits_in_burst(); }, &BudgetRow::worst_in_burst);
  }

  /// Prints a warning that does not change the verdict, because this case needs a late server and,
  /// at the same moment, all frames that devices send outside the cycle.
  void warn_of_services() {
    const Time tolerated = plan_.cycle.period / 10;
    const auto delay = budget_.sync_delay_behind_services();
    if (!plan_.cycle.makes_sync() || (delay && *delay <= tolerated)) return;
    out_ << "warning: SDO and other service frames share the send queue of SYNC and the outputs; "
            "behind waiting service frames\n";
    out_ << (delay ? fmt::format("SYNC can be {:.0f} us late", us(*delay))
                   : std::string{"SYNC can be late, and no bound was found for this delay"});
    out_ << " if servers answer late and all unsolicited frames come at once\n";
  }

  void refusal() {
    const TimeBudget wire = time_budget(plan_);
    out_ << fmt::format(
        "  SYNC and TPDOs ({:.0f} us), RPDOs ({:.0f} us) and the quiet before SYNC ({:.0f} us) "
        "need "
        "more than the period: taktd refuses the network\n",
        us(wire.inputs_wire), us(wire.outputs_wire), us(plan_.cycle.quiet_before_sync));
  }

  template <class Fits>
  void list(Fits fits, std::optional<Time> BudgetRow::* end) {
    std::size_t left_out = 0;
    std::size_t reported = 0;
    const bool overloaded = std::ranges::any_of(
        budget_.rows, [&](const BudgetRow& row) { return row.frame.in_cycle && !(row.*end); });
    if (overloaded) {
      out_ << "  the frames of a cycle and the frames that may come between need more than the "
              "whole bus\n";
    }
    for (const auto& row : budget_.rows) {
      if (fits(row) || (overloaded && !(row.*end))) continue;
      if (reported++ < most_reported) {
        out_ << "  " << why_late(row, row.*end) << '\n';
      } else {
        ++left_out;
      }
    }
    if (left_out != 0) out_ << "  and " << left_out << " more\n";
  }

  /// Returns the verdict and the smallest margin, for example "It fits, with a margin of 80 us:",
  /// and on a second line the frame that has it.
  std::string verdict_text() const {
    const BudgetRow* const row = budget_.tightest();
    const bool bounded = std::ranges::all_of(budget_.rows, [](const BudgetRow& each) {
      return each.worst || (each.why == BudgetLimit::none && each.cycle == Time{0});
    });
    if (!budget_.fits()) {
      if (!bounded || row == nullptr || *row->margin() >= Time{0}) return "It does not fit:";
      return fmt::format("It does not fit; the worst margin is {:.0f} us:", us(*row->margin()));
    }
    if (row == nullptr) return "It fits. No frame has a limit.";
    const Time margin = *row->margin();
    std::string text = fmt::format("It fits, with a margin of {:.0f} us:", us(margin));
    if (row->is_late_by_changes_only()) {
      text = fmt::format(
          "It fits, unless all event-driven outputs change at once. The worst margin is {:.0f} us:",
          us(margin));
    } else if (margin < Time{0}) {
      text = fmt::format(
          "It fits. SYNC can be {:.0f} us late if all these frames come at once, and {:.0f} us are "
          "permitted:",
          us(-margin), us(row->tolerance));
    }
    const bool sync = row->cycle != Time{0} && row->cycle - *row->worst == margin;
    const std::string end =
        sync ? fmt::format("the next SYNC comes at {:.0f} us", us(row->cycle)) : limit_end(*row);
    return fmt::format("{}\n  {} ends at {:.0f} us, {}", text, row->frame.name, us(*row->worst),
                       end);
  }

  static std::string limit_end(const BudgetRow& row) {
    const std::string whose = row.frame.waits.empty() ? "" : " by " + row.frame.waits;
    return fmt::format("{}{} ends at {:.0f} us", name_of(row.why), whose, us(row.limit));
  }

  static std::string why_late(const BudgetRow& row, const std::optional<Time>& end) {
    const auto& name = row.frame.name;
    if (!end) return name + ": the frame and the frames before it need more than the whole bus";
    if (row.why != BudgetLimit::none && *end > row.limit) {
      return fmt::format("{}: {:.0f} us, {}", name, us(*end), limit_end(row));
    }
    return fmt::format("{}: {:.0f} us, the next SYNC comes at {:.0f} us", name, us(*end),
                       us(row.cycle));
  }

  static constexpr std::size_t most_reported = 8;
  static constexpr std::size_t many = 4;

  std::ostream& out_;
  const BusPlan& plan_;
  const BusBudget& budget_;
  std::size_t width_ = 16;
};

}  // namespace

std::string_view name_of(BudgetLimit limit) noexcept {
  static constexpr std::string_view names[]{"",
                                            "the receive window",
                                            "the time before the outputs",
                                            "the SYNC window (0x1007)",
                                            "its own period",
                                            "the wait for it"};
  return name_of(limit, names);
}

void print_suggestions(std::ostream& out, std::span<const Suggestion> suggestions) {
  if (suggestions.empty()) {
    out << "\nNo change of identifiers, inhibit times, PDO rates, period or bit rate makes it fit, "
           "not even together.\n";
    return;
  }
  out << "\nIt would fit with one of these changes, the cheapest first:\n";
  for (const auto& suggestion : suggestions) {
    out << "  " << suggestion.text << "\n      --what-if " << to_string(suggestion.changes) << '\n';
  }
}

void print_budget_text(std::ostream& out, const BusPlan& plan, const BusBudget& budget) {
  BudgetText{out, plan, budget}.run();
}

}  // namespace takt
