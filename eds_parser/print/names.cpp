#include "eds_parser/print/names.hpp"

#include <fmt/format.h>
#include <iterator>

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::string_view object_type_name(ObjectType type) noexcept {
  static constexpr std::string_view names[]{"NULL",    "VAR",       "DOMAIN", "VAR",   "VAR",
                                            "DEFTYPE", "DEFSTRUCT", "VAR",    "ARRAY", "RECORD"};
  return name_of(type, names, "VAR");
}

std::string_view list_name(const Object& object) noexcept {
  static constexpr std::string_view names[]{"mandatory", "optional", "manufacturer", "unlisted"};
  if (object.list != ObjectList::unlisted) return name_of(object.list, names);
  const bool mandatory = object.index == 0x1000 || object.index == 0x1001 || object.index == 0x1018;
  if (mandatory) return "mandatory";
  return object.index >= 0x2000 && object.index < 0x6000 ? "manufacturer" : "optional";
}

std::string hex_bytes(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    fmt::format_to(std::back_inserter(text), "{:02x}", static_cast<unsigned char>(c));
  }
  return text;
}

std::string transmission_name(std::uint8_t type, bool is_tpdo) {
  if (type == 0) return is_tpdo ? "with SYNC, on change" : "acts at SYNC";
  if (type <= 240) {
    if (!is_tpdo) return "acts at SYNC";
    return type == 1 ? "every SYNC" : fmt::format("every {} SYNCs", type);
  }
  if (type == 252) return is_tpdo ? "RTR, sampled at SYNC" : "reserved";
  if (type == 253) return is_tpdo ? "RTR" : "reserved";
  if (type == 254) return "event, manufacturer";
  if (type == 255) return "event, profile";
  return "reserved";
}

}  // namespace takt
