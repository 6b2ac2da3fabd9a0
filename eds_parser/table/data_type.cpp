#include "eds_parser/table/data_type.hpp"

namespace takt {

std::string_view name(DataType type) noexcept {
  switch (type) {
    case DataType::unknown:
      return "unknown";
    case DataType::boolean:
      return "BOOLEAN";
    case DataType::integer8:
      return "INTEGER8";
    case DataType::integer16:
      return "INTEGER16";
    case DataType::integer32:
      return "INTEGER32";
    case DataType::unsigned8:
      return "UNSIGNED8";
    case DataType::unsigned16:
      return "UNSIGNED16";
    case DataType::unsigned32:
      return "UNSIGNED32";
    case DataType::real32:
      return "REAL32";
    case DataType::visible_string:
      return "VISIBLE_STRING";
    case DataType::octet_string:
      return "OCTET_STRING";
    case DataType::unicode_string:
      return "UNICODE_STRING";
    case DataType::time_of_day:
      return "TIME_OF_DAY";
    case DataType::time_difference:
      return "TIME_DIFFERENCE";
    case DataType::domain:
      return "DOMAIN";
    case DataType::integer24:
      return "INTEGER24";
    case DataType::real64:
      return "REAL64";
    case DataType::integer40:
      return "INTEGER40";
    case DataType::integer48:
      return "INTEGER48";
    case DataType::integer56:
      return "INTEGER56";
    case DataType::integer64:
      return "INTEGER64";
    case DataType::unsigned24:
      return "UNSIGNED24";
    case DataType::unsigned40:
      return "UNSIGNED40";
    case DataType::unsigned48:
      return "UNSIGNED48";
    case DataType::unsigned56:
      return "UNSIGNED56";
    case DataType::unsigned64:
      return "UNSIGNED64";
  }
  return "unknown";
}

}  // namespace takt
