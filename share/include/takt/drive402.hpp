#pragma once
/// @file
/// The state machine of one CiA 402 drive: decodes the statusword, and gives the controlwords that
/// bring the drive to Operation enabled and back. It needs neither a bus nor a clock.
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt {

/// States of the power drive state machine. CiA 402-2, finite state automaton.
enum class State402 : std::uint8_t {
  not_ready_to_switch_on,  ///< The drive starts or tests itself.
  switch_on_disabled,      ///< The drive may not be switched on; the power stage is off.
  ready_to_switch_on,      ///< The drive may be switched on; the power stage is off.
  switched_on,             ///< The power stage is ready, and the motor has no torque.
  operation_enabled,       ///< The drive follows its set-points.
  quick_stop_active,       ///< The quick stop is running, or the drive holds after it (0x605A).
  fault_reaction_active,   ///< The drive reacts to a fault.
  fault,                   ///< The drive has a fault; the power stage is off.
};

/// Returns the state that a statusword (0x6041) reports, or std::nullopt if the profile does not
/// define its pattern.
std::optional<State402> decode_statusword(std::uint16_t statusword) noexcept;

/// Returns the name of the state for messages, for example "operation enabled".
std::string_view name(State402 state) noexcept;

/// Modes of operation: the values of the objects 0x6060 and 0x6061. CiA 402-2.
enum class DriveMode : std::int8_t {
  none = 0,                   ///< no mode
  profile_position = 1,       ///< pp: the drive moves to each target position by itself
  profile_velocity = 3,       ///< pv: the drive accelerates to the target velocity by itself
  profile_torque = 4,         ///< tq: the drive changes the torque by itself
  homing = 6,                 ///< hm: the drive looks for its reference
  interpolated_position = 7,  ///< ip: a point (0x60C1:01) for the buffer of the drive in each SYNC
  cyclic_position = 8,        ///< csp: a target position for each SYNC
  cyclic_velocity = 9,        ///< csv: a target velocity for each SYNC
  cyclic_torque = 10,         ///< cst: a target torque for each SYNC
};

/// When a drive in profile position mode begins to move to a new set-point. CiA 402-2, bit 5 of the
/// controlword.
enum class SetPointTiming : std::uint8_t {
  immediately,    ///< The new set-point replaces the earlier ones.
  after_the_last  ///< The drive first reaches the earlier set-point.
};

/// State to which a DriveSequence brings its drive.
enum class DriveGoal : std::uint8_t {
  disabled,      ///< Switch on disabled
  enabled,       ///< Operation enabled
  quick_stopped  ///< Quick stop active, or Switch on disabled if the drive was not enabled
};

/// Whether a drive may be brought towards Operation enabled. A drive that is already in that state
/// stays there in either case.
enum class Enabling : std::uint8_t {
  waits,   ///< The drive is not enabled for the time being.
  goes_on  ///< The drive may be enabled.
};

/// Limits of a DriveSequence, in steps. There is one step in each cycle.
struct DriveSequenceLimits {
  /// Number of steps for which bit 7 of the controlword is low before its rising edge.
  std::uint32_t reset_low_steps = 10;
  /// A drive that has not reached its goal is stuck if its state does not change for more than this
  /// number of steps.
  std::uint32_t hop_steps = 2500;
};

/// Takes one drive through the CiA 402 state machine: in each cycle, a step takes the statusword
/// and gives the controlword. Each controlword is held until the statusword acknowledges it, so
/// that no edge is lost on a channel where only the newest value counts. If a drive has a fault or
/// leaves Operation enabled by itself (safe torque off), its goal becomes DriveGoal::disabled, and
/// the drive is not enabled again before the next set_goal().
///
/// Calls allocate nothing. All calls come from one thread.
class DriveSequence {
 public:
  /// The goal of a new sequence is DriveGoal::disabled.
  explicit DriveSequence(DriveSequenceLimits limits = {}) noexcept : limits_{limits} {}

  /// Sets the goal. The following steps bring the drive to it.
  void set_goal(DriveGoal goal) noexcept;
  /// Asks for one fault reset. The call has no effect unless the drive is in Fault or in Fault
  /// reaction active.
  void reset_fault() noexcept;

  /// Returns the controlword (0x6040, without mode-specific bits) that answers this statusword
  /// (0x6041). CiA 402-2, commands of the controlword.
  std::uint16_t step(std::uint16_t statusword, Enabling enabling = Enabling::goes_on) noexcept;

  /// Returns the goal, which is DriveGoal::disabled after a fault.
  DriveGoal goal() const noexcept { return goal_; }
  /// Returns the last known state. A statusword with an unknown pattern does not change it.
  State402 state() const noexcept { return state_; }
  /// Returns true if the last statusword has a pattern that the profile does not define.
  bool unknown_statusword() const noexcept { return unknown_; }
  /// Returns true if the drive is in Operation enabled.
  bool enabled() const noexcept { return state_ == State402::operation_enabled; }
  /// Returns true if the drive is in Fault or in Fault reaction active.
  bool in_fault() const noexcept;
  /// Returns true if the drive has reached its goal. Not ready to switch on and Fault also count as
  /// disabled.
  bool reached() const noexcept;
  /// Returns true if the drive has not reached its goal and its state has not changed for more
  /// than DriveSequenceLimits::hop_steps steps.
  bool stuck() const noexcept { return waited_ > limits_.hop_steps; }

 private:
  void notice(State402 state) noexcept;
  std::uint16_t reset_word() noexcept;
  std::uint16_t word_for_goal(Enabling enabling) const noexcept;

  DriveSequenceLimits limits_;
  DriveGoal goal_ = DriveGoal::disabled;
  State402 state_ = State402::not_ready_to_switch_on;
  bool unknown_ = false;
  bool was_enabled_ = false;  // true if the drive was enabled since the goal was set
  bool resetting_ = false;
  std::uint32_t reset_steps_ = 0;
  std::uint32_t waited_ = 0;  // steps without a change of state before the goal is reached
};

}  // namespace takt
