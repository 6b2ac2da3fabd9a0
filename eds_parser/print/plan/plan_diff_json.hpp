#pragma once
#include <iosfwd>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/print/plan/plan_diff.hpp"

namespace takt {

/// Prints {"before", "after", "changes": [{"part", "node", "name", "removed", "added"}]}. Only the
/// parts of one node have `node` and `name`.
void print_plan_diff_json(std::ostream& out, const PlanSide& before, const PlanSide& after,
                          std::optional<NodeId> only = {});

/// The changes that an entry of the device data makes to one node.
struct DeviceChanges {
  NodeId node;
  std::string name;
  std::string entry;
  std::string entry_file;
  std::vector<PlanChange> changes;
};

/// Prints {"file", "nodes": [{"node", "name", "device_data", "device_data_file", "changes"}]}.
void print_device_changes_json(std::ostream& out, const std::string& file,
                               std::span<const DeviceChanges> nodes);

}  // namespace takt
