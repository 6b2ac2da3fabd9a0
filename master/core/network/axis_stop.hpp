#pragma once
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The state of one axis in the ordered stop.
enum class AxisState : std::uint8_t {
  unseen,    ///< No statusword has come since the stop began.
  asked,     ///< As `unseen`, but an answer is not required, because the node was neither ready nor
             ///< OPERATIONAL.
  rested,    ///< As `unseen`, but the axis was disabled before, and nothing could enable it since.
  exempt,    ///< There is nothing to stop: the axis was disabled when the stop began, its node has
             ///< never given a sign of life, or the device is no drive.
  braking,   ///< The axis is commanded to stop quickly, and was not seen at standstill.
  standing,  ///< The axis was seen at standstill, and is commanded to disable.
  settling,  ///< The axis disabled itself before its standstill was certain.
  stopped,   ///< The axis was seen at standstill and disabled.
  cut,       ///< The time was over: the axis was commanded to disable although it still moved.
  dropped,   ///< The axis was disabled while it moved, or while nothing showed that it stood still.
};

/// The knowledge about an axis when the stop begins.
enum class AxisPrior : std::uint8_t {
  untouched,  ///< The stop does not include the axis, or its node has never given a sign of life.
  heard,      ///< The node has given a sign of life, but was neither ready nor OPERATIONAL.
  disabled,  ///< The node was ready; the axis was seen disabled, and nothing could enable it since.
  exposed,   ///< The node was ready: the axis may be enabled.
  foreign,   ///< The node is OPERATIONAL although this master has not booted it: the axis may be
             ///< enabled.
};

/// The result of the stop of one axis, as it is reported to the user.
enum class AxisVerdict : std::uint8_t {
  stopped,   ///< The stop is confirmed, or there was nothing to stop.
  moving,    ///< The axis was disabled while it moved.
  enabled,   ///< The axis was not disabled.
  silent,    ///< No answer has come for some time.
  lost,      ///< The node does not exchange PDOs and does not answer.
  refused,   ///< The node answers, but refuses the read of the statusword.
  unproven,  ///< The axis was disabled, and nothing showed before that it stood still.
};

/// The values of an axis that have come since the last call. A value is empty if no frame has
/// carried it since then. The values are raw values of the device.
struct AxisSample {
  std::optional<std::int64_t> statusword;
  std::optional<std::int64_t> velocity;  ///< 0x606C
  std::optional<std::int64_t> position;  ///< 0x6064
  /// The time at which the statusword was requested by SDO. Empty if a TPDO has carried it.
  std::optional<Time> word_asked{};
  /// The time at which velocity and position were requested by SDO. Empty if TPDOs have carried
  /// them.
  std::optional<Time> motion_asked{};

  bool empty() const noexcept { return !statusword && !velocity && !position; }
};

/// Determines whether an axis moves. It uses 0x606C, or differences of 0x6064 while 0x606C does not
/// come. Standstill is certain when at least `enough_samples` values in a row were inside a window
/// for at least `standstill_time`. The longest pause between two of these values does not count as
/// part of this time, because frames that were sent before a pause of the bus may arrive after it.
class Standstill {
 public:
  /// Shortest rest that counts as certain standstill.
  static constexpr Time standstill_time = std::chrono::milliseconds{50};
  /// The smallest number of values that can show a standstill.
  static constexpr std::uint32_t enough_samples = 3;

  explicit Standstill(const AxisPlan& plan) noexcept
      : velocity_window_{plan.velocity_window}, position_window_{plan.position_window} {}

