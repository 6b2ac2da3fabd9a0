#include <fmt/format.h>

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

}  // namespace takt
