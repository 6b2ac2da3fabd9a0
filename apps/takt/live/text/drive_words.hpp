#pragma once
#include <cstdint>
#include <string>
#include <takt/speed_axis_t.hpp>

namespace takt {

/// Returns the state and the other set bits of a statusword (0x6041) in words, for example
/// "operation enabled, voltage, remote, target reached". Bits 12 and 13 depend on the mode of
/// operation (0x6061). CiA 402-2.
std::string statusword_text(std::uint16_t statusword, int mode);

/// Returns what a controlword (0x6040) commands, for example "enable operation, halt". CiA 402-2.
std::string controlword_text(std::uint16_t controlword, int mode);

/// Returns the usual abbreviation of a mode of operation, for example "csp", or the number of a
/// mode of the manufacturer. CiA 402-2, 0x6060.
std::string mode_text(int mode);

/// Returns the states that the status word of a speed axis shows, for example "ready, running".
std::string speed_words(const speed_axis_t& axis, std::uint16_t word);

/// Returns what the control word of a speed axis commands, for example "run backward".
std::string speed_command(const speed_axis_t& axis, std::uint16_t word);

}  // namespace takt
