#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {
namespace {

constexpr std::uint32_t all_but_rtr = 0xBFFF'FFFF;

class PdoBoot : BootPart {
 public:
  PdoBoot(const BootPart& part, const EffectivePdo& pdo) : BootPart{part}, pdo_{pdo} {}

  /// Compares and configures first the mapping, then the communication parameters. To write the
  /// mapping, the boot switches the PDO off. The comparison of the COB-ID then fails, so the steps
  /// for the communication parameters switch the PDO on again.
  void exchange() {
    const std::size_t first = steps.size();
    append_exchange();
    mark_running(first);
  }

  void switch_off() {
    if (!steps.has(cob_id_key())) return;
    steps.integer(BootAction::compare, cob_id_key(), cob_id_off, pdo_.label() + " off?").mask =
        cob_id_off;
    const std::size_t skip = steps.skip_if_same(pdo_.label() + " is off");
    disable();
    steps.land(skip);
  }

 private:
  void append_exchange() {
    if (!pdo_.fixed_mapping) {
      mapping_steps(BootAction::compare, "");
      const std::size_t skip = steps.skip_if_same(pdo_.label() + " already has this mapping");
      disable();
      write_mapping();
      steps.land(skip);
    }
    compare_communication();
    if (pdo_.fixed_mapping) mapping_steps(BootAction::compare, "");
    const std::size_t skip = steps.skip_if_same(pdo_.label() + " is already configured");
    disable();
    write_parameters();
    if (steps.writable(cob_id_key())) {
      // If the master polls the PDO by remote request, bit 30 must be clear. Otherwise the bit
      // keeps the value of the device.
      steps.integer(pdo_.rtr ? BootAction::write : BootAction::enable_pdo, cob_id_key(),
                    cob_id_value(),
                    pdo_.label() + " on, COB-ID " + to_string(pdo_.cob_id) +
                        (pdo_.rtr ? ", remote requests allowed" : ""));
    }
    read_back();
    steps.land(skip);
  }

  ObjectKey communication(std::uint8_t sub) const { return {pdo_.communication_index(), sub}; }
  ObjectKey mapping(std::size_t sub) const {
    return {pdo_.mapping_index(), static_cast<std::uint8_t>(sub)};
  }
  ObjectKey cob_id_key() const { return communication(1); }
  std::int64_t cob_id_value() const {
    return std::int64_t{pdo_.cob_id.id()} | (pdo_.cob_id.is_extended() ? 0x2000'0000 : 0);
  }
  std::string entry_text(std::size_t number) const {
    const EffectiveEntry& entry = pdo_.mapping[number - 1];
    return concat(pdo_.label(), " entry ", number, ": ",
                  entry.dummy ? "gap" : label(dictionary, entry.object), ", ", entry.bits, " bits");
  }
  std::string count_text() const {
    if (pdo_.mpdo == Mpdo::sam) return "by source address (SAM)";
    if (pdo_.mpdo == Mpdo::dam) return "by destination address (DAM)";
    return concat(pdo_.mapping.size(), pdo_.mapping.size() == 1 ? " object" : " objects");
  }
  std::uint32_t cob_id_mask() const { return pdo_.rtr ? 0xFFFF'FFFF : all_but_rtr; }
  std::string type_text() const {
    const std::string text = concat(pdo_.label(), " type ", pdo_.transmission);
    if (pdo_.transmission == 0) return text + ": after SYNC, on change";
    if (pdo_.transmission == 1) return text + ": every SYNC";
    if (pdo_.synchronous()) return concat(text, ": every ", pdo_.transmission, " SYNCs");
    if (pdo_.transmission == 252) return text + ": on remote request, sampled at SYNC";
    if (pdo_.transmission == 253) return text + ": on remote request";
    return text + ": by event";
  }

  void compare_communication() {
    if (steps.has(cob_id_key())) {
      steps
          .integer(BootAction::compare, cob_id_key(), cob_id_value(),
                   pdo_.label() + " COB-ID " + to_string(pdo_.cob_id))
          .mask = cob_id_mask();
    }
    if (steps.has(communication(2))) {
      steps.integer(BootAction::compare, communication(2), pdo_.transmission, type_text());
    }
    parameters(BootAction::compare);
  }

  /// Gives the comparisons of a PDO the error letter L. The boot fails with this letter if a
  /// comparison fails on a node that was left OPERATIONAL, because such a node can't be configured.
  void mark_running(std::size_t first) {
    for (std::size_t i = first; i < steps.size(); ++i) {
      BootStep& step = steps.steps()[i];
      if (step.action == BootAction::compare) step.running_letter = 'L';
    }
  }

  /// Appends steps for the number of entries and the entries. A number that is fixed may count
  /// empty entries, which the plan leaves out.
  void mapping_steps(BootAction action, const std::string& suffix) {
    if (!pdo_.fixed_mapping) {
      steps.integer(action, mapping(0), pdo_.mapping_count(),
                    pdo_.label() + " maps " + count_text() + suffix, 1);
    }
    for (std::size_t i = 1; i <= pdo_.entries().size(); ++i) {
      steps.integer(action, mapping(i), pdo_.entries()[i - 1].raw(), entry_text(i) + suffix);
    }
  }

  void disable() {
    if (!steps.writable(cob_id_key())) return;
    steps.bytes(BootAction::disable_pdo, cob_id_key(), {}, pdo_.label() + " off");
  }

  void write_mapping() {
    steps.integer(BootAction::write, mapping(0), 0, pdo_.label() + " mapping off", 1);
    for (std::size_t i = 1; i <= pdo_.entries().size(); ++i) {
      steps.integer(BootAction::write, mapping(i), pdo_.entries()[i - 1].raw(), entry_text(i));
    }
    steps.integer(BootAction::write, mapping(0), pdo_.mapping_count(),
                  pdo_.label() + " mapping on, " + count_text(), 1);
  }

  void write_parameters() {
    if (steps.writable(communication(2))) {
      steps.integer(BootAction::write_if_differs, communication(2), pdo_.transmission, type_text());
    }
    parameters(BootAction::write_if_differs);
  }

  /// Appends steps for the inhibit time, event timer and SYNC start value that the device has.
  void parameters(BootAction action) {
    const auto step = [&](bool has, std::uint8_t sub, std::int64_t value, const std::string& text) {
      if (!has) return;
      steps.integer(action, communication(sub), value, pdo_.label() + " " + text).optional = true;
    };
    step(
        pdo_.has_inhibit, 3, pdo_.inhibit_time,
        concat("inhibit time ", pdo_.inhibit_time, " x ", microseconds_text(pdo_.inhibit_unit_us)));
    step(pdo_.has_event_timer, 5, pdo_.event_timer,
         concat(pdo_.is_tpdo ? "event timer " : "deadline ", pdo_.event_timer, " ms"));
    step(pdo_.has_sync_start, 6, pdo_.sync_start, concat("SYNC start value ", pdo_.sync_start));
  }

  void read_back() {
    if (steps.has(cob_id_key())) {
      steps
          .integer(BootAction::verify, cob_id_key(), cob_id_value(),
                   pdo_.label() + " COB-ID read back")
          .mask = cob_id_mask();
    }
    mapping_steps(BootAction::verify, ", read back");
  }

  const EffectivePdo& pdo_;
};

}  // namespace

void append_pdo(const BootPart& part, const EffectivePdo& pdo) {
  PdoBoot boot{part, pdo};
  if (pdo.is_used()) boot.exchange();
  if (pdo.use == PdoUse::off) boot.switch_off();
}

}  // namespace takt
