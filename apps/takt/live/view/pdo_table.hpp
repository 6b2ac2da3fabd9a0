#pragma once
#include <nlohmann/json_fwd.hpp>
#include <takt/pdo_status_t.hpp>
#include <takt/status_t.hpp>

#include "apps/takt/live/text/table.hpp"

namespace takt {

/// Returns a table of all PDOs with their parameters, their ages in cycles and their errors.
Table::Text pdo_table(const pdo_status_t& pdos, const status_t& status, std::size_t width);
nlohmann::json pdos_json(const pdo_status_t& pdos);

}  // namespace takt