  /// Takes a new sample.
  void take(Time now, const AxisSample& sample) noexcept;
  /// Returns true if the value has stayed within the window for long enough.
  bool certain() const noexcept {
    return resting_ && samples_ >= enough_samples && last_ - since_ - pause_ >= standstill_time;
  }
  /// Returns true if the newest value lies outside the window.
  bool moves() const noexcept { return measured_ && !resting_; }
  /// Returns true if the newest value shows standstill and is not newer than `latest`. A single
  /// difference of positions does not count.
  bool rests(Time latest) const noexcept {
    return last_ <= latest && resting_ && (!by_position_ || certain());
  }
  /// Returns true if this value of 0x606C lies within the window.
  bool rests_at(std::int64_t velocity) const noexcept {
    return std::abs(velocity) <= velocity_window_;
  }
  /// Returns true if the newest value lies outside the window and is newer than `start` by more
  /// than `grace`. For a difference of positions, both positions must be newer than `start`. A
  /// value that was read by SDO must have been requested after `start`.
  bool moves_after(Time start, Time grace) const noexcept {
    return moves() && from_ >= start && (by_position_ ? last_ : from_) - start > grace;
  }
  /// Returns the newest velocity in the unit of 0x606C of the device, or in counts of 0x6064 per
  /// second.
  std::int64_t velocity() const noexcept { return velocity_; }
  /// Returns true if the newest velocity comes from differences of 0x6064.
  bool by_position() const noexcept { return by_position_; }

 private:
  void rest(Time from, Time now, bool within) noexcept;
  void take_position(Time now, Time asked, std::int64_t position) noexcept;
  void set_anchor(Time now, Time asked, std::int64_t position) noexcept;

  std::int64_t velocity_window_;
  std::int64_t position_window_;  ///< largest distance in standstill_time that counts as standstill
  std::int64_t velocity_ = 0;
  std::int64_t anchor_ = 0;  ///< Differences are measured from this position.
  Time anchor_at_{};
  /// Time at which the anchor was requested by SDO; anchor_at_ if a TPDO has carried it.
  Time anchor_from_{};
  std::int64_t position_ = 0;
  std::optional<Time> position_at_;
  std::optional<Time> velocity_at_;  ///< The time of the newest 0x606C.
  Time from_{};  ///< The beginning of the time in which the newest value was measured.
  /// Number of successive values within the window, including the anchor.
  std::uint32_t samples_ = 0;
  Time since_{};  ///< start of the current rest
  Time pause_{};  ///< The longest pause between two values of the current rest.
  Time last_{};   ///< The time of the newest value.
  bool measured_ = false;
  bool resting_ = false;
  bool by_position_ = false;
};

/// The ordered stop of one axis. The axis is commanded to stop quickly; when it is seen at
/// standstill, it is disabled. The table in axis_stop.cpp lists the transitions. Bus thread only.
class AxisStop {
 public:
  /// Controlword of the command "quick stop".
  static constexpr std::int64_t quick_stop_word = 0x0002;
  /// Controlword of the command "disable voltage".
  static constexpr std::int64_t disable_voltage_word = 0x0000;
  /// After an axis has disabled itself at the end of its ramp, a velocity that it reports within
  /// this time does not count as a motion.
  static constexpr Time settling_grace = std::chrono::milliseconds{40};

  AxisStop() noexcept : AxisStop{AxisPlan{}} {}
  explicit AxisStop(const AxisPlan& plan) noexcept
      : standstill_{plan}, coasts_{plan.quick_stop_option == 0} {}

  /// Begins the stop of this axis.
  void begin(Time now, AxisPrior prior) noexcept;
  /// Notes that the axis may have received a controlword that changes its state. It may have been
  /// enabled since, even if the next statusword shows that it is disabled.
  void note_command() noexcept { commanded_ = true; }
  /// Notes the behaviour of the drive at a quick stop. `coasts` means that it disables itself at
  /// once (0x605A is 0); otherwise it brakes.
  void note_quick_stop(bool coasts) noexcept { coasts_ = coasts; }
  /// Notes that the node has restarted during the stop. The drive no longer brakes the axis then,
  /// and a drive that starts may report the velocity 0. Therefore only the values count that came
  /// while the axis was enabled.
  void note_restart() noexcept {
    coasts_ = true;
    if (prior_ == AxisPrior::exposed || prior_ == AxisPrior::foreign) commanded_ = true;
  }
  /// Takes the newest values from the time before the stop. They only show whether the axis moved
  /// before it was disabled.
  void recall(std::optional<std::int64_t> statusword,
              std::optional<std::int64_t> velocity) noexcept;
  /// Takes a new sample and advances the stop.
  void step(Time now, const AxisSample& sample) noexcept;
  /// Notes that the time in which the axis can come to standstill is over.
  void cut() noexcept;
  /// Notes that the device has refused the read of its statusword with this abort code.
  void refuse(std::uint32_t abort_code) noexcept { refusal_ = abort_code; }
  /// Notes that the device has no statusword for this axis and is no drive. There is nothing to
  /// stop then, unless this master has booted the node before.
  void absent() noexcept {
    const bool foreign = state_ == AxisState::unseen && prior_ == AxisPrior::foreign;
    if (foreign || state_ == AxisState::asked) state_ = AxisState::exempt;
  }

