#include "apps/takt/od/value_meaning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <takt/drive402.hpp>
#include <utility>

#include "eds_parser/specification/object_units.hpp"
#include "eds_parser/values/pdo_number.hpp"
#include "eds_parser/values/raw_number.hpp"
#include "master/explain/emcy_text.hpp"
#include "master/gateway/message/value_text.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

using Named = std::pair<std::int64_t, std::string_view>;

constexpr Named modes[] = {{0, "no mode"},
                           {1, "profile position"},
                           {2, "velocity"},
                           {3, "profile velocity"},
                           {4, "profile torque"},
                           {6, "homing"},
                           {7, "interpolated position"},
                           {8, "cyclic synchronous position"},
                           {9, "cyclic synchronous velocity"},
                           {10, "cyclic synchronous torque"}};

/// Bits of 0x6502 by their position. CiA 402-2.
constexpr std::array<std::string_view, 10> supported_modes{"pp", "vl", "pv",  "tq",  "",
                                                           "hm", "ip", "csp", "csv", "cst"};

/// Reactions to quick stop, 0x605A. CiA 402-2.
constexpr Named quick_stops[] = {{0, "disable the drive"},
                                 {1, "slow down ramp, then disabled"},
                                 {2, "quick stop ramp, then disabled"},
                                 {3, "current limit, then disabled"},
                                 {4, "voltage limit, then disabled"},
                                 {5, "slow down ramp, stay in quick stop"},
                                 {6, "quick stop ramp, stay in quick stop"},
                                 {7, "current limit, stay in quick stop"},
                                 {8, "voltage limit, stay in quick stop"}};

std::string_view name_in(std::span<const Named> names, std::int64_t number) {
  const auto found = std::ranges::find(names, number, &Named::first);
  return found == names.end() ? std::string_view{} : found->second;
}

void add(std::string& text, std::string_view word, std::string_view before = ", ") {
  if (!text.empty() && !word.empty()) text += before;
  text += word;
}

std::string status_text(std::uint16_t word) {
  const auto state = decode_statusword(word);
  std::string text{state ? name(*state) : "unknown state"};
  if ((word & 0x0080) != 0) add(text, "warning");
  if ((word & 0x0400) != 0) add(text, "target reached");
  if ((word & 0x0800) != 0) add(text, "internal limit active");
  if ((word & 0x0200) == 0) add(text, "not remote");
  return text;
}

/// Commands of the controlword. CiA 402-2.
std::string control_text(std::uint16_t word) {
  std::string text;
  if ((word & 0x80) != 0) {
    text = "fault reset";
  } else if ((word & 0x02) == 0) {
    text = "disable voltage";
  } else if ((word & 0x04) == 0) {
    text = "quick stop";
  } else if ((word & 0x01) == 0) {
    text = "shutdown";
  } else {
    text = (word & 0x08) != 0 ? "enable operation" : "switch on";
  }
  if ((word & 0x0100) != 0) add(text, "halt");
  return text;
}

std::string modes_text(std::uint32_t bits) {
  std::string text;
  for (std::size_t i = 0; i < supported_modes.size(); ++i) {
    if ((bits >> i & 1) != 0) add(text, supported_modes[i], " ");
  }
  return text.empty() ? "none of the profile" : text;
}

std::string profile_text(std::uint32_t type) {
  const std::uint32_t profile = type & 0xFFFF;
  return profile == 0 ? "no profile" : fmt::format("CiA {}", profile);
}

