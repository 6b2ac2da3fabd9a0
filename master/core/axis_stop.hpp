#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// What the ordered stop knows of one axis.
enum class AxisState : std::uint8_t {
  unseen,    ///< its statusword was not seen since the stop began
  asked,     ///< the same, but it need not answer: its node was neither ready nor OPERATIONAL
  rested,    ///< the same, but it was disabled before, and nothing could enable it since
  exempt,    ///< it was disabled when the stop began, or its node was never heard
  braking,   ///< it is told to stop quickly, and was not seen at standstill
  standing,  ///< it was seen at standstill and is told to disable
  settling,  ///< it disabled itself before its standstill was certain
  stopped,   ///< it was seen at standstill and disabled
  cut,       ///< the time was over: it was told to disable although it was not at standstill
  dropped,   ///< it was disabled and moved on
};

/// What is known of an axis when the stop begins.
enum class AxisPrior : std::uint8_t {
  untouched,  ///< the stop does not reach it, or its node was never heard
  heard,      ///< its node was heard, but was neither ready nor OPERATIONAL
  disabled,   ///< its node was ready; it was seen disabled, and nothing could enable it since
  exposed,    ///< its node was ready, or OPERATIONAL without this master: it may be enabled
};

/// What the front side tells of one axis after the stop.
enum class AxisVerdict : std::uint8_t {
  stopped,  ///< confirmed, or there was nothing to stop
  moving,   ///< it was disabled while it moved
  enabled,  ///< it was not disabled
  silent,   ///< no answer for some time
  lost,     ///< its node does not exchange PDOs and does not answer
};

/// What was read of an axis since the last call; empty: nothing new, or nothing that can be relied
/// on. Raw values of the device.
struct AxisSample {
  std::optional<std::int64_t> statusword;
  std::optional<std::int64_t> velocity;  ///< 0x606C
  std::optional<std::int64_t> position;  ///< 0x6064

  bool empty() const noexcept { return !statusword && !velocity && !position; }
};

/// Judges whether an axis moves: by 0x606C, else by differences of 0x6064. Standstill is certain
/// when the value has stayed within a window for `standstill_time`.
class Standstill {
 public:
  static constexpr Time standstill_time = std::chrono::milliseconds{50};

  explicit Standstill(const AxisPlan& plan) noexcept
      : velocity_window_{plan.velocity_window}, position_window_{plan.position_window} {}

  void take(Time now, const AxisSample& sample) noexcept;
  /// It has stayed within the window for long enough.
  bool certain() const noexcept { return resting_ && last_ - since_ >= standstill_time; }
  /// The newest value lies outside the window.
  bool moves() const noexcept { return measured_ && !resting_; }
  /// Raw units of 0x606C, or of 0x6064 in a second.
  std::int64_t velocity() const noexcept { return velocity_; }
  bool by_position() const noexcept { return by_position_; }

 private:
  void rest(Time now, bool within) noexcept;

  std::int64_t velocity_window_;
  std::int64_t position_window_;  ///< within standstill_time
  std::int64_t velocity_ = 0;
  std::int64_t anchor_ = 0;  ///< position from which differences are measured
  std::int64_t position_ = 0;
  Time position_at_{};
  Time since_{};  ///< at rest since then
  Time last_{};   ///< newest value
  bool measured_ = false;
  bool resting_ = false;
  bool by_position_ = false;
};

/// The ordered stop of one axis: quick stop, standstill seen, disabled. The transitions are the
/// table in axis_stop.cpp. Bus thread only.
class AxisStop {
 public:
  static constexpr std::int64_t quick_stop_word = 0x0002;
  static constexpr std::int64_t disable_voltage_word = 0x0000;
  /// An axis that disables itself may be as much younger at rest than its newest velocity says.
  static constexpr Time settling_grace = std::chrono::milliseconds{40};

  AxisStop() noexcept : AxisStop{AxisPlan{}} {}
  explicit AxisStop(const AxisPlan& plan) noexcept : standstill_{plan} {}

  void begin(Time now, AxisPrior prior) noexcept;
  void step(Time now, const AxisSample& sample) noexcept;
  /// The time for standing still is over.
  void cut() noexcept;
  /// The device says that it has no such statusword.
  void absent() noexcept {
    if (state_ == AxisState::asked) state_ = AxisState::exempt;
  }

  AxisState state() const noexcept { return state_; }
  /// Its statusword was seen since the stop began.
  bool seen() const noexcept {
    return state_ != AxisState::unseen && state_ != AxisState::asked && state_ != AxisState::rested;
  }
  /// Nothing more is to be waited for.
  bool settled() const noexcept;
  bool confirmed() const noexcept {
    return state_ == AxisState::stopped || state_ == AxisState::exempt ||
           state_ == AxisState::asked || state_ == AxisState::rested;
  }
  /// It was seen at standstill and disabled, and its newest statusword still says disabled.
  bool rests() const noexcept { return state_ == AxisState::stopped && !powered_; }
  std::int64_t controlword() const noexcept;
  Time silence(Time now) const noexcept { return now - answered_; }
  /// While it was disabled, or now.
  std::int64_t velocity() const noexcept;
  bool by_position() const noexcept { return standstill_.by_position(); }
  AxisVerdict verdict(Time now, bool exchanging) const noexcept;

  /// The power stage is off: not ready, switch on disabled, fault, or ready to switch on.
  static constexpr bool disabled(std::int64_t statusword) noexcept {
    const std::int64_t state = statusword & 0x4F;
    return state == 0x00 || state == 0x40 || state == 0x08 || (statusword & 0x6F) == 0x21;
  }

 private:
  enum class Seen : std::uint8_t {
    powered,   ///< it is enabled
    standing,  ///< it is enabled and certainly at standstill
    off,       ///< it is disabled
    off_rest,  ///< it is disabled and certainly at standstill
    off_move,  ///< it is disabled and moves
  };
  static AxisState next(AxisState state, Seen seen) noexcept;
  Seen judge(Time now) const noexcept;
  void go(AxisState state, Time now) noexcept;

  Standstill standstill_;
  AxisState state_ = AxisState::unseen;
  bool powered_ = true;
  bool disabled_seen_ = false;  ///< at least once since it was enabled
  Time entered_{};
  Time answered_{};
  std::int64_t velocity_then_ = 0;  ///< when it was disabled
};

}  // namespace takt
