#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// Node guarding of one node: when to ask for its state, and what its answers are worth. CiA 301,
/// 7.2.8.3.2.1.
class NodeGuard {
 public:
  explicit NodeGuard(const GuardPlan& plan) noexcept : plan_{plan} {}

  bool running() const noexcept { return next_request_ != never; }
  /// The first request is due at once; the node's life time begins.
  void start(Time now) noexcept;
  void stop() noexcept { next_request_ = silent_from_ = never; }
  /// The first answer after a boot-up message has toggle bit 0.
  void node_was_reset() noexcept;

  bool wants_request(Time now) const noexcept { return now >= next_request_; }
  void request_sent(Time now) noexcept;

  /// False: the toggle bit repeats, the answer counts as not received.
  bool on_answer(bool toggle, Time now) noexcept;
  /// Answers whose toggle bit repeated, in a row.
  std::uint32_t repeated() const noexcept { return repeated_; }

  /// The master itself was away for so long: nobody is silent for that.
  void excuse(Time away) noexcept {
    if (silent_from_ != never) silent_from_ += away;
  }

  /// Time of silence when the life time is over, told once; an answer arms it again.
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
  Time silent_from_ = never;         // since the last good answer
  std::optional<bool> last_toggle_;  // none: the first answer may have either
  std::uint32_t repeated_ = 0;
};

}  // namespace takt
