#pragma once
#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/print/plan/plan_names.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt::test {

/// Returns `action object value` for every step of the first node.
inline std::vector<std::string> steps(const Compiled& net) {
  std::vector<std::string> out;
  for (const BootStep& step : net.plan.nodes.at(0).boot_plan.steps) {
    std::string text{action_name(step.action)};
    if (step.object.index != 0) text += " " + to_string(step.object);
    const std::string value = value_text(step);
    if (!value.empty()) text += " " + value;
    out.push_back(text);
  }
  return out;
}

/// Returns `count` of the steps, starting at `from`.
inline std::vector<std::string> part(const Compiled& net, std::string_view from,
                                     std::size_t count) {
  std::vector<std::string> all = steps(net);
  const auto first = std::ranges::find(all, from);
  const auto left = static_cast<std::size_t>(all.end() - first);
  return {first, first + static_cast<std::ptrdiff_t>(std::min(count, left))};
}

inline const BootStep& step_at(const Compiled& net, std::string_view text) {
  const std::vector<std::string> all = steps(net);
  const auto found = std::ranges::find(all, text);
  if (found == all.end()) throw std::runtime_error{"no step " + std::string{text}};
  return net.plan.nodes[0].boot_plan.steps[static_cast<std::size_t>(found - all.begin())];
}

/// Makes a network file with one node, `arm` with node-ID 5.
inline std::string arm(std::string_view more = "") {
  return "master: {node_id: 127, sync_period: 10000}\narm: {node_id: 5, dcf: x, " +
         std::string{more} + "}\n";
}

}  // namespace takt::test
