#include "eds_parser/read/eds_info.hpp"

#include <algorithm>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/section_keys.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

/// Returns N of `BaudRate_N`, or std::nullopt for other keys such as `BaudRate_auto`.
std::optional<std::uint16_t> baud_rate_of(std::string_view key) noexcept {
  constexpr std::string_view prefix = "baudrate_";
  if (!has_prefix(key, prefix)) return std::nullopt;
  return number_in<std::uint16_t>(key.substr(prefix.size()));
}

bool nothing_else(std::string_view /*key*/) noexcept { return false; }

/// Returns true for keys of [DeviceInfo] that takt does not use, and for bit rates of vendors.
bool is_reserved(std::string_view key) noexcept {
  constexpr std::string_view reserved[] = {
      "productversion",       "productrevision",     "lmt_manufacturername",   "lmt_productname",
      "extendedbootupmaster", "extendedbootupslave", "canopensafetysupported", "baudrate_auto"};
  // NG_Slave, NG_Master ... are keys of older files.
  if (baud_rate_of(key) || has_prefix(key, "ng_")) return true;
  return std::ranges::any_of(reserved, [key](auto word) { return same_word(key, word); });
}

/// Returns the index of the data type in `Dummy0005`, or std::nullopt for other keys.
std::optional<std::uint32_t> dummy_type(std::string_view key) noexcept {
  constexpr std::string_view word = "dummy";
  if (key.size() != word.size() + 4 || !has_prefix(key, word)) return std::nullopt;
  return hex_digits(key.substr(word.size()));
}

void read_baud_rates(DeviceInfo& device, const IniEntries& entries, ValueReader& values) {
  for (const auto& entry : entries) {
    const auto rate = baud_rate_of(entry.key);
    if (!rate || !values.read_flag(entry)) continue;
    const auto at = std::ranges::lower_bound(device.baud_rates_kbit, *rate);
    if (at != device.baud_rates_kbit.end() && *at == *rate) continue;
    if (device.baud_rates_kbit.size() < 64) device.baud_rates_kbit.insert(at, *rate);
  }
}

}  // namespace

void read_file_info(FileInfo& info, const IniEntries& entries, Report& report) {
  const SectionKeys keys{entries, report};
  info.file_name = keys.text("filename");
  info.file_version = keys.text("fileversion");
  info.file_revision = keys.text("filerevision");
  info.eds_version = keys.text("edsversion");
  info.description = keys.text("description");
  info.creation_date = keys.text("creationdate");
  info.creation_time = keys.text("creationtime");
  info.created_by = keys.text("createdby");
  info.modification_date = keys.text("modificationdate");
  info.modification_time = keys.text("modificationtime");
  info.modified_by = keys.text("modifiedby");
  info.last_eds = keys.text("lasteds");
  keys.report_unknown("FileInfo", nothing_else);
}

std::vector<std::string> read_comments(const IniEntries& entries, Report& report) {
  std::vector<std::string> lines;
  for (const auto& entry : read_numbered_list(entries, "Comments", "lines", report, "line")) {
    lines.push_back(to_utf8(entry.value));
  }
  return lines;
}

VendorTool read_tool(const IniSection& section, const IniEntries& entries, Report& report) {
  const SectionKeys keys{entries, report};
  VendorTool tool{keys.text("name"), keys.text("command")};
  keys.report_unknown(section.name, nothing_else);
  return tool;
}

void check_tools(const IniEntries& entries, std::size_t found, Report& report) {
  const SectionKeys keys{entries, report};
  if (const auto* count = keys.get("items")) check_entry_count(*count, found, "Tools", report);
  keys.report_unknown("Tools", nothing_else);
}

ObjectLinks read_links(const IniSection& section, const IniEntries& entries,
                       const std::function<bool(std::uint16_t)>& is_described, Report& report) {
  ValueReader values{report, std::nullopt};
  ObjectLinks links{classify_section(section).index, {}};
  for (const auto& entry : read_numbered_list(entries, section.name, "objectlinks", report)) {
    const auto other = values.read_count(entry, 0xFFFF);
    if (!other) continue;
    const auto index = static_cast<std::uint16_t>(*other);
    links.to.push_back(index);
    if (is_described(index)) continue;
    report.warning(entry.pos(), "listed-without-section", section, " links object ", Hex{index},
                   ", which the file does not describe");
  }
  return links;
}

