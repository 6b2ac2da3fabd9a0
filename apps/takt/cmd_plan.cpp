#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <sstream>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/plan_diff.hpp"
#include "eds_parser/print/plan/plan_diff_json.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr int invalid_file = 2;

struct PlanOptions {
  std::string file;
  std::string node;
  std::string other;
  bool devices = false;
  bool json = false;
  bool brief = false;
  bool quiet = false;
};

/// Finds a node of the plan by name or by node-ID.
std::optional<NodeId> find_node(const BusPlan& plan, const std::string& text) {
  const auto by_name = std::ranges::find(plan.nodes, text, &NodePlan::name);
  if (by_name != plan.nodes.end()) return by_name->id;
  const auto id = parse_node_id(text);
  const auto is_it = [&id](const NodePlan& node) { return node.id == id; };
  return std::ranges::any_of(plan.nodes, is_it) ? id : std::nullopt;
}

/// Prints the findings on stderr. Returns false if the file is invalid.
bool reported_good(const LoadedNetwork& network, bool quiet) {
  const bool notes = !quiet && !has_error(network.findings);
  return !print_findings(network.findings, notes ? Severity::note : Severity::warning);
}

/// Sets `node` if the options name one. Prints an error and returns false if there is no such node.
bool chosen_node(const PlanOptions& options, const BusPlan& plan, std::optional<NodeId>& node) {
  if (options.node.empty()) return true;
  node = find_node(plan, options.node);
  if (node) return true;
  std::cerr << options.file << ": no node `" << options.node << "`; there is";
  for (const NodePlan& each : plan.nodes) {
    std::cerr << ' ' << each.name << " (" << unsigned{each.id.value()} << ')';
  }
  std::cerr << '\n';
  return false;
}

/// Prints the differences of two plans. Returns the exit code of diff: 0 if nothing differs, 1 if
/// something differs, 2 on errors.
int diff(const PlanOptions& options) {
  const LoadedNetwork before = load_network(options.file);
  const LoadedNetwork after = load_network(options.other);
  std::optional<NodeId> node;
  if (!reported_good(before, true) || !reported_good(after, true)) return invalid_file;
  if (!chosen_node(options, before.plan, node)) return invalid_file;
  const PlanSide first{before.plan, options.file};
  const PlanSide second{after.plan, options.other};
  const std::string text = plan_diff(first, second, node);
  if (options.json) {
    print_plan_diff_json(std::cout, first, second, node);
  } else {
    std::cout << printable_lines(text);
  }
  return text.empty() ? 0 : 1;
}

/// Two plans of the same network, without and with the device data.
struct DeviceDataPlans {
  const BusPlan& without;
  const BusPlan& with;
};

void print_device_diff(const DeviceDataPlans& plans, const NodePlan& node) {
  std::ostringstream text;
  text << "node " << unsigned{node.id.value()} << ' ' << node.name << ": " << node.device_data
       << " (" << node.device_data_file << ")\n"
       << node_diff({plans.without, "without device data"}, {plans.with, node.device_data_file},
                    node.id);
  std::cout << printable_lines(text.str());
}

void print_device_diffs_json(const DeviceDataPlans& plans, const std::vector<NodePlan>& nodes,
                             const std::string& file) {
  std::vector<DeviceChanges> all;
  for (const NodePlan& node : nodes) {
    all.push_back({node.id, node.name, node.device_data, node.device_data_file,
                   node_changes({plans.without, ""}, {plans.with, ""}, node.id)});
  }
  print_device_changes_json(std::cout, file, all);
}

/// Prints what each entry of the device data changes in its nodes.
int diff_devices(const PlanOptions& options) {
  const LoadedNetwork with = load_network(options.file);
  if (!reported_good(with, true)) return invalid_file;
  const LoadedNetwork without = load_network(options.file, DeviceDataUse::ignored);
  std::optional<NodeId> only;
  if (!chosen_node(options, with.plan, only)) return invalid_file;
  std::vector<NodePlan> nodes;
  std::ranges::copy_if(with.plan.nodes, std::back_inserter(nodes), [&](const NodePlan& node) {
    return !node.device_data.empty() && (!only || *only == node.id);
  });
  const DeviceDataPlans plans{without.plan, with.plan};
  if (options.json) {
    print_device_diffs_json(plans, nodes, options.file);
    return 0;
  }
  if (nodes.empty()) std::cout << "no entry of the device data applies\n";
  for (const NodePlan& node : nodes) {
    if (&node != &nodes.front()) std::cout << '\n';
    print_device_diff(plans, node);
  }
  return 0;
}

/// Prints a plan that fits on one screen, together with the findings.
int print_brief(const LoadedNetwork& network) {
  std::ostringstream text;
  print_plan_brief(text, network.plan, network.findings);
  std::cout << printable_lines(text.str());
  return 0;
}

int print(const PlanOptions& options) {
  if (!options.other.empty()) return diff(options);
  if (options.devices) return diff_devices(options);
  const LoadedNetwork network = load_network(options.file);
  if (options.brief && !has_error(network.findings)) return print_brief(network);
  if (!reported_good(network, options.quiet)) return invalid_file;
  PlanPrint what{.node = {}, .realtime = network.realtime, .lcm = network.lcm};
  if (!chosen_node(options, network.plan, what.node)) return invalid_file;
  if (options.json) {
    print_plan_json(std::cout, network.plan, what);
  } else {
    std::ostringstream text;
    print_plan_text(text, network.plan, what);
    std::cout << printable_lines(text.str());
  }
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto [command, options] = add_command<PlanOptions>(
      app, exit_code, "plan", "prints everything that taktd will do with a network file", print);
  command.add_option("NET", options.file, "network file (YAML, also a bus.yml)")->required();
  command.add_option("--node", options.node, "print only this node, by name or id");
  auto* json = command.add_flag("--json", options.json, "print one JSON document");
  auto* brief = command.add_flag("--brief", options.brief,
                                 "print one screen: nodes, cycle, load, limits and their sources, "
                                 "findings");
  brief->excludes(json);
  auto* other =
      command.add_option("--diff", options.other, "print what changes from NET to this file")
          ->type_name("OTHER");
  command
      .add_flag("--diff-devices", options.devices,
                "print what the device data change, before and after")
      ->excludes(other)
      ->excludes(brief);
  other->excludes(brief);
  command.add_flag("--quiet", options.quiet, "leave out notes");
  command.footer(
      "The plan goes to stdout, findings go to stderr. Exit code 2: the file is invalid.\n"
      "Each boot step shows its first frame; `..` is a byte that depends on the device. If takt\n"
      "writes only where the answer differs, the value follows, in --json also as a frame.\n"
      "--diff compares everything that happens on the bus and the image, in the form of diff -u.\n"
      "takt matches nodes by id, and lists steps and signals without their numbers. The exit\n"
      "codes are those of diff: 0 nothing differs, 1 something differs, 2 a file is invalid.\n\n"
      "Example:\n"
      "  takt plan lift.yaml --brief\n"
      "  takt plan share/demo/two_axes.yaml --node shoulder\n"
      "  takt plan lift.yaml --diff lift_new.yaml\n"
      "  takt plan share/demo/lenze8400.yaml --diff-devices");
}

}  // namespace takt
