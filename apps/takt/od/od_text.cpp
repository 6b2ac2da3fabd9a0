#include "apps/takt/od/od_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "apps/command_line/help_text.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/od/value_meaning.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

constexpr std::size_t object_width = 9;
constexpr std::size_t type_width = 7;
constexpr std::size_t access_width = 6;
constexpr std::size_t pdo_width = 6;
constexpr std::size_t fixed_width = object_width + type_width + access_width + pdo_width;
constexpr std::size_t narrowest_name = 12;
constexpr std::size_t widest_name = 44;

/// Returns `T1 R2` for the PDOs that carry an object, `T` if the number of the PDO is not known,
/// and a dot for an object that no PDO carries but a PDO can carry.
std::string pdo_text(const OdEntry& entry) {
  if (entry.pdos.empty()) return entry.sub->pdo_mappable ? "." : "";
  std::string text;
  for (const std::string& pdo : entry.pdos) {
    const std::string mark = pdo.front() + pdo.substr(std::min<std::size_t>(4, pdo.size()));
    text += (text.empty() ? "" : " ") + mark;
  }
  return text;
}

std::string without_trailing_blanks(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

}  // namespace

std::string entry_text(const KnownDevice& device, const OdEntry& entry) {
  if (!entry.value && !entry.error.empty()) return entry.error;
  if (!entry.value && !entry.why_unread.empty()) return entry.why_unread;
  if (!entry.value) return entry.sub->text();  // for example $NODEID+0x80 without a node-ID
  const std::string value = shown_value(entry.key, entry.sub->type, *entry.value);
  const std::string meaning = value_meaning(device, entry.key, entry.sub->type, *entry.value);
  return meaning.empty() ? value : value + "  " + meaning;
}

OdTable::OdTable(const KnownDevice& device, std::size_t width)
    : device_{device},
      width_{width},
      name_width_{std::clamp((width - std::min(width, fixed_width)) * 11 / 20, narrowest_name,
                             widest_name)} {}

std::string OdTable::heading() const {
  return without_trailing_blanks(left("OBJECT", object_width) + left("NAME", name_width_) +
                                 left("TYPE", type_width) + left("ACCESS", access_width + 1) +
                                 left("PDO", pdo_width - 1) + "VALUE");
}

std::string OdTable::row(const OdEntry& entry) {
  std::string lines;
  if (entry.is_entry() && entry.object != group_) {
    const std::string_view name{entry.name};
    lines = without_trailing_blanks(
        left(to_string(entry.key).substr(0, 4), object_width) +
        left(shortened(name.substr(0, name.find('.')), name_width_ - 1), name_width_) +
        (entry.object->type == ObjectType::array ? "array" : "record"));
  }
  group_ = entry.object;
  const std::string text = entry_text(device_, entry);
  return lines + cells(entry, text);
}

std::string OdTable::cells(const OdEntry& entry, const std::string& value) const {
  const std::string key = to_string(entry.key);
  std::string_view name{entry.name};
  if (entry.is_entry()) name.remove_prefix(std::min(name.find('.') + 1, name.size()));
  const std::string line = left(entry.is_entry() ? "    " + key.substr(4) : key, object_width) +
                           left((entry.is_entry() ? "  " : "") +
                                    shortened(name, name_width_ - (entry.is_entry() ? 3 : 1)),
                                name_width_) +
                           left(type_word(*entry.sub), type_width) +
                           left(access_name(entry.sub->access), access_width) +
                           left(pdo_text(entry), pdo_width);
  return continued(line, value);
}

/// Writes a value that does not fit in the line on several lines, in the same column.
std::string OdTable::continued(const std::string& line, const std::string& value) const {
  const std::size_t column = fixed_width + name_width_;
  const std::size_t room = width_ > column + 8 ? width_ - column : 8;
  std::string lines;
  for (const std::string& part : broken(value, room)) {
    lines += without_trailing_blanks((lines.empty() ? line : std::string(column, ' ')) + part);
  }
  return lines;
}

}  // namespace takt
