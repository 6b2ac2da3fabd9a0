#include "apps/takt/key_schema.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/keys/key_reference.hpp"
#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;
using Parts = KeyRows (*)();

// takt accepts a number in quotes, too. For YAML that is a string, so these patterns check it.
constexpr std::string_view whole_number = "^[-+]?(0|[1-9][0-9]*|0[xX][0-9A-Fa-f]+)$";
constexpr std::string_view real_number =
    "^[-+]?(0[xX][0-9A-Fa-f]+|0|[1-9][0-9]*|([0-9]+\\.[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?|"
    "[0-9]+[eE][-+]?[0-9]+)$";
constexpr std::string_view yes_or_no =
    "^([Tt][Rr][Uu][Ee]|[Ff][Aa][Ll][Ss][Ee]|[Yy][Ee][Ss]|[Nn][Oo]|[Oo][Nn]|[Oo][Ff][Ff]|[01])$";
constexpr std::string_view version_number = "^[0-9]+(\\.[0-9]+){0,2}$";
constexpr std::string_view object_name =
    "^(0|[1-9][0-9]*|0[xX][0-9A-Fa-f]+)(:(0[xX])?[0-9A-Fa-f]{1,2})?$";
constexpr std::string_view node_name = "^(?!all$)(?![0-9]*$)[A-Za-z0-9_-]{1,48}$";
constexpr std::string_view hidden_name = "^\\.";  // takt does not read these keys at the top

Json scalar(std::string_view pattern, const std::vector<std::string>& types) {
  return {{"type", types}, {"pattern", pattern}};
}

/// Returns the schema with limits for numbers. A number in quotes is checked against the pattern
/// only.
Json within(const IntegerRange& range, Json schema) {
  schema["minimum"] = range.low;
  schema["maximum"] = range.high;
  return schema;
}

Json whole_schema(const IntegerRange& range) {
  return within(range, scalar(whole_number, {"integer", "string"}));
}

Json real_schema(const RealRange& range) {
  Json schema = scalar(real_number, {"number", "string"});
  if (std::isfinite(range.low)) {
    schema[range.without_low ? "exclusiveMinimum" : "minimum"] = range.low;
  }
  if (std::isfinite(range.high)) schema["maximum"] = range.high;
  return schema;
}

Json words_schema(const KeyValue& value) {
  return {{"enum", std::vector<std::string>{value.words.begin(), value.words.end()}}};
}

Json any_of(std::vector<Json> schemas) {
  return schemas.size() == 1 ? std::move(schemas.front()) : Json{{"anyOf", std::move(schemas)}};
}

/// Returns a regular expression for the numbers from 1 to `high`, as parts of an alternative.
std::string numbers_to(std::int64_t high) {
  const std::string last = std::to_string(high);
  std::string pattern = last;
  const auto more = [&](const std::string& begin, char low, char up, std::size_t rest) {
    if (up < low) return;
    pattern += '|' + begin + '[' + low + '-' + up + ']' +
               (rest == 0 ? "" : "[0-9]{" + std::to_string(rest) + '}');
  };
  for (std::size_t i = 0; i < last.size(); ++i) {
    const char below = static_cast<char>(last[i] - 1);
    more(last.substr(0, i), i == 0 ? '1' : '0', below, last.size() - i - 1);
    if (i > 0) more("", '1', '9', i - 1);
  }
  return pattern;
}

/// Removes the backticks and the targets of links: editors show these texts as they are.
std::string plain(std::string_view markdown) {
  std::string text;
  for (std::size_t at = 0; at < markdown.size(); ++at) {
    const char c = markdown[at];
    if (c == '`' || (c == '[' && markdown.find("](", at) != markdown.npos)) continue;
    if (markdown.substr(at, 2) == "](") {
      at = markdown.find(')', at);
      continue;
    }
    text += c;
  }
  return text;
}

/// Returns the default as a value of YAML, if the text of the row is one.
std::optional<Json> default_value(const KeyText& key) {
  const std::string text = plain(key.otherwise);
  const bool is_word = std::ranges::find(key.value.words, text) != key.value.words.end();
  if (is_word) return Json{text};
  const Json value = Json::parse(text, nullptr, false);
  if (value.is_number() || value.is_boolean()) return value;
  return {};
}

