#include "eds_parser/network_file/yaml/key_table.hpp"

#include <algorithm>
#include <cctype>

namespace takt {
namespace {

constexpr std::size_t most_items = 1024;

/// Returns for example " `{index: ..., value: ...}`", or an empty text if the entries are no maps.
std::string entry_text(const KeyValue& value) {
  if (value.parts == nullptr) return {};
  std::string keys;
  for (const KeyText& part : value.parts()) {
    keys += (keys.empty() ? "" : ", ") + std::string{part.name} + ": ...";
  }
  return " `{" + keys + "}`";
}

}  // namespace

bool KeyInput::is_list() const {
  if (node.kind == YamlNode::Kind::null) return true;
  if (node.kind == YamlNode::Kind::sequence && node.items.size() <= most_items) return true;
  error("wrong-type", what() + " has to be a list of at most 1024 entries" + entry_text(key.value));
  return false;
}

bool read_value(const KeyInput& in, bool& out) {
  const auto& words = in.key.value.words;
  if (words.empty()) return store(read_bool(in.node, in.key.name, in.report()), out);
  return store(read_choice(in.node, in.key.name, words, in.report()), out);
}

bool read_value(const KeyInput& in, double& out) {
  return store(read_number(in.node, in.key.name, in.report()), out);
}

bool read_value(const KeyInput& in, std::string& out) {
  const auto& words = in.key.value.words;
  if (words.empty()) return store(read_text(in.node, in.key.name, in.report()), out);
  const auto choice = read_choice(in.node, in.key.name, words, in.report());
  return store(choice ? std::optional{words[*choice]} : std::nullopt, out);
}

bool read_value(const KeyInput& in, Firmware& out) {
  std::string text;
  if (!read_value(in, text)) return false;
  const auto version = Firmware::parse(text);
  if (!version) in.error("not-a-version", in.what(), " has to be a version like \"16.00.00\"");
  out = version.value_or(out);
  return version.has_value();
}

bool read_value(const KeyInput& in, Time& out) {
  std::int64_t number = 0;
  if (!read_value(in, number)) return false;
  const bool in_ms = in.key.value.range.unit == "ms";
  out = in_ms ? Time{std::chrono::milliseconds{number}} : std::chrono::microseconds{number};
  return true;
}

bool is_word(const KeyInput& in, bool& wrong) {
  if (in.key.value.type != KeyType::integer || in.node.kind != YamlNode::Kind::scalar) return false;
  const auto& words = in.key.value.words;
  if (std::ranges::find(words, in.node.text) != words.end()) return true;
  const char first = in.node.text.empty() ? '0' : in.node.text.front();
  wrong = !words.empty() && (std::isalpha(static_cast<unsigned char>(first)) != 0 || first == '$');
  if (wrong) {
    in.error("unknown-value", "`", in.key.name, "` has to be a number or `", words.front(),
             "`, not `", in.node.text.substr(0, 40), "`");
  }
  return false;
}

void report_missing(MapReader& map, const KeyText& key, SourcePos pos) {
  if (!map.is_readable() || map.has(key.name) || map.has_slip_of(key.name)) return;
  const KeyValue& value = key.value;
  const std::string range =
      value.type == KeyType::integer ? " (" + to_string(value.range) + ")" : "";
  map.report().error(pos, "missing-key", map.what(), " lacks `", key.name, "`", range);
}

}  // namespace takt
