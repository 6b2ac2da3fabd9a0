#pragma once
#include <array>
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Bytes and bits of a PDO, a column a bit, as they lie on the wire (bit 0 first):
///
///     0       1       2       3       4       5
///     |6041:00 status_|6064:00 position_actual_value          |
///
/// The first line numbers the bytes; in the second each mapped object begins with `|`. A field of
/// fewer columns than its name shows the beginning; gaps are dots.
std::array<std::string, 2> pdo_picture(const BusPlan& plan, const PdoRow& row);

}  // namespace takt
