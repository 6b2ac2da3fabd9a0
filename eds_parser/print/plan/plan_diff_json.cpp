#include "eds_parser/print/plan/plan_diff_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

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
    const auto found = std::ranges::find(plan->nodes, *node, &NodePlan::id);
    if (found != plan->nodes.end()) return found->name;
  }
  return {};
}

void print(std::ostream& out, const Json& json) {
  out << json.dump(2, ' ', true, Json::error_handler_t::replace) << '\n';
}

}  // namespace

void print_plan_diff_json(std::ostream& out, const PlanSide& before, const PlanSide& after,
                          std::optional<NodeId> only) {
  auto changes = Json::array();
  for (const PlanChange& change : plan_changes(before, after, only)) {
    changes.push_back(json_of(change, name_of(change.node, before, after)));
  }
  print(out, {{"before", before.name}, {"after", after.name}, {"changes", std::move(changes)}});
}

void print_device_changes_json(std::ostream& out, const std::string& file,
                               std::span<const DeviceChanges> nodes) {
  auto list = Json::array();
  for (const DeviceChanges& each : nodes) {
    auto changes = Json::array();
    for (const PlanChange& change : each.changes) changes.push_back(json_of(change, each.name));
    list.push_back({{"node", each.node.value()},
                    {"name", each.name},
                    {"device_data", each.entry},
                    {"device_data_file", each.entry_file},
                    {"changes", std::move(changes)}});
  }
  print(out, {{"file", file}, {"nodes", std::move(list)}});
}

}  // namespace takt
