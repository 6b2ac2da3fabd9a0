#include "eds_parser/budget/suggestions.hpp"

#include <algorithm>

#include "eds_parser/budget/combinations.hpp"
#include "eds_parser/budget/fitting_services.hpp"
#include "eds_parser/budget/plan_changes.hpp"

namespace takt {
namespace {

using std::chrono::microseconds;

constexpr std::uint32_t longest_period_us = 60'000'000;
constexpr std::size_t most_alternating = 16;
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

  std::string label(const PdoRow& row, bool tpdo) const {
    return (tpdo ? "TPDO" : "RPDO") + std::to_string(row.number) + ' ' +
           plan_.nodes[row.node_index].name;
  }

  PdoChange change_of(const PdoRow& row) const {
    return {.node = plan_.nodes[row.node_index].name, .tpdo = true, .number = row.number};
  }

  WhatIf with(const std::vector<PdoChange>& pdos) const {
    WhatIf changes = base_;
    merge(changes, {.pdos = pdos});
    return changes;
  }

  /// The fewest of these changes that are enough. The search leaves out one after another and may
  /// miss a smaller set.
  std::vector<PdoChange> fewest(std::vector<PdoChange> pdos) const {
    for (std::size_t i = pdos.size(); i-- > 0 && pdos.size() > 1;) {
      auto less = pdos;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
      if (fits(with(less))) pdos = std::move(less);
    }
    return pdos;
  }

  void try_services() {
    const auto frames = fitting_service_frames(plan_, options_);
    if (!frames || *frames == plan_.cycle.service_frames) return;
    WhatIf changes = base_;
    changes.service_frames = *frames;
    add(services_text(plan_, *frames), std::move(changes));
  }

  void try_identifiers() {
    auto moved = lower_priorities(plan_);
    if (moved.empty() || !fits(with(moved))) return;
    moved = fewest(std::move(moved));
    add("lower priority than all synchronous PDOs for " + names_of(moved), with(moved));
  }

  /// Tries inhibit times of twice the worst-case time of the frame, at most the longest possible
  /// one. A frame that would need more may fit when the others are sent less often.
  void try_inhibit_times() {
    const auto budget = bus_budget(plan_, options_);
    std::vector<PdoChange> longer;
    for (const auto& row : plan_.pdos.tpdos) {
      const auto found = std::ranges::find_if(budget.rows, [&](const BudgetRow& other) {
        return other.frame.name == label(row, true) && !other.frame.in_cycle;
      });
      if (found == budget.rows.end() || found->fits() || !found->worst) continue;
      auto change = change_of(row);
      constexpr Time::rep longest_ms = 6553;  // 0xFFFF * 100 us
      const auto ms = std::chrono::ceil<std::chrono::milliseconds>(2 * *found->worst).count();
      change.inhibit_time = static_cast<std::uint16_t>(std::min(ms, longest_ms) * 10);
      longer.push_back(std::move(change));
    }
    if (longer.empty() || !fits(with(longer))) return;
    add("longer inhibit times for " + names_of(longer), with(longer));
  }

  /// Tries synchronous TPDOs that take turns, beginning with those of the lowest priority.
  void try_alternating() {
    for (std::size_t count = 2; count <= most_alternating; count += 2) {
      const auto turns = by_turns(plan_, count);
      if (turns.pdos.empty()) return;
      auto changes = base_;
      merge(changes, turns);
      if (!fits(changes)) continue;
      return add("every second SYNC, alternately (SYNC with counter), for " + names_of(turns.pdos),
                 std::move(changes));
    }
  }

  void try_period() {
    if (!plan_.cycle.sync) return;
    const auto with_period = [this](std::uint32_t period) {
      WhatIf changes = base_;
      changes.sync_period_us = period;
      return changes;
    };
    const std::uint32_t now = us(plan_.cycle.period);
    std::uint32_t too_short = now;
    std::uint32_t enough = 0;
    for (std::uint32_t period = round_period(now + 1);
         period <= std::min(64 * now, longest_period_us); period = round_period(period * 3 / 2)) {
      if (fits(with_period(period))) {
        enough = period;
        break;
      }
      too_short = period;
    }
    if (enough == 0) return;
    while (round_period(too_short + 1) < enough) {
      const auto middle = round_period(too_short + (enough - too_short) / 2);
      if (middle >= enough) break;
      (fits(with_period(middle)) ? enough : too_short) = middle;
    }
    add(period_text(plan_, enough), with_period(enough));
  }

  void try_bitrate() {
    for (const auto rate : known_bitrates) {
      if (rate * 1000U <= plan_.bitrate) continue;
      WhatIf changes = base_;
      changes.bitrate_kbit = rate;
      if (!fits(changes)) continue;
      return add(bitrate_text(plan_, rate), std::move(changes));
    }
  }

  void add(std::string text, WhatIf changes) {
    found_.push_back({std::move(text), std::move(changes)});
  }

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
