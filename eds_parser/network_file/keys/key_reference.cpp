#include "eds_parser/network_file/keys/key_reference.hpp"

#include <algorithm>
#include <set>

#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

using Parts = KeyRows (*)();

void collect(const std::string& name, const KeyRows& rows, std::set<Parts>& seen,
             std::vector<KeySection>& out) {
  out.push_back({name, rows});
  for (const KeyText& key : rows) {
    if (key.value.parts == nullptr || !seen.insert(key.value.parts).second) continue;
    collect((name.empty() ? "" : name + ": ") + std::string{key.name}, key.value.parts(), seen,
            out);
  }
}

std::string code(std::string_view text) { return "`" + std::string{text} + "`"; }

std::string words_text(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + code(word);
  return text;
}

/// Returns the words and `other` as alternatives ("`a`, `b` or 1..10"), or only `other` if there
/// are no words.
std::string either(std::span<const std::string_view> words, const std::string& other) {
  return words.empty() ? other : words_text(words) + " or " + other;
}

}  // namespace

std::string value_text(const KeyValue& value) {
  switch (value.type) {
    case KeyType::boolean:
      return value.parts == nullptr ? "true, false" : "true, false or a map";
    case KeyType::integer:
      return either(value.words, to_string(value.range)) +
             (value.parts == nullptr ? "" : " or a map");
    case KeyType::number:
      return "number";
    case KeyType::text:
      return "text";
    case KeyType::word:
      return words_text(value.words);
    case KeyType::version:
      return "version";
    case KeyType::range:
      return to_string(value.range) + " or `[lowest, highest]`";
    case KeyType::value:
      return "number or text";
    case KeyType::map:
      return "map";
    case KeyType::list:
      if (value.parts != nullptr) return either(value.words, "list");
      return value.words.empty() ? "list" : "list of " + words_text(value.words);
    case KeyType::pair:
      return "`[lowest, highest]`";
    case KeyType::mapping:
      return "list";
    case KeyType::numbered:
      return "map by number, " + to_string(value.range);
    case KeyType::foreign:
      return "any";
    case KeyType::group:
      break;
  }
  return {};
}

namespace {

std::string names_text(const KeyText& key) {
  std::string text = code(key.name);
  for (std::size_t at = 0; (at = text.find(' ', at)) != std::string::npos; at += 4) {
    text.replace(at, 1, "`, `");
  }
  return text;
}

std::string row(const KeyText& key, bool marks) {
  const bool foreign = key.value.type == KeyType::foreign;
  const bool own = marks && key.origin == KeyOrigin::takt;
  return "| " + names_text(key) + (own ? " *takt*" : "") + " | " + value_text(key.value) + " | " +
         std::string{foreign ? "none" : key.otherwise} + " | " + (foreign ? "No effect: " : "") +
         std::string{key.meaning} + (foreign ? "." : "") + " |\n";
}

}  // namespace

std::vector<KeySection> network_file_keys() {
  std::vector<KeySection> sections;
  std::set<Parts> seen;
  for (const auto& key : network_keys()) {
    if (key.name != "defaults") collect(std::string{key.name}, key.value.parts(), seen, sections);
  }
  return sections;
}

std::vector<KeySection> device_data_keys() {
  std::vector<KeySection> sections;
  std::set<Parts> seen;
  collect("", device_data_rows(), seen, sections);
  sections.front().name = "entry";
  return sections;
}

std::string key_reference(const std::vector<KeySection>& sections) {
  std::string text;
  for (const KeySection& section : sections) {
    const bool marks = std::ranges::any_of(sections, [](const KeySection& any) {
      return std::ranges::any_of(
          any.keys, [](const KeyText& key) { return key.origin == KeyOrigin::bus_yml; });
    });
    text += (text.empty() ? "" : "\n") + ("<!-- keys: " + section.name + " -->\n") +
            "| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const KeyText& key : section.keys) text += row(key, marks);
    text += "<!-- end of keys -->\n";
  }
  return text;
}

std::string_view key_meaning(std::string_view section, std::string_view key) {
  static const std::vector<KeySection> sections = network_file_keys();
  const auto in = [&](const KeySection& from) -> const KeyText* {
    const auto names = [&](const KeyText& text) {
      const std::string all = ' ' + std::string{text.name} + ' ';
      return all.find(' ' + std::string{key} + ' ') != std::string::npos;
    };
    const auto found = std::ranges::find_if(from.keys, names);
    return found == from.keys.end() ? nullptr : &*found;
  };
  const auto own = std::ranges::find(sections, section, &KeySection::name);
  if (own != sections.end()) {
    if (const KeyText* text = in(*own)) return text->meaning;
  }
  const auto first_of_nodes = std::ranges::find(sections, "nodes", &KeySection::name);
  for (auto at = first_of_nodes; at != sections.end(); ++at) {
    if (const KeyText* text = in(*at)) return text->meaning;
  }
  return {};
}

}  // namespace takt
