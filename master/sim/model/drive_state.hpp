#pragma once
#include <cstdint>

namespace takt::sim {

/// States of a drive. CiA 402-2, 6.
enum class DriveState : std::uint8_t {
  not_ready,
  switch_on_disabled,
  ready,
  switched_on,
  operation_enabled,
  quick_stop,
  fault_reaction,
  fault,
};

/// The command in a controlword, independent of the state. A controlword with bit 7 set holds no
/// command.
enum class DriveCommand : std::uint8_t {
  none,
  shutdown,          ///< xxxx x110
  switch_on,         ///< xxxx 0111; in Operation enabled this disables operation
  enable_operation,  ///< xxxx 1111
  disable_voltage,   ///< xxxx xx0x
  quick_stop,        ///< xxxx x01x
};

constexpr DriveCommand command_of(std::uint16_t controlword) noexcept {
  if ((controlword & 0x80) != 0) return DriveCommand::none;
  if ((controlword & 0x02) == 0) return DriveCommand::disable_voltage;
  if ((controlword & 0x04) == 0) return DriveCommand::quick_stop;
  if ((controlword & 0x01) == 0) return DriveCommand::shutdown;
  return (controlword & 0x08) == 0 ? DriveCommand::switch_on : DriveCommand::enable_operation;
}

/// Bits 0-3, 5 and 6 of the statusword.
constexpr std::uint16_t state_bits(DriveState state) noexcept {
  switch (state) {
    case DriveState::not_ready:
      return 0x0000;
    case DriveState::switch_on_disabled:
      return 0x0040;
    case DriveState::ready:
      return 0x0021;
    case DriveState::switched_on:
      return 0x0023;
    case DriveState::operation_enabled:
      return 0x0027;
    case DriveState::quick_stop:
      return 0x0007;
    case DriveState::fault_reaction:
      return 0x000F;
    case DriveState::fault:
      return 0x0008;
  }
  return 0;
}

/// Returns the state after a command; each call makes at most one transition. `stays` is true if
/// option codes 5 to 8 of 0x605A keep the drive in Quick stop active until it is enabled again.
/// This function covers transitions 2 to 12 and 16. Axis402 makes the transitions without a command
/// (0, 1, 12 after the ramp, 13, 14) and the fault reset (15).
DriveState commanded(DriveState state, DriveCommand command, bool stays) noexcept;

/// Returns true if the power stage is on in this state.
constexpr bool is_powered(DriveState state) noexcept {
  return state == DriveState::operation_enabled || state == DriveState::quick_stop ||
         state == DriveState::fault_reaction;
}

}  // namespace takt::sim
