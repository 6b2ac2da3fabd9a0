#include "eds_parser/print/plan/plan_diff_json.hpp"

#include <utility>

#include "eds_parser/print/json.hpp"

namespace takt {
namespace {

Json json_of(const PlanChange& change, const std::string& node_name) {
  Json json{{"part", change.part}};
  if (change.node) json["node"] = change.node->value();
  if (change.node) json["name"] = node_name;
  json["removed"] = change.removed;
  json["added"] = change.added;
  return json;
}

/// Returns the name in the second plan, or in the first if the second does not have the node.
std::string name_of(std::optional<NodeId> node, const PlanSide& before, const PlanSide& after) {
  if (!node) return {};
  for (const BusPlan* plan : {&after.plan, &before.plan}) {
    if (const NodePlan* found = plan->find(node->value())) return found->name;
  }
  return {};
}

}  // namespace

void print_plan_diff_json(std::ostream& out, const PlanSide& before, const PlanSide& after,
                          std::optional<NodeId> only) {
  auto changes = list_of(plan_changes(before, after, only), [&](const PlanChange& change) {
    return json_of(change, name_of(change.node, before, after));
  });
  print_document(out,
                 {{"before", before.name}, {"after", after.name}, {"changes", std::move(changes)}});
}

void print_device_changes_json(std::ostream& out, const std::string& file,
                               std::span<const DeviceChanges> nodes) {
  auto list = list_of(nodes, [](const DeviceChanges& each) {
    const auto change_json = [&](const PlanChange& change) { return json_of(change, each.name); };
    return Json{{"node", each.node.value()},
                {"name", each.name},
                {"device_data", each.entry},
                {"device_data_file", each.entry_file},
                {"changes", list_of(each.changes, change_json)}};
  });
  print_document(out, {{"file", file}, {"nodes", std::move(list)}});
}

}  // namespace takt
