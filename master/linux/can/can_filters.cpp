#include "master/linux/can/can_filters.hpp"

#include <algorithm>
#include <bitset>

namespace takt {
namespace {

using IdSet = std::bitset<2048>;

// For exactly these masks, the kernel keeps a filter in a table by identifier instead of in a list.
constexpr canid_t exact_base = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG;
constexpr canid_t exact_extended = CAN_EFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG;
constexpr CobId lss_answers = CobId::base(0x7E4);
constexpr can_filter any_extended{.can_id = CAN_EFF_FLAG, .can_mask = CAN_EFF_FLAG | CAN_RTR_FLAG};

std::size_t count(const IdSet& wanted, std::size_t first, std::size_t size) {
  std::size_t members = 0;
  for (std::size_t id = first; id < first + size; ++id) members += wanted[id] ? 1 : 0;
  return members;
}

/// Covers the aligned block [first, first + size) with prefixes. Each prefix lets at most `slack`
/// unwanted identifiers pass.
void cover(const IdSet& wanted, std::size_t first, std::size_t size, std::size_t slack,
           std::vector<can_filter>& out) {
  const std::size_t members = count(wanted, first, size);
  if (members == 0) return;
  if (size - members > slack) {
    cover(wanted, first, size / 2, slack, out);
    cover(wanted, first + size / 2, size / 2, slack, out);
    return;
  }
  const auto prefix = static_cast<canid_t>(~(size - 1)) & CAN_SFF_MASK;
  out.push_back(
      {.can_id = static_cast<canid_t>(first), .can_mask = prefix | CAN_EFF_FLAG | CAN_RTR_FLAG});
}

std::vector<can_filter> exact(const IdSet& wanted) {
  std::vector<can_filter> out;
  for (std::size_t id = 0; id < wanted.size(); ++id) {
    if (wanted[id]) out.push_back({.can_id = static_cast<canid_t>(id), .can_mask = exact_base});
  }
  return out;
}

}  // namespace

std::vector<can_filter> filters_for(std::span<const CobId> ids, std::size_t limit) {
  IdSet wanted;
  std::vector<can_filter> extended;
  for (const CobId id : ids) {
    if (id.is_extended()) {
      extended.push_back({.can_id = id.id() | CAN_EFF_FLAG, .can_mask = exact_extended});
    } else {
      wanted.set(id.id());
    }
  }
  if (extended.size() > limit / 2) extended.assign(1, any_extended);

  std::vector<can_filter> out = exact(wanted);
  for (std::size_t slack = 0; out.size() + extended.size() > limit; slack = slack * 2 + 1) {
    out.clear();
    cover(wanted, 0, wanted.size(), slack, out);
  }
  out.insert(out.end(), extended.begin(), extended.end());
  return out;
}

std::vector<can_filter> filters_for(const BusPlan& plan) {
  std::vector<CobId> ids{lss_answers};
  if (plan.cycle.sync) ids.push_back(plan.cycle.sync_cob_id);
  // Other nodes send requests to the SDO server of the master with this identifier.
  ids.push_back(default_sdo_channel(plan.master_id).request);
  for (const PdoRow& row : plan.pdos.tpdos) ids.push_back(row.cob_id);
  for (const NodePlan& node : plan.nodes) {
    ids.push_back(node.sdo.channel_of(node.id).answer);
    ids.push_back(node.emcy_cob_id.value_or(CobId::base(0x080U + node.id.value())));
    ids.push_back(CobId::base(0x700U + node.id.value()));
  }
  // Heartbeats of nodes that are not in the plan pass as well, unless the filters would then no
  // longer be exact.
  const std::size_t own = ids.size();
  for (std::uint32_t node = 1; node <= 127; ++node) {
    if (node != plan.master_id.value()) ids.push_back(CobId::base(0x700U + node));
  }
  if (ids.size() > max_kernel_filters) ids.resize(own);
  return filters_for(ids);
}

bool passes(std::span<const can_filter> filters, canid_t id) noexcept {
  return std::ranges::any_of(filters, [id](const can_filter& filter) {
    return (id & filter.can_mask) == (filter.can_id & filter.can_mask);
  });
}

}  // namespace takt
