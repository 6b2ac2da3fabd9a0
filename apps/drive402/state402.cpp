#include <array>
#include <takt/drive402.hpp>

#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

struct Pattern {
  std::uint16_t mask;
  std::uint16_t value;
  State402 state;
};

constexpr std::array patterns{
    Pattern{0x4F, 0x00, State402::not_ready_to_switch_on},
    Pattern{0x4F, 0x40, State402::switch_on_disabled},
    Pattern{0x6F, 0x21, State402::ready_to_switch_on},
    Pattern{0x6F, 0x23, State402::switched_on},
    Pattern{0x6F, 0x27, State402::operation_enabled},
    Pattern{0x6F, 0x07, State402::quick_stop_active},
    Pattern{0x4F, 0x0F, State402::fault_reaction_active},
    Pattern{0x4F, 0x08, State402::fault},
};

}  // namespace

std::optional<State402> decode_statusword(std::uint16_t statusword) noexcept {
  for (const Pattern& pattern : patterns) {
    if ((statusword & pattern.mask) == pattern.value) return pattern.state;
  }
  return std::nullopt;
}

std::string_view name(State402 state) noexcept {
  static constexpr std::string_view names[]{
      "not ready to switch on", "switch on disabled", "ready to switch on",    "switched on",
      "operation enabled",      "quick stop active",  "fault reaction active", "fault"};
  return name_of(state, names, "unknown");
}

}  // namespace takt
