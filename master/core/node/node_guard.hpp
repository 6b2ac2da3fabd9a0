#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The node guarding of one node. It decides when the master requests the NMT state, and checks the
/// answers. Bus thread only. CiA 301, 7.2.8.3.2.1.
class NodeGuard {
 public:
  explicit NodeGuard(const GuardPlan& plan) noexcept : plan_{plan} {}

  bool running() const noexcept { return next_request_ != never; }
  /// Begins guarding: the first request is due at once, and the life time of the node begins.
  void start(Time now) noexcept;
  void stop() noexcept { next_request_ = silent_from_ = never; }
  /// Stops guarding, and expects toggle bit 0 in the first answer, because the node has reset it.
  void node_was_reset() noexcept;

  /// Returns true if a guarding request is due.
  bool wants_request(Time now) const noexcept { return now >= next_request_; }
  void request_sent(Time now) noexcept;

  /// Takes a guarding answer. Returns false if the toggle bit repeats; such an answer counts as not
  /// received.
  bool on_answer(bool toggle, Time now) noexcept;
  /// Returns the number of answers in a row whose toggle bit repeats.
  std::uint32_t repeated() const noexcept { return repeated_; }

  /// Extends the life time by the time for which the master itself did not run.
  void extend_deadlines(Time away) noexcept {
    if (silent_from_ != never) silent_from_ += away;
  }

  /// When the life time is over, returns once for how long the node has been silent. The next
  /// answer starts the supervision again.
  std::optional<Time> on_time(Time now) noexcept;
  Time deadline() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(next_request_, silent_from_, last_toggle_, repeated_);
  }

 private:
  Time lost_at() const noexcept {
    return silent_from_ == never ? never : silent_from_ + plan_.life_time();
  }

  GuardPlan plan_;
  Time next_request_ = never;
  Time silent_from_ = never;         // time of the last valid answer
  std::optional<bool> last_toggle_;  // std::nullopt: the first answer may have either value
  std::uint32_t repeated_ = 0;
};

}  // namespace takt
