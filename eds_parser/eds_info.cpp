#include "eds_parser/eds_info.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "eds_parser/text.hpp"

namespace takt {
namespace {

/// The entries of a section by key; of a repeated key the first counts.
class Keys {
 public:
  Keys(std::span<const IniEntry> entries, Report& report) : entries_{entries}, report_{report} {}

  /// `key` in lower case.
  const IniEntry* get(std::string_view key) const {
    const IniEntry* found = nullptr;
    for (const auto& entry : entries_) {
      if (!same_word(entry.key, key)) continue;
      if (found == nullptr) {
        found = &entry;
      } else if (found->value != entry.value) {
        report_.warning(entry.pos(), "duplicate-key",
                        "key " + quoted(entry.key) +
                            " repeated with another value; the first one counts, " +
                            quoted(found->value));
      }
    }
    return found;
  }

  std::string text(std::string_view key) const {
    const auto* entry = get(key);
    return entry == nullptr ? std::string{} : to_utf8(entry->value);
  }

  template <class T>
  void number(T& out, std::string_view key, ValueReader& values) const {
    const auto* entry = get(key);
    if (entry == nullptr) return;
    constexpr auto highest = std::numeric_limits<T>::max();
    const auto value = values.read_count(entry->value, highest, entry->key, entry->pos());
    if (value) out = static_cast<T>(*value);
  }

  void flag(bool& out, std::string_view key, ValueReader& values) const {
    const auto* entry = get(key);
    if (entry != nullptr) out = values.read_flag(entry->value, entry->key, entry->pos());
  }

 private:
  std::span<const IniEntry> entries_;
  Report& report_;
};

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

void read_baud_rates(DeviceInfo& device, std::span<const IniEntry> entries, ValueReader& values) {
  for (const auto& entry : entries) {
    const auto rate = baud_rate_of(entry.key);
    if (!rate || !values.read_flag(entry.value, entry.key, entry.pos())) continue;
    const auto at = std::ranges::lower_bound(device.baud_rates_kbit, *rate);
    if (at != device.baud_rates_kbit.end() && *at == *rate) continue;
    if (device.baud_rates_kbit.size() < 64) device.baud_rates_kbit.insert(at, *rate);
  }
}

}  // namespace

void read_device_info(DeviceInfo& device, const IniSection& section,
                      std::span<const IniEntry> entries, ValueReader& values, Report& report) {
  const Keys keys{entries, report};
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
  keys.number(device.nr_rx_pdo, "nrofrxpdo", values);
  keys.number(device.nr_tx_pdo, "nroftxpdo", values);
  keys.flag(device.lss_supported, "lss_supported", values);
  keys.number(device.compact_pdo, "compactpdo", values);
  read_baud_rates(device, entries, values);
}

void read_commissioning(Commissioning& commissioning, std::span<const IniEntry> entries,
                        ValueReader& values, Report& report) {
  const Keys keys{entries, report};
  commissioning.node_name = keys.text("nodename");
  commissioning.network_name = keys.text("networkname");
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

void read_dummy_usage(std::array<bool, 8>& usage, std::span<const IniEntry> entries,
                      ValueReader& values) {
  constexpr std::string_view prefix = "dummy000";
  for (const auto& entry : entries) {
    if (entry.key.size() != prefix.size() + 1) continue;
    const int digit = hex_digit(entry.key.back());
    if (!same_word(entry.key.substr(0, prefix.size()), prefix) || digit < 1 || digit > 7) continue;
    usage[static_cast<std::size_t>(digit)] |= values.read_flag(entry.value, entry.key, entry.pos());
  }
}

}  // namespace takt
