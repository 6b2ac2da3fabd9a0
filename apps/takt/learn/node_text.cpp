#include "apps/takt/learn/node_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ranges>

#include "apps/takt/learn/learned_pdos.hpp"
#include "apps/takt/learn/sdo_value_text.hpp"
#include "apps/takt/learn/yaml_text.hpp"
#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/specification/object_units.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt::learn {
namespace {

constexpr std::uint32_t invalid_bit = 0x8000'0000;
constexpr std::size_t most_comments = 40;

std::string bytes_text(const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) return {};
  const std::string text = fmt::format(" {:02X}", fmt::join(bytes | std::views::take(16), " "));
  return text + (bytes.size() > 16 ? fmt::format(" ... ({} bytes)", bytes.size()) : "");
}

std::string object_text(ObjectKey key) {
  return fmt::format("index: 0x{:04X}, sub_index: {}", key.index, key.sub);
}

class NodeText {
 public:
  NodeText(const NodeToWrite& what, const LearnedBus& bus, Findings& findings)
      : what_{what},
        node_{what.node},
        bus_{bus},
        findings_{findings},
        values_{node_.values()},
        configuration_{node_.configuration()} {}

  std::string write() {
    text_ = fmt::format("  {}:\n    node_id: {}\n    dcf: {}\n", node_name(node_.id), node_.id,
                        yaml_quoted(what_.dcf));
    identity();
    boot();
    error_control();
    emergency_and_time();
    pdos();
    sdo_list();
    remarks();
    return std::move(text_);
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... arguments) {
    text_ += "    " + fmt::format(format, std::forward<T>(arguments)...) + '\n';
  }

  void announce(Severity severity, std::string_view rule, std::uint32_t at, std::string message) {
    findings_.push_back({bus_.file,
                         {at, 0},
                         severity,
                         rule,
                         fmt::format("node {}: {}", node_.id, std::move(message))});
  }

  std::optional<std::uint64_t> number(ObjectKey key) const { return values_.number(key); }
  std::optional<std::uint64_t> written(ObjectKey key) const { return values_.number_written(key); }
  const SubObject* described(ObjectKey key) const {
    return what_.dictionary == nullptr ? nullptr : what_.dictionary->find(key);
  }
  std::uint64_t described_number(ObjectKey key) const {
    const SubObject* sub = described(key);
    return sub == nullptr ? 0 : static_cast<std::uint64_t>(integer_of(sub->value()).value_or(0));
  }

  void identity() {
    const SeenIdentity seen = identity_of(values_);
    if (seen.device_type != 0) line("device_type: 0x{:08X}", seen.device_type);
    if (seen.vendor_id != 0) line("vendor_id: 0x{:08X}", seen.vendor_id);
    if (seen.product_code != 0) line("product_code: 0x{:08X}", seen.product_code);
    if (seen.revision_number != 0) {
      line("# revision_number: 0x{:08X}", seen.revision_number);
    }
    if (seen.serial_number != 0) line("# serial_number: 0x{:08X}", seen.serial_number);
  }

  void boot() {
    if (node_.reset_node) line("reset: node");
    for (const LearnedWrite& write : configuration_) {
      const ObjectKey key = write.transfer.object;
      if (key.index == 0x1010 && key.sub != 0) line("store_configuration: {}", key.sub);
      if (key.index == 0x1011 && key.sub != 0) line("restore_configuration: {}", key.sub);
    }
    const auto date = written({0x1020, 1});
    const auto time = written({0x1020, 2});
    if (date && *date != 0) line("configuration_date: {}", *date);
    if (date && *date != 0 && time && *time < 86'400'000) line("configuration_time: {}", *time);
  }

  void error_control() {
    heartbeat();
    watch_master();
    if (node_.guarded()) {
      const auto measured = as_configured_ms(node_.guard_requests.median()).value_or(0);
      const auto ms = written({0x100C, 0}).value_or(static_cast<std::uint64_t>(measured));
      if (ms != 0) line("guard_time: {}", ms);
      if (const auto factor = written({0x100D, 0})) line("life_time_factor: {}", *factor);
    }
    bool opened = false;
    for (const auto& [key, value] : values_) {
      if (key.index != 0x1029 || key.sub == 0 || !value.written) continue;
      if (!opened) line("error_behavior:");
      opened = true;
      line("  {}: {}", key.sub, value.number().value_or(0));
    }
  }

