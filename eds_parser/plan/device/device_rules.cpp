#include "eds_parser/plan/device/device_rules.hpp"

#include <algorithm>
#include <optional>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

constexpr std::int64_t produce_bit = 0x4000'0000;

bool contains(const std::vector<NumberRange>& list, std::uint32_t number) {
  return std::ranges::any_of(list, [&](const NumberRange& one) { return one.contains(number); });
}

class Judge {
 public:
  Judge(const NodePdos& node, const MasterSpec& master, NetworkReport& report)
      : node_{node},
        spec_{*node.node.spec},
        data_{*node.node.data},
        master_{master},
        report_{report} {}

  void run() {
    for (const EffectivePdo& pdo : node_.pdos) {
      if (const PdoRule* rule = data_.rule(pdo.is_tpdo, pdo.number)) judge(pdo, *rule);
      if (pdo.is_tpdo && is_set(pdo, 3)) inhibit(pdo);
    }
    sync_producer();
  }

 private:
  void judge(const EffectivePdo& pdo, const PdoRule& rule) {
    if (is_set(pdo, 2)) type(pdo, rule);
    if (is_set(pdo, 5)) timer(pdo, rule);
    remote_requests(pdo, rule);
    if (!pdo.is_used()) return;
    entries(pdo, rule);
    gap(pdo, rule);
    answer(pdo, rule);
  }

  std::string label(const EffectivePdo& pdo) const { return pdo.label(spec_); }
  std::string source(const DeviceFact& fact) const { return data_.cite(fact); }
  const PdoSpec* spec_of(const EffectivePdo& pdo) const {
    return spec_.pdo(pdo.is_tpdo, pdo.number);
  }
  /// Returns true if the PDO is used, or if an `sdo:` entry writes the parameter `sub` of an unused
  /// PDO.
  bool is_set(const EffectivePdo& pdo, std::uint8_t sub) const {
    return pdo.is_used() || spec_.written({pdo.communication_index(), sub}) != nullptr;
  }
  /// Returns the place of the `sdo:` entry that writes the object, or `otherwise` if there is none.
  SourcePos sdo_pos(ObjectKey key, SourcePos otherwise) const {
    const SdoSpec* entry = spec_.written(key);
    return entry == nullptr ? otherwise : entry->pos;
  }

  template <class T>
  SourcePos pos_of(const EffectivePdo& pdo, Sourced<T> PdoSpec::* member, std::uint8_t sub) const {
    const PdoSpec* spec = spec_of(pdo);
    if (spec != nullptr && (spec->*member).given) return (spec->*member).pos;
    return sdo_pos({pdo.communication_index(), sub}, pdo.pos);
  }

  void type(const EffectivePdo& pdo, const PdoRule& rule) {
    if (rule.types.empty() || contains(rule.types, pdo.transmission)) return;
    report_.error(pos_of(pdo, &PdoSpec::transmission, 2), "device-data", label(pdo),
                  " can't have transmission type ", pdo.transmission, " on ", data_.name,
                  ", which allows only ", list_of(rule.types), source(rule.fact));
  }

  void timer(const EffectivePdo& pdo, const PdoRule& rule) {
    if (!rule.without_timer || pdo.event_timer == 0) return;
    report_.error(pos_of(pdo, &PdoSpec::event_timer, 5), "device-data", label(pdo),
                  " can't have an event timer (", pdo.event_timer, " ms) on ", data_.name,
                  source(rule.fact));
  }

  void remote_requests(const EffectivePdo& pdo, const PdoRule& rule) {
    if (!rule.without_rtr || (pdo.poll_ms == 0 && pdo.poll_syncs == 0)) return;
    const PdoSpec* spec = spec_of(pdo);
    if (spec == nullptr) return;
    const SourcePos pos = spec->poll_ms.given ? spec->poll_ms.pos : spec->poll_syncs.pos;
    report_.error(pos, "device-data", label(pdo), " can't be polled: ", data_.name,
                  " answers no remote request", source(rule.fact));
  }

  void entries(const EffectivePdo& pdo, const PdoRule& rule) {
    const SubObject* count = node_.node.dictionary->find(ObjectKey{pdo.mapping_index(), 0});
    if (!rule.no_more_entries || count == nullptr || pdo.mpdo != Mpdo::none) return;
    const auto most = integer_of(count->default_value);
    if (!most || std::ssize(pdo.mapping) <= *most) return;
    const PdoSpec* spec = spec_of(pdo);
    const bool given = spec != nullptr && spec->mapping.given;
    report_.error(given ? spec->mapping.pos : sdo_pos({pdo.mapping_index(), 0}, pdo.pos),
                  "device-data", label(pdo), " can't map ", pdo.mapping.size(), " objects on ",
                  data_.name, ", only the ", *most, " of its default mapping", source(rule.fact));
  }

  void gap(const EffectivePdo& pdo, const PdoRule& rule) {
    const auto is_before = [&](const EffectivePdo& other) {
      return other.is_tpdo == pdo.is_tpdo && other.number + 1 == pdo.number && other.is_used();
    };
    if (!rule.no_gaps || pdo.number == 1 || std::ranges::any_of(node_.pdos, is_before)) return;
    report_.error(pdo.pos, "device-data", label(pdo), " can't be used without ",
                  pdo.is_tpdo ? "TPDO" : "RPDO", pdo.number - 1, " on ", data_.name,
                  source(rule.fact));
  }

