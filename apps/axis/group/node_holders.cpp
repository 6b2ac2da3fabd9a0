#include "apps/axis/group/node_holders.hpp"

#include <algorithm>
#include <limits>

namespace takt {

void NodeHolders::take(const status_t& part) {
  for (const node_status_t& node : part.nodes) {
    if (node.node_id < 1 || node.node_id > highest_node) continue;
    NodeHolder& holder = nodes_[static_cast<std::size_t>(node.node_id)];
    if (holder.name != node.holder) holder = {.name = node.holder, .own = node.holder == sender_};
    holder.statuses = std::min(holder.statuses, std::numeric_limits<int>::max() - 1) + 1;
  }
}

const NodeHolder& NodeHolders::operator[](std::int16_t node) const noexcept {
  const bool known = node >= 1 && node <= highest_node;
  return nodes_[known ? static_cast<std::size_t>(node) : 0];
}

void NodeHolders::clear() { nodes_ = {}; }

}  // namespace takt