  void heartbeat() {
    const auto set = number({0x1017, 0});
    const auto measured = node_.heartbeats.median();
    if (set && *set <= 65535) {
      line("heartbeat_producer: {}", *set);
    } else if (measured && !node_.guarded()) {
      const auto ms = as_configured_ms(measured);
      line("heartbeat_producer: {}   # {}", ms.value_or(0),
           ms ? "as measured" : "0x1017 can't hold the measured time");
    } else {
      line("heartbeat_producer: 0   # no heartbeat in the recording");
    }
  }

  /// Writes the heartbeat consumer by the entries of 0x1016. An entry with the node-ID of the
  /// master needs no key, except `heartbeat_multiplier` if its time is not the default. Without
  /// such an entry, the key is `heartbeat_consumer: false`. An entry with another node-ID becomes a
  /// comment.
  void watch_master() {
    bool watches = false;
    for (const auto& [key, value] : values_) {
      if (key.index != 0x1016 || key.sub == 0) continue;
      const std::uint64_t entry = value.number().value_or(0);
      const auto producer = static_cast<std::uint8_t>(entry >> 16U & 0x7FU);
      const std::uint64_t ms = entry & 0xFFFFU;
      if (producer == 0 || ms == 0) continue;
      if (producer != what_.master_id) {
        line("# {} was {}: the device watches node {} for {} ms", to_string(key),
             value.written ? "written" : "read", producer, ms);
        continue;
      }
      watches = true;
      if (what_.master_heartbeat_ms == 0) continue;
      const double factor =
          static_cast<double>(ms) / static_cast<double>(what_.master_heartbeat_ms);
      if (factor >= 1.5 && std::abs(factor - 3.0) > 0.01) {
        line("heartbeat_multiplier: {:.4g}", factor);
      }
    }
    if (!watches) line("heartbeat_consumer: false");
  }

  void emergency_and_time() {
    const auto emcy = written({0x1014, 0});
    const std::uint64_t id = emcy.value_or(0) & 0x7FFU;
    if (emcy && id != 0 && (*emcy & invalid_bit) == 0) line("emcy_cob_id: 0x{:03X}", id);
    if (const auto inhibit = written({0x1015, 0})) line("emcy_inhibit_time: {}", *inhibit);
    if (const auto time = written({0x1012, 0})) line("time_cob_id: 0x{:08X}", *time);
  }

  void pdos() {
    const std::vector<LearnedPdo> all = learned_pdos(values_);
    for (const bool tpdos : {false, true}) {
      bool opened = false;
      for (const LearnedPdo& pdo : all) {
        if (pdo.is_tpdo != tpdos) continue;
        if (!opened) line("{}:", tpdos ? "tpdo" : "rpdo");
        opened = true;
        write_pdo(pdo);
      }
    }
    if (unmapped_.empty()) return;
    announce(
        Severity::note, "no-mapping", node_.first_line,
        "the mapping of" + unmapped_ + " is not in the recording: " +
            (what_.made ? "the vendor's EDS may have it" : "takt uses that of the device file"));
  }

