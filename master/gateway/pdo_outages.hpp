#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/gateway/notice.hpp"

namespace takt {

/// Keeps TPDOs that come and go from flooding the log, LCM and the event file. Of each PDO the
/// first "missing" and the "back" that follows are told at once. What else comes, until it was in
/// order for ten seconds, is summed up: one line a second and PDO; many at a time share one line.
/// Front thread.
class PdoOutages {
 public:
  explicit PdoOutages(const BusPlan& plan) : plan_{plan} {}

  static bool concerns(EventKind kind) noexcept {
    return kind == EventKind::pdo_missing || kind == EventKind::pdo_back;
  }
  /// What to tell of this event now; nothing: it is kept for take_due().
  std::optional<Notice> on_event(const Event& event);
  /// The sums that are due at `now`.
  std::vector<Notice> take_due(Time now);
  /// All that has not been told, at the end.
  std::vector<Notice> take_rest(Time now);

 private:
  static constexpr Time calm = std::chrono::seconds{10};

  struct Outage {
    Time last = -calm;  ///< newest event
    Time told{};        ///< the line before the next sum
    Time since{};       ///< begin of what `missed` counts
    Time due = never;   ///< of the next sum
    std::uint64_t cycle = 0;
    std::uint64_t missed = 0;  ///< not told yet
    bool missing = false;
    bool back_at_once = false;  ///< its "missing" was told at once, so will be its "back"
  };
  struct Pdo {
    std::uint8_t node = 0;
    std::int64_t number = 0;
    auto operator<=>(const Pdo&) const = default;
  };
  using Row = std::map<Pdo, Outage>::value_type;

  std::vector<Notice> tell(const std::vector<Row*>& rows, Time now);
  Notice one(const Row& row, Time now) const;
  Notice many(const std::vector<Row*>& rows, Time now) const;

  const BusPlan& plan_;
  std::map<Pdo, Outage> outages_;  // at most one a TPDO of the plan
  Time next_look_ = never;         // nothing is due before
};

}  // namespace takt
