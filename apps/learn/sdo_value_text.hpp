#pragma once
#include <optional>
#include <span>
#include <string>

#include "eds_parser/table/data_type.hpp"

namespace takt {

/// Bytes of an object as the value of a network file; none: it can't be written there (bytes that
/// are no text, a text that looks like a number).
std::optional<std::string> sdo_value_text(std::span<const std::uint8_t> bytes, DataType type);

}  // namespace takt
