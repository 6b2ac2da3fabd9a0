#include "eds_parser/plan/pdo/pdo_compiler.hpp"

#include <algorithm>
#include <ranges>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"
#include "eds_parser/plan/pdo/pdo_rules.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

constexpr std::uint8_t event_driven = 255;
constexpr std::uint8_t dam_mpdo = 0xFF;
constexpr std::uint8_t sam_mpdo = 0xFE;

bool writes_pdo(const SdoSpec& sdo) {
  return is_pdo_parameter(sdo.object.index) && sdo.integer() != nullptr;
}

bool on_remote_request(std::uint8_t type) { return type == 252 || type == 253; }

bool usable_type(const EffectivePdo& pdo) {
  return pdo.transmission <= 240 || pdo.transmission >= (pdo.is_tpdo ? 252 : 254);
}

Mpdo mpdo_of(const PdoDescription& device) {
  if (device.mapping_count == sam_mpdo) return Mpdo::sam;
  return device.mapping_count == dam_mpdo ? Mpdo::dam : Mpdo::none;
}

class PdoCompiler {
 public:
  PdoCompiler(const NodeSource& node, NetworkReport& report) : node_{node}, report_{report} {}

  EffectivePdo compile(const PdoDescription& device, const PdoSpec* spec) {
    EffectivePdo pdo = of_device(device);
    if (spec != nullptr) {
      overlay(device, *spec, pdo);
    } else {
      if (!device.valid) pdo.use = is_turned_off(pdo) ? PdoUse::off : PdoUse::ignored;
      judge_written_type(pdo);
      judge_unnamed(device, pdo);
    }
    return pdo;
  }

  /// Reports in one message all PDOs that are switched on and have an empty mapping.
  void report_unmapped() {
    if (unmapped_.empty()) return;
    constexpr std::size_t most_named = 8;
    std::string list = unmapped_[0];
    for (const std::string& pdo : unmapped_ | std::views::take(most_named) | std::views::drop(1)) {
      list += ", " + pdo;
    }
    if (unmapped_.size() > most_named) list += concat(", ... (", unmapped_.size(), " in all)");
    report_.note(node_.spec->pos, "pdo-left-out", list, " of node `", node_.spec->name,
                 "`: valid in ", node_.dictionary->file,
                 ", but without mapped objects; not part of the image");
  }

 private:
  std::string label(const EffectivePdo& pdo) const { return pdo.label(*node_.spec); }

  bool is_writable(std::uint16_t index, std::uint8_t sub_index) const {
    const SubObject* sub = node_.dictionary->find(ObjectKey{index, sub_index});
    return sub != nullptr && sub->is_writable();
  }

  /// Returns true if an `sdo:` entry or a ParameterValue, and not only the default, switches the
  /// PDO off.
  bool is_turned_off(const EffectivePdo& pdo) const {
    const ObjectKey key{pdo.communication_index(), 1};
    const SubObject* cob_id = node_.dictionary->find(key);
    const bool by_dcf = node_.dictionary->is_dcf && cob_id != nullptr && cob_id->parameter_value &&
                        cob_id->is_configurable();
    return by_dcf || node_.spec->written(key) != nullptr;
  }

  EffectivePdo of_device(const PdoDescription& device) const {
    EffectivePdo pdo;
    pdo.number = device.number;
    pdo.is_tpdo = device.is_tpdo;
    pdo.pos = node_.spec->pos;
    pdo.cob_id_pos = node_.spec->pos;
    const std::uint16_t index = device.communication_index();
    pdo.transmission = device.transmission_type.value_or(event_driven);
    pdo.inhibit_time = static_cast<std::uint16_t>(device.inhibit_time_us / 100);
    if (node_.data != nullptr) {
      pdo.inhibit_unit_us = node_.data->inhibit.unit_us;
      const PdoRule* rule = node_.data->rule(device.is_tpdo, device.number);
      pdo.on_request = rule != nullptr && rule->function == PdoFunction::parameter_channel;
    }
    pdo.event_timer = device.event_timer_ms;
    pdo.sync_start = device.sync_start.value_or(0);
    pdo.has_inhibit = is_writable(index, 3) && device.is_tpdo;
    pdo.has_event_timer = is_writable(index, 5);
    pdo.has_sync_start = is_writable(index, 6) && device.is_tpdo;
    pdo.fixed_mapping = !is_writable(device.mapping_index(), 0);
    pdo.mapping = mapping_of(node_, device, node_.spec->pos);
    pdo.bits = device.bits;
    take_cob_id(device, pdo);
    return pdo;
  }

