#pragma once
#include <string_view>

#include "eds_parser/table/device_table.hpp"

namespace takt {

/// As an EDS writes it: "ro", "const".
std::string_view access_name(Access access) noexcept;

}  // namespace takt
