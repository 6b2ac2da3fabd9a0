#pragma once
#include <string>
#include <string_view>

#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// `VAR`, `RECORD`.
std::string_view object_type_name(ObjectType type) noexcept;
/// `mandatory`, `optional`, `manufacturer`; an unlisted object by where it belongs.
std::string_view list_name(const Object& object) noexcept;
/// Hex pairs without prefix: `01a105`.
std::string hex_bytes(std::string_view bytes);
/// `SYNC 1`, `every 3rd SYNC` ... of a PDO's transmission type. CiA 301, tables 69 and 72.
std::string transmission_name(std::uint8_t type, bool is_tpdo);

}  // namespace takt