  static void take_cob_id(const PdoDescription& device, EffectivePdo& pdo) {
    const auto id = device.cob_id();
    if (!id || *id == 0) {
      pdo.origin = CobIdOrigin::automatic;
      return;
    }
    pdo.has_cob_id = true;
    pdo.cob_id = device.extended ? CobId::extended(*id) : CobId::base(*id);
  }

  /// Checks a transmission type that an `sdo:` entry writes, even for an unused PDO. If the device
  /// data list the allowed types, the rules of the device data apply instead.
  void judge_written_type(const EffectivePdo& pdo) {
    const SdoSpec* entry = node_.spec->written({pdo.communication_index(), 2});
    if (entry == nullptr || usable_type(pdo)) return;
    const PdoRule* rule =
        node_.data == nullptr ? nullptr : node_.data->rule(pdo.is_tpdo, pdo.number);
    if (rule != nullptr && !rule->types.empty()) return;
    report_.error(entry->value_pos, "transmission-type", label(pdo),
                  " can't have transmission type ", pdo.transmission,
                  pdo.transmission < 252 ? ": 241..251 are reserved"
                                         : ": only a TPDO is sent on remote request");
  }

  /// Decides whether takt uses a PDO that only the device file mentions. A PDO that takt can't use
  /// is left out with a note.
  void judge_unnamed(const PdoDescription& device, EffectivePdo& pdo) {
    if (pdo.use != PdoUse::exchanged) return;
    const auto leave_out = [&](const auto&... why) {
      pdo.use = PdoUse::ignored;
      report_.note(node_.spec->pos, "pdo-left-out", label(pdo), " is valid in ",
                   node_.dictionary->file, " but ", why..., "; it is not part of the image");
    };
    if (device.mapping_count == dam_mpdo || device.mapping_count == sam_mpdo) {
      leave_out("is a multiplexed PDO: write it with `mpdo:` and its objects under `mapping:`");
    } else if (!usable_type(pdo)) {
      leave_out("has transmission type ", pdo.transmission);
    } else if (on_remote_request(pdo.transmission)) {
      leave_out("has transmission type ", pdo.transmission,
                " (sent on remote request): write it with `poll_ms:` or `poll_syncs:`");
    } else if (pdo.mapping.empty()) {
      pdo.use = PdoUse::ignored;
      unmapped_.push_back(pdo.label());
    } else if (pdo.bits > 64) {
      leave_out("maps ", pdo.bits, " bits, more than 64");
    } else if (std::ranges::any_of(pdo.mapping, [](const auto& e) { return e.bits == 0; })) {
      leave_out("maps an entry of 0 bits");
    }
  }

  void overlay(const PdoDescription& device, const PdoSpec& spec, EffectivePdo& pdo) {
    pdo.named = true;
    pdo.pos = spec.pos;
    pdo.cob_id_pos = spec.cob_id.given ? spec.cob_id.pos : spec.pos;
    if (!*spec.enabled) {
      pdo.use = PdoUse::off;
      judge_written_type(pdo);
      return;
    }
    overlay_cob_id(spec, pdo);
    overlay_times(spec, pdo);
    overlay_requests(spec, pdo);
    pdo.mpdo = spec.mpdo.given ? *spec.mpdo : mpdo_of(device);
    if (pdo.mpdo != Mpdo::none) {
      overlay_mpdo(spec, pdo);
    } else if (spec.mapping.given) {
      overlay_mapping(spec, pdo);
    } else {
      for (EffectiveEntry& entry : pdo.mapping) entry.pos = spec.pos;
    }
    judge_named(spec, pdo);
  }

  void overlay_cob_id(const PdoSpec& spec, EffectivePdo& pdo) {
    if (!spec.cob_id.given) return;
    if (!spec.cob_id.value) {
      pdo.has_cob_id = false;
      pdo.origin = CobIdOrigin::automatic;
      return;
    }
    const FileCobId file = read_cob_id_bits(spec, pdo.is_tpdo, label(pdo), report_);
    if (file.off) pdo.use = PdoUse::off;
    if (!file.id) return;
    pdo.has_cob_id = true;
    pdo.origin = CobIdOrigin::network_file;
    pdo.cob_id = *file.id;
  }

