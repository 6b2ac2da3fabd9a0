#include "apps/takt/soak/judge/node_judge.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

namespace takt::soak {
namespace {

constexpr std::array<const char*, 5> boot_names{"idle", "booting", "ready", "failed", "lost"};

bool named(NmtState state) noexcept {
  using enum NmtState;
  return state == bootup || state == stopped || state == operational || state == preoperational ||
         state == unknown;
}

}  // namespace

NodeJudge::NodeJudge(const BusPlan& plan, Verdict& verdict)
    : plan_{plan}, verdict_{verdict}, progress_(plan.nodes.size()) {}

bool NodeJudge::ready(const NodeStatus& node) noexcept {
  return node.boot == BootState::ready && node.nmt == NmtState::operational;
}

std::string NodeJudge::description(std::size_t index, const NodeStatus& node) const {
  const auto boot = static_cast<std::size_t>(node.boot);
  std::string text =
      fmt::format("node {} is {}, NMT state {}, boot step {}", plan_.nodes[index].id.value(),
                  boot < boot_names.size() ? boot_names[boot] : "in an unknown boot state",
                  std::to_underlying(node.nmt), node.boot_step + 1);
  if (node.boot_letter != 0) text += std::string{", letter "} + node.boot_letter;
  return text;
}

void NodeJudge::judge(const StatusSnapshot& status, Time now) {
  for (std::size_t i = 0; i < progress_.size(); ++i) {
    const NodeStatus& node = status.nodes[i];
    if (static_cast<std::size_t>(node.boot) >= boot_names.size() || !named(node.nmt)) {
      verdict_.report_violation("every node is in a named state", description(i, node));
    }
    Progress& progress = progress_[i];
    if (node.boot != progress.boot || node.boot_step != progress.step) {
      progress = {.boot = node.boot, .step = node.boot_step, .since = now};
    }
    if (node.boot == BootState::booting && now - progress.since > time_limit) {
      verdict_.report_violation("every wait ends", description(i, node) + " for 60 s");
    }
  }
}

bool NodeJudge::all_ready(const StatusSnapshot& status) const noexcept {
  return std::ranges::all_of(status.nodes, ready);
}

void NodeJudge::judge_end(const StatusSnapshot& status) {
  for (std::size_t i = 0; i < status.nodes.size(); ++i) {
    if (ready(status.nodes[i])) continue;
    verdict_.report_violation("every node comes back", description(i, status.nodes[i]));
  }
}

std::uint64_t NodeJudge::boots(const StatusSnapshot& status) const noexcept {
  std::uint64_t sum = 0;
  for (const NodeStatus& node : status.nodes) sum += node.boot_count;
  return sum;
}

}  // namespace takt::soak
