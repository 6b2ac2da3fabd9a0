#include <algorithm>
#include <ostream>

#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"
#include "eds_parser/print/plan/print_plan.hpp"

namespace takt {

void add_lcm(PlanLines& lines, const BusPlan& plan, const LcmOptions& options) {
  lines.line("");
  lines.line("LCM: {}{}",
             options.url.empty() ? "default URL (LCM_DEFAULT_URL, --lcm-url)" : options.url,
             options.broker ? ", own broker" : "");
  std::size_t widest = 0;
  std::size_t widest_type = 0;
  const std::vector<LcmChannel> channels = lcm_channels(plan, options);
  for (const LcmChannel& channel : channels) {
    widest = std::max(widest, channel.name.size());
    widest_type = std::max(widest_type, channel.type.size());
  }
  for (const LcmChannel& channel : channels) {
    lines.line("  {:<{}}  {:<{}}  {}", channel.name, widest, channel.type, widest_type,
               channel.content);
  }
}

void print_plan_text(std::ostream& out, const BusPlan& plan, const PlanPrint& what) {
  const auto wanted = [&](NodeId id) { return !what.node || *what.node == id; };
  PlanLines lines{out};
  if (!what.node) {
    add_bus(lines, plan, what.realtime);
    add_cycle(lines, plan);
    add_waits(lines, plan);
  }
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (wanted(plan.nodes[i].id)) add_node(lines, plan, i);
  }
  add_image(lines, plan, what.node);
  add_limits(lines, plan, what.node);
  if (!what.node) add_lcm(lines, plan, what.lcm);
  for (const NodePlan& node : plan.nodes) {
    if (wanted(node.id)) add_boot(lines, node);
  }
}

}  // namespace takt
