#pragma once
#include <cstddef>
#include <linux/can.h>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The kernel takes so many filters of one CAN_RAW socket (CAN_RAW_FILTER_MAX).
inline constexpr std::size_t max_kernel_filters = 512;

/// What the bus thread has to hear of this bus: TPDOs, SDO answers, error control and EMCY of every
/// node, LSS answers, heartbeats of nodes that are not in the plan, and SYNC (whose own echo gives
/// its time on the wire). RTR frames never pass.
std::vector<can_filter> filters_for(const BusPlan& plan);

/// Filters that let all of `ids` pass. Exact ones (the kernel finds them by hash) where there are
/// at most `limit`; else prefix masks, which let as few other identifiers pass as that allows.
std::vector<can_filter> filters_for(std::span<const CobId> ids,
                                    std::size_t limit = max_kernel_filters);

/// Whether the kernel would let an identifier (with its flags) pass.
bool passes(std::span<const can_filter> filters, canid_t id) noexcept;

}  // namespace takt
