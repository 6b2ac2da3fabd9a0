#include "apps/takt/od/od_entry.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "eds_parser/dictionary/object_names.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"

namespace takt {
namespace {

/// Returns the reason why an object is not read from a device, or an empty text if reading it has
/// no effect.
std::string reason_not_to_read(ObjectKey key, const SubObject& sub) {
  constexpr std::uint32_t refuse_on_scan = 2;  // bit 1 of ObjFlags, CiA 306
  if (sub.access == Access::wo) return "write-only";
  if (sub.type == DataType::domain) return "a file: takt sdo upload";
  if ((sub.flags & refuse_on_scan) != 0) return "not read: the EDS forbids it (ObjFlags)";
  // OS command, OS command mode, OS debugger and OS prompt: reading removes the answer.
  if (key.index >= 0x1023 && key.index <= 0x1026) return "not read: reading has an effect";
  return {};
}

/// Returns the PDOs that carry each object.
std::multimap<ObjectKey, std::string> carriers(const KnownDevice& device) {
  std::multimap<ObjectKey, std::string> pdos;
  for (const KnownSignal& signal : device.signals) {
    pdos.emplace(signal.object,
                 signal.pdo.empty() ? (signal.output ? "RPDO" : "TPDO") : signal.pdo);
  }
  if (!device.signals.empty()) return pdos;
  for (const PdoDescription& pdo : describe_pdos(*device.dictionary)) {
    if (!pdo.valid) continue;
    for (const MappedObject& entry : pdo.mapping) {
      pdos.emplace(entry.key, fmt::format("{}PDO{}", pdo.is_tpdo ? 'T' : 'R', pdo.number));
    }
  }
  return pdos;
}

bool fits_word(const OdEntry& entry, const std::string& word) {
  return entry.name.find(word) != entry.name.npos;
}

bool fits_index(const OdEntry& entry, std::string word) {
  std::ranges::transform(word, word.begin(), [](char c) {
    return c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return to_string(entry.key).starts_with(word);
}

}  // namespace

bool read_range(std::string_view text, OdChoice& choice) {
  const std::size_t dots = text.find("..");
  const auto first = parse_unsigned(text.substr(0, dots), 16);
  const auto last = dots == text.npos ? first : parse_unsigned(text.substr(dots + 2), 16);
  if (!first || !last || *first > *last || *last > 0xFFFF) return false;
  choice.first = static_cast<std::uint16_t>(*first);
  choice.last = static_cast<std::uint16_t>(*last);
  return true;
}

std::vector<OdEntry> od_entries(const KnownDevice& device, const OdChoice& choice) {
  const ObjectNames names{*device.dictionary};
  const auto pdos = carriers(device);
  const std::string word = choice.word.empty() ? std::string{} : snake_case(choice.word);
  std::vector<OdEntry> entries;
  for (const Object& object : device.dictionary->objects) {
    if (object.index < choice.first || object.index > choice.last) continue;
    for (const SubObject& sub : object.subs) {
      OdEntry entry{.key = {object.index, sub.sub}, .name = {}, .object = &object, .sub = &sub};
      entry.name = names.name_of(entry.key);
      if (!word.empty() && !fits_word(entry, word) && !fits_index(entry, choice.word)) continue;
      const auto [begin, end] = pdos.equal_range(entry.key);
      for (auto at = begin; at != end; ++at) entry.pdos.push_back(at->second);
      entry.why_unread = reason_not_to_read(entry.key, sub);
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

void take_file_values(std::vector<OdEntry>& entries) {
  for (OdEntry& entry : entries) {
    if (const auto& value = entry.sub->value()) entry.value = to_bytes(*value, entry.sub->type);
  }
}

std::string type_word(const SubObject& sub) {
  switch (sub.type) {
    case DataType::boolean:
      return "bool";
    case DataType::visible_string:
    case DataType::unicode_string:
      return "string";
    case DataType::octet_string:
      return "hex";
    case DataType::domain:
      return "domain";
    case DataType::unknown:
      return fmt::format("0x{:02X}", sub.type_code);
    default:
      break;
  }
  if (is_time(sub.type)) return "time";
  const char kind = is_real(sub.type) ? 'f' : is_signed(sub.type) ? 'i' : 'u';
  return fmt::format("{}{}", kind, bit_width(sub.type));
}

}  // namespace takt