void read_device_info(DeviceInfo& device, const IniSection& section, const IniEntries& entries,
                      ValueReader& values, Report& report) {
  const SectionKeys keys{entries, report};
  device.pos = section.pos;
  device.vendor_name = keys.text("vendorname");
  device.product_name = keys.text("productname");
  device.order_code = keys.text("ordercode");
  keys.number(device.vendor_number, "vendornumber", values);
  keys.number(device.product_number, "productnumber", values);
  keys.number(device.revision_number, "revisionnumber", values);
  keys.flag(device.simple_boot_up_master, "simplebootupmaster", values);
  keys.flag(device.simple_boot_up_slave, "simplebootupslave", values);
  const auto place = [&](const IniEntry* entry) {
    return entry == nullptr ? section.pos : entry->pos();
  };
  device.granularity_pos = place(keys.number(device.granularity, "granularity", values));
  device.nr_rx_pdo_pos = place(keys.number(device.nr_rx_pdo, "nrofrxpdo", values));
  device.nr_tx_pdo_pos = place(keys.number(device.nr_tx_pdo, "nroftxpdo", values));
  keys.number(device.dynamic_channels, "dynamicchannelssupported", values);
  keys.flag(device.group_messaging, "groupmessaging", values);
  keys.flag(device.lss_supported, "lss_supported", values);
  keys.number(device.compact_pdo, "compactpdo", values);
  keys.report_unknown("DeviceInfo", is_reserved);
  read_baud_rates(device, entries, values);
}

void read_commissioning(Commissioning& commissioning, const IniEntries& entries,
                        ValueReader& values, Report& report) {
  const SectionKeys keys{entries, report};
  commissioning.node_name = keys.text("nodename");
  commissioning.node_refd = keys.text("noderefd");
  commissioning.network_name = keys.text("networkname");
  commissioning.net_refd = keys.text("netrefd");
  keys.number(commissioning.net_number, "netnumber", values);
  keys.number(commissioning.serial_number, "lss_serialnumber", values);
  keys.flag(commissioning.manager, "canopenmanager", values);
  const auto* rate = keys.get("baudrate");
  const auto* node = keys.get("nodeid");
  keys.report_unknown("DeviceComissioning", nothing_else);
  if (node != nullptr) {
    const auto id = values.read_count(*node, 0xFFFF'FFFF);
    if (id) commissioning.node_id = NodeId::from(*id);
    if (id && !commissioning.node_id) {
      report.warning(node->pos(), "node-id-range", "NodeID is 1..127, not ", Quoted{node->value},
                     "; it was left out");
    }
  }
  if (rate == nullptr) return;
  auto kbit = values.read_count(*rate, 0xFFFF'FFFF).value_or(0);
  if (kbit > 1000) {
    report.warning(rate->pos(), "baudrate-unit", "Baudrate is in kbit/s; ", Quoted{rate->value},
                   " was read as bit/s");
    kbit = std::min(kbit / 1000, 0xFFFFU);
  }
  commissioning.baudrate_kbit = static_cast<std::uint16_t>(kbit);
  commissioning.baudrate_pos = rate->pos();
}

ModuleInfo read_module_info(std::uint16_t number, const IniSection& section,
                            const IniEntries& entries, Report& report) {
  const SectionKeys keys{entries, report};
  ModuleInfo info{number, keys.text("productname"), keys.text("productversion"),
                  keys.text("productrevision"), keys.text("ordercode")};
  keys.report_unknown(section.name, nothing_else);
  return info;
}

void read_dummy_usage(std::array<bool, 8>& usage, const IniEntries& entries, ValueReader& values,
                      Report& report) {
  for (const auto& entry : entries) {
    const auto type = dummy_type(entry.key);
    if (!type) {
      report_unknown_key(entry, "DummyUsage", report);
    } else if (*type >= 1 && *type < usage.size()) {
      usage[*type] |= values.read_flag(entry);
    }
  }
}

}  // namespace takt
