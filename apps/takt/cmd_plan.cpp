#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <iostream>

#include "apps/takt/commands.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan.hpp"

namespace takt {
namespace {

constexpr int invalid_file = 2;

struct PlanOptions {
  std::string file;
  std::string node;
  bool json = false;
  bool quiet = false;
};

/// By name, or by id.
std::optional<NodeId> find_node(const BusPlan& plan, const std::string& text) {
  const auto by_name = std::ranges::find(plan.nodes, text, &NodePlan::name);
  if (by_name != plan.nodes.end()) return by_name->id;
  unsigned id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  const auto by_id =
      std::ranges::find_if(plan.nodes, [&](const NodePlan& node) { return node.id.value() == id; });
  return by_id == plan.nodes.end() ? std::nullopt : std::optional{by_id->id};
}

int print(const PlanOptions& options) {
  const LoadedNetwork network = load_network(options.file);
  const bool bad = has_error(network.findings);
  for (const Finding& finding : network.findings) {
    if (finding.severity == Severity::note && (options.quiet || bad)) continue;
    std::cerr << to_string(finding) << '\n';
  }
  if (bad) return invalid_file;
  PlanPrint what{.node = {}, .realtime = network.realtime, .lcm = network.lcm};
  if (!options.node.empty()) {
    what.node = find_node(network.plan, options.node);
    if (!what.node) {
      std::cerr << options.file << ": no node `" << options.node << "`; there is";
      for (const NodePlan& node : network.plan.nodes) {
        std::cerr << ' ' << node.name << " (" << unsigned{node.id.value()} << ')';
      }
      std::cerr << '\n';
      return invalid_file;
    }
  }
  if (options.json) {
    print_plan_json(std::cout, network.plan, what);
  } else {
    print_plan_text(std::cout, network.plan, what);
  }
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PlanOptions>();
  auto* command = app.add_subcommand("plan", "all that taktd will do with a network file");
  command->add_option("NET", options->file, "network file (YAML, also a bus.yml)")->required();
  command->add_option("--node", options->node, "only this node, by name or id");
  command->add_flag("--json", options->json, "one JSON document");
  command->add_flag("--quiet", options->quiet, "leave out notes");
  command->footer(
      "The plan goes to stdout, findings to stderr. Exit code 2 if the file is invalid.\n\n"
      "Example:\n  takt plan share/demo/two_axes.yaml --node shoulder");
  command->callback([options, &exit_code] { exit_code = print(*options); });
}

}  // namespace takt
