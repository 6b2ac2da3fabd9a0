#include <fmt/format.h>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "master/black_box/recording_file.hpp"
#include "master/explain/boot_report.hpp"

namespace takt {

Decision to_decision(const BusPlan& plan, const Event& event) {
  Decision decision{.time = event.when.count(),
                    .cycle = event.cycle,
                    .node = event.node,
                    .kind = std::string{name(event.kind)},
                    .value = event.value,
                    .detail = event.detail,
                    .text = describe(plan, event)};
  for (const std::uint8_t byte : event.bytes) decision.bytes += fmt::format("{:02X}", byte);
  return decision;
}

std::string plan_fingerprint(const BusPlan& plan) {
  BusPlan bare = plan;
  bare.name.clear();
  bare.interface.clear();
  std::ostringstream text;
  print_plan_json(text, bare, {});
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;  // FNV-1a
  for (const char letter : text.str()) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100'0000'01B3;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace takt
