#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Describes an EMCY error code (also 0x603F of drives) in words, by the most specific entry of CiA
/// 301 and CiA 402 that covers it. The text is never empty.
std::string_view emcy_text(std::uint16_t code) noexcept;
/// Describes an EMCY error code of `node`, preferably by a text of its device data. `node` is
/// nullptr for a node that is not in the plan.
std::string_view emcy_text(const NodePlan* node, std::uint16_t code) noexcept;

/// Names the bits that are set in the error register 0x1001, for example "generic,
/// voltage". The text is "none" if no bit is set.
std::string error_register_text(std::uint8_t error_register);

}  // namespace takt