  /// Takes over the times of the network file. As in dcfgen, event_timer is a time of the sender
  /// and event_deadline a time of the receiver.
  void overlay_times(const PdoSpec& spec, EffectivePdo& pdo) {
    pdo.transmission = spec.transmission.value_or(pdo.transmission);
    if (pdo.is_tpdo) {
      if (spec.inhibit_time.given) {
        pdo.inhibit_time =
            static_cast<std::uint16_t>(*spec.inhibit_time * 100U / pdo.inhibit_unit_us);
      }
      pdo.event_timer = spec.event_timer.value_or(pdo.event_timer);
      pdo.sync_start = spec.sync_start.value_or(pdo.sync_start);
      pdo.master_timer = *spec.event_deadline;
      demand(spec.inhibit_time, pdo, 3, "inhibit_time", pdo.has_inhibit);
      demand(spec.event_timer, pdo, 5, "event_timer", pdo.has_event_timer);
      demand(spec.sync_start, pdo, 6, "sync_start", pdo.has_sync_start);
      return;
    }
    pdo.event_timer = spec.event_deadline.value_or(pdo.event_timer);
    pdo.master_timer = *spec.event_timer;
    pdo.master_inhibit = *spec.inhibit_time;
    demand(spec.event_deadline, pdo, 5, "event_deadline", pdo.has_event_timer);
    if (spec.sync_start.given && *spec.sync_start != 0) {
      report_.error(spec.sync_start.pos, "wrong-direction", "`sync_start` of ", label(pdo),
                    ": only a TPDO has a SYNC start value");
    }
  }

  void overlay_requests(const PdoSpec& spec, EffectivePdo& pdo) {
    pdo.poll_ms = *spec.poll_ms;
    pdo.poll_syncs = *spec.poll_syncs;
    pdo.drop_late = *spec.drop_late;
    pdo.on_request = spec.on_request.value_or(pdo.on_request);
    const bool asked = pdo.poll_ms != 0 || pdo.poll_syncs != 0;
    pdo.rtr = asked || on_remote_request(pdo.transmission);
    if (asked && pdo.is_tpdo && pdo.synchronous()) {
      report_.warning(spec.pos, "transmission-type", label(pdo), " is polled, but has type ",
                      pdo.transmission,
                      ": few devices answer remote requests for types other than 252..255");
    }
    if (!asked && on_remote_request(pdo.transmission)) {
      report_.note(spec.pos, "not-polled", label(pdo), " has type ", pdo.transmission,
                   " and is sent on remote request only: the master polls it only when an "
                   "application requests it (or with `poll_ms:` or `poll_syncs:`)");
    }
  }

  /// Multiplexed PDOs are event-driven. Their objects are not in the mapping record.
  void overlay_mpdo(const PdoSpec& spec, EffectivePdo& pdo) {
    pdo.mapping = compile_mpdo(node_, pdo, spec.mapping, report_);
    pdo.bits = 64;
    if (pdo.transmission < 254) {
      report_.error(spec.transmission.given ? spec.transmission.pos : spec.pos, "transmission-type",
                    label(pdo), " is multiplexed: write `transmission` 254 or 255 (by event)");
    }
  }

  template <class T>
  void demand(const Sourced<T>& value, const EffectivePdo& pdo, std::uint8_t sub_index,
              const char* key, bool has) {
    if (!value.given || *value == 0 || has) return;
    report_.error(value.pos, "no-such-object", "`", key, "` of ", label(pdo), " needs ",
                  ObjectKey{pdo.communication_index(), sub_index}, ", which ",
                  node_.dictionary->file, " does not have as a writable object");
  }

