#include "eds_parser/budget/combinations.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace takt {
namespace {

constexpr std::size_t most_suggestions = 3;
constexpr unsigned most_tries = 400;
constexpr unsigned turns_by_level[] = {2, 4, 8, 16, 32};
constexpr unsigned factors_by_level[] = {2, 4, 8, 16, 32, 64};
constexpr unsigned percents_by_level[] = {115, 130, 150, 200, 300, 400, 800};

/// One kind of change in ascending levels.
struct Ladder {
  unsigned cost = 0;  ///< cost of using this kind of change at all
  std::vector<Suggestion> levels{};
};

/// The level of each ladder; 0 means that the ladder is not used.
using Levels = std::array<std::size_t, 5>;

class Combinations {
 public:
  Combinations(const BusPlan& plan, const WhatIf& base, const ChangeFits& fits)
      : plan_{plan}, base_{base}, fits_{fits} {
    ladders_ = {identifiers(),
                ladder_of(1, factors_by_level, longer_inhibits),
                ladder_of(2, turns_by_level, by_turns),
                periods(),
                {.cost = 3, .levels = higher_bitrates(plan)}};
  }

  std::vector<Suggestion> run() {
    for (std::size_t a = 0; a < ladders_.size(); ++a) {
      for (std::size_t b = a + 1; b < ladders_.size(); ++b) try_pair(a, b);
    }
    if (found_.empty()) try_all();
    std::ranges::stable_sort(found_, {}, [this](const Levels& levels) { return cost(levels); });
    std::vector<Suggestion> out;
    for (const auto& levels : found_) {
      if (out.size() < most_suggestions) out.push_back(reported(levels));
    }
    return out;
  }

 private:
  Ladder identifiers() const {
    auto moved = lower_priorities(plan_);
    if (moved.empty()) return {};
    return {.cost = 1, .levels = {lower_priority_of(std::move(moved))}};
  }

  /// Calls `make` for each of `levels`, in order, and returns the changes. Ends before the first
  /// level at which `make` changes no PDO.
  Ladder ladder_of(unsigned cost, std::span<const unsigned> levels,
                   Suggestion (*make)(const BusPlan&, unsigned)) const {
    Ladder ladder{.cost = cost};
    for (const unsigned level : levels) {
      Suggestion change = make(plan_, level);
      if (change.changes.pdos.empty()) break;
      ladder.levels.push_back(std::move(change));
    }
    return ladder;
  }

  Ladder periods() const {
    Ladder ladder{.cost = 2};
    if (!plan_.cycle.sync) return ladder;
    const auto now = static_cast<std::uint64_t>(plan_.cycle.period / std::chrono::microseconds{1});
    for (const unsigned percent : percents_by_level) {
      const auto us = round_period(static_cast<std::uint32_t>(now * percent / 100));
      ladder.levels.push_back(other_period(plan_, us));
    }
    return ladder;
  }

  WhatIf changes_of(const Levels& levels) const {
    WhatIf changes = base_;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (levels[i] != 0) merge(changes, ladders_[i].levels[levels[i] - 1].changes);
    }
    return changes;
  }

  bool fits(const Levels& levels) { return tries_++ < most_tries && fits_(changes_of(levels)); }

  unsigned cost(const Levels& levels) const {
    unsigned sum = 0;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (levels[i] != 0) sum += ladders_[i].cost + static_cast<unsigned>(levels[i]);
    }
    return sum;
  }

  /// Finds the lowest sufficient level of ladder `which`, provided that a higher level is never
  /// worse.
  void lower(Levels& levels, std::size_t which, std::size_t least) {
    std::size_t low = least;
    while (low < levels[which]) {
      Levels less = levels;
      less[which] = low + (levels[which] - low) / 2;
      if (fits(less)) {
        levels = less;
      } else {
        low = less[which] + 1;
      }
    }
  }

  void try_pair(std::size_t a, std::size_t b) {
    Levels most{};
    most[a] = ladders_[a].levels.size();
    most[b] = ladders_[b].levels.size();
    if (most[a] == 0 || most[b] == 0 || !fits(most)) return;
    std::optional<Levels> best;
    for (std::size_t first = 1; first <= ladders_[a].levels.size(); ++first) {
      Levels levels = most;
      levels[a] = first;
      if (first != most[a] && !fits(levels)) continue;
      lower(levels, b, 1);
      if (!best || cost(levels) < cost(*best)) best = levels;
    }
    if (best) found_.push_back(*best);
  }

  /// Starts with the highest levels of all ladders and lowers each as far as possible, the most
  /// expensive first.
  void try_all() {
    Levels levels{};
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = ladders_[i].levels.size();
    if (!fits(levels)) return;
    for (std::size_t i = levels.size(); i-- > 0;) lower(levels, i, 0);
    found_.push_back(levels);
  }

  Suggestion reported(const Levels& levels) const {
    Suggestion all{.text = {}, .changes = changes_of(levels)};
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (levels[i] == 0) continue;
      all.text += (all.text.empty() ? "" : "; and ") + ladders_[i].levels[levels[i] - 1].text;
    }
    return all;
  }

  const BusPlan& plan_;
  const WhatIf& base_;
  const ChangeFits& fits_;
  std::array<Ladder, 5> ladders_;
  std::vector<Levels> found_;
  unsigned tries_ = 0;
};

}  // namespace

std::vector<Suggestion> cheapest_combinations(const BusPlan& plan, const WhatIf& base,
                                              const ChangeFits& fits) {
  return Combinations{plan, base, fits}.run();
}

}  // namespace takt
