#pragma once
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Whose silence a device notices once its boot plan has run: 0x1016, and 0x100C with 0x100D.
void set_device_watch(const ObjectDictionary& dictionary, NodePlan& node);

}  // namespace takt
