#include "master/sim/model/drive_state.hpp"

namespace takt::sim {
namespace {

bool takes_power_away(DriveCommand command) noexcept {
  return command == DriveCommand::disable_voltage || command == DriveCommand::quick_stop;
}

DriveState from_ready(DriveCommand command) noexcept {
  if (takes_power_away(command)) return DriveState::switch_on_disabled;  // 7
  const bool on = command == DriveCommand::switch_on || command == DriveCommand::enable_operation;
  return on ? DriveState::switched_on : DriveState::ready;  // 3
}

DriveState from_switched_on(DriveCommand command) noexcept {
  if (takes_power_away(command)) return DriveState::switch_on_disabled;                 // 10
  if (command == DriveCommand::shutdown) return DriveState::ready;                      // 6
  if (command == DriveCommand::enable_operation) return DriveState::operation_enabled;  // 4
  return DriveState::switched_on;
}

DriveState from_operation_enabled(DriveCommand command) noexcept {
  switch (command) {
    case DriveCommand::switch_on:
      return DriveState::switched_on;  // 5
    case DriveCommand::shutdown:
      return DriveState::ready;  // 8
    case DriveCommand::disable_voltage:
      return DriveState::switch_on_disabled;  // 9
    case DriveCommand::quick_stop:
      return DriveState::quick_stop;  // 11
    case DriveCommand::none:
    case DriveCommand::enable_operation:
      break;
  }
  return DriveState::operation_enabled;
}

}  // namespace

DriveState commanded(DriveState state, DriveCommand command, bool stays) noexcept {
  switch (state) {
    case DriveState::switch_on_disabled:
      return command == DriveCommand::shutdown ? DriveState::ready : state;  // 2
    case DriveState::ready:
      return from_ready(command);
    case DriveState::switched_on:
      return from_switched_on(command);
    case DriveState::operation_enabled:
      return from_operation_enabled(command);
    case DriveState::quick_stop:
      if (command == DriveCommand::disable_voltage) return DriveState::switch_on_disabled;  // 12
      if (command == DriveCommand::enable_operation && stays) {
        return DriveState::operation_enabled;  // 16
      }
      return state;
    case DriveState::not_ready:
    case DriveState::fault_reaction:
    case DriveState::fault:
      break;
  }
  return state;
}

}  // namespace takt::sim
