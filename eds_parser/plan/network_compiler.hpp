#pragma once
#include <span>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/device_data.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// The tables of a network.
struct CompiledNetwork {
  BusPlan plan;
  std::vector<DeviceTable> devices;  ///< in the order of plan.nodes
};

/// Compiles a network. `dictionaries` holds one dictionary for each node of `spec`, in the same
/// order, read with the node-ID of that node. nullptr means that the file could not be read; that
/// node is left out. `device_data` holds the deviations of devices from their EDS.
CompiledNetwork compile_network(const NetworkSpec& spec,
                                std::span<const ObjectDictionary* const> dictionaries,
                                Findings& findings, std::span<const DeviceData> device_data = {});

}  // namespace takt