class SchemaWriter {
 public:
  Json run() {
    Json sections;
    for (const auto& key : network_keys()) {
      Json& section = sections[std::string{key.name}] = described(key);
      if (key.name == "nodes") {
        section["type"] = "object";
        section["patternProperties"] = {{node_name, node()}, {hidden_name, true}};
        section["additionalProperties"] = false;
      } else if (key.name == "defaults") {
        section["allOf"] = {node(), only_known(node_rows())};
      } else {
        section["allOf"] = {reference(key.value.parts)};
      }
    }
    Json root{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "network file of takt"},
              {"type", "object"},
              {"properties", sections},
              {"patternProperties", {{hidden_name, true}}},
              {"additionalProperties", node()},
              {"allOf",
               {unless_default("dcf", {{"type", "object"}, {"required", {"node_id", "dcf"}}}),
                unless_default("driver", only_known(node_rows())), has_node()}}};
    root["definitions"] = definitions_;
    return root;
  }

 private:
  Json node() { return reference(node_rows); }

  /// Returns a reference to the map with these rows, and defines it before its first use.
  Json reference(Parts parts) {
    const auto [known, is_new] = names_.try_emplace(parts, std::to_string(names_.size() + 1));
    const std::string name = known->second;
    if (is_new) definitions_[name] = map_schema(parts());
    return {{"$ref", "#/definitions/" + name}};
  }

  Json map_schema(const KeyRows& rows) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const KeyText& key : rows) {
      if (key.value.type == KeyType::foreign) {
        add_foreign(key, properties);
      } else {
        properties[std::string{key.name}] = property(key);
      }
      if (key.required) required.push_back(key.name);
    }
    const bool is_node = properties.contains("dcf");
    const bool shared = properties.contains("driver");
    Json schema{{"type", required.empty() || is_node ? Json{"object", "null"} : Json{"object"}},
                {"properties", std::move(properties)}};
    if (!required.empty() && !is_node) schema["required"] = std::move(required);
    if (!shared) {
      schema["additionalProperties"] = false;
    } else if (!is_node) {
      schema["allOf"] = {only_known(rows)};
    }
    return schema;
  }

  static void add_foreign(const KeyText& key, Json& properties) {
    for (const std::string& name : names_of(key)) {
      properties[name] = {{"description", "No effect: " + plain(key.meaning) + "."},
                          {"doNotSuggest", true}};
    }
  }

  static std::vector<std::string> names_of(const KeyText& key) {
    std::vector<std::string> names(1);
    for (const char c : key.name) {
      if (c == ' ') {
        names.emplace_back();
      } else {
        names.back() += c;
      }
    }
    return names;
  }

  /// Returns the texts that an editor shows for a key.
  static Json described(const KeyText& key) {
    const std::string value = plain(value_text(key.value));
    Json schema{{"title", std::string{key.name} + ": " + value},
                {"description", plain(key.meaning)}};
    if (key.otherwise.empty() || key.required) return schema;
    schema["description"] = plain(key.meaning) + " Default: " + plain(key.otherwise) + ".";
    if (const auto known = default_value(key)) schema["default"] = *known;
    return schema;
  }

  Json property(const KeyText& key) {
    Json schema = described(key);
    schema.update(value_schema(key.value));
    return schema;
  }

  Json value_schema(const KeyValue& value) {
    std::vector<Json> forms;
    const auto or_map = [&] {
      if (value.parts != nullptr) forms.push_back(reference(value.parts));
      if (forms.size() > 1 && value.type == KeyType::boolean) {  // an empty value is then no map
        forms.back() = {{"type", "object"}, {"allOf", {forms.back()}}};
      }
      return any_of(std::move(forms));
    };
    const bool has_words = !value.words.empty();
    const Json words = words_schema(value);
    switch (value.type) {
      case KeyType::boolean:
        forms.push_back(within({0, 1}, scalar(yes_or_no, {"boolean", "integer", "string"})));
        return or_map();
      case KeyType::integer:
        if (has_words) forms.push_back(words);
        forms.push_back(whole_schema(value.range));
        return or_map();
      case KeyType::number:
        return real_schema(value.numbers);
      case KeyType::word:
        return words;
      case KeyType::version:
        return within({0, 0xFFFF}, scalar(version_number, {"string", "number"}));
      case KeyType::map:
        return or_map();
      case KeyType::pair:
        return {{"type", "array"}, {"items", real_schema({})}, {"minItems", 2}, {"maxItems", 2}};
      case KeyType::mapping:
        return {{"type", "array"},
                {"maxItems", 64},
                {"items", any_of({within({1, 0xFFFF}, scalar(object_name, {"integer", "string"})),
                                  reference(value.parts)})}};
      case KeyType::list:
        return list_schema(value);
      case KeyType::numbered:
        return numbered_schema(value);
      case KeyType::text:
      case KeyType::value:
        return {{"type", {"string", "number", "boolean"}}};
      case KeyType::range:
      case KeyType::group:
      case KeyType::foreign:
        break;  // not in a network file, or not a value
    }
    return Json::object();
  }

  Json list_schema(const KeyValue& value) {
    if (!value.words.empty()) {
      const Json word = words_schema(value);
      return any_of({word, {{"type", {"array", "null"}}, {"items", word}}});
    }
    if (value.parts == nullptr) {
      return {{"type", "array"},
              {"items", whole_schema(value.entries)},
              {"minItems", 1},
              {"maxItems", 64}};
    }
    return {{"type", {"array", "null"}}, {"items", reference(value.parts)}, {"maxItems", 1024}};
  }

  Json numbered_schema(const KeyValue& value) {
    const std::string number = "^(" + numbers_to(value.range.high) + "|0[xX][0-9A-Fa-f]+)$";
    const Json entry =
        value.parts == nullptr ? whole_schema(value.entries) : reference(value.parts);
    return {{"type", {"object", "null"}},
            {"patternProperties", {{number, entry}}},
            {"additionalProperties", false}};
  }

  /// Returns a schema that refuses unknown keys of a map, unless the map has `driver`: the class
  /// that it names may read them.
  static Json only_known(const KeyRows& rows) {
    Json names = Json::object();
    for (const KeyText& key : rows) {
      for (const std::string& name : names_of(key)) names[name] = true;
    }
    return {{"if", {{"type", "object"}, {"required", {"driver"}}}},
            {"else", {{"properties", names}, {"additionalProperties", false}}}};
  }

  /// Returns `schema` as a condition for each node, unless `defaults` has the key.
  static Json unless_default(const char* key, Json schema) {
    Json own;
    for (const auto& section : network_keys()) own[std::string{section.name}] = true;
    const Json every_node{{"patternProperties", {{hidden_name, true}}},
                          {"additionalProperties", schema}};
    // The names in `patternProperties` are exempt from `additionalProperties`.
    own["nodes"] = every_node;
    return {
        {"if",
         {{"required", {"defaults"}},
          {"properties", {{"defaults", {{"type", "object"}, {"required", Json::array({key})}}}}}}},
        {"else",
         {{"properties", own},
          {"patternProperties", {{hidden_name, true}}},
          {"additionalProperties", schema}}}};
  }

  /// Returns a schema that refuses a file without a node.
  static Json has_node() {
    Json others = Json::array();
    for (const auto& section : network_keys()) {
      if (section.name != "nodes") others.push_back(section.name);
    }
    const Json no_node = Json::array({{{"enum", others}}, {{"pattern", hidden_name}}});
    return {{"not", {{"propertyNames", {{"anyOf", no_node}}}}},
            {"errorMessage", "The file describes no node: nodes: with NAME: {node_id, dcf}."}};
  }

  std::map<Parts, std::string> names_;
  Json definitions_ = Json::object();
};

}  // namespace

std::string network_schema() { return SchemaWriter{}.run().dump(1) + '\n'; }

}  // namespace takt