  /// Warns if the device sends a TPDO only as an answer to an RPDO, but no RPDO requests it.
  void answer(const EffectivePdo& pdo, const PdoRule& rule) {
    if (!pdo.is_tpdo || pdo.event_timer != 0 || !contains(rule.answers, pdo.transmission)) return;
    const auto asks = [&](const EffectivePdo& other) {
      return !other.is_tpdo && other.number == pdo.number && other.is_used();
    };
    if (std::ranges::any_of(node_.pdos, asks)) return;
    const std::string rpdo = concat("RPDO", pdo.number);
    report_.warning(pos_of(pdo, &PdoSpec::transmission, 2), "device-data", label(pdo),
                    " of transmission type ", pdo.transmission, " is sent only as the answer to ",
                    rpdo, ", which is off, so the device never sends it. Switch ", rpdo, " on",
                    other_type(rule), source(rule.fact));
  }

  /// Returns `, or write "transmission: 254"` if the device supports another type, else an empty
  /// text.
  static std::string other_type(const PdoRule& rule) {
    const auto works = [&](std::uint32_t type) {
      const bool known = rule.types.empty() || contains(rule.types, type);
      return known && !contains(rule.answers, type);
    };
    if (works(254)) return ", or write `transmission: 254` (on change)";
    return works(1) ? ", or write `transmission: 1` (every SYNC)" : "";
  }

  /// Checks an inhibit time. The network file counts in 100 us, as CiA 301 does; the device counts
  /// in its own unit.
  void inhibit(const EffectivePdo& pdo) {
    const InhibitRule& rule = data_.inhibit;
    const PdoSpec* spec = spec_of(pdo);
    const bool given = spec != nullptr && spec->inhibit_time.given;
    const std::uint64_t us =
        given ? std::uint64_t{*spec->inhibit_time} * 100 : rule.us(pdo.inhibit_time);
    const ObjectKey key{pdo.communication_index(), 3};
    const SourcePos pos = pos_of(pdo, &PdoSpec::inhibit_time, 3);
    if (!given && pos == pdo.pos) return;  // A default of the device file is not checked.
    const auto refuse = [&](const auto&... why) {
      report_.error(pos, "device-data", "the inhibit time of ", label(pdo), why...);
    };
    if (us % rule.unit_us != 0) {
      refuse(" is ", microseconds_text(us), "; ", data_.name, " counts ", key, " in ",
             microseconds_text(rule.unit_us), source(rule.fact));
    } else if (us < rule.us(rule.least)) {
      refuse(" is ", microseconds_text(us), "; ", data_.name, " takes no less than ",
             microseconds_text(rule.us(rule.least)), source(rule.fact));
    } else if (us / rule.unit_us > 0xFFFF) {
      refuse(" does not fit into ", key);
    }
  }

  /// Returns the place where the network file makes this node the SYNC producer.
  std::optional<SourcePos> producer_request() const {
    const Sourced<std::string>& source = master_.sync_source;
    if (source.given && *source == spec_.name) return source.pos;
    for (const SdoSpec& sdo : spec_.sdo) {
      const std::int64_t* value = sdo.integer();
      if (sdo.object == ObjectKey{0x1005, 0} && value != nullptr && (*value & produce_bit) != 0) {
        return sdo.value_pos;
      }
    }
    return std::nullopt;
  }

  void sync_producer() {
    const std::optional<SourcePos> request = producer_request();
    if (!request || !data_.sync.own_tpdos_from) return;
    const Firmware needed = *data_.sync.own_tpdos_from;
    const auto firmware = node_.node.firmware;
    const auto synchronous = std::ranges::find_if(node_.pdos, [](const EffectivePdo& pdo) {
      const bool by_sync = pdo.synchronous() || pdo.transmission == 252;
      return pdo.is_tpdo && pdo.use == PdoUse::exchanged && by_sync;
    });
    if (synchronous == node_.pdos.end()) return;
    const std::string what =
        label(*synchronous) + " is synchronous, and this node produces the SYNC";
    sync_identifier(what);
    if (firmware && *firmware >= needed) return;
    if (!firmware) {
      report_.warning(*request, "device-data", what, ": this needs firmware ", needed,
                      " or newer; write the version of the device under `firmware:`",
                      source(data_.sync.fact));
      return;
    }
    report_.error(*request, "device-data", what, ": ", data_.name, " with firmware ", *firmware,
                  " does not send the TPDO in this case; the oldest firmware that does is ", needed,
                  source(data_.sync.fact));
  }

  /// Returns the identifier in 0x1005, on which the device receives SYNC.
  std::int64_t received_sync() const {
    const std::int64_t* value = spec_.written_integer({0x1005, 0});
    return value == nullptr ? *master_.sync_cob_id : *value & 0x7FF;
  }

  void sync_identifier(const std::string& what) {
    if (data_.sync.tx_identifier == 0) return;
    const SdoSpec* entry = spec_.written({data_.sync.tx_identifier, 0});
    const std::int64_t* sent = entry == nullptr ? nullptr : entry->integer();
    if (sent == nullptr || *sent == received_sync()) return;
    report_.error(entry->value_pos, "device-data", what, " on ",
                  hex(static_cast<std::uint32_t>(*sent), 3), ", but receives it on ",
                  hex(static_cast<std::uint32_t>(received_sync()), 3), ": ", data_.name,
                  " does not send the TPDO in this case", source(data_.sync.fact));
  }

  const NodePdos& node_;
  const NodeSpec& spec_;
  const DeviceData& data_;
  const MasterSpec& master_;
  NetworkReport& report_;
};

}  // namespace

void judge_by_device_data(const NodePdos& node, const MasterSpec& master, NetworkReport& report) {
  if (node.node.data == nullptr) return;
  judge_node_by_device_data(node.node, report);
  Judge{node, master, report}.run();
}

}  // namespace takt
