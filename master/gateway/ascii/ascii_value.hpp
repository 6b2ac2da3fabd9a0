#pragma once
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/values/data_type.hpp"

namespace takt {

/// A data type by its name in CiA 309-3, and the notation of its values.
struct AsciiType {
  enum class Form : std::uint8_t {
    plain,   ///< decimal numbers
    hex,     ///< x8 ... x64 as hex numbers, hex as bytes
    quoted,  ///< vs as "text"
    base64,  ///< os, us, d
  };
  DataType type = DataType::domain;
  Form form = Form::hex;
};

/// Parses `b`, `i8`, `u32`, `x16`, `r64`, `vs`, `os`, `us`, `d`, `hex` ...
std::optional<AsciiType> parse_ascii_type(std::string_view name);

/// Converts one word (without its quotes) to bytes for the wire. The error is a sentence.
std::expected<std::vector<std::byte>, std::string> ascii_bytes(AsciiType type,
                                                               const std::string& word);
/// Returns the value in one line, whatever its bytes are. Returns std::nullopt if the number of
/// bytes does not fit the type.
std::optional<std::string> ascii_text(AsciiType type, std::span<const std::byte> bytes);

/// Parses an integer in the notation of C, without octal. Returns std::nullopt if the word is not
/// an integer.
std::optional<std::int64_t> parse_ascii_integer(std::string_view word);

}  // namespace takt
