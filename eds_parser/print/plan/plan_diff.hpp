#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// One of two plans with its name.
struct PlanSide {
  const BusPlan& plan;
  std::string name;
};

/// Returns the differences of two plans on the bus and in the image in the format of `diff -u`:
/// bus, cycle, nodes with their PDOs, image, boots. Nodes are matched by their node-ID. The text is
/// empty if there is no difference. `only` restricts it to one node.
std::string plan_diff(const PlanSide& before, const PlanSide& after,
                      std::optional<NodeId> only = {});

/// Returns the differences of one node: its PDOs and its boot.
std::string node_diff(const PlanSide& before, const PlanSide& after, NodeId node);

/// The lines that differ in one part of a plan, without their indentation.
struct PlanChange {
  std::string_view part;       ///< bus (with the cycle), node, image, limits, lcm, boot
  std::optional<NodeId> node;  ///< only in the parts node and boot
  std::vector<std::string> removed{};
  std::vector<std::string> added{};
};

/// Returns the content of plan_diff() for programs: the parts that differ, in the order of a plan.
std::vector<PlanChange> plan_changes(const PlanSide& before, const PlanSide& after,
                                     std::optional<NodeId> only = {});
std::vector<PlanChange> node_changes(const PlanSide& before, const PlanSide& after, NodeId node);

}  // namespace takt
