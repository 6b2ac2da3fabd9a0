#include <cmath>
#include <utility>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/print/json.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

/// Returns a number as JSON. NaN and infinities become strings, because JSON does not have them.
Json json_of(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json json_of(const std::string& bytes, DataType type) {
  const bool is_text = type == DataType::visible_string || type == DataType::unicode_string;
  return is_text ? to_utf8(bytes) : hex_bytes(bytes);
}

Json json_of(const std::optional<Value>& value, DataType type) {
  if (!value) return nullptr;
  if (const auto* bytes = std::get_if<BoxedText>(&*value)) return json_of(bytes->text(), type);
  if (const auto* real = std::get_if<double>(&*value)) return json_of(*real);
  if (const auto* number = std::get_if<std::uint64_t>(&*value)) return *number;
  return std::get<std::int64_t>(*value);
}

Json json_of(const DeviceInfo& device) {
  return {{"vendor_name", device.vendor_name},
          {"vendor_number", device.vendor_number},
          {"product_name", device.product_name},
          {"product_number", device.product_number},
          {"revision_number", device.revision_number},
          {"order_code", device.order_code},
          {"baud_rates_kbit", device.baud_rates_kbit},
          {"simple_boot_up_master", device.simple_boot_up_master},
          {"simple_boot_up_slave", device.simple_boot_up_slave},
          {"granularity", device.granularity},
          {"dynamic_channels", device.dynamic_channels},
          {"group_messaging", device.group_messaging},
          {"nr_rx_pdo", device.nr_rx_pdo},
          {"nr_tx_pdo", device.nr_tx_pdo},
          {"lss_supported", device.lss_supported},
          {"compact_pdo", device.compact_pdo}};
}

Json json_of(const FileInfo& info) {
  return {{"file_name", info.file_name},
          {"file_version", info.file_version},
          {"file_revision", info.file_revision},
          {"eds_version", info.eds_version},
          {"description", info.description},
          {"creation_date", info.creation_date},
          {"creation_time", info.creation_time},
          {"created_by", info.created_by},
          {"modification_date", info.modification_date},
          {"modification_time", info.modification_time},
          {"modified_by", info.modified_by},
          {"last_eds", info.last_eds}};
}

Json json_of(const VendorTool& tool) { return {{"name", tool.name}, {"command", tool.command}}; }

Json json_of(const DomainFiles& files) {
  return {{"index", files.key.index},
          {"sub", files.key.sub},
          {"upload_file", files.upload},
          {"download_file", files.download}};
}

Json json_of(const Commissioning& node) {
  if (node.pos.line == 0) return nullptr;
  return {{"node_id", node.node_id ? Json(node.node_id->value()) : Json(nullptr)},
          {"node_name", node.node_name},
          {"node_refd", node.node_refd},
          {"baudrate_kbit", node.baudrate_kbit},
          {"net_number", node.net_number},
          {"network_name", node.network_name},
          {"net_refd", node.net_refd},
          {"canopen_manager", node.manager},
          {"lss_serial_number", node.serial_number}};
}

Json json_of(const ParameterReference& reference) {
  return {
      {"index", reference.index}, {"sub", or_null(reference.sub)}, {"param_refd", reference.text}};
}

Json json_of(const ModuleInfo& module) {
  return {{"number", module.number},
          {"product_name", module.product_name},
          {"product_version", module.product_version},
          {"product_revision", module.product_revision},
          {"order_code", module.order_code}};
}

Json json_of(const ObjectLinks& links) { return {{"index", links.index}, {"to", links.to}}; }

Json json_of(const DynamicChannel& channel) {
  return {{"data_type", channel.type_code}, {"direction", access_name(channel.direction)},
          {"first", channel.first},         {"last", channel.last},
          {"offset", channel.offset},       {"max_count", channel.most}};
}

Json json_of(const SubObject& sub) {
  Json json{{"sub", sub.sub},
            {"name", sub.name},
            {"data_type", sub.type_code},
            {"access", access_name(sub.access)},
            {"pdo_mappable", sub.pdo_mappable},
            {"low_limit", json_of(sub.low_limit, sub.type)},
            {"high_limit", json_of(sub.high_limit, sub.type)},
            {"default", json_of(sub.default_value, sub.type)},
            {"default_text", sub.default_text},
            {"value", json_of(sub.value(), sub.type)}};
  if (!sub.parameter_text.empty()) json["parameter_text"] = sub.parameter_text;
  if (!sub.denotation.empty()) json["denotation"] = sub.denotation;
  if (sub.flags != 0) json["obj_flags"] = sub.flags;
  return json;
}

Json json_of(const Object& object) {
  Json json{{"index", object.index},
            {"name", object.name},
            {"object_type", static_cast<unsigned>(object.type)},
            {"list", list_name(object)}};
  if (!object.denotation.empty()) json["denotation"] = object.denotation;
  json["subs"] = list_of(object.subs, [](const SubObject& sub) { return json_of(sub); });
  return json;
}

Json json_of(const MappedObject& entry) {
  return {{"index", entry.key.index},
          {"sub", entry.key.sub},
          {"bits", entry.bits},
          {"bit_offset", entry.bit_offset},
          {"name", entry.name}};
}

Json json_of(const PdoDescription& pdo) {
  Json json{{"number", pdo.number},
            {"cob_id", or_null(pdo.cob_id())},
            {"valid", pdo.valid},
            {"rtr_allowed", pdo.rtr_allowed},
            {"extended", pdo.extended},
            {"transmission_type", or_null(pdo.transmission_type)},
            {"inhibit_time_us", pdo.inhibit_time_us},
            {"event_timer_ms", pdo.event_timer_ms},
            {"sync_start", or_null(pdo.sync_start)},
            {"bits", pdo.bits}};
  json["mapping"] = list_of(pdo.mapping, [](const MappedObject& entry) { return json_of(entry); });
  return json;
}

/// Replaces bytes that are not UTF-8, for example in a file name. Otherwise dump() would throw an
/// exception.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

/// Prints `"name":[` and one item on each line.
template <class Items, class Wanted>
void print_items(std::ostream& out, std::string_view name, const Items& items, Wanted wanted) {
  out << ",\n\"" << name << "\":[";
  std::string_view separator = "\n";
  for (const auto& item : items) {
    if (!wanted(item)) continue;
    out << separator << text_of(json_of(item));
    separator = ",\n";
  }
  out << ']';
}

}  // namespace

