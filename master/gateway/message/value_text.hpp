#pragma once
#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/values/data_type.hpp"

namespace takt {

/// Parses `u16`, `i32`, `f32`, `bool`, `string`, `hex`, or the names of CiA 301 such as
/// `UNSIGNED16`. Returns std::nullopt if there is no such type.
std::optional<DataType> parse_data_type(std::string_view text);

/// Returns true if the number of bytes fits the type. Strings and domains may have any number.
bool fits(DataType type, std::span<const std::byte> bytes) noexcept;
/// Returns the text for the user if `bytes` do not fit the type that was given as `name`.
std::string misfit_text(std::string_view name, DataType type, std::span<const std::byte> bytes);

/// Formats the bytes of an SDO value: numbers in decimal, strings as they are, anything else in
/// hex.
std::string value_text(DataType type, std::span<const std::byte> bytes);
/// Formats a value of unknown type: number, text and bytes, as far as they make sense.
std::string untyped_text(std::span<const std::byte> bytes);
std::string hex_text(std::span<const std::byte> bytes);

/// Converts text of the command line to bytes for the wire, little endian. The error is a sentence.
std::expected<std::vector<std::byte>, std::string> value_bytes(DataType type,
                                                               const std::string& text);

}  // namespace takt
