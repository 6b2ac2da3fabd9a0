#include <cctype>
#include <limits>
#include <map>
#include <string>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

constexpr std::size_t max_list = 1024;

/// Reads an integer, a real number or a text, depending on how the value looks. Returns false after
/// an error, which it reports.
bool read_plain(const YamlNode& node, SdoSpec& sdo, NetworkReport& report) {
  const std::string& text = node.text;
  const std::size_t digits = text.find_first_not_of("+-");
  const bool numeric = node.kind != YamlNode::Kind::scalar ||
                       (digits < 2 && std::isdigit(static_cast<unsigned char>(text[digits])) != 0);
  const bool is_hex =
      digits < 2 && (text.compare(digits, 2, "0x") == 0 || text.compare(digits, 2, "0X") == 0);
  if (!numeric) {
    sdo.value = text;
    return true;
  }
  if (!is_hex && text.find_first_of(".eE") != std::string::npos) {
    const auto number = read_number(node, "value", report);
    if (number) sdo.value = *number;
    return number.has_value();
  }
  constexpr IntegerRange any{std::numeric_limits<std::int64_t>::min(),
                             std::numeric_limits<std::int64_t>::max()};
  const auto number = read_integer(node, "value", any, report);
  if (number) sdo.value = *number;
  return number.has_value();
}

/// A quoted value is a text for a string object, whatever it looks like. Other objects take the
/// number in the quotes.
bool read_value(const YamlNode& node, SdoSpec& sdo, NetworkReport& report) {
  if (!node.quoted) return read_plain(node, sdo, report);
  sdo.quoted = node.text;
  Findings unheard;
  NetworkReport quiet{report.file(), unheard};
  if (!read_plain(node, sdo, quiet)) sdo.value = node.text;
  return true;
}

std::optional<SdoSpec> read_object(const YamlNode& item, std::string_view key,
                                   const std::string& owner, bool& again, NetworkReport& report) {
  MapReader reader{item, "an entry of `" + std::string{key} + "` of " + owner, report};
  const auto object = read_object_key(reader, item.pos);
  Sourced<bool> repeated;
  reader.boolean("again", repeated);
  again = *repeated;
  const YamlNode* value = reader.take("value");
  reader.finish();
  if (value == nullptr) {
    const bool told = !reader.is_map() || !object || reader.has_slip_of("value");
    if (!told) report.error(item.pos, "missing-key", reader.what() + " lacks `value`");
    return {};
  }
  if (!object) return {};
  SdoSpec sdo;
  sdo.object = *object;
  sdo.pos = item.pos;
  sdo.value_pos = value->pos;
  if (!read_value(*value, sdo, report)) return {};
  return sdo;
}

/// Reports a repeated object. In a list that is written in order both entries take effect;
/// elsewhere one of them has no effect.
void tell_repeated(const SdoSpec& sdo, const std::string& owner, SourcePos first, bool in_order,
                   NetworkReport& report) {
  const std::string text = to_string(sdo.object) + " of " + owner +
                           " is written twice, first in line " + std::to_string(first.line);
  if (in_order) {
    report.warning(sdo.pos, "written-twice",
                   text +
                       ": takt writes both values in this order; is one of them meant for another "
                       "object? (`again: true` confirms both)");
  } else {
    report.error(sdo.pos, "written-twice", text + ": keep one");
  }
}

}  // namespace

std::vector<SdoSpec> read_objects(const YamlNode& node, std::string_view key,
                                  const std::string& owner, NetworkReport& report) {
  std::vector<SdoSpec> list;
  if (node.kind == YamlNode::Kind::null) return list;
  if (node.kind != YamlNode::Kind::sequence || node.items.size() > max_list) {
    report.error(
        node.pos, "wrong-type",
        "`" + std::string{key} + "` of " + owner +
            " has to be a list of at most 1024 `{index: 0x6083, sub_index: 0, value: 1000}`");
    return list;
  }
  std::map<ObjectKey, SourcePos> seen;
  for (const YamlNode* item : node.items) {
    bool again = false;
    const auto sdo = read_object(*item, key, owner, again, report);
    if (!sdo) continue;
    const auto [first, is_new] = seen.emplace(sdo->object, sdo->pos);
    if (!is_new && !again) tell_repeated(*sdo, owner, first->second, key == "sdo", report);
    list.push_back(*sdo);
  }
  return list;
}

}  // namespace takt