  void write_pdo(const LearnedPdo& pdo) {
    if (!pdo.enabled()) return line("  {}: {{enabled: false}}", pdo.number);
    if (pdo.count == 0 && !what_.made) {
      return line("  {}: {{enabled: false}}   # nothing is mapped in the recording", pdo.number);
    }
    std::string keys;
    const auto add = [&](const std::string& key) { keys += (keys.empty() ? "" : ", ") + key; };
    const auto id = pdo.identifier();
    if (id) {
      add(fmt::format("cob_id: 0x{:X}", id->id() | (id->is_extended() ? 0x2000'0000U : 0U)));
    }
    if (pdo.transmission) add(fmt::format("transmission: {}", *pdo.transmission));
    const auto optional = [&](std::string_view key, std::uint8_t sub, const auto& value,
                              std::uint32_t unit = 1) {
      const std::uint64_t known =
          what_.made ? 0 : described_number({pdo.communication_index(), sub});
      if (!value || *value == known) return;
      add(fmt::format("{}: {}", key, *value * unit));
    };
    optional("inhibit_time", 3, pdo.inhibit_time, what_.inhibit_unit_us / 100);
    optional(pdo.is_tpdo ? "event_timer" : "event_deadline", 5, pdo.timer);
    if (pdo.is_tpdo) optional("sync_start", 6, pdo.sync_start);
    if (id && (pdo.is_tpdo || pdo.transmission.value_or(0) > 240)) {
      if (const std::string key = period_key(*id, pdo.is_tpdo); !key.empty()) add(key);
    }
    if (pdo.count == 0xFE || pdo.count == 0xFF) {
      add(pdo.count == 0xFE ? "mpdo: sam" : "mpdo: dam");
    }
    const std::string mapping = mapping_text(pdo);
    const bool unknown = mapping.empty() && what_.made;
    if (!mapping.empty()) add(mapping);
    text_ += fmt::format("      {}{}: {{{}}}{}\n", unknown ? "# " : "", pdo.number, keys,
                         unknown ? "  the mapping is not in the recording" : "");
  }

  /// Returns the key for an event-driven RPDO that the master sends at a steady period, or for a
  /// TPDO that the master polls. Empty if the frames show no period.
  std::string period_key(CobId id, bool is_tpdo) const {
    const auto traffic = bus_.traffic.find(id);
    if (traffic == bus_.traffic.end()) return {};
    const auto period =
        is_tpdo ? traffic->second.requests.median() : traffic->second.frames.steady();
    if (!period || (!is_tpdo && *period < 1000)) return {};
    const std::int64_t ms = as_configured(*period) / 1000;
    return is_tpdo ? fmt::format("poll_ms: {}", std::max<std::int64_t>(1, ms))
                   : fmt::format("event_timer: {}", std::min<std::int64_t>(65535, ms));
  }

  std::string mapping_text(const LearnedPdo& pdo) {
    if (!pdo.mapping) {
      const bool multiplexed = pdo.count && *pdo.count > 64;
      if (!multiplexed) unmapped_ += fmt::format(" {}PDO{}", pdo.is_tpdo ? 'T' : 'R', pdo.number);
      return {};
    }
    std::string text = "mapping: [";
    for (std::size_t i = 0; i < pdo.mapping->size(); ++i) {
      const std::uint32_t entry = (*pdo.mapping)[i];
      const ObjectKey key = mapped_object(entry);
      const SubObject* sub = described(key);
      text += fmt::format("{}{{index: 0x{:04X}", i == 0 ? "" : ", ", key.index);
      if (key.sub != 0) text += fmt::format(", sub_index: {}", key.sub);
      const unsigned bits = entry & 0xFFU;
      if (sub == nullptr || bit_width(sub->type) != bits) text += fmt::format(", bits: {}", bits);
      text += '}';
    }
    return text + ']';
  }

  void sdo_list() {
    std::set<ObjectKey> seen;
    bool opened = false;
    for (const LearnedWrite& write : configuration_) {
      const ObjectKey key = write.transfer.object;
      if (is_pdo_parameter(key.index) || has_key_of_its_own(key) || is_own_cycle(key)) continue;
      if (!opened) line("sdo:");
      opened = true;
      const std::string why = why_not(write);
      if (!why.empty()) {
        line("  # {{{}}} =={}: {}", object_text(key), bytes_text(write.transfer.value), why);
        announce(Severity::warning, "not-taken", write.line,
                 fmt::format("{} = {}: {}", to_string(key), bytes_text(write.transfer.value), why));
        continue;
      }
      const auto value = sdo_value_text(write.transfer.value, described(key)->type);
      line("  - {{{}, value: {}{}}}", object_text(key), *value,
           seen.insert(key).second ? "" : ", again: true");
    }
  }

  /// Returns the reason why a write can't be in the list `sdo`. Empty if it can.
  std::string why_not(const LearnedWrite& write) const {
    if (write.transfer.extent == SeenTransfer::Extent::in_parts) {
      return "parts of the value are not in the recording";
    }
    if (write.transfer.extent == SeenTransfer::Extent::too_long) {
      return "takt learn does not keep a value of this length";
    }
    const SubObject* sub = described(write.transfer.object);
    if (sub == nullptr) return "not in " + what_.dcf;
    if (sub->access == Access::ro || sub->access == Access::constant) {
      return "read-only in " + what_.dcf;
    }
    if (is_longer_than(write.transfer.value, sub->type)) {
      return "longer than its type in " + what_.dcf;
    }
    if (!sdo_value_text(write.transfer.value, sub->type))
      return "a network file can't hold this value";
    return {};
  }

  /// Returns true for the interpolation time period (0x60C2) of a drive if it equals the SYNC
  /// period, because takt sets this value by itself.
  bool is_own_cycle(ObjectKey key) const {
    if ((identity_of(values_).device_type & 0xFFFFU) != 402 || what_.sync_us == 0) return false;
    if (described({0x6040, 0}) == nullptr || described({0x6041, 0}) == nullptr) return false;
    if (first_axis(key.index) != 0x60C2) return false;
    const auto count = number({key.index, 1});
    const auto exponent = number({key.index, 2});
    if (key.sub > 2 || !count) return false;
    const int power = exponent ? static_cast<std::int8_t>(*exponent) : -3;
    const double us = static_cast<double>(*count) * std::pow(10.0, power + 6);
    return std::abs(us - static_cast<double>(what_.sync_us)) < 0.5;
  }

  /// Writes comments on SDO writes that are no part of a boot: the device refused them, or they
  /// came later.
  void remarks() {
    comment_writes(node_.refused, "refused by the device", [](const LearnedWrite& write) {
      return fmt::format("{:08X} {}", *write.transfer.abort_code,
                         abort_text(*write.transfer.abort_code));
    });
    comment_writes(node_.later, "sent while OPERATIONAL, so not part of the boot",
                   [](const LearnedWrite&) { return std::string{}; });
    if (!node_.boots.empty() && !node_.boots.back().started && !node_.boots.back().writes.empty()) {
      announce(
          Severity::warning, "not-started", node_.first_line,
          "the master did not start the node in this recording: the configuration may continue "
          "after its end");
    }
  }

  template <class Why>
  void comment_writes(const std::vector<LearnedWrite>& writes, std::string_view what,
                      const Why& why) {
    if (writes.empty()) return;
    line("# {}:", what);
    for (std::size_t i = 0; i < writes.size() && i < most_comments; ++i) {
      const LearnedWrite& write = writes[i];
      line("#   {} ={}  {}", to_string(write.transfer.object), bytes_text(write.transfer.value),
           why(write));
    }
    if (writes.size() > most_comments) line("#   and {} more", writes.size() - most_comments);
    announce(Severity::note, "no-part-of-the-boot", writes.front().line,
             fmt::format("{} SDO write{} {}: see the comments in the network file", writes.size(),
                         writes.size() == 1 ? "" : "s", what));
  }

  const NodeToWrite& what_;
  const LearnedNode& node_;
  const LearnedBus& bus_;
  Findings& findings_;
  LearnedValues values_;
  std::vector<LearnedWrite> configuration_;
  std::string unmapped_;
  std::string text_;
};

}  // namespace

std::string node_name(std::uint8_t id) { return fmt::format("node_{}", id); }

bool has_key_of_its_own(ObjectKey key) noexcept {
  static constexpr std::uint16_t indices[]{0x1005, 0x1006, 0x1007, 0x100C, 0x100D,
                                           0x1010, 0x1011, 0x1012, 0x1014, 0x1015,
                                           0x1016, 0x1017, 0x1019, 0x1020, 0x1029};
  return std::ranges::find(indices, key.index) != std::end(indices);
}

std::string node_text(const NodeToWrite& node, const LearnedBus& bus, Findings& findings) {
  return NodeText{node, bus, findings}.write();
}

}  // namespace takt::learn
