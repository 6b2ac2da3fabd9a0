#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Returns the integer that `sdo:` of the node or its DCF writes into an object in each boot.
std::optional<std::int64_t> written_object(const NodeSource& node, ObjectKey object);
/// Returns the integer of written_object(), or the default of the device file if nothing writes the
/// object.
std::optional<std::int64_t> configured_object(const NodeSource& node, ObjectKey object);

/// Enters in `node` what the device supervises after its boot: the heartbeat producers in 0x1016,
/// and the life time of its guarding (0x100C times 0x100D).
void set_device_watch(const ObjectDictionary& dictionary, NodePlan& node);

}  // namespace takt
