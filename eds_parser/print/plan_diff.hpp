#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// One of two plans, and what it is called.
struct PlanSide {
  const BusPlan& plan;
  std::string name;
};

/// What changes on the bus and in the image from one plan to the other, as `diff -u` prints it:
/// bus, cycle, nodes with their PDOs, image, boots; nodes are matched by their id. Empty: nothing.
/// `only`: this node alone.
std::string plan_diff(const PlanSide& before, const PlanSide& after,
                      std::optional<NodeId> only = {});

/// The same of one node alone: its PDOs and its boot.
std::string node_diff(const PlanSide& before, const PlanSide& after, NodeId node);

/// What differs in one part of a plan, line by line, without the lines' indentation.
struct PlanChange {
  std::string_view part;       ///< bus (with the cycle), node, image, limits, lcm, boot
  std::optional<NodeId> node;  ///< of the parts node and boot
  std::vector<std::string> removed;
  std::vector<std::string> added;
};

/// plan_diff() for programs: the parts that differ, in the order of a plan.
std::vector<PlanChange> plan_changes(const PlanSide& before, const PlanSide& after,
                                     std::optional<NodeId> only = {});
std::vector<PlanChange> node_changes(const PlanSide& before, const PlanSide& after, NodeId node);

}  // namespace takt
