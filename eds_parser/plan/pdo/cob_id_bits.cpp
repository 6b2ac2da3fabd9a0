#include "eds_parser/plan/pdo/pdo_rules.hpp"

namespace takt {
namespace {

constexpr std::uint32_t no_rtr_bit = 0x4000'0000;
constexpr std::uint32_t extended_bit = 0x2000'0000;
constexpr std::uint32_t identifier = 0x1FFF'FFFF;
constexpr std::uint32_t highest_base = 0x7FF;

void judge_rtr_bit(const PdoSpec& spec, bool is_tpdo, const std::string& cob_id,
                   NetworkReport& report) {
  if (!is_tpdo) {
    report.warning(spec.cob_id.pos, "cob-id", cob_id,
                   " has bit 30 set, which has no meaning for an RPDO: takt ignores the bit");
  } else if (*spec.poll_ms != 0 || *spec.poll_syncs != 0) {
    report.error(spec.cob_id.pos, "cob-id", cob_id,
                 " has bit 30 set (no remote requests), but the PDO is polled by remote request: "
                 "clear the bit, or drop `poll_ms`/`poll_syncs`");
  } else {
    report.note(
        spec.cob_id.pos, "cob-id", cob_id,
        " has bit 30 set (no remote requests): takt leaves this bit as it is in the device");
  }
}

}  // namespace

FileCobId read_cob_id_bits(const PdoSpec& spec, bool is_tpdo, const std::string& owner,
                           NetworkReport& report) {
  const std::uint32_t raw = *spec.cob_id.value;
  const std::uint32_t id = raw & identifier;
  const bool extended = (raw & extended_bit) != 0;
  const std::string cob_id = "`cob_id` " + hex(raw) + " of " + owner;
  if ((raw & cob_id_off) != 0) {
    report.warning(spec.cob_id.pos, "cob-id", cob_id,
                   " has bit 31 set: the PDO is switched off, as with `enabled: false`; ",
                   hex(raw & ~cob_id_off, 3), " switches the PDO on");
    return {.off = true, .id = {}};
  }
  if (!extended && id > highest_base) {
    report.error(
        spec.cob_id.pos, "cob-id", cob_id,
        " needs 29 bits: set bit 29 (0x2...) for an extended frame, or use an id up to 0x7FF");
    return {};
  }
  if (extended && id <= highest_base) {
    report.warning(spec.cob_id.pos, "cob-id", cob_id,
                   " has bit 29 set: this is the 29-bit identifier ", hex(id, 8),
                   ", which is another identifier on the bus than ", hex(id, 3));
  }
  if ((raw & no_rtr_bit) != 0) judge_rtr_bit(spec, is_tpdo, cob_id, report);
  return {.off = false, .id = CobId::of_object(raw)};
}

}  // namespace takt
