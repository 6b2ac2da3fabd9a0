#pragma once
#include <span>
#include <vector>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/device_data.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// The tables of a network, and the effective PDOs that they were made from (for printing).
struct CompiledNetwork {
  BusPlan plan;
  std::vector<DeviceTable> devices;  ///< order of plan.nodes
};

/// Compiles a network. `dictionaries` holds one dictionary a node of `spec`, in its order, read
/// with that node's id; nullptr where the file could not be read (that node is left out).
/// `device_data` says what devices do otherwise than their EDS.
CompiledNetwork compile_network(const NetworkSpec& spec,
                                std::span<const ObjectDictionary* const> dictionaries,
                                Findings& findings, std::span<const DeviceData> device_data = {});

}  // namespace takt
