#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt {

/// States of a drive. CiA 402-2, power drive state machine.
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

/// State that a statusword (0x6041) tells; none for a pattern that the profile does not know.
std::optional<State402> decode_statusword(std::uint16_t statusword) noexcept;

/// "operation enabled".
std::string_view name(State402 state) noexcept;

}  // namespace takt
