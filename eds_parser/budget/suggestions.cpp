#include "eds_parser/budget/suggestions.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/combinations.hpp"
#include "eds_parser/report/message.hpp"

namespace takt {
namespace {

using std::chrono::microseconds;

constexpr unsigned most_alternating = 16;
std::uint32_t us(Time time) {
  return static_cast<std::uint32_t>(std::chrono::ceil<microseconds>(time).count());
}

class Search {
 public:
  Search(const BusPlan& plan, const WhatIf& changes, const BudgetOptions& options,
         const TryNetwork& try_network)
      : plan_{plan}, base_{changes}, options_{options}, try_network_{try_network} {}

  std::vector<Suggestion> run() {
    try_services();
    try_identifiers();
    try_inhibit_times();
    try_alternating();
    try_period();
    try_bitrate();
    if (found_.empty()) {
      found_ = cheapest_combinations(plan_, base_,
                                     [this](const WhatIf& changes) { return fits(changes); });
    }
    return std::move(found_);
  }

 private:
  bool fits(const WhatIf& changes) const {
    const auto plan = try_network_(changes);
    return plan && bus_fits(*plan, options_);
  }

  WhatIf with(const WhatIf& more) const {
    WhatIf changes = base_;
    merge(changes, more);
    return changes;
  }

  /// Returns the fewest of these changes that are enough. The search leaves out one after another
  /// and may miss a smaller set.
  std::vector<PdoChange> fewest(std::vector<PdoChange> pdos) const {
    for (std::size_t i = pdos.size(); i-- > 0 && pdos.size() > 1;) {
      auto less = pdos;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
      if (fits(with({.pdos = less}))) pdos = std::move(less);
    }
    return pdos;
  }

  /// Adds the change if it is enough. Returns false otherwise.
  bool try_one(const Suggestion& one) {
    const bool enough = fits(with(one.changes));
    if (enough) add(one);
    return enough;
  }

  void try_services() {
    const auto frames = fitting_service_frames(plan_, options_);
    if (frames && *frames != plan_.cycle.service_frames) add(other_service_frames(plan_, *frames));
  }

  void try_identifiers() {
    auto moved = lower_priorities(plan_);
    if (moved.empty() || !fits(with({.pdos = moved}))) return;
    add(lower_priority_of(fewest(std::move(moved))));
  }

  /// Tries inhibit times of twice the worst-case time of the frame, at most the longest possible
  /// one. A frame that would need more may fit when the others are sent less often.
  void try_inhibit_times() {
    const auto budget = bus_budget(plan_, options_);
    std::vector<PdoChange> longer;
    for (const auto& row : plan_.pdos.tpdos) {
      const auto& node = plan_.nodes[row.node_index].name;
      const auto name = concat("TPDO", row.number, ' ', node);
      const auto found = std::ranges::find_if(budget.rows, [&](const BudgetRow& other) {
        return other.frame.name == name && !other.frame.in_cycle;
      });
      if (found == budget.rows.end() || found->fits() || !found->worst) continue;
      constexpr Time::rep longest_ms = 6553;  // 0xFFFF * 100 us
      const auto ms = std::chrono::ceil<std::chrono::milliseconds>(2 * *found->worst).count();
      longer.push_back({.node = node,
                        .number = row.number,
                        .inhibit_time = static_cast<std::uint16_t>(std::min(ms, longest_ms) * 10)});
    }
    if (longer.empty()) return;
    const std::string text = "longer inhibit times for " + names_of(longer);
    try_one({.text = text, .changes = {.pdos = std::move(longer)}});
  }

  /// Tries synchronous TPDOs that take turns, beginning with those of the lowest priority.
  void try_alternating() {
    for (unsigned count = 2; count <= most_alternating; count += 2) {
      const auto turns = by_turns(plan_, count);
      if (turns.changes.pdos.empty() || try_one(turns)) return;
    }
  }

  void try_period() {
    if (!plan_.cycle.sync) return;
    const auto is_enough = [this](std::uint32_t period) {
      return fits(with({.sync_period_us = period}));
    };
    const std::uint32_t now = us(plan_.cycle.period);
    std::uint32_t too_short = now;
    std::uint32_t enough = 0;
    for (std::uint32_t period = round_period(now + 1);
         period <= std::min(64 * now, longest_period_us); period = round_period(period * 3 / 2)) {
      if (is_enough(period)) {
        enough = period;
        break;
      }
      too_short = period;
    }
    if (enough == 0) return;
    while (round_period(too_short + 1) < enough) {
      const auto middle = round_period(too_short + (enough - too_short) / 2);
      if (middle >= enough) break;
      (is_enough(middle) ? enough : too_short) = middle;
    }
    add(other_period(plan_, enough));
  }

  void try_bitrate() {
    for (const Suggestion& rate : higher_bitrates(plan_)) {
      if (try_one(rate)) return;
    }
  }

  void add(const Suggestion& one) { found_.push_back({one.text, with(one.changes)}); }

  const BusPlan& plan_;
  const WhatIf& base_;
  const BudgetOptions& options_;
  const TryNetwork& try_network_;
  std::vector<Suggestion> found_;
};

}  // namespace

std::vector<Suggestion> cheapest_changes(const BusPlan& plan, const WhatIf& changes,
                                         const BudgetOptions& options,
                                         const TryNetwork& try_network) {
  return Search{plan, changes, options, try_network}.run();
}

}  // namespace takt
