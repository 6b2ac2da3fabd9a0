#include "eds_parser/dictionary/standard_types.hpp"

namespace takt {
namespace {

DataType single(std::uint16_t index) noexcept {
  switch (index) {
    case 0x1000:
    case 0x1002:
    case 0x1005:
    case 0x1006:
    case 0x1007:
    case 0x1012:
    case 0x1013:
    case 0x1014:
      return DataType::unsigned32;
    case 0x1008:
    case 0x1009:
    case 0x100A:
      return DataType::visible_string;
    case 0x100C:
    case 0x1015:
    case 0x1017:
      return DataType::unsigned16;
    case 0x1001:
    case 0x100D:
    case 0x1019:
      return DataType::unsigned8;
    default:
      return DataType::unknown;
  }
}

DataType pdo_communication(std::uint8_t sub) noexcept {
  switch (sub) {
    case 1:
      return DataType::unsigned32;
    case 3:
    case 5:
      return DataType::unsigned16;
    case 0:
    case 2:
    case 4:
    case 6:
      return DataType::unsigned8;
    default:
      return DataType::unknown;
  }
}

bool within(std::uint16_t index, std::uint16_t first, std::uint16_t last) noexcept {
  return index >= first && index <= last;
}

bool is_array_of_u32(std::uint16_t index) noexcept {
  return index == 0x1003 || index == 0x1010 || index == 0x1011 || index == 0x1016 ||
         index == 0x1018 || within(index, 0x1600, 0x17FF) || within(index, 0x1A00, 0x1BFF);
}

}  // namespace

DataType standard_type(ObjectKey key) noexcept {
  if (within(key.index, 0x1400, 0x15FF) || within(key.index, 0x1800, 0x19FF)) {
    return pdo_communication(key.sub);
  }
  if (is_array_of_u32(key.index)) return key.sub == 0 ? DataType::unsigned8 : DataType::unsigned32;
  return key.sub == 0 ? single(key.index) : DataType::unknown;
}

DataType data_type_of(std::uint32_t code) noexcept {
  const auto type = static_cast<DataType>(code);
  return code <= 0x1B && name(type) != "unknown" ? type : DataType::unknown;
}

}  // namespace takt
