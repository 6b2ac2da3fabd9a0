#include "eds_parser/eds_info.hpp"

#include <algorithm>
#include <charconv>

#include "eds_parser/section_keys.hpp"
#include "eds_parser/text.hpp"

namespace takt {
namespace {

/// N of `BaudRate_N`; `BaudRate_auto` is none.
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
}

std::vector<std::string> read_comments(const IniEntries& entries) {
  std::vector<std::string> lines;
  for (const auto& entry : entries) {
    if (!same_word(entry.key, "lines")) lines.push_back(to_utf8(entry.value));
  }
  return lines;
}

VendorTool read_tool(const IniEntries& entries, Report& report) {
  const SectionKeys keys{entries, report};
  return {keys.text("name"), keys.text("command")};
}

ObjectLinks read_links(std::uint16_t index, const IniEntries& entries, ValueReader& values) {
  ObjectLinks links{index, {}};
  for (const auto& entry : entries) {
    if (same_word(entry.key, "objectlinks") || entry.value.empty()) continue;
    const auto other = values.read_count(entry.value, 0xFFFF, entry.key, entry.pos());
    if (other) links.to.push_back(static_cast<std::uint16_t>(*other));
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
  keys.number(device.granularity, "granularity", values);
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
  if (const auto* entry = keys.get("nodeid")) {
    const auto id = values.read_count(entry->value, 0xFFFF'FFFF, entry->key, entry->pos());
    if (id) commissioning.node_id = NodeId::from(*id);
    if (id && !commissioning.node_id) {
      report.warning(entry->pos(), "node-id-range",
                     "NodeID is 1..127, not " + quoted(entry->value) + "; it was left out");
    }
  }
  const auto* rate = keys.get("baudrate");
  if (rate == nullptr) return;
  auto kbit = values.read_count(rate->value, 0xFFFF'FFFF, rate->key, rate->pos()).value_or(0);
  if (kbit > 1000) {
    report.warning(rate->pos(), "baudrate-unit",
                   "Baudrate is in kbit/s; " + quoted(rate->value) + " was taken for bit/s");
    kbit = std::min(kbit / 1000, 0xFFFFU);
  }
  commissioning.baudrate_kbit = static_cast<std::uint16_t>(kbit);
}

ModuleInfo read_module_info(std::uint16_t number, const IniEntries& entries, Report& report) {
  const SectionKeys keys{entries, report};
  return {number, keys.text("productname"), keys.text("productversion"),
          keys.text("productrevision"), keys.text("ordercode")};
}

void read_dummy_usage(std::array<bool, 8>& usage, const IniEntries& entries, ValueReader& values) {
  constexpr std::string_view prefix = "dummy000";
  for (const auto& entry : entries) {
    if (entry.key.size() != prefix.size() + 1) continue;
    const int digit = hex_digit(entry.key.back());
    if (!same_word(entry.key.substr(0, prefix.size()), prefix) || digit < 1 || digit > 7) continue;
    usage[static_cast<std::size_t>(digit)] |= values.read_flag(entry.value, entry.key, entry.pos());
  }
}

}  // namespace takt
