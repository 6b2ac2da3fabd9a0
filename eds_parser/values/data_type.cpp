#include "eds_parser/values/data_type.hpp"

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::string_view name(DataType type) noexcept {
  static constexpr std::string_view names[]{
      "unknown",      "BOOLEAN",        "INTEGER8",    "INTEGER16",       "INTEGER32",
      "UNSIGNED8",    "UNSIGNED16",     "UNSIGNED32",  "REAL32",          "VISIBLE_STRING",
      "OCTET_STRING", "UNICODE_STRING", "TIME_OF_DAY", "TIME_DIFFERENCE", "unknown",
      "DOMAIN",       "INTEGER24",      "REAL64",      "INTEGER40",       "INTEGER48",
      "INTEGER56",    "INTEGER64",      "UNSIGNED24",  "unknown",         "UNSIGNED40",
      "UNSIGNED48",   "UNSIGNED56",     "UNSIGNED64"};
  return name_of(type, names, "unknown");
}

}  // namespace takt