void print_json(std::ostream& out, const ObjectDictionary& dictionary, const Findings& findings) {
  const auto pdos = describe_pdos(dictionary);
  const auto all = [](const auto&) { return true; };
  out << "{\"file\":" << text_of(dictionary.file) << ",\"kind\":\""
      << (dictionary.is_dcf ? "dcf" : "eds") << "\",\"node_id\":"
      << (dictionary.node_id ? std::to_string(dictionary.node_id->value()) : "null")
      << ",\n\"device\":" << text_of(json_of(dictionary.device));
  print_items(out, "objects", dictionary.objects, all);
  print_items(out, "rpdos", pdos, [](const PdoDescription& pdo) { return !pdo.is_tpdo; });
  print_items(out, "tpdos", pdos, [](const PdoDescription& pdo) { return pdo.is_tpdo; });
  out << ",\n\"file_info\":" << text_of(json_of(dictionary.notes.info));
  out << ",\n\"comments\":" << text_of(dictionary.notes.comments);
  print_items(out, "tools", dictionary.notes.tools, all);
  print_items(out, "domain_files", dictionary.domain_files, all);
  print_items(out, "object_links", dictionary.links, all);
  print_items(out, "dynamic_channels", dictionary.channels, all);
  out << ",\n\"commissioning\":" << text_of(json_of(dictionary.commissioning));
  print_items(out, "parameter_references", dictionary.parameter_references, all);
  print_items(out, "modules", dictionary.modules, all);
  out << ",\n\"connected_modules\":" << text_of(dictionary.connected_modules);
  print_items(out, "diagnostics", findings, all);
  out << "}\n";
}

}  // namespace takt
