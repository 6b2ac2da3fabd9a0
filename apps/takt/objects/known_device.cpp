#include "apps/takt/objects/known_device.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/suggest.hpp"
#include "eds_parser/report/text.hpp"
#include "master/gateway/message/bus_view.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

/// A daemon sends its layout once a second.
constexpr Time layout_limit = std::chrono::milliseconds{1500};
constexpr Time answer_limit = std::chrono::seconds{3};

/// Returns the position of a node in the plan, or the number of nodes if there is none.
std::size_t node_of(const BusPlan& plan, const std::string& text) {
  const auto id = parse_node_id(text);
  const auto found = std::ranges::find_if(plan.nodes, [&](const NodePlan& node) {
    return node.name == text || (id && node.id == *id);
  });
  return static_cast<std::size_t>(found - plan.nodes.begin());
}

/// Returns the label of the PDO that carries a signal.
std::string pdo_of(const BusPlan& plan, const Signal& signal) {
  const std::vector<PdoRow>& rows = signal.output ? plan.pdos.rpdos : plan.pdos.tpdos;
  return signal.row < rows.size()
             ? fmt::format("{}PDO{}", signal.output ? 'R' : 'T', rows[signal.row].number)
             : std::string{};
}

std::vector<KnownSignal> signals_of(const BusPlan& plan, NodeId id) {
  std::vector<KnownSignal> signals;
  for (const Signal& signal : plan.layout.signals) {
    if (signal.node != id) continue;
    signals.push_back({.name = signal.name,
                       .object = signal.object,
                       .type = signal.type,
                       .output = signal.output,
                       .pdo = pdo_of(plan, signal),
                       .scale = signal.scale,
                       .offset = signal.offset,
                       .unit = signal.unit});
  }
  return signals;
}

std::vector<KnownSignal> signals_of(const std::vector<signal_t>& layout, std::int16_t id) {
  std::vector<KnownSignal> signals;
  for (const signal_t& signal : layout) {
    if (signal.node_id != id) continue;
    signals.push_back({.name = signal.name,
                       .object = {static_cast<std::uint16_t>(signal.index),
                                  static_cast<std::uint8_t>(signal.sub)},
                       .type = static_cast<DataType>(signal.data_type),
                       .output = signal.output != 0,
                       .scale = signal.scale,
                       .offset = signal.offset,
                       .unit = signal.unit});
  }
  return signals;
}

/// Returns true if a path that a daemon named may be opened. The path comes over the network, so
/// only a device file is read.
bool is_device_file(const fs::path& path) {
  std::error_code error;
  const std::string extension = path.extension().string();
  return (same_word(extension, ".eds") || same_word(extension, ".dcf")) &&
         fs::is_regular_file(path, error);
}

/// Returns the path of the device file; empty if the daemon does not know it.
std::string device_file(DaemonClient& daemon, std::int16_t id) {
  const reply_t reply = daemon.ask(make_request("device_file", id), answer_limit);
  return reply.good != 0 ? reply.text : std::string{};
}

std::vector<KnownSignal> live_signals(const std::string& bus_name, const LiveOptions& options,
                                      std::int16_t id) {
  LcmClient lcm = open_live(options, {"STATUS", "LAYOUT"});
  BusViews views;
  const auto bus = [&]() -> const BusView* {
    const auto buses = chosen(views, bus_name);
    return buses.empty() ? nullptr : buses.front();
  };
  listen(lcm, views, monotonic_now() + layout_limit,
         [&] { return bus() != nullptr && !bus()->signals().empty(); });
  return bus() == nullptr ? std::vector<KnownSignal>{} : signals_of(bus()->signals(), id);
}

}  // namespace

KnownDevice device_of_eds(const std::string& path, std::optional<NodeId> id) {
  EdsFile file = read_eds_file(path, id);
  if (!file.readable) {
    throw Failure{path + ": can't be read as an EDS or DCF; `takt eds check " + path + "` says why",
                  exit_wrong_use};
  }
  if (!id) id = file.dictionary.node_id;
  return {.id = id, .file = path, .dictionary = std::move(file.dictionary)};
}

KnownDevice device_of_network(const std::string& path, const std::string& node) {
  const LoadedNetwork network = load_network(path);
  if (has_error(network.findings)) {
    throw Failure{path + ": has errors; `takt plan " + path + "` lists them", exit_wrong_use};
  }
  const std::size_t found = node_of(network.plan, node);
  if (found == network.plan.nodes.size()) {
    std::string list;
    std::vector<std::string_view> names;
    for (const NodePlan& known : network.plan.nodes) {
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", known.id.value(), known.name);
      names.push_back(known.name);
    }
    throw Failure{fmt::format("{} has no node '{}'{}; the nodes are: {}", path, node,
                              did_you_mean(node, names), list),
                  exit_wrong_use};
  }
  const NodePlan& plan = network.plan.nodes[found];
  KnownDevice device = device_of_eds(network.device_files[found], plan.id);
  device.name = plan.name;
  device.signals = signals_of(network.plan, plan.id);
  return device;
}

KnownDevice device_of_files(const DeviceFileOptions& files, const std::string& node) {
  if (files.eds.empty()) return device_of_network(files.network, node);
  return device_of_eds(files.eds, parse_node_id(node));
}

KnownDevice device_of_daemon(DaemonClient& daemon, const LiveOptions& options, std::int16_t id) {
  KnownDevice device{.id = NodeId::from(static_cast<unsigned>(id)),
                     .file = device_file(daemon, id),
                     .signals = live_signals(daemon.status().bus, options, id)};
  for (const node_status_t& node : daemon.status().nodes) {
    if (node.node_id == id) device.name = node.name;
  }
  if (!is_device_file(device.file)) return device;
  EdsFile file = read_eds_file(device.file, device.id);
  if (file.readable) device.dictionary = std::move(file.dictionary);
  return device;
}

}  // namespace takt
