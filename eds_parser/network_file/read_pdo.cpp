#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

void read_cob_id(MapReader& reader, PdoSpec& pdo) {
  const YamlNode* node = reader.take("cob_id");
  if (node == nullptr) return;
  if (node->kind == YamlNode::Kind::scalar && node->text == "auto") {
    pdo.cob_id = {std::nullopt, node->pos, true};
    return;
  }
  if (node->kind == YamlNode::Kind::scalar && !node->text.empty() &&
      (std::isalpha(static_cast<unsigned char>(node->text[0])) != 0 || node->text[0] == '$')) {
    reader.report().error(
        node->pos, "unknown-value",
        "`cob_id` has to be a number or `auto`, not `" + node->text.substr(0, 40) + "`");
    return;
  }
  if (const auto value = read_integer(*node, "cob_id", {0, 0xFFFF'FFFF}, reader.report())) {
    pdo.cob_id = {static_cast<std::uint32_t>(*value), node->pos, true};
  }
}

bool is_hex(std::string_view text) {
  return !text.empty() && text.size() <= 4 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// Reads an index. For hex digits without 0x the error says how to write them.
std::optional<std::uint16_t> read_index(const YamlNode& node, NetworkReport& report) {
  const bool has_letter =
      std::ranges::any_of(node.text, [](unsigned char c) { return std::isalpha(c) != 0; });
  if (node.kind == YamlNode::Kind::scalar && has_letter && is_hex(node.text)) {
    report.error(node.pos, "not-a-number",
                 "`index`: `" + node.text + "` is hexadecimal without 0x: write 0x" + node.text);
    return {};
  }
  const auto value = read_integer(node, "index", {1, 0xFFFF}, report);
  if (!value) return {};
  return static_cast<std::uint16_t>(*value);
}

/// Reads `0x6064` or `0x6064:0`, with index and sub-index in hex.
std::optional<ObjectKey> read_short_key(const YamlNode& node, std::string_view key,
                                        NetworkReport& report) {
  const std::size_t colon = node.text.find(':');
  YamlNode index = node;
  index.text = node.text.substr(0, colon);
  const auto value = read_index(index, report);
  if (!value) return {};
  if (colon == std::string::npos) return ObjectKey{*value, 0};
  std::string_view sub = std::string_view{node.text}.substr(colon + 1);
  if (sub.starts_with("0x") || sub.starts_with("0X")) sub.remove_prefix(2);
  if (!is_hex(sub) || sub.size() > 2) {
    report.error(node.pos, "not-a-number",
                 "`" + std::string{key} + "`: `" + node.text.substr(0, 40) +
                     "` is not an object: write 0x6064, or 0x6064:0 with the sub-index in hex");
    return {};
  }
  std::uint8_t number = 0;
  std::from_chars(sub.data(), sub.data() + sub.size(), number, 16);
  return ObjectKey{*value, number};
}

void read_mapping(MapReader& reader, PdoSpec& pdo, const std::string& what) {
  const YamlNode* node = reader.take("mapping");
  if (node == nullptr) return;
  NetworkReport& report = reader.report();
  if (node->kind != YamlNode::Kind::sequence) {
    report.error(
        node->pos, "wrong-type",
        "`mapping` of " + what +
            " has to be a list of `0x6041:0` or `{index: 0x6041, sub_index: 0}`, but this is " +
            std::string{name(node->kind)});
    return;
  }
  pdo.mapping.pos = node->pos;
  pdo.mapping.given = true;
  if (node->items.size() > 64) {
    report.error(node->pos, "too-many", "`mapping` of " + what + " has more than 64 entries");
    return;
  }
  bool complete = true;
  for (const YamlNode* item : node->items) {
    if (item->kind == YamlNode::Kind::scalar) {
      const auto key = read_short_key(*item, "mapping", report);
      if (key) pdo.mapping.value.push_back({.object = *key, .bits = {}, .pos = item->pos});
      complete = complete && key;
      continue;
    }
    MapReader entry{*item, "a mapping entry of " + what, report};
    MappingSpec mapping{.object = {}, .bits = {}, .pos = item->pos};
    const auto key = read_object_key(entry, item->pos);
    Sourced<std::uint8_t> bits;
    entry.integer("bits", bits, {1, 64});
    entry.finish();
    complete = complete && key;
    if (!key) continue;
    mapping.object = *key;
    if (bits.given) mapping.bits = *bits;
    pdo.mapping.value.push_back(mapping);
  }
  if (!complete) pdo.enabled.value = false;  // avoids findings on an incomplete PDO
}

void check_types(const PdoSpec& pdo, std::string_view key, const std::string& what,
                 NetworkReport& report) {
  if (pdo.transmission.given && *pdo.transmission >= 241 && *pdo.transmission <= 251) {
    report.error(pdo.transmission.pos, "transmission-type",
                 "`transmission` " + std::to_string(*pdo.transmission) + " of " + what +
                     " is reserved by CiA 301: write 0..240 with SYNC, 254 or 255 by event");
  }
  const bool remote = *pdo.transmission == 252 || *pdo.transmission == 253;
  if (pdo.transmission.given && remote && key == "rpdo") {
    report.error(pdo.transmission.pos, "transmission-type",
                 "`transmission` " + std::to_string(*pdo.transmission) + " of " + what +
                     " is reserved for RPDOs: write 0..240 with SYNC, 254 or 255 by event");
  }
}

/// Reports keys that only PDOs received by the master may have.
void check_direction(const PdoSpec& pdo, std::string_view key, const std::string& what,
                     NetworkReport& report) {
  if (pdo.poll_ms.given && pdo.poll_syncs.given) {
    report.error(pdo.poll_syncs.pos, "written-twice",
                 "`poll_ms` and `poll_syncs` of " + what + " exclude each other: keep one");
  }
  if (key == "tpdo") return;
  const auto refuse = [&](const auto& value, std::string_view name) {
    if (!value.given) return;
    report.error(value.pos, "wrong-direction",
                 "`" + std::string{name} + "` of " + what + ": the master receives only TPDOs");
  };
  refuse(pdo.poll_ms, "poll_ms");
  refuse(pdo.poll_syncs, "poll_syncs");
  refuse(pdo.drop_late, "late");
}

void read_kinds(MapReader& reader, PdoSpec& pdo) {
  reader.integer("poll_ms", pdo.poll_ms, {0, 3'600'000, " ms"});
  reader.integer("poll_syncs", pdo.poll_syncs, {0, 60'000});
  reader.boolean("request", pdo.on_request);
  if (const YamlNode* late = reader.take("late")) {
    constexpr std::array<std::string_view, 2> names{"use", "drop"};
    if (const auto choice = read_choice(*late, "late", names, reader.report())) {
      pdo.drop_late = {*choice == 1, late->pos, true};
    }
  }
  if (const YamlNode* mpdo = reader.take("mpdo")) {
    constexpr std::array<std::string_view, 2> names{"dam", "sam"};
    if (const auto choice = read_choice(*mpdo, "mpdo", names, reader.report())) {
      pdo.mpdo = {static_cast<Mpdo>(*choice + 1), mpdo->pos, true};
    }
  }
}

PdoSpec read_pdo(const YamlPair& pair, std::uint16_t number, std::string_view key,
                 const std::string& owner, NetworkReport& report) {
  const std::string what =
      (key == "tpdo" ? "TPDO" : "RPDO") + std::to_string(number) + " of " + owner;
  PdoSpec pdo{.number = number,
              .pos = pair.key_pos,
              .cob_id = {},
              .transmission = {},
              .inhibit_time = {},
              .event_timer = {},
              .event_deadline = {},
              .sync_start = {},
              .mapping = {}};
  MapReader reader{*pair.value, what, report};
  reader.boolean("enabled", pdo.enabled);
  read_cob_id(reader, pdo);
  reader.integer("transmission", pdo.transmission);
  reader.integer("inhibit_time", pdo.inhibit_time, {0, 65535, " x 100 us"});
  reader.integer("event_timer", pdo.event_timer, {0, 65535, " ms"});
  reader.integer("event_deadline", pdo.event_deadline, {0, 65535, " ms"});
  reader.integer("sync_start", pdo.sync_start, {0, 240});
  read_kinds(reader, pdo);
  read_mapping(reader, pdo, what);
  reader.finish();
  check_types(pdo, key, what, report);
  check_direction(pdo, key, what, report);
  return pdo;
}

}  // namespace

std::optional<ObjectKey> read_object_key(MapReader& reader, SourcePos pos) {
  Sourced<std::uint16_t> index;
  Sourced<std::uint8_t> sub;
  const bool has_index = reader.take("index") != nullptr;
  if (const YamlNode* node = reader.take("index")) {
    if (const auto value = read_index(*node, reader.report())) index = {*value, node->pos, true};
  }
  reader.integer("sub_index", sub, {0, 0xFF});
  const bool has_bad_sub = !sub.given && reader.take("sub_index") != nullptr;
  if (index.given && has_bad_sub) return std::nullopt;
  if (index.given) return ObjectKey{*index, *sub};
  if (!has_index && reader.is_map() && !reader.has_slip_of("index")) {
    reader.report().error(pos, "missing-key", reader.what() + " lacks `index`");
  }
  return std::nullopt;
}

std::vector<PdoSpec> read_pdos(const YamlNode& node, std::string_view key, const std::string& owner,
                               NetworkReport& report) {
  std::vector<PdoSpec> pdos;
  if (node.kind == YamlNode::Kind::null) return pdos;
  if (node.kind != YamlNode::Kind::map) {
    report.error(node.pos, "wrong-type",
                 "`" + std::string{key} + "` of " + owner +
                     " has to be a map of PDO numbers, `1: {mapping: [...]}`, but this is " +
                     std::string{name(node.kind)});
    return pdos;
  }
  for (const YamlPair& pair : node.pairs) {
    YamlNode number;
    number.kind = YamlNode::Kind::scalar;
    number.text = pair.key;
    number.pos = pair.key_pos;
    const auto value = read_integer(number, std::string{key} + " number", {1, 512}, report);
    if (!value) continue;
    const auto same = [&](const PdoSpec& pdo) { return pdo.number == *value; };
    if (std::ranges::any_of(pdos, same)) {
      report.error(pair.key_pos, "duplicate-key",
                   "`" + std::string{key} + "` " + std::to_string(*value) + " of " + owner +
                       " is written twice");
      continue;
    }
    pdos.push_back(read_pdo(pair, static_cast<std::uint16_t>(*value), key, owner, report));
  }
  return pdos;
}

}  // namespace takt