/// Returns the meaning of a COB-ID of a PDO, of EMCY or of SYNC. Bit 30 has a different meaning in
/// each of these objects, so the text describes only the other bits.
std::string cob_id_text(std::uint32_t value) {
  const bool extended = (value & 0x2000'0000) != 0;
  const std::uint32_t id = value & (extended ? 0x1FFF'FFFF : 0x7FF);
  return fmt::format("0x{:0{}X}{}", id, extended ? 8 : 3,
                     (value & 0x8000'0000) != 0 ? ", off" : "");
}

bool is_cob_id(ObjectKey key) noexcept { return is_pdo_cob_id(key) || key.index == 0x1014; }

bool is_mapping(ObjectKey key) noexcept { return key.sub != 0 && is_pdo_mapping(key.index); }

std::string mapping_text(std::uint32_t value) {
  if (value == 0) return "nothing";
  return fmt::format("{}, {} bits",
                     to_string(ObjectKey{static_cast<std::uint16_t>(value >> 16),
                                         static_cast<std::uint8_t>(value >> 8 & 0xFF)}),
                     value & 0xFF);
}

std::string communication_text(ObjectKey key, std::uint64_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  switch (key.index) {
    case 0x1000:
      return profile_text(word);
    case 0x1001:
      return error_register_text(static_cast<std::uint8_t>(value));
    case 0x1003:
      if (key.sub == 0 || word == 0) return {};
      return std::string{emcy_text(static_cast<std::uint16_t>(value & 0xFFFF))};
    case 0x1006:
    case 0x1007:
      return fmt::format("{} us", value);
    case 0x1016:
      if (key.sub == 0 || word == 0) return {};
      return fmt::format("node {}, {} ms", word >> 16 & 0x7F, word & 0xFFFF);
    case 0x100C:
    case 0x1017:
      return value == 0 ? "off" : fmt::format("{} ms", value);
    default:
      break;
  }
  if (is_mapping(key)) return mapping_text(word);
  return is_cob_id(key) ? cob_id_text(word) : std::string{};
}

std::string drive_text(ObjectKey key, std::int64_t value) {
  const auto word = static_cast<std::uint16_t>(value);
  switch (first_axis(key.index)) {
    case 0x6040:
      return control_text(word);
    case 0x6041:
      return status_text(word);
    case 0x603F:
      return word == 0 ? "no error" : std::string{emcy_text(word)};
    case 0x605A:
      return std::string{name_in(quick_stops, value)};
    case 0x6060:
    case 0x6061:
      return std::string{name_in(modes, value)};
    case 0x6502:
      return modes_text(static_cast<std::uint32_t>(value));
    default:
      return {};
  }
}

/// Returns true if the device has the statusword and the controlword of a CiA 402 drive. In other
/// devices, indices above 0x6000 have the meaning of another profile.
bool is_drive(const KnownDevice& device) {
  return device.dictionary && device.dictionary->find(ObjectKey{0x6041, 0}) != nullptr &&
         device.dictionary->find(ObjectKey{0x6040, 0}) != nullptr;
}

/// Returns true for sub-index 0 of an ARRAY or RECORD, which is the number of entries.
bool is_count(const KnownDevice& device, ObjectKey key) {
  const Object* const object = device.dictionary ? device.dictionary->find(key.index) : nullptr;
  return key.sub == 0 && object != nullptr &&
         (object->type == ObjectType::array || object->type == ObjectType::record);
}

bool is_shown_in_hex(ObjectKey key) noexcept {
  constexpr std::uint16_t always[] = {0x1000, 0x1001, 0x1002, 0x1005, 0x1012, 0x1014};
  constexpr std::uint16_t words[] = {0x6040, 0x6041, 0x603F, 0x6502, 0x60FD};
  if (std::ranges::find(always, key.index) != std::end(always)) return true;
  if (std::ranges::find(words, first_axis(key.index)) != std::end(words)) return true;
  if (key.sub == 0) return false;
  return key.index == 0x1003 || key.index == 0x1018 ||
         (key.index >= 0x1200 && key.index < 0x1300) || is_cob_id(key) || is_mapping(key);
}

bool is_whole_number(DataType type, std::span<const std::byte> bytes) noexcept {
  return !is_bytes(type) && !is_real(type) && !is_time(type) && bytes.size() == byte_width(type);
}

std::int64_t whole_number(DataType type, std::span<const std::byte> bytes) noexcept {
  const auto raw = load_le<std::uint64_t>(bytes);
  return is_signed(type) ? sign_extended(raw, bit_width(type)) : static_cast<std::int64_t>(raw);
}

}  // namespace

std::string shown_value(ObjectKey key, DataType type, std::span<const std::byte> bytes) {
  if (type == DataType::unknown || !fits(type, bytes)) return untyped_text(bytes);
  if (is_shown_in_hex(key) && is_whole_number(type, bytes)) {
    return fmt::format("0x{:0{}X}", load_le<std::uint64_t>(bytes), 2 * bytes.size());
  }
  return value_text(type, bytes);
}

std::optional<UnitValue> value_in_unit(const KnownDevice& device, ObjectKey key, DataType type,
                                       std::span<const std::byte> bytes) {
  if (is_bytes(type) || bytes.size() != byte_width(type) || is_count(device, key)) {
    return std::nullopt;
  }
  const double raw = number_of(type, whole_number(type, bytes));
  const auto signal = std::ranges::find(device.signals, key, &KnownSignal::object);
  if (signal != device.signals.end()) {
    if (signal->unit.empty()) return std::nullopt;
    return UnitValue{raw * signal->scale + signal->offset, signal->unit};
  }
  const auto quantity = is_drive(device) ? quantity_of(key) : std::nullopt;
  if (!quantity) return std::nullopt;
  for (const KnownSignal& other : device.signals) {
    const auto same = quantity_of(other.object);
    if (!same || same->quantity != quantity->quantity || other.unit.empty()) continue;
    if (axis_of(other.object) != axis_of(key) || !same->directed) continue;
    const double scale = quantity->directed ? other.scale : std::abs(other.scale);
    const bool shifted = quantity->absolute && same->absolute;
    return UnitValue{raw * scale + (shifted ? other.offset : 0.0), other.unit};
  }
  return std::nullopt;
}

std::string value_meaning(const KnownDevice& device, ObjectKey key, DataType type,
                          std::span<const std::byte> bytes) {
  if (const auto unit = value_in_unit(device, key, type, bytes)) {
    return fmt::format("{:.6g} {}", unit->value, unit->unit);
  }
  if (!is_whole_number(type, bytes)) return {};
  const std::int64_t value = whole_number(type, bytes);
  if (key.index < 0x2000) return communication_text(key, static_cast<std::uint64_t>(value));
  return is_drive(device) ? drive_text(key, value) : std::string{};
}

}  // namespace takt
