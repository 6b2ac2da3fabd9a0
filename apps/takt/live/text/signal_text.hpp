#pragma once
#include <cstdint>
#include <string>
#include <takt/signal_t.hpp>

namespace takt {

/// Returns a value in its unit, or the bits of a digital value, for example "1.2500 rad" or "0010
/// 1101".
std::string long_value(const signal_t& signal, std::int64_t raw);
/// Returns a value in few columns: in its unit, or the bits of a digital value in hex.
std::string short_value(const signal_t& signal, std::int64_t raw);
/// Returns the raw value: real numbers in decimal, others in hex with all digits of their bits.
std::string raw_text(const signal_t& signal, std::int64_t raw);

}  // namespace takt
