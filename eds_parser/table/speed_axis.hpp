#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/pdo_table.hpp"

namespace takt {

/// The bits of the status word with which a drive shows one of its states.
struct WordPattern {
  std::uint16_t mask = 0;               ///< the bits that count; 0 = the state is not shown
  std::vector<std::uint16_t> values{};  ///< values of the bits of `mask` in this state

  bool is_known() const noexcept { return mask != 0; }
  bool shows(std::int64_t word) const noexcept {
    const auto bits = static_cast<std::uint16_t>(word & mask);
    return is_known() && std::ranges::find(values, bits) != values.end();
  }
};

/// The way in which the control word of a speed axis leads the drive from one state to the next.
enum class SpeedSequence : std::uint8_t {
  words,   ///< each command is one value of the control word
  cia402,  ///< the state machine of CiA 402; bits 4 to 6 of the controlword run the ramp (mode vl)
};

/// The moment at which a drive executes the command "fault reset".
enum class FaultReset : std::uint8_t {
  edge,   ///< at the change from another command to this one
  level,  ///< while the command is present
};

/// The values of the control word of a speed axis, in the bits of `mask`.
struct SpeedCommands {
  std::uint16_t mask = 0xFFFF;
  std::uint16_t off = 0;   ///< the drive does not move, and may be without power
  std::uint16_t stop = 0;  ///< the drive stops along its ramp and stays at standstill
  std::uint16_t run = 0;   ///< the drive follows the set speed
  std::optional<std::uint16_t> run_reverse{};  ///< backward; empty: the set speed has a sign
  std::optional<std::uint16_t> quick_stop{};
  std::optional<std::uint16_t> reset{};
};

/// What the status word of a speed axis shows.
struct SpeedStates {
  WordPattern ready{};       ///< the drive accepts the command to run
  WordPattern running{};     ///< the motor is under power
  WordPattern reverse{};     ///< the drive turns backward
  WordPattern at_speed{};    ///< the set speed is reached
  WordPattern standstill{};  ///< the drive is at standstill
  WordPattern fault{};
};

/// An axis that follows a set speed and has no position: an inverter, or a CiA 402 drive in mode
/// vl. Its objects and commands are those of the device data, or of `speed_axis` in the network
/// file.
struct SpeedAxisPlan {
  std::uint8_t node_index = 0;  ///< position in BusPlan::nodes
  SpeedSequence sequence = SpeedSequence::words;
  FaultReset fault_reset = FaultReset::edge;
  SignalIndex control = 0;    ///< output
  SignalIndex set_speed = 0;  ///< output
  SignalIndex status = 0;     ///< input
  std::optional<SignalIndex> actual_speed{};
  SpeedCommands commands{};
  SpeedStates states{};
  std::string unit{};           ///< unit of speeds: "rpm", "Hz"
  double set_scale = 1.0;       ///< speed = raw set speed x set_scale
  double actual_scale = 1.0;    ///< speed = raw actual speed x actual_scale
  double max_speed = 0;         ///< `limits: {velocity}` in `unit`; 0 = none
  double max_acceleration = 0;  ///< `limits: {acceleration}` in `unit` per second; 0 = none
};

/// The effect of the control word on the set speed: the drive follows the set speed times factor().
/// The checks of the bus thread use this.
struct SpeedOrders {
  std::uint16_t mask = 0xFFFF;
  std::uint16_t run = 0;
  std::optional<std::uint16_t> run_reverse{};
  std::array<std::uint16_t, 4> idle{};  ///< values with which the drive ignores the set speed
  bool others_run = true;               ///< with any other value, the drive follows the set speed
  double scale = 1.0;                   ///< speed of one count, for messages

  constexpr double factor(std::int64_t order) const noexcept {
    const auto bits = static_cast<std::uint16_t>(order & mask);
    if (run_reverse && bits == *run_reverse) return -1.0;
    if (bits == run) return 1.0;
    if (std::ranges::find(idle, bits) != idle.end()) return 0.0;
    return others_run ? 1.0 : 0.0;
  }
};

/// Returns the effects of the control words of this axis, for the checks of the bus thread.
inline SpeedOrders orders_of(const SpeedAxisPlan& axis) noexcept {
  const SpeedCommands& words = axis.commands;
  const auto bits = [&](std::uint16_t word) {
    return static_cast<std::uint16_t>(word & words.mask);
  };
  SpeedOrders orders{
      .mask = words.mask,
      .run = bits(words.run),
      .idle = {bits(words.off), bits(words.stop), bits(words.quick_stop.value_or(words.stop)),
               bits(words.reset.value_or(words.stop))},
      .others_run = axis.sequence == SpeedSequence::words,
      .scale = axis.set_scale};
  if (words.run_reverse) orders.run_reverse = bits(*words.run_reverse);
  return orders;
}

}  // namespace takt
