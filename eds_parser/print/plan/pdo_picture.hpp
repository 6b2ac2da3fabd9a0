#pragma once
#include <array>
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns a picture of the bits of a PDO, one column for each bit, as they are on the wire (bit 0
/// first):
///
///     0       1       2       3       4       5
///     |6041:00 status_|6064:00 position_actual_value          |
///
/// The first line numbers the bytes. In the second line each mapped object begins with `|`. If a
/// field has fewer columns than its name, it shows the beginning of the name. Gaps are dots.
std::array<std::string, 2> pdo_picture(const BusPlan& plan, const PdoRow& row);

}  // namespace takt