  AxisState state() const noexcept { return state_; }
  /// Returns true if a statusword has come since the stop began.
  bool seen() const noexcept {
    return state_ != AxisState::unseen && state_ != AxisState::asked && state_ != AxisState::rested;
  }
  /// Returns true if the stop does not have to wait for this axis any longer.
  bool settled() const noexcept;
  /// Returns true if the stop is confirmed, or there was nothing to stop.
  bool confirmed() const noexcept {
    return state_ == AxisState::stopped || state_ == AxisState::exempt ||
           state_ == AxisState::asked || state_ == AxisState::rested;
  }
  /// Returns true if the axis was seen at standstill and disabled, and its newest statusword still
  /// shows that it is disabled.
  bool rests() const noexcept { return state_ == AxisState::stopped && !powered_; }
  /// Returns the controlword that this axis has to receive now.
  std::int64_t controlword() const noexcept;
  /// Returns the time since the newest sample, or since the stop began.
  Time silence(Time now) const noexcept { return now - answered_; }
  /// Returns the velocity at which the axis was disabled, or the newest one if it was not disabled
  /// while it moved.
  std::int64_t velocity() const noexcept;
  bool by_position() const noexcept { return standstill_.by_position(); }
  /// Returns the abort code of AxisVerdict::refused.
  std::uint32_t refusal() const noexcept { return refusal_; }
  /// Returns the result for this axis. `exchanging` states whether the node exchanges PDOs.
  AxisVerdict verdict(Time now, bool exchanging) const noexcept;

  /// Returns true if the power stage is off: the state is "not ready to switch on", "switch on
  /// disabled", "fault" or "ready to switch on". CiA 402-2, 0x6041.
  static constexpr bool disabled(std::int64_t statusword) noexcept {
    const std::int64_t state = statusword & 0x4F;
    return state == 0x00 || state == 0x40 || state == 0x08 || (statusword & 0x6F) == 0x21;
  }

 private:
  enum class Seen : std::uint8_t {
    powered,   ///< The axis is enabled.
    standing,  ///< The axis is enabled and certainly at standstill.
    off,       ///< The axis is disabled.
    off_rest,  ///< The axis is disabled and certainly at standstill.
    off_move,  ///< The axis is disabled and moves.
  };
  /// The last known motion of the axis while it was enabled.
  enum class Motion : std::uint8_t { unknown, rests, moves };
  static AxisState next(AxisState state, Seen seen) noexcept;
  Seen judge() const noexcept;
  void go(AxisState state, Time now) noexcept;
  void note_motion(Time now, const AxisSample& sample) noexcept;
  bool drops(AxisState state, std::int64_t statusword) const noexcept;

  Standstill standstill_;
  bool coasts_;  ///< 0x605A is 0: the quick stop disables the drive at once.
  AxisState state_ = AxisState::unseen;
  AxisPrior prior_ = AxisPrior::exposed;
  std::uint32_t refusal_ = 0;  ///< The abort code of the newest refused read; 0 means none.
  bool commanded_ = false;     ///< note_command() was called
  bool powered_ = true;
  bool disabled_seen_ = false;         ///< The axis was seen disabled during this stop.
  bool unproven_ = false;              ///< the verdict is AxisVerdict::unproven
  Motion motion_ = Motion::unknown;    ///< The motion while the axis was enabled.
  std::int64_t velocity_enabled_ = 0;  ///< The newest velocity that was noted with `motion_`.
  Time entered_{};
  Time answered_{};
  std::int64_t velocity_then_ = 0;  ///< The velocity when the axis was disabled.
};

}  // namespace takt
