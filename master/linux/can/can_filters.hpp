#pragma once
#include <cstddef>
#include <linux/can.h>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Most filters that the kernel accepts for one CAN_RAW socket (CAN_RAW_FILTER_MAX).
inline constexpr std::size_t max_kernel_filters = 512;

/// Filters for everything that the bus thread must receive: TPDOs, SDO answers, error control and
/// EMCY of every node, LSS answers, heartbeats of nodes that are not in the plan, and SYNC (the
/// echo of the master's SYNC gives its time on the wire). RTR frames never pass.
std::vector<can_filter> filters_for(const BusPlan& plan);

/// Filters that let all of `ids` pass. The filters are exact if there are at most `limit`
/// identifiers (the kernel finds exact ones by hash). Otherwise they are prefix masks that let as
/// few other identifiers pass as the limit allows.
std::vector<can_filter> filters_for(std::span<const CobId> ids,
                                    std::size_t limit = max_kernel_filters);

/// Returns true if the kernel would let an identifier (with its flags) pass.
bool passes(std::span<const can_filter> filters, canid_t id) noexcept;

}  // namespace takt
