#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "apps/command_line/json_text.hpp"
#include "apps/takt/od/od_text.hpp"
#include "apps/takt/od/value_meaning.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/raw_number.hpp"
#include "master/gateway/message/value_text.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

/// Returns numbers as numbers, strings as strings, and bytes, times and numbers that are not finite
/// as text.
nlohmann::json value_json(DataType type, const std::vector<std::byte>& bytes) {
  if (!fits(type, bytes) || is_bytes(type) || is_time(type)) {
    return type == DataType::visible_string ? value_text(type, bytes) : hex_text(bytes);
  }
  const auto raw = load_le<std::uint64_t>(std::span{bytes});
  if (is_real(type)) {
    const double number = number_of(type, static_cast<std::int64_t>(raw));
    if (!std::isfinite(number)) return value_text(type, bytes);
    return number;
  }
  if (type == DataType::boolean) return raw != 0;
  if (is_signed(type)) return sign_extended(raw, bit_width(type));
  return raw;
}

nlohmann::json entry_json(const KnownDevice& device, const OdEntry& entry) {
  nlohmann::json json{{"index", entry.key.index},
                      {"sub", entry.key.sub},
                      {"name", entry.name},
                      {"type", name(entry.sub->type)},
                      {"access", access_name(entry.sub->access)},
                      {"pdo_mappable", entry.sub->pdo_mappable},
                      {"pdos", entry.pdos},
                      {"value", nullptr},
                      {"text", ""},
                      {"unread", nullptr},
                      {"error", nullptr}};
  if (!entry.why_unread.empty()) json["unread"] = entry.why_unread;
  if (!entry.error.empty()) json["error"] = entry.error;
  if (!entry.value) return json;
  json["value"] = value_json(entry.sub->type, *entry.value);
  json["text"] = entry_text(device, entry);
  if (const auto unit = value_in_unit(device, entry.key, entry.sub->type, *entry.value)) {
    json["si"] = unit->value;
    json["unit"] = unit->unit;
  }
  return json;
}

}  // namespace

std::string od_json(const KnownDevice& device, const std::vector<OdEntry>& entries, bool live) {
  nlohmann::json objects = nlohmann::json::array();
  for (const OdEntry& entry : entries) objects.push_back(entry_json(device, entry));
  nlohmann::json document{{"node", nullptr},
                          {"node_id", nullptr},
                          {"file", device.file},
                          {"live", live},
                          {"objects", std::move(objects)}};
  if (!device.name.empty()) document["node"] = device.name;
  if (device.id) document["node_id"] = device.id->value();
  return json_text(document, 1);
}

}  // namespace takt
