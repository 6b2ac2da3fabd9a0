#pragma once
#include <array>
#include <string_view>

namespace takt {

/// Names of the bits of 0x6041. CiA 402-2, table "statusword". Bits 12 and 13 depend on the mode.
inline constexpr std::array<std::string_view, 16> statusword_bits{"ready_to_switch_on",
                                                                  "switched_on",
                                                                  "operation_enabled",
                                                                  "fault",
                                                                  "voltage_enabled",
                                                                  "quick_stop",
                                                                  "switch_on_disabled",
                                                                  "warning",
                                                                  "bit_8",
                                                                  "remote",
                                                                  "target_reached",
                                                                  "internal_limit_active",
                                                                  "bit_12",
                                                                  "bit_13",
                                                                  "bit_14",
                                                                  "bit_15"};

/// Names of the bits of 0x6040. Bits 4 to 6 and 9 depend on the mode.
inline constexpr std::array<std::string_view, 16> controlword_bits{
    "switch_on",   "enable_voltage", "quick_stop", "enable_operation", "bit_4",  "bit_5",  "bit_6",
    "fault_reset", "halt",           "bit_9",      "bit_10",           "bit_11", "bit_12", "bit_13",
    "bit_14",      "bit_15"};

}  // namespace takt