  void overlay_mapping(const PdoSpec& spec, EffectivePdo& pdo) {
    std::vector<EffectiveEntry> wanted = compile_mapping(node_, pdo, spec.mapping, report_);
    const bool complete = wanted.size() == spec.mapping->size();
    const bool same =
        std::ranges::equal(wanted, pdo.mapping, {}, &EffectiveEntry::raw, &EffectiveEntry::raw);
    if (pdo.fixed_mapping && complete && !same) {
      std::string fixed;
      for (const EffectiveEntry& entry : pdo.mapping) {
        fixed += (fixed.empty() ? "" : ", ") + takt::label(*node_.dictionary, entry.object);
      }
      report_.error(spec.mapping.pos, "fixed-mapping", label(pdo),
                    " can't be remapped, it is fixed in the device ",
                    fixed.empty() ? "without objects" : "to: " + fixed);
    }
    const Object* record = node_.dictionary->find(pdo.mapping_index());
    const std::size_t places =
        record == nullptr ? 0
                          : static_cast<std::size_t>(std::ranges::count_if(
                                record->subs, [](const SubObject& s) { return s.sub != 0; }));
    if (!pdo.fixed_mapping && wanted.size() > places) {
      report_.error(spec.mapping.pos, "too-many", label(pdo), " maps ", wanted.size(), " objects, ",
                    hex(pdo.mapping_index()), " of ", node_.dictionary->file, " has room for ",
                    places);
    }
    pdo.mapping = std::move(wanted);
    pdo.bits = 0;
    for (const EffectiveEntry& entry : pdo.mapping) pdo.bits += entry.bits;
  }

  void judge_named(const PdoSpec& spec, EffectivePdo& pdo) {
    if (pdo.use == PdoUse::off) return;
    if (pdo.on_request && pdo.mapping.empty()) {
      pdo.fixed_mapping = true;  // The device does not describe the content of the PDO.
      pdo.bits = 64;
    } else if (pdo.mapping.empty() && (!spec.mapping.given || spec.mapping->empty())) {
      report_.error(
          spec.mapping.given ? spec.mapping.pos : spec.pos, "maps-nothing", label(pdo),
          " maps no objects: list them under `mapping:`, or switch it off with `enabled: false`");
    }
    if (!spec.transmission.given && !usable_type(pdo)) {
      report_.error(spec.pos, "transmission-type", label(pdo), " has transmission type ",
                    pdo.transmission, " in ", node_.dictionary->file,
                    ", which takt does not use: write `transmission:` 0..240, 254 or 255");
    }
    if (!spec.mapping.given && pdo.bits > 64) {
      report_.error(spec.pos, "too-long", label(pdo), " maps ", pdo.bits, " bits in ",
                    node_.dictionary->file, ", a PDO holds 64: write `mapping:`");
    }
    if (pdo.bits > 64) pdo.use = PdoUse::ignored;
  }

  const NodeSource& node_;
  NetworkReport& report_;
  std::vector<std::string> unmapped_;
};

/// Returns the dictionary with the values that `sdo:` writes into PDO parameters (0x1400..0x1BFF).
/// The PDOs are then compiled as the device will have them.
ObjectDictionary with_pdo_writes(const ObjectDictionary& dictionary, const NodeSpec& spec) {
  ObjectDictionary copy = dictionary;
  for (const SdoSpec& sdo : spec.sdo) {
    const auto object = std::ranges::find(copy.objects, sdo.object.index, &Object::index);
    if (!writes_pdo(sdo) || object == copy.objects.end()) continue;
    for (SubObject& sub : object->subs) {
      if (sub.sub == sdo.object.sub)
        sub.parameter_value = static_cast<std::uint64_t>(*sdo.integer());
    }
  }
  return copy;
}

/// Returns the PDOs as the device file and `sdo:` configure them.
std::vector<PdoDescription> configured_pdos(const NodeSource& node) {
  if (std::ranges::none_of(node.spec->sdo, writes_pdo)) return describe_pdos(*node.dictionary);
  return describe_pdos(with_pdo_writes(*node.dictionary, *node.spec));
}

}  // namespace

std::vector<EffectivePdo> compile_pdos(const NodeSource& node, NetworkReport& report) {
  const std::vector<PdoDescription> devices = configured_pdos(node);
  std::vector<EffectivePdo> pdos;
  PdoCompiler compiler{node, report};
  report_missing_pdos(node, false, devices, report);
  report_missing_pdos(node, true, devices, report);
  for (const PdoDescription& device : devices) {
    pdos.push_back(compiler.compile(device, node.spec->pdo(device.is_tpdo, device.number)));
  }
  compiler.report_unmapped();
  check_request_pairs(node, pdos, report);
  return pdos;
}

}  // namespace takt
