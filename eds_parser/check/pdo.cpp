#include <algorithm>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

bool within(std::uint16_t index, unsigned first) noexcept {
  return index >= first && index < first + 512;
}

SourcePos pos_of(const ObjectDictionary& dictionary, ObjectKey key) {
  if (const auto* sub = dictionary.find(key)) return sub->value_pos();
  const auto* object = dictionary.find(key.index);
  return object == nullptr ? SourcePos{} : object->pos;
}

/// Checks the transmission type. CiA 301, tables 69 and 72.
void check_transmission(const ObjectDictionary& dictionary, const PdoDescription& pdo,
                        Report& report) {
  const ObjectKey key{pdo.communication_index(), 2};
  const unsigned type = pdo.transmission_type.value_or(0);
  const unsigned first_event = pdo.is_tpdo ? 252 : 254;
  if (type > 240 && type < first_event) {
    report.error(pos_of(dictionary, key), "pdo-transmission-type",
                 section_name(key) + ": transmission type " + std::to_string(type) +
                     " is reserved for " +
                     (pdo.is_tpdo ? "TPDOs (0..240, 252..255)" : "RPDOs (0..240, 254, 255)"));
  }
  if (pdo.sync_start.value_or(0) > 240) {
    const ObjectKey start{pdo.communication_index(), 6};
    report.error(pos_of(dictionary, start), "pdo-sync-start",
                 section_name(start) + ": the SYNC start value is 0..240");
  }
  if (!pdo.is_tpdo && pdo.inhibit_time_us != 0) {
    const ObjectKey inhibit{pdo.communication_index(), 3};
    report.note(pos_of(dictionary, inhibit), "pdo-inhibit-of-rpdo",
                section_name(inhibit) + ": the inhibit time of an RPDO has no effect");
  }
}

bool is_on_request(unsigned type) noexcept { return type == 252 || type == 253; }

std::string what_sends(unsigned type) {
  return is_on_request(type) ? ", which is sent on remote request only"
                             : ", which follows the SYNC";
}

void check_inhibit_use(const ObjectDictionary& dictionary, const PdoDescription& pdo,
                       ObjectKey inhibit, Report& report) {
  if (!pdo.transmission_type || pdo.inhibit_time_us == 0) return;
  const unsigned type = *pdo.transmission_type;
  if (type > 240 && !is_on_request(type)) return;
  report.note(pos_of(dictionary, inhibit), "pdo-inhibit-unused",
              section_name(inhibit) + ": the inhibit time has no effect with transmission type " +
                  std::to_string(type) + what_sends(type));
}

/// Checks the inhibit time and the event timer of a TPDO. CiA 301, 7.5.2.37.
void check_times(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  if (!pdo.is_tpdo) return;
  const ObjectKey inhibit{pdo.communication_index(), 3};
  check_inhibit_use(dictionary, pdo, inhibit, report);
  if (pdo.event_timer_ms == 0) return;
  const ObjectKey timer{pdo.communication_index(), 5};
  const unsigned type = pdo.transmission_type.value_or(0);
  if ((type >= 1 && type <= 240) || is_on_request(type)) {
    report.note(pos_of(dictionary, timer), "pdo-event-timer-unused",
                section_name(timer) + ": the event timer has no effect with transmission type " +
                    std::to_string(type) + what_sends(type));
  } else if (pdo.inhibit_time_us > pdo.event_timer_ms * 1000U) {
    report.warning(pos_of(dictionary, inhibit), "pdo-inhibit-too-long",
                   section_name(inhibit) + ": the inhibit time of " +
                       std::to_string(pdo.inhibit_time_us / 100) + " x 100 us is longer than " +
                       "the event timer of " + std::to_string(pdo.event_timer_ms) +
                       " ms, so the device can't keep the event timer");
  }
}

/// Checks the types that are sent only on remote request. CiA 301, 7.5.2.37.
void check_remote(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  const unsigned type = pdo.transmission_type.value_or(0);
  const bool on_request = pdo.is_tpdo && is_on_request(type);
  if (!on_request || !pdo.valid || pdo.rtr_allowed) return;
  const ObjectKey key{pdo.communication_index(), 2};
  report.warning(pos_of(dictionary, key), "pdo-rtr",
                 section_name(key) + ": transmission type " + std::to_string(type) +
                     " sends on remote request only, which bit 30 of " +
                     section_name({key.index, 1}) + " does not allow; the PDO is never sent");
}

void check_partners(const ObjectDictionary& dictionary, Report& report) {
  for (const auto& object : dictionary.objects) {
    const bool mapping = within(object.index, 0x1600) || within(object.index, 0x1A00);
    const bool communication = within(object.index, 0x1400) || within(object.index, 0x1800);
    if (!mapping && !communication) continue;
    const auto partner = static_cast<std::uint16_t>(object.index + (mapping ? -0x200 : 0x200));
    if (dictionary.find(partner) != nullptr) continue;
    report.warning(object.pos, "pdo-half",
                   hex(object.index) + " has no " + (mapping ? "communication" : "mapping") +
                       " record " + hex(partner) + ", so the PDO is incomplete");
  }
}

/// Compares NrOfRXPDO or NrOfTXPDO with the records found. Records that CompactPDO implies are
/// included.
void check_number(const ObjectDictionary& dictionary, bool is_tpdo, std::size_t found,
                  Report& report) {
  const auto& device = dictionary.device;
  const std::size_t declared = is_tpdo ? device.nr_tx_pdo : device.nr_rx_pdo;
  if (declared == found || device.pos.line == 0) return;
  const SourcePos pos = is_tpdo ? device.nr_tx_pdo_pos : device.nr_rx_pdo_pos;
  report.warning(pos, "pdo-count",
                 std::string{is_tpdo ? "NrOfTXPDO" : "NrOfRXPDO"} +
                     (pos == device.pos ? " is missing" : " is " + std::to_string(declared)) +
                     ", but " + std::to_string(found) +
                     " are described; takt uses the described PDOs");
}

void check_granularity(const ObjectDictionary& dictionary, Report& report) {
  if (dictionary.device.granularity != 0) return;
  const Object* record = mappable_record(dictionary);
  if (record == nullptr) return;
  report.warning(dictionary.device.granularity_pos, "granularity",
                 "Granularity 0 says that the mapping of PDOs is fixed, but " +
                     to_string(ObjectKey{record->index, 0}) +
                     " can be written; takt follows the record");
}

}  // namespace

void check_pdos(const ObjectDictionary& dictionary, Report& report) {
  const auto pdos = describe_pdos(dictionary);
  for (const auto& pdo : pdos) {
    check_transmission(dictionary, pdo, report);
    check_times(dictionary, pdo, report);
    check_remote(dictionary, pdo, report);
    check_mapping(dictionary, pdo, report);
  }
  check_partners(dictionary, report);
  check_granularity(dictionary, report);
  const auto tpdos =
      static_cast<std::size_t>(std::ranges::count_if(pdos, &PdoDescription::is_tpdo));
  check_number(dictionary, false, pdos.size() - tpdos, report);
  check_number(dictionary, true, tpdos, report);
}

}  // namespace takt
