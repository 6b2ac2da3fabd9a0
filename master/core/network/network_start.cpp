#include "master/core/network/network_start.hpp"

#include <algorithm>

namespace takt {

void NetworkStart::begin(Time now) noexcept {
  ready_ = false;
  const Time limit = plan_->start_up.boot_time;
  late_at_ = limit > Time{} ? now + limit : never;
}

bool NetworkStart::matters() const noexcept {
  return plan_->start_up.start_all || std::ranges::any_of(plan_->nodes, &NodePlan::mandatory);
}

std::size_t NetworkStart::missing(std::span<const NodeStatus> nodes) const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool wanted = plan_->nodes[i].mandatory && plan_->nodes[i].boot;
    count += wanted && nodes[i].boot != BootState::ready;
  }
  return count;
}

bool NetworkStart::update(std::span<const NodeStatus> nodes) noexcept {
  if (ready_ || missing(nodes) != 0) return false;
  // A single broadcast that starts all nodes also waits for the first boot attempt of each optional
  // node.
  const bool trying = std::ranges::any_of(nodes, [](const NodeStatus& node) {
    return node.boot == BootState::booting && !node.boot_tried;
  });
  if (plan_->start_up.start_all && trying) return false;
  ready_ = true;
  return true;
}

bool NetworkStart::late(Time now) noexcept {
  if (ready_ || now < late_at_) return false;
  late_at_ = never;
  return true;
}

}  // namespace takt
