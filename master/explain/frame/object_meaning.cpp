#include <fmt/format.h>
#include <string_view>

#include "eds_parser/values/pdo_number.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr std::uint32_t bit_31 = 0x8000'0000;
constexpr std::uint32_t bit_30 = 0x4000'0000;
constexpr std::uint32_t bit_29 = 0x2000'0000;

std::string identifier(std::uint32_t raw) {
  return (raw & bit_29) != 0 ? fmt::format("0x{:08X}", raw & 0x1FFF'FFFF)
                             : fmt::format("0x{:03X}", raw & 0x7FF);
}

std::string pdo_cob_id(std::uint32_t raw, bool tpdo) {
  const char* rtr = tpdo && (raw & bit_30) != 0 ? ", no RTR" : "";
  return fmt::format("{}, {}{}", identifier(raw), (raw & bit_31) != 0 ? "not valid" : "valid", rtr);
}

std::string mapping_entry(const FrameNames& names, unsigned node, std::uint32_t raw) {
  if (raw == 0) return "empty";
  const ObjectKey object{static_cast<std::uint16_t>(raw >> 16),
                         static_cast<std::uint8_t>(raw >> 8)};
  return fmt::format("{}, {} bits", names.object(node, object), raw & 0xFF);
}

std::string transmission(unsigned type) {
  if (type == 0) return "with the next SYNC after an event";
  if (type == 1) return "every SYNC";
  if (type <= 240) return fmt::format("every {} SYNCs", type);
  if (type == 252) return "on remote request, sampled at SYNC";
  if (type == 253) return "on remote request";
  if (type == 254) return "event, manufacturer-specific";
  return type == 255 ? "event, by the device profile" : "reserved type";
}

std::string nmt_request(const FrameNames& names, unsigned target, unsigned value) {
  constexpr unsigned first = 4;
  constexpr std::string_view commands[] = {"stop", "start", "reset", "reset communication of"};
  const bool known = value >= first && value - first < std::size(commands);
  if (!known && value != 127) return {};
  return fmt::format("{} {}", known ? commands[value - first] : "enter pre-operational:",
                     target >= 0x80 ? "all nodes" : names.node(target));
}

std::string_view program_control(unsigned value) {
  constexpr std::string_view texts[] = {"stop", "start", "reset", "clear"};
  return value < 4 ? texts[value] : std::string_view{};
}

std::string of_32_bits(const FrameNames& names, unsigned node, ObjectKey key, std::uint32_t raw) {
  const bool is_channel = key.index >= 0x1200 && key.index <= 0x12FF;
  if (is_pdo_cob_id(key)) return pdo_cob_id(raw, key.index >= 0x1800);
  if (is_channel && (key.sub == 1 || key.sub == 2)) return pdo_cob_id(raw, false);
  if (is_pdo_mapping(key.index) && key.sub != 0) return mapping_entry(names, node, raw);
  switch (key.index) {
    case 0x1005:
      return identifier(raw) + ((raw & bit_30) != 0 ? ", produces SYNC" : "");
    case 0x1012:
      return identifier(raw) + ((raw & bit_30) != 0 ? ", produces TIME" : "") +
             ((raw & bit_31) != 0 ? ", consumes TIME" : "");
    case 0x1014:
      return pdo_cob_id(raw, false);
    case 0x1010:
      return key.sub != 0 && raw == 0x6576'6173 ? "\"save\"" : "";
    case 0x1011:
      return key.sub != 0 && raw == 0x6461'6F6C ? "\"load\"" : "";
    case 0x1016:
      if (key.sub == 0) return {};
      if (raw == 0) return "unused";
      return fmt::format("{}, {} ms", names.node(raw >> 16 & 0x7F), raw & 0xFFFF);
    default:
      return {};
  }
}

}  // namespace

std::string object_meaning(const FrameNames& names, unsigned node, ObjectKey key,
                           std::span<const std::uint8_t> bytes) {
  if (bytes.size() == 4) return of_32_bits(names, node, key, load_le<std::uint32_t>(bytes));
  if (bytes.size() != 1) return {};
  if (is_pdo_communication(key.index) && key.sub == 2) return transmission(bytes[0]);
  if (is_pdo_mapping(key.index) && key.sub == 0 && bytes[0] == 0xFE) return "SAM-MPDO";
  if (is_pdo_mapping(key.index) && key.sub == 0 && bytes[0] == 0xFF) return "DAM-MPDO";
  if (key.index == 0x1F82 && key.sub != 0) return nmt_request(names, key.sub, bytes[0]);
  if (key.index == 0x1F51 && key.sub != 0) return std::string{program_control(bytes[0])};
  return {};
}

}  // namespace takt
