#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Returns the integer that `sdo:` of the node or its DCF writes into an object in each boot.
std::optional<std::int64_t> written_object(const NodeSource& node, ObjectKey object);
/// Returns the same integer, else the default of the device file.
std::optional<std::int64_t> configured_object(const NodeSource& node, ObjectKey object);

/// Sets in `node` the producers whose silence the device notices after its boot: by heartbeat
/// (0x1016) and by life guarding (0x100C with 0x100D).
void set_device_watch(const ObjectDictionary& dictionary, NodePlan& node);

}  // namespace takt
