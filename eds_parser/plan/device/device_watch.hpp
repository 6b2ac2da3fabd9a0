#pragma once
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Sets in `node` the producers whose silence the device notices after its boot: by heartbeat
/// (0x1016) and by life guarding (0x100C with 0x100D).
void set_device_watch(const ObjectDictionary& dictionary, NodePlan& node);

}  // namespace takt
