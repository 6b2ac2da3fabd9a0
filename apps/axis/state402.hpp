#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt {

/// States of the power drive state machine. CiA 402-2.
enum class State402 : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

/// Returns the state that a statusword (0x6041) reports, or std::nullopt if the profile does not
/// define its pattern.
std::optional<State402> decode_statusword(std::uint16_t statusword) noexcept;

/// Returns the name of the state for messages, for example "operation enabled".
std::string_view name(State402 state) noexcept;

}  // namespace takt
