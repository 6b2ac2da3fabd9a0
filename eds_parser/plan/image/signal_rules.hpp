#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Sets scale, offset and unit of a signal from `units:` of its node.
void apply_units(const NodeSource& node, Signal& signal);

/// Returns the time to live of commands in cycles. 0 means no limit.
std::uint32_t fallback_cycles(const TimeoutSpec& timeout, Time period);

/// Sets the safe value of an output and its fallback, which applies when its command is too old.
/// `cia402` means that the node is a drive. By default a drive makes a quick stop after 50 ms.
/// Other nodes hold their outputs; their commands also expire after 50 ms, so that another sender
/// can take over.
void apply_fallback(const NodeSource& node, bool cia402, Time period, Signal& signal);

/// Returns the input that gives an output its first value, on the same axis: 6064 for 607A and
/// 60C1:01, 6061 for 6060.
std::optional<ObjectKey> seed_object(ObjectKey output) noexcept;

/// Reports errors in `on_timeout` and `safe_values` that concern the node as a whole.
void check_fallback(const NodeSource& node, bool cia402, NetworkReport& report);

/// Reports entries of `safe_values` and `units: objects:` that would have no effect: objects that
/// the device does not have or that no RPDO of the network file carries, and values that do not
/// fit.
void check_node_values(const NodePdos& node, NetworkReport& report);

}  // namespace takt
