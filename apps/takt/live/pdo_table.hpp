#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <takt/pdo_status_t.hpp>
#include <takt/status_t.hpp>
#include <vector>

namespace takt {

/// Returns a header and a line for each PDO with its parameters, its age in cycles and its errors.
std::vector<std::string> pdo_lines(const pdo_status_t& pdos, const status_t& status);
nlohmann::json pdos_json(const pdo_status_t& pdos);

}  // namespace takt
