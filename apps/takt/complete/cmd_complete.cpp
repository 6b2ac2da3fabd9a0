#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "apps/command_line/commands.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/objects/known_device.hpp"
#include "eds_parser/dictionary/object_names.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

/// If no status has come within this time, no bus runs: a daemon sends its status ten times a
/// second.
constexpr Time silence = std::chrono::milliseconds{220};
/// Longest wait for the layout, which a daemon sends once a second.
constexpr Time layout_period = std::chrono::milliseconds{1200};

struct CompleteOptions {
  std::string kind;
  std::string network;
  std::string node;
};

/// A signal, as a shell proposes it.
struct Named {
  std::string node;
  std::string name;
  int index = 0;
  int sub = 0;
};

struct Known {
  std::vector<std::string> buses;
  std::vector<std::string> nodes;
  std::vector<Named> signals;
};

Known known_of_file(const std::string& path) {
  const LoadedNetwork network = load_network(path);
  Known known{{network.plan.name}, {}, {}};
  for (const NodePlan& node : network.plan.nodes) known.nodes.push_back(node.name);
  for (const Signal& signal : network.plan.layout.signals) {
    known.signals.push_back({network.plan.nodes[signal.node_index].name, signal.name,
                             signal.object.index, signal.object.sub});
  }
  return known;
}

Known known_of_bus(bool with_signals) {
  LcmClient lcm = open_live({}, {"STATUS", "LAYOUT"});
  BusViews views;
  const Time begin = monotonic_now();
  listen(lcm, views, begin + silence, [&] { return !chosen(views, "").empty(); });
  Known known;
  const auto buses = chosen(views, "");
  if (with_signals && !buses.empty()) {
    listen(lcm, views, begin + layout_period, [&] { return !buses.front()->signals().empty(); });
  }
  for (const BusView* bus : buses) {
    known.buses.push_back(bus->status()->bus);
    for (const node_status_t& node : bus->status()->nodes) known.nodes.push_back(node.name);
    for (const signal_t& signal : bus->signals()) {
      known.signals.push_back({signal.node, signal.name, signal.index, signal.sub});
    }
  }
  return known;
}

void print(const std::set<std::string>& proposals) {
  for (const std::string& proposal : proposals) std::printf("%s\n", proposal.c_str());
}

/// Returns the CAN interfaces of this machine.
std::set<std::string> can_interfaces() {
  constexpr int is_can = 280;  // ARPHRD_CAN
  std::set<std::string> names{"sim"};
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator{"/sys/class/net", error}) {
    std::ifstream file{entry.path() / "type"};
    int type = 0;
    if (file >> type && type == is_can) names.insert(entry.path().filename());
  }
  return names;
}

/// Returns `6041`, or `1018:01`.
std::string object_number(int index, int sub) {
  return fmt::format("{:04X}{}", index, sub == 0 ? "" : fmt::format(":{:02X}", sub));
}

std::set<std::string> objects_of(const Known& known, const std::string& node) {
  std::set<std::string> objects;
  for (const Named& signal : known.signals) {
    if (!node.empty() && signal.node != node) continue;
    const std::string number = object_number(signal.index, signal.sub);
    objects.insert(number + '\t' + signal.name);
    objects.insert(signal.name + '\t' + number);
  }
  return objects;
}

/// Returns the names of all objects of a node of a network file.
std::set<std::string> names_of(const std::string& network, const std::string& node) {
  std::set<std::string> names;
  const KnownDevice device = device_of_network(network, node);
  const ObjectNames known{*device.dictionary};
  for (const ObjectNames::Entry& entry : known.entries()) {
    names.insert(entry.name + '\t' + object_number(entry.key.index, entry.key.sub));
  }
  return names;
}

int complete(const CompleteOptions& options) {
  if (options.kind == "interfaces") {
    print(can_interfaces());
    return 0;
  }
  const bool with_signals = options.kind == "objects" || options.kind == "signals";
  const Known known =
      options.network.empty() ? known_of_bus(with_signals) : known_of_file(options.network);
  if (options.kind == "buses") print({known.buses.begin(), known.buses.end()});
  if (options.kind == "nodes") print({known.nodes.begin(), known.nodes.end()});
  if (options.kind == "objects") {
    std::set<std::string> objects = objects_of(known, options.node);
    if (!options.network.empty() && !options.node.empty()) {
      objects.merge(names_of(options.network, options.node));
    }
    print(objects);
  }
  if (options.kind == "signals") {
    std::set<std::string> names;
    for (const Named& signal : known.signals) names.insert(signal.node + '.' + signal.name);
    print(names);
  }
  return 0;
}

}  // namespace

void add_complete(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<CompleteOptions>(
      app, exit_code, "complete", "lists names for the completion of the shell", complete);
  verb.add_option("KIND", options.kind, "buses, nodes, objects, signals or interfaces")->required();
  verb.add_option("--network", options.network, "of this network file, not of the running bus");
  verb.add_option("--node", options.node, "objects of this node only");
}

}  // namespace takt
