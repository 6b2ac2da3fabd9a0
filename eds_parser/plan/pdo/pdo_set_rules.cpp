#include <algorithm>

#include "eds_parser/plan/pdo/pdo_rules.hpp"

namespace takt {

void report_missing_pdos(const NodeSource& node, bool is_tpdo,
                         const std::vector<PdoDescription>& devices, NetworkReport& report) {
  const std::string kind = is_tpdo ? "TPDO" : "RPDO";
  std::size_t count = 0;
  std::uint16_t last = 0;
  for (const PdoDescription& device : devices) {
    if (device.is_tpdo != is_tpdo) continue;
    ++count;
    last = std::max(last, device.number);
  }
  for (const PdoSpec& spec : is_tpdo ? node.spec->tpdos : node.spec->rpdos) {
    const auto same = [&](const PdoDescription& device) {
      return device.is_tpdo == is_tpdo && device.number == spec.number;
    };
    if (std::ranges::any_of(devices, same) || !*spec.enabled) continue;
    const std::uint16_t index = PdoNumber{spec.number, is_tpdo}.communication_index();
    report.error(spec.pos, "no-such-pdo", node.dictionary->file, " has no ", kind, spec.number,
                 " (", hex(index), ")",
                 count == 0 ? ", and no " + kind + " at all"
                            : "; its " + std::to_string(count) + " " + kind + "s end with number " +
                                  std::to_string(last));
  }
}

void check_request_pairs(const NodeSource& node, std::span<const EffectivePdo> pdos,
                         NetworkReport& report) {
  for (const EffectivePdo& pdo : pdos) {
    if (pdo.is_tpdo || !pdo.on_request || pdo.use != PdoUse::exchanged) continue;
    const bool answered = std::ranges::any_of(pdos, [&](const EffectivePdo& other) {
      return other.is_tpdo && other.number == pdo.number && other.use == PdoUse::exchanged;
    });
    if (answered) continue;
    report.error(pdo.pos, "request-pair", pdo.label(*node.spec), " is sent on request, but TPDO",
                 pdo.number, ", which answers it, is off or maps nothing: write it too, `tpdo: {",
                 pdo.number, ": {request: true}}`");
  }
}

}  // namespace takt
