#pragma once
#include <cstddef>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/data_type.hpp"

namespace takt {

/// `u16`, `i32`, `f32`, `bool`, `string`, `hex`, or as CiA 301 has them: `UNSIGNED16`. None: no
/// such type.
std::optional<DataType> parse_data_type(std::string_view text);

/// As many bytes as a value of this type has. Strings and domains have any number.
bool fits(DataType type, std::span<const std::byte> bytes) noexcept;
/// What the user is told where they do not fit the type that was called `name`.
std::string misfit_text(std::string_view name, DataType type, std::span<const std::byte> bytes);

/// Bytes of an SDO value as text: numbers in decimal, strings as they are, else hex.
std::string value_text(DataType type, std::span<const std::byte> bytes);
/// For whoever does not know the type: number, text and bytes, as far as they make sense.
std::string untyped_text(std::span<const std::byte> bytes);
std::string hex_text(std::span<const std::byte> bytes);

/// Text of the command line as bytes for the wire, little endian. An error is a sentence.
std::expected<std::vector<std::byte>, std::string> value_bytes(DataType type,
                                                               const std::string& text);

}  // namespace takt
