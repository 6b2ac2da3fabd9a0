#pragma once
#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// Scale, offset and unit of a signal from `units:` of its node.
void apply_units(const NodeSource& node, Signal& signal);

/// What an output does when its command has grown old, and its safe value. `cia402`: the node is a
/// drive; its default is a quick stop after 3 cycles. Others hold, and their commands expire after
/// 100 ms, so that another sender can take over.
void apply_fallback(const NodeSource& node, bool cia402, Time period, Signal& signal);

/// The input that gives an output its first value, on the same axis (6064 for 607A, 6061 for 6060);
/// 0: none.
std::uint16_t seed_object(std::uint16_t output_index) noexcept;

/// Complaints about `on_timeout` and `safe_values` as a whole.
void check_fallback(const NodeSource& node, bool cia402, NetworkReport& report);

}  // namespace takt
