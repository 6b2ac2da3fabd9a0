#include "eds_parser/write/object_sections.hpp"

#include "eds_parser/report/message.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

void add_limit(std::vector<std::string>& lines, std::string_view key,
               const std::optional<Value>& limit, DataType type) {
  if (limit) lines.push_back(concat(key, '=', eds_value_text(*limit, type)));
}

void add_fields(std::vector<std::string>& lines, const SubObject& sub) {
  if (sub.type_code != 0) lines.push_back("DataType=" + hex(sub.type_code));
  lines.push_back(concat("AccessType=", access_name(sub.access)));
  lines.push_back("DefaultValue=" + sub.default_text);
  add_limit(lines, "LowLimit", sub.low_limit, sub.type);
  add_limit(lines, "HighLimit", sub.high_limit, sub.type);
  lines.push_back(sub.pdo_mappable ? "PDOMapping=1" : "PDOMapping=0");
  if (sub.flags != 0) lines.push_back("ObjFlags=" + hex(sub.flags, 1));
}

}  // namespace

std::vector<std::string> object_sections(const Object& object) {
  const auto header = hex(object.index).substr(2);
  std::vector<std::string> lines{"", '[' + header + ']', "ParameterName=" + object.name,
                                 "ObjectType=" + hex(static_cast<unsigned>(object.type), 1)};
  const bool single = object.type == ObjectType::var || object.type == ObjectType::domain;
  if (single) {
    if (!object.subs.empty()) add_fields(lines, object.subs.front());
    return lines;
  }
  lines.push_back("SubNumber=" + std::to_string(object.subs.size()));
  for (const auto& sub : object.subs) {
    lines.insert(lines.end(), {"", concat('[', header, "sub", hex(sub.sub, 1).substr(2), ']'),
                               "ParameterName=" + sub.name, "ObjectType=0x7"});
    add_fields(lines, sub);
  }
  return lines;
}

}  // namespace takt
