#pragma once
#include <cstdint>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/core/node/boot_runner.hpp"

namespace takt {

/// Decides when the boot of a node is tried again, where it begins, and which failures are
/// reported. The pause doubles after each failed boot, up to a maximum. Bus thread only.
class BootRetries {
 public:
  /// `plan` must outlive the object.
  explicit BootRetries(const NodePlan& plan) noexcept : plan_{&plan} {}

  /// Plans the next boot after the pause. It begins at `from`.
  void after_pause(BootRunner::From from, Time now) noexcept;
  /// Moves the planned boot to `now`; it begins with the same step.
  void without_pause(Time now) noexcept { at_ = now; }
  /// Cancels the planned boot.
  void cancel() noexcept { at_ = never; }
  bool due(Time now) const noexcept { return now >= at_; }
  Time deadline() const noexcept { return at_; }
  BootRunner::From from() const noexcept { return from_; }

  /// Takes the failure of a boot. Returns false if it does not count as a failure of the node yet.
  /// The next boot then begins at once.
  bool on_failure(const BootFailure& failure, Time now) noexcept;
  void on_success() noexcept;
  /// Sets the pause to its minimum again, because the node shows signs of life or an application
  /// has reset it.
  void shorten_pause() noexcept { failed_boots_ = 0; }
  /// Counts a boot-up message. Returns true if the node restarts again and again, so
  /// that it has to wait for its next regular boot.
  bool boots_up_repeatedly(Time now, BootState state) noexcept;

  /// Returns the newest failure of a boot.
  const BootFailure& last_failure() const noexcept { return last_failure_; }
  /// Returns the number of failures in a row by the same cause.
  std::uint32_t same_failures() const noexcept { return same_failures_; }
  /// Returns true if the failure with this number is reported: the first, second, fourth, eighth
  /// ... one, so that an absent node does not fill the log.
  static bool is_reported(std::uint32_t number) noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(at_, from_, same_failures_, failed_boots_, counter_error_retried_, bootups_,
          bootups_since_);
    BootFailure& last = last_failure_;  // The next failure is compared with these values.
    state(last.step, last.fault, last.abort_code, last.value, last.node_state, last.restarts);
  }

 private:
  Time pause() const noexcept;

  const NodePlan* plan_;
  Time at_ = never;
  BootRunner::From from_ = BootRunner::From::beginning;
  std::uint32_t same_failures_ = 0;
  std::uint8_t failed_boots_ = 0;  // failures in a row since a boot-up message or a command
  // True if the node was already booted again because a SYNC with counter came too early.
  bool counter_error_retried_ = false;
  BootFailure last_failure_;
  std::uint32_t bootups_ = 0;  // number of boot-up messages since bootups_since_
  Time bootups_since_{};
};

}  // namespace takt
