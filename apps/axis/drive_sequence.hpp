#pragma once
#include <cstdint>

#include "apps/axis/state402.hpp"

namespace takt {

/// Where a drive shall go.
enum class DriveGoal : std::uint8_t { disabled, enabled, quick_stopped };

/// Whether a drive may be led towards Operation enabled; one that is there stays.
enum class Enabling : std::uint8_t { waits, goes_on };

/// Limits of a DriveSequence, in steps (one a cycle).
struct DriveSequenceLimits {
  std::uint32_t reset_low_steps = 10;  ///< bit 7 rests low so long before its edge
  std::uint32_t hop_steps = 2500;      ///< a drive that does not change for longer is stuck
};

/// Leads one drive through the CiA 402 state machine: statusword in, controlword out, once a cycle.
/// Each word is held until the statusword acknowledges it, so that no edge is lost on a channel
/// where only the newest value counts. A drive that leaves Operation enabled by itself (fault, safe
/// torque off) is not enabled again until it is told to.
class DriveSequence {
 public:
  explicit DriveSequence(DriveSequenceLimits limits = {}) noexcept : limits_{limits} {}

  void set_goal(DriveGoal goal) noexcept;
  /// Asks for one fault reset; without effect when the drive is not in Fault.
  void reset_fault() noexcept;

  /// The controlword (without mode-specific bits) that answers this statusword. CiA 402-2, 1.4.
  std::uint16_t step(std::uint16_t statusword, Enabling enabling = Enabling::goes_on) noexcept;

  DriveGoal goal() const noexcept { return goal_; }
  /// Last known state; a statusword that tells none leaves it as it was.
  State402 state() const noexcept { return state_; }
  bool unknown_statusword() const noexcept { return unknown_; }
  bool enabled() const noexcept { return state_ == State402::operation_enabled; }
  bool in_fault() const noexcept;
  bool reached() const noexcept;  ///< the goal
  bool stuck() const noexcept { return waited_ > limits_.hop_steps; }

 private:
  void notice(State402 state) noexcept;
  std::uint16_t reset_word() noexcept;
  std::uint16_t word_for_goal(Enabling enabling) const noexcept;

  DriveSequenceLimits limits_;
  DriveGoal goal_ = DriveGoal::disabled;
  State402 state_ = State402::not_ready_to_switch_on;
  bool unknown_ = false;
  bool was_enabled_ = false;  // since the goal was set
  bool resetting_ = false;
  std::uint32_t reset_steps_ = 0;
  std::uint32_t waited_ = 0;  // steps since the last change of state, while short of the goal
};

}  // namespace takt
