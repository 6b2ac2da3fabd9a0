#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "master/explain/report_text.hpp"

namespace takt {

/// Returns the value of an object as its type reads it: `1591 (0x637)`, `-5`, `1.5` or `"Drive"`.
/// The bytes begin with the least significant one. Returns bytes_text() if they do not fit the
/// type.
std::string value_text(DataType type, std::span<const std::uint8_t> bytes);

/// Returns a mapped value in its unit, `12.3 rad`. Bit fields (statusword, controlword) are in hex.
std::string value_text(const Signal& signal, std::uint64_t raw);

}  // namespace takt
