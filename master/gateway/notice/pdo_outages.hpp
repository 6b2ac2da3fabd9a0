#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/gateway/notice/notice.hpp"

namespace takt {

/// Keeps intermittent TPDOs from flooding the log, LCM and the event file. For each PDO, the first
/// "missing" and the following "back" are reported at once. Later events, until ten seconds have
/// passed without one, are summed up: one line per second and PDO; many PDOs share one line. All
/// calls come from the front thread.
class PdoOutages {
 public:
  explicit PdoOutages(const BusPlan& plan) : plan_{plan} {}

  static bool concerns(EventKind kind) noexcept {
    return kind == EventKind::pdo_missing || kind == EventKind::pdo_back;
  }
  /// Returns the notice for this event, or std::nullopt if the event is kept for take_due().
  std::optional<Notice> on_event(const Event& event);
  /// Returns the sums that are due at `now`.
  std::vector<Notice> take_due(Time now);
  /// Returns all notices that are not yet reported. Call this at the end.
  std::vector<Notice> take_rest(Time now);

 private:
  static constexpr Time calm = std::chrono::seconds{10};

  struct Outage {
    Time last = -calm;  ///< time of the newest event
    Time reported{};    ///< time of the last report before the next sum
    Time since{};       ///< start of the time that `missed` covers
    Time due = never;   ///< time of the next sum
    std::uint64_t cycle = 0;
    std::uint64_t missed = 0;  ///< not yet reported
    bool missing = false;
    /// The newest "missing" of the PDO was reported at once, so the following "back" will be, too.
    bool back_at_once = false;
  };
  struct Pdo {
    std::uint8_t node = 0;
    std::int64_t number = 0;
    auto operator<=>(const Pdo&) const = default;
  };
  using Row = std::map<Pdo, Outage>::value_type;

  std::vector<Notice> announce(const std::vector<Row*>& rows, Time now);
  Notice one(const Row& row, Time now) const;
  Notice many(const std::vector<Row*>& rows, Time now) const;

  const BusPlan& plan_;
  std::map<Pdo, Outage> outages_;  // at most one per TPDO of the plan
  Time next_look_ = never;         // nothing is due before this time
};

}  // namespace takt
