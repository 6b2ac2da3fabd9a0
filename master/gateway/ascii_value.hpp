#pragma once
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/data_type.hpp"

namespace takt {

/// A data type as CiA 309-3 names it, and how its values are written.
struct AsciiType {
  enum class Form : std::uint8_t {
    plain,   ///< numbers in decimal
    hex,     ///< x8 ... x64: numbers in hex; hex: bytes
    quoted,  ///< vs: "text"
    base64,  ///< os, us, d
  };
  DataType type = DataType::domain;
  Form form = Form::hex;
};

/// `b`, `i8`, `u32`, `x16`, `r64`, `vs`, `os`, `us`, `d`, `hex` ...
std::optional<AsciiType> parse_ascii_type(std::string_view name);

/// One word (without its quotes) as bytes for the wire; an error is a sentence.
std::expected<std::vector<std::byte>, std::string> ascii_bytes(AsciiType type,
                                                               const std::string& word);
/// None: these are not as many bytes as the type has. One line, whatever the bytes are.
std::optional<std::string> ascii_text(AsciiType type, std::span<const std::byte> bytes);

/// An integer as C writes it, without octal; none: it is none.
std::optional<std::int64_t> parse_ascii_integer(std::string_view word);

}  // namespace takt
