#pragma once
#include <string_view>

#include "eds_parser/table/device_table.hpp"

namespace takt {

/// Returns the access type as an EDS writes it, for example "ro" or "const".
std::string_view access_name(Access access) noexcept;

}  // namespace takt
