#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "eds_parser/values/data_type.hpp"

namespace takt::learn {

/// Returns the bytes of an object as a value in a network file. Text and raw bytes are quoted.
/// Returns std::nullopt if a network file can't hold the value: text or raw bytes that are empty,
/// not ASCII or longer than 4096 bytes, a number that does not have 1 to 8 bytes or is longer than
/// its type, a BOOLEAN other than 0 and 1, a real number that is not finite, or an unsigned number
/// above 2^63 - 1.
std::optional<std::string> sdo_value_text(std::span<const std::uint8_t> bytes, DataType type);

/// Returns true if a number has bytes beyond the width of its type that are neither zeros nor the
/// extension of its sign. Some masters send four bytes whatever the type is.
bool is_longer_than(std::span<const std::uint8_t> bytes, DataType type);

}  // namespace takt::learn
