#include <algorithm>
#include <cctype>
#include <limits>
#include <string>

#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

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

/// Reads the value of an object. A value in quotes is a text if the object is a string, even if it
/// looks like a number. For other objects, the number in the quotes is used.
void read_object_value(const KeyInput& in, SdoSpec& sdo) {
  sdo.value_pos = in.node.pos;
  if (!in.node.quoted) {
    read_plain(in.node, sdo, in.report());
    return;
  }
  sdo.quoted = in.node.text;
  Findings unheard;
  NetworkReport quiet{in.report().file(), unheard};
  if (!read_plain(in.node, sdo, quiet)) sdo.value = in.node.text;
}

constexpr Key<SdoSpec> object_keys[] = {
    index_key<SdoSpec>(),
    sub_index_key<SdoSpec>(),
    required(key<read_object_value>("value", KeyValue{}, "",
                                    "A number, or a text. A value in quotes is text for a string "
                                    "object.",
                                    bus_yml)),
    key<&SdoSpec::again>("again", "false", "The object is in the list twice on purpose."),
};

/// Reports an object that appears twice. In `sdo`, whose entries are written in order, both entries
/// take effect, so this is a warning. In other lists one entry would have no effect, so it is an
/// error.
void check_repeated(const KeyInput& in, std::vector<SdoSpec>& objects, const SdoSpec& sdo) {
  const auto first = std::ranges::find(objects, sdo.object, &SdoSpec::object);
  if (first == objects.end() || sdo.again) return;
  const std::string text = to_string(sdo.object) + " of " + in.map.what() +
                           " is written twice, first in line " + std::to_string(first->pos.line);
  if (in.key.name == "sdo") {
    in.report().warning(sdo.pos, "written-twice", text,
                        ": takt writes both values in this order; is one of them meant for another "
                        "object? (`again: true` confirms both)");
  } else {
    in.error("written-twice", text, ": keep one");
  }
}

}  // namespace

void read_objects(const KeyInput& in, std::vector<SdoSpec>& objects) {
  read_list<object_keys, check_repeated>(in, objects);
}

KeyRows object_rows() { return rows_of<object_keys>(); }

}  // namespace takt
