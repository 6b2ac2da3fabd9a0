#include <algorithm>
#include <fmt/format.h>
#include <ostream>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

constexpr std::size_t widest_name = 44;
constexpr std::size_t widest_value = 34;

/// Returns the number of characters of a UTF-8 text.
std::size_t width(std::string_view text) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Returns the text on one line, cut to at most `most` characters.
std::string shortened(std::string_view text, std::size_t most) {
  std::string out;
  std::size_t count = 0;
  const bool cut = width(text) > most;
  for (const char c : text) {
    const bool starts = (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    if (starts && cut && count == most - 3) break;
    if (starts) ++count;
    out += is_blank(c) ? ' ' : c;
  }
  return cut ? out + "..." : out;
}

std::string left(std::string_view text, std::size_t columns) {
  std::string out{text};
  const auto used = width(text);
  if (used < columns) out.append(columns - used, ' ');
  return out;
}

std::string right(std::string_view text, std::size_t columns) {
  const auto used = width(text);
  return used < columns ? std::string(columns - used, ' ').append(text) : std::string{text};
}

std::string text_of(const Value& value, DataType type) {
  const auto* boxed = std::get_if<BoxedText>(&value);
  if (boxed == nullptr) return eds_value_text(value, type);
  const auto& bytes = boxed->text();
  const bool is_text = type == DataType::visible_string || type == DataType::unicode_string;
  return is_text ? '"' + to_utf8(bytes) + '"' : hex_bytes(bytes);
}

/// Returns the value, with the text of the file if that says more: `131474 (0x00020192)`.
std::string value_text(const SubObject& sub) {
  const auto& value = sub.value();
  const auto& text = sub.parameter_text.empty() ? sub.default_text : sub.parameter_text;
  if (!value) return text.empty() ? "-" : text;
  auto shown = text_of(*value, sub.type);
  if (std::holds_alternative<BoxedText>(*value) || text == shown) return shown;
  return shown + " (" + text + ')';
}

std::string limits_text(const SubObject& sub) {
  if (!sub.low_limit && !sub.high_limit) return {};
  return (sub.low_limit ? text_of(*sub.low_limit, sub.type) : "") + ".." +
         (sub.high_limit ? text_of(*sub.high_limit, sub.type) : "");
}

std::string type_text(const SubObject& sub) {
  return sub.type == DataType::unknown ? hex(sub.type_code) : std::string{name(sub.type)};
}

void print_fact(std::ostream& out, std::string_view label, std::string_view text) {
  if (!text.empty()) out << "  " << left(label, 12) << text << '\n';
}

std::string bit_rates(const DeviceInfo& device) {
  std::string text;
  for (const auto rate : device.baud_rates_kbit) text += std::to_string(rate) + ' ';
  return text.empty() ? "none given" : text + "kbit/s";
}

std::string profile_text(const ObjectDictionary& dictionary) {
  const auto value = integer_of(dictionary, {0x1000, 0});
  if (!value) return "unknown";
  const auto type = static_cast<std::uint32_t>(*value);
  const std::uint32_t profile = type & 0xFFFF;
  return fmt::format("{}, device type 0x{:08X}",
                     profile == 0 ? "none" : fmt::format("CiA {}", profile), type);
}

/// Returns for example `version 1.2, EDS 4.0, modified 05-12-2026 by A. Author`.
std::string file_text(const FileInfo& info) {
  std::string text;
  const auto add = [&text](std::string_view before, std::string_view what) {
    if (what.empty()) return;
    if (!text.empty()) text += ", ";
    text.append(before).append(what);
  };
  add("version ", info.file_version + (info.file_revision.empty() ? "" : '.' + info.file_revision));
  add("EDS ", info.eds_version);
  const bool modified = !info.modification_date.empty();
  const auto& by = modified ? info.modified_by : info.created_by;
  add(modified ? "modified " : "created ", modified ? info.modification_date : info.creation_date);
  if (!by.empty()) text.append(" by ").append(by);
  add("made from ", info.last_eds);
  return text;
}

void print_notes(std::ostream& out, const FileNotes& notes) {
  constexpr std::size_t most_lines = 20;
  print_fact(out, "file", shortened(file_text(notes.info), 100));
  std::string_view label = "comments";
  for (std::size_t i = 0; i < notes.comments.size() && i < most_lines; ++i) {
    print_fact(out, label, shortened(notes.comments[i], 100));
    label = "";
  }
  for (std::size_t i = 0; i < notes.tools.size() && i < most_lines; ++i) {
    print_fact(out, "tool", shortened(notes.tools[i].name + "  " + notes.tools[i].command, 100));
  }
}

/// Prints for example `lift  number 1  reference +A1`, without the parts that are not given.
void print_commissioning(std::ostream& out, const Commissioning& node) {
  const auto reference = [](const std::string& text) {
    return text.empty() ? text : "  reference " + text;
  };
  const auto fact = [&out](std::string_view label, std::string text) {
    text.erase(0, text.find_first_not_of(' '));
    print_fact(out, label, shortened(text, 100));
  };
  fact("node name", node.node_name + reference(node.node_refd));
  fact("network", node.network_name +
                      (node.net_number == 0 ? "" : "  number " + std::to_string(node.net_number)) +
                      reference(node.net_refd));
  if (node.serial_number != 0) print_fact(out, "LSS serial", hex(node.serial_number, 8));
}

/// Returns for example `M2  Digital output  version 1.0  MOD-DO-8  (3 connected)`.
std::string module_text(const ModuleInfo& module, const std::vector<std::uint16_t>& connected) {
  auto text = fmt::format("M{}  {}", module.number, module.product_name);
  if (!module.product_version.empty()) text += "  version " + module.product_version;
  if (!module.product_revision.empty()) text += '.' + module.product_revision;
  if (!module.order_code.empty()) text += "  " + module.order_code;
  const auto count = std::ranges::count(connected, module.number);
  return count == 0 ? text : fmt::format("{}  ({} connected)", text, count);
}

void print_modules(std::ostream& out, const ObjectDictionary& dictionary) {
  for (const auto& module : dictionary.modules) {
    print_fact(out, "module", shortened(module_text(module, dictionary.connected_modules), 100));
  }
}

void print_device(std::ostream& out, const ObjectDictionary& dictionary) {
  const auto& device = dictionary.device;
  out << dictionary.file << "  (" << (dictionary.is_dcf ? "DCF" : "EDS");
  if (dictionary.node_id) out << ", node " << unsigned{dictionary.node_id->value()};
  out << ")\n\n";
  print_fact(out, "vendor", device.vendor_name + "  " + hex(device.vendor_number, 8));
  print_fact(out, "product",
             fmt::format("{}  0x{:08X}  revision 0x{:08X}", device.product_name,
                         device.product_number, device.revision_number));
  print_fact(out, "order code", device.order_code);
  print_fact(out, "profile", profile_text(dictionary));
  print_fact(out, "bit rates", bit_rates(device));
  const bool fixed = device.granularity == 0 && mappable_record(dictionary) == nullptr;
  print_fact(out, "PDOs",
             fmt::format("{} RPDOs, {} TPDOs{}", device.nr_rx_pdo, device.nr_tx_pdo,
                         fixed ? ", mapping is fixed" : ""));
  print_commissioning(out, dictionary.commissioning);
  for (const auto& channel : dictionary.channels) {
    print_fact(out, "channels",
               fmt::format("0x{:04X}-0x{:04X}  {}  {}", channel.first, channel.last,
                           name(channel.type), access_name(channel.direction)));
  }
  print_modules(out, dictionary);
  print_notes(out, dictionary.notes);
}

std::string cob_id_text(const PdoDescription& pdo) {
  if (const auto id = pdo.cob_id()) return hex(*id, pdo.extended ? 8 : 3);
  if (pdo.cob_id_offset) return hex(*pdo.cob_id_offset, pdo.extended ? 8 : 3) + "+id";
  return "no COB-ID";
}

/// Returns for example `byte 2..5`, or the bits if an entry does not fill whole bytes.
std::string place_text(const MappedObject& entry) {
  const unsigned first = entry.bit_offset;
  const unsigned last = first + std::max<unsigned>(entry.bits, 1) - 1;
  const auto span = [](std::string_view unit, unsigned from, unsigned to) {
    return from == to ? fmt::format("{} {}", unit, from) : fmt::format("{} {}..{}", unit, from, to);
  };
  const bool whole_bytes = first % 8 == 0 && entry.bits % 8 == 0 && entry.bits != 0;
  return whole_bytes ? span("byte", first / 8, last / 8) : span("bit", first, last);
}

void print_pdo(std::ostream& out, const PdoDescription& pdo) {
  out << "  " << left(pdo.label(), 8) << left(cob_id_text(pdo), 11)
      << (pdo.valid ? "on   " : "off  ");
  if (pdo.transmission_type) {
    out << "type " << left(std::to_string(*pdo.transmission_type), 4)
        << left(transmission_name(*pdo.transmission_type, pdo.is_tpdo), 22);
  }
  out << pdo.bits << " bits";
  if (pdo.inhibit_time_us != 0) out << ", inhibit " << pdo.inhibit_time_us << " us";
  if (pdo.event_timer_ms != 0) out << ", event timer " << pdo.event_timer_ms << " ms";
  if (pdo.sync_start.value_or(0) != 0) out << ", from SYNC " << unsigned{*pdo.sync_start};
  if (pdo.is_tpdo && pdo.rtr_allowed) out << ", RTR";
  out << '\n';
  for (const auto& entry : pdo.mapping) {
    out << "      " << left(place_text(entry), 12) << to_string(entry.key) << "  "
        << left(shortened(entry.name, widest_name), widest_name)
        << right(std::to_string(entry.bits), 3) << " bits\n";
  }
}

void print_pdos(std::ostream& out, const ObjectDictionary& dictionary) {
  const auto pdos = describe_pdos(dictionary);
  if (pdos.empty()) return;
  out << "\nPDOs (directions are the device's: it receives RPDOs)\n";
  for (const auto& pdo : pdos) print_pdo(out, pdo);
}

std::size_t name_column(const ObjectDictionary& dictionary) {
  std::size_t widest = 12;
  for (const auto& object : dictionary.objects) {
    widest = std::max(widest, width(object.name));
    for (const auto& sub : object.subs) widest = std::max(widest, width(sub.name));
  }
  return std::min(widest, widest_name);
}

void print_entry(std::ostream& out, std::string_view key, const SubObject& sub,
                 std::size_t columns) {
  std::string line = "  " + left(key, 10) + left(shortened(sub.name, columns), columns) + "  " +
                     left(type_text(sub), 16) + left(access_name(sub.access), 7) +
                     left(sub.pdo_mappable ? "PDO" : "", 5) +
                     left(shortened(value_text(sub), widest_value), widest_value) + "  " +
                     limits_text(sub);
  line.erase(line.find_last_not_of(' ') + 1);
  out << line << '\n';
}

void print_object(std::ostream& out, const Object& object, std::size_t columns) {
  const auto index = hex(object.index).substr(2);
  const bool single = object.subs.size() == 1 && object.subs.front().sub == 0 &&
                      object.type != ObjectType::array && object.type != ObjectType::record;
  if (single) return print_entry(out, index, object.subs.front(), columns);
  out << "  " << left(index, 10) << left(shortened(object.name, columns), columns) << "  "
      << object_type_name(object.type) << '\n';
  for (const auto& sub : object.subs) {
    print_entry(out, "    :" + hex(sub.sub, 2).substr(2), sub, columns);
  }
}

/// Prints the names that the application gives to objects.
void print_denotations(std::ostream& out, const std::vector<Object>& objects) {
  bool first = true;
  const auto print = [&](std::string_view key, std::string_view text) {
    if (text.empty()) return;
    if (first) out << "\nDenotations\n";
    first = false;
    out << "  " << left(key, 10) << shortened(text, 100) << '\n';
  };
  for (const auto& object : objects) {
    print(hex(object.index).substr(2), object.denotation);
    for (const auto& sub : object.subs)
      print(to_string(ObjectKey{object.index, sub.sub}), sub.denotation);
  }
}

void print_references(std::ostream& out, const std::vector<ParameterReference>& references) {
  if (references.empty()) return;
  out << "\nReferences (" << references.size() << ")\n";
  for (const auto& reference : references) {
    const auto object = reference.sub ? to_string(ObjectKey{reference.index, *reference.sub})
                                      : hex(reference.index).substr(2);
    out << "  " << left(object, 10) << shortened(reference.text, 100) << '\n';
  }
}

}  // namespace

void print_text(std::ostream& out, const ObjectDictionary& dictionary) {
  print_device(out, dictionary);
  print_pdos(out, dictionary);
  const auto columns = name_column(dictionary);
  out << "\nObjects (" << dictionary.objects.size() << ")\n  " << left("index", 10)
      << left("name", columns) << "  " << left("type", 16) << left("access", 7) << left("PDO", 5)
      << left("value (as written)", widest_value) << "  limits\n";
  for (const auto& object : dictionary.objects) print_object(out, object, columns);
  print_denotations(out, dictionary.objects);
  print_references(out, dictionary.parameter_references);
}

}  // namespace takt
