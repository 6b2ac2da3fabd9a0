#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// `37 06`.
std::string bytes_text(std::span<const std::uint8_t> bytes);

/// Bytes of an object, least significant first, as its type reads them: `1591 (0x637)`, `-5`,
/// `1.5`,
/// `"Drive"`. Bytes where they do not fit the type.
std::string value_text(DataType type, std::span<const std::uint8_t> bytes);

/// A mapped value in its unit: `12.3 rad`; words of bits (statusword, controlword) in hex.
std::string value_text(const Signal& signal, std::uint64_t raw);

}  // namespace takt
