#include <algorithm>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

using enum Severity;

bool is_on_request(unsigned type) noexcept { return type == 252 || type == 253; }

std::string_view what_sends(unsigned type) {
  return is_on_request(type) ? ", which is sent on remote request only"
                             : ", which follows the SYNC";
}

/// Checks the communication record of one PDO.
class CommunicationCheck {
 public:
  CommunicationCheck(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report)
      : dictionary_{dictionary},
        pdo_{pdo},
        report_{report},
        type_{pdo.transmission_type.value_or(0)} {}

  void run() {
    check_transmission();
    if (!pdo_.is_tpdo) return;
    check_inhibit_use();
    check_event_timer();
    check_remote();
  }

 private:
  /// Reports a finding at a sub-object of the record.
  template <class... Parts>
  void add(Severity severity, std::string_view rule, std::uint8_t sub_index,
           const Parts&... parts) {
    const ObjectKey key{pdo_.communication_index(), sub_index};
    const auto* sub = dictionary_.find(key);
    const SourcePos pos = sub != nullptr ? sub->value_pos() : dictionary_.find(key.index)->pos;
    report_.add(severity, pos, rule, section_name(key), parts...);
  }

  /// Checks the transmission type. CiA 301, tables 69 and 72.
  void check_transmission() {
    const unsigned first_event = pdo_.is_tpdo ? 252 : 254;
    if (type_ > 240 && type_ < first_event) {
      add(error, "pdo-transmission-type", 2, ": transmission type ", type_, " is reserved for ",
          pdo_.is_tpdo ? "TPDOs (0..240, 252..255)" : "RPDOs (0..240, 254, 255)");
    }
    if (pdo_.sync_start.value_or(0) > 240) {
      add(error, "pdo-sync-start", 6, ": the SYNC start value is 0..240");
    }
    if (!pdo_.is_tpdo && pdo_.inhibit_time_us != 0) {
      add(note, "pdo-inhibit-of-rpdo", 3, ": the inhibit time of an RPDO has no effect");
    }
  }

  void check_inhibit_use() {
    if (!pdo_.transmission_type || pdo_.inhibit_time_us == 0) return;
    if (type_ > 240 && !is_on_request(type_)) return;
    add(note, "pdo-inhibit-unused", 3, ": the inhibit time has no effect with transmission type ",
        type_, what_sends(type_));
  }

  /// Checks the event timer of a TPDO. CiA 301, 7.5.2.37.
  void check_event_timer() {
    if (pdo_.event_timer_ms == 0) return;
    if ((type_ >= 1 && type_ <= 240) || is_on_request(type_)) {
      add(note, "pdo-event-timer-unused", 5,
          ": the event timer has no effect with transmission type ", type_, what_sends(type_));
    } else if (pdo_.inhibit_time_us > pdo_.event_timer_ms * 1000U) {
      add(warning, "pdo-inhibit-too-long", 3, ": the inhibit time of ", pdo_.inhibit_time_us / 100,
          " x 100 us is longer than the event timer of ", pdo_.event_timer_ms,
          " ms, so the device can't keep the event timer");
    }
  }

  /// Checks the types that are sent only on remote request. CiA 301, 7.5.2.37.
  void check_remote() {
    if (!is_on_request(type_) || !pdo_.valid || pdo_.rtr_allowed) return;
    add(warning, "pdo-rtr", 2, ": transmission type ", type_,
        " sends on remote request only, which bit 30 of ",
        section_name({pdo_.communication_index(), 1}), " does not allow; the PDO is never sent");
  }

  const ObjectDictionary& dictionary_;
  const PdoDescription& pdo_;
  Report& report_;
  unsigned type_;  ///< transmission type; 0 if it has no value
};

void check_partners(const ObjectDictionary& dictionary, Report& report) {
  for (const auto& object : dictionary.objects) {
    const bool mapping = is_pdo_mapping(object.index);
    if (!mapping && !is_pdo_communication(object.index)) continue;
    const auto partner = static_cast<std::uint16_t>(object.index + (mapping ? -0x200 : 0x200));
    if (dictionary.find(partner) != nullptr) continue;
    report.warning(object.pos, "pdo-half", Hex{object.index}, " has no ",
                   mapping ? "communication" : "mapping", " record ", Hex{partner},
                   ", so the PDO is incomplete");
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
  report.warning(pos, "pdo-count", is_tpdo ? "NrOfTXPDO" : "NrOfRXPDO",
                 pos == device.pos ? " is missing" : concat(" is ", declared), ", but ", found,
                 " are described; takt uses the described PDOs");
}

void check_granularity(const ObjectDictionary& dictionary, Report& report) {
  if (dictionary.device.granularity != 0) return;
  const Object* record = mappable_record(dictionary);
  if (record == nullptr) return;
  report.warning(dictionary.device.granularity_pos, "granularity",
                 "Granularity 0 says that the mapping of PDOs is fixed, but ",
                 ObjectKey{record->index, 0}, " can be written; takt follows the record");
}

}  // namespace

void check_pdos(const ObjectDictionary& dictionary, Report& report) {
  const auto pdos = describe_pdos(dictionary);
  for (const auto& pdo : pdos) {
    CommunicationCheck{dictionary, pdo, report}.run();
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
