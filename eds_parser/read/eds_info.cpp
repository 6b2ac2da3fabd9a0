#include "eds_parser/read/eds_info.hpp"

#include <algorithm>
#include <charconv>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/section_keys.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

/// Returns N of `BaudRate_N`, or std::nullopt for other keys such as `BaudRate_auto`.
std::optional<std::uint16_t> baud_rate_of(std::string_view key) noexcept {
  constexpr std::string_view prefix = "baudrate_";
  if (key.size() <= prefix.size() || !same_word(key.substr(0, prefix.size()), prefix)) {
    return std::nullopt;
  }
  std::uint16_t rate = 0;
  const auto* end = key.data() + key.size();
  const auto [stop, error] = std::from_chars(key.data() + prefix.size(), end, rate);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return rate;
}

bool nothing_else(std::string_view /*key*/) noexcept { return false; }

/// Returns true for keys of [DeviceInfo] that takt does not use, and for bit rates of vendors.
bool is_reserved(std::string_view key) noexcept {
  constexpr std::string_view reserved[] = {
      "productversion",       "productrevision",     "lmt_manufacturername",   "lmt_productname",
      "extendedbootupmaster", "extendedbootupslave", "canopensafetysupported", "baudrate_auto"};
  constexpr std::string_view guarding = "ng_";  // NG_Slave, NG_Master ... of older files
  if (baud_rate_of(key) || same_word(key.substr(0, guarding.size()), guarding)) return true;
  return std::ranges::any_of(reserved, [key](auto word) { return same_word(key, word); });
}

/// Returns true for `Dummy0005`: the word followed by the index of a data type.
bool is_dummy(std::string_view key) noexcept {
  constexpr std::string_view word = "dummy";
  return key.size() == word.size() + 4 && same_word(key.substr(0, word.size()), word) &&
         std::ranges::all_of(key.substr(word.size()), [](char c) { return hex_digit(c) >= 0; });
}

void read_baud_rates(DeviceInfo& device, const IniEntries& entries, ValueReader& values) {
  for (const auto& entry : entries) {
    const auto rate = baud_rate_of(entry.key);
    if (!rate || !values.read_flag(entry.value, entry.key, entry.pos())) continue;
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
  std::optional<IniEntry> count;
  for (const auto& entry : entries) {
    if (same_word(entry.key, "lines")) {
      if (!count) count = entry;
    } else if (is_numbered(entry.key, "line")) {
      lines.push_back(to_utf8(entry.value));
    } else {
      report_unknown_key(entry, "Comments", report);
    }
  }
  if (count) check_entry_count(*count, lines.size(), "Comments", report);
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
  std::optional<IniEntry> count;
  std::size_t found = 0;
  for (const auto& entry : entries) {
    if (same_word(entry.key, "objectlinks")) {
      if (!count) count = entry;
      continue;
    }
    if (!entry_number(entry.key)) {
      report_unknown_key(entry, section.name, report);
      continue;
    }
    ++found;
    const auto other = values.read_count(entry.value, 0xFFFF, entry.key, entry.pos());
    if (!other) continue;
    const auto index = static_cast<std::uint16_t>(*other);
    links.to.push_back(index);
    if (is_described(index) || !report.wants("listed-without-section")) continue;
    report.warning(entry.pos(), "listed-without-section",
                   "[" + to_utf8(section.name) + "] links object " + hex(index) +
                       ", which the file does not describe");
  }
  if (count) check_entry_count(*count, found, section.name, report);
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
  keys.number(device.granularity, "granularity", values);
  const auto* granularity = keys.get("granularity");
  device.granularity_pos = granularity == nullptr ? section.pos : granularity->pos();
  keys.number(device.dynamic_channels, "dynamicchannelssupported", values);
  keys.flag(device.group_messaging, "groupmessaging", values);
  const auto pdos = [&](std::uint16_t& count, SourcePos& pos, std::string_view key) {
    const auto* entry = keys.get(key);
    pos = entry == nullptr ? section.pos : entry->pos();
    if (entry == nullptr) return;
    const auto read = values.read_count(entry->value, 0xFFFF, entry->key, entry->pos());
    if (read) count = static_cast<std::uint16_t>(*read);
  };
  pdos(device.nr_rx_pdo, device.nr_rx_pdo_pos, "nrofrxpdo");
  pdos(device.nr_tx_pdo, device.nr_tx_pdo_pos, "nroftxpdo");
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
  if (const auto* entry = node) {
    const auto id = values.read_count(entry->value, 0xFFFF'FFFF, entry->key, entry->pos());
    if (id) commissioning.node_id = NodeId::from(*id);
    if (id && !commissioning.node_id) {
      report.warning(entry->pos(), "node-id-range",
                     "NodeID is 1..127, not " + quoted(entry->value) + "; it was left out");
    }
  }
  if (rate == nullptr) return;
  auto kbit = values.read_count(rate->value, 0xFFFF'FFFF, rate->key, rate->pos()).value_or(0);
  if (kbit > 1000) {
    report.warning(rate->pos(), "baudrate-unit",
                   "Baudrate is in kbit/s; " + quoted(rate->value) + " was read as bit/s");
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
  constexpr std::string_view prefix = "dummy000";
  for (const auto& entry : entries) {
    if (!is_dummy(entry.key)) {
      report_unknown_key(entry, "DummyUsage", report);
      continue;
    }
    const int digit = hex_digit(entry.key.back());
    if (!same_word(entry.key.substr(0, prefix.size()), prefix) || digit < 1 || digit > 7) continue;
    usage[static_cast<std::size_t>(digit)] |= values.read_flag(entry.value, entry.key, entry.pos());
  }
}

}  // namespace takt
