#include "eds_parser/dictionary/standard_types.hpp"

#include <algorithm>
#include <iterator>

#include "eds_parser/dictionary/pdo_description.hpp"

namespace takt {
namespace {

using enum DataType;

struct StandardObject {
  std::uint16_t index;
  DataType type;  ///< data type of sub-index 0
};

constexpr StandardObject single_values[] = {
    {0x1000, unsigned32},     {0x1001, unsigned8},      {0x1002, unsigned32},
    {0x1005, unsigned32},     {0x1006, unsigned32},     {0x1007, unsigned32},
    {0x1008, visible_string}, {0x1009, visible_string}, {0x100A, visible_string},
    {0x100C, unsigned16},     {0x100D, unsigned8},      {0x1012, unsigned32},
    {0x1013, unsigned32},     {0x1014, unsigned32},     {0x1015, unsigned16},
    {0x1017, unsigned16},     {0x1019, unsigned8}};

/// The data types of sub-index 0 to 6 in the communication record of a PDO.
constexpr DataType of_pdo[] = {unsigned8, unsigned32, unsigned8, unsigned16,
                               unsigned8, unsigned16, unsigned8};

bool is_array_of_u32(std::uint16_t index) noexcept {
  return index == 0x1003 || index == 0x1010 || index == 0x1011 || index == 0x1016 ||
         index == 0x1018 || is_pdo_mapping(index);
}

}  // namespace

DataType standard_type(ObjectKey key) noexcept {
  if (key.index > 0x1BFF) return unknown;
  if (is_pdo_communication(key.index)) {
    return key.sub < std::size(of_pdo) ? of_pdo[key.sub] : unknown;
  }
  if (is_array_of_u32(key.index)) return key.sub == 0 ? unsigned8 : unsigned32;
  const auto* found = std::ranges::find(single_values, key.index, &StandardObject::index);
  return key.sub == 0 && found != std::end(single_values) ? found->type : unknown;
}

DataType data_type_of(std::uint32_t code) noexcept {
  const auto type = static_cast<DataType>(code);
  return code <= 0x1B && name(type) != "unknown" ? type : unknown;
}

}  // namespace takt
