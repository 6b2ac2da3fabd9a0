#include "eds_parser/write/object_sections.hpp"

#include <charconv>

#include "eds_parser/table/access_name.hpp"

namespace takt {
namespace {

std::string bare_hex(unsigned value, int digits) {
  std::string text(static_cast<std::size_t>(digits), '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, value >>= 4) {
    *digit = "0123456789ABCDEF"[value & 0xF];
  }
  return text;
}

std::string sub_name(std::uint8_t sub) { return bare_hex(sub, sub < 0x10 ? 1 : 2); }

std::string real_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string bytes_text(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) text += bare_hex(static_cast<unsigned char>(byte), 2);
  return text;
}

void add_limit(std::vector<std::string>& lines, std::string_view key,
               const std::optional<Value>& limit, DataType type) {
  if (limit) lines.push_back(std::string{key} + '=' + eds_value_text(*limit, type));
}

void add_fields(std::vector<std::string>& lines, const SubObject& sub) {
  if (sub.type_code != 0) lines.push_back("DataType=" + hex(sub.type_code));
  lines.push_back("AccessType=" + std::string{access_name(sub.access)});
  lines.push_back("DefaultValue=" + sub.default_text);
  add_limit(lines, "LowLimit", sub.low_limit, sub.type);
  add_limit(lines, "HighLimit", sub.high_limit, sub.type);
  lines.push_back(sub.pdo_mappable ? "PDOMapping=1" : "PDOMapping=0");
  if (sub.flags != 0) lines.push_back("ObjFlags=" + hex(sub.flags, 1));
}

}  // namespace

std::string eds_value_text(const Value& value, DataType type) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value)) return real_text(*number);
  const auto& bytes = std::get<BoxedText>(value).text();
  const bool text = type == DataType::visible_string || type == DataType::unicode_string;
  return text ? bytes : bytes_text(bytes);
}

std::vector<std::string> object_sections(const Object& object) {
  const auto header = bare_hex(object.index, 4);
  std::vector<std::string> lines{"", '[' + header + ']', "ParameterName=" + object.name,
                                 "ObjectType=" + hex(static_cast<unsigned>(object.type), 1)};
  const bool single = object.type == ObjectType::var || object.type == ObjectType::domain;
  if (single) {
    if (!object.subs.empty()) add_fields(lines, object.subs.front());
    return lines;
  }
  lines.push_back("SubNumber=" + std::to_string(object.subs.size()));
  for (const auto& sub : object.subs) {
    lines.insert(lines.end(), {"", '[' + header + "sub" + sub_name(sub.sub) + ']',
                               "ParameterName=" + sub.name, "ObjectType=0x7"});
    add_fields(lines, sub);
  }
  return lines;
}

}  // namespace takt
