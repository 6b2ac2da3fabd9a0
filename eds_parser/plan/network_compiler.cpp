#include "eds_parser/plan/network_compiler.hpp"

#include <algorithm>
#include <cctype>
#include <deque>
#include <map>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/profile_of.hpp"
#include "eds_parser/plan/boot/boot_compiler.hpp"
#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/plan/device/device_compiler.hpp"
#include "eds_parser/plan/device/device_rules.hpp"
#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/plan/error_control.hpp"
#include "eds_parser/plan/image/layout_compiler.hpp"
#include "eds_parser/plan/image/signal_rules.hpp"
#include "eds_parser/plan/image/speed_axes.hpp"
#include "eds_parser/plan/limits/limits_compiler.hpp"
#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/plan/pdo/pdo_compiler.hpp"
#include "eds_parser/plan/sdo_servers.hpp"
#include "eds_parser/table/waits.hpp"

namespace takt {
namespace {

constexpr std::uint32_t default_sdo_timeout_ms = 500;
constexpr Time storing_timeout = std::chrono::seconds{5};
constexpr std::uint32_t default_reboot_delay_ms = 1000;
constexpr std::uint32_t default_reboot_delay_max_ms = 30'000;
constexpr std::uint8_t stand_in_id = 127;
constexpr std::uint8_t stray_index = 255;  // index of a node that has no place in the plan
constexpr int stop_cycles = 10;  // limit of an ordered stop without axes, which takes five cycles

Time milliseconds(std::uint32_t value) { return std::chrono::milliseconds{value}; }

Time sdo_timeout(const NodeSpec& node) {
  return milliseconds(node.sdo_timeout_ms.value_or(default_sdo_timeout_ms));
}

/// Returns a name in the form in which names are compared: in lower case, with `_` for `-`. LCM
/// channels contain the names in capitals.
std::string channel_form(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return name;
}

class NetworkCompiler {
 public:
  NetworkCompiler(const NetworkSpec& spec, std::span<const ObjectDictionary* const> dictionaries,
                  std::span<const DeviceData> device_data, Findings& findings)
      : spec_{spec},
        dictionaries_{dictionaries},
        device_data_{device_data},
        report_{spec.file, findings},
        error_control_{spec, report_} {}

  CompiledNetwork run() {
    bus();
    collect_nodes();
    compile_sync_source(spec_, nodes_, plan(), report_);
    for (NodePdos& node : nodes_) {
      node.pdos = compile_pdos(node.node, report_);
      judge_by_device_data(node, spec_.master, report_);
    }
    assign_cob_ids(nodes_, service_ids(spec_, nodes_, report_), report_);
    for (const NodePdos& node : nodes_) judge_pdo_times(node, plan().bitrate, report_);
    ask_about_drives(nodes_, report_);
    for (const NodePdos& node : nodes_) {
      judge_interpolation(node, *spec_.master.sync_period_us, report_);
    }
    for (const NodePdos& node : nodes_) add_node(node);
    error_control_.report_unused_retry_factor();
    compile_layout(nodes_, plan(), report_);
    compile_cycle(spec_, nodes_, plan(), report_);
    compile_speed_axes(nodes_, plan(), report_);
    compile_limits(nodes_, plan(), report_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) add_boot(i);
    for (const NodePdos& node : nodes_) out_.devices.push_back(compile_device(node.node));
    stop();
    judge_feed_forward(plan(), spec_, report_);
    for (NodePdos& node : strays_) judge_stray(node);
    return std::move(out_);
  }

 private:
  BusPlan& plan() { return out_.plan; }

  void bus() {
    const MasterSpec& master = spec_.master;
    BusPlan& bus = plan();
    bus.interface = *spec_.bus.interface;
    bus.name = spec_.bus.name.given          ? *spec_.bus.name
               : !spec_.bus.interface->empty() ? *spec_.bus.interface
                                               : "sim";
    bus.bitrate = *master.baudrate_kbit * 1000;
    bus.master_id = *NodeId::from(*master.node_id);
    bus.master_heartbeat = milliseconds(*master.heartbeat_producer);
    bus.start_nodes = *master.start_nodes;
    bus.start_up = {.start_master = *master.start,
                    .start_all = *master.start_all_nodes,
                    .on_loss = *master.stop_all_nodes    ? MandatoryLoss::stop_all
                               : *master.reset_all_nodes ? MandatoryLoss::reset_all
                                                         : MandatoryLoss::only_it,
                    .boot_time = milliseconds(*master.boot_time_ms),
                    .nmt_inhibit = std::chrono::microseconds{100} * *master.nmt_inhibit_time};
    bus.cycle.sync = *master.sync_period_us != 0;
    bus.cycle.period =
        std::chrono::microseconds{bus.cycle.sync ? *master.sync_period_us : *master.cycle_us};
    bus.stop_disarm = *master.stop_disarm;
    bus.cycle.sync_cob_id = CobId::base(*master.sync_cob_id);
    bus.cycle.sync_overflow = *master.sync_overflow;
    bus.time = {.period = milliseconds(*master.time_period_ms),
                .cob_id = CobId::base(*master.time_cob_id & 0x7FF)};
    if (*master.time_period_ms != 0 && is_restricted(*master.time_cob_id & 0x7FF)) {
      report_.error(master.time_cob_id.pos, "cob-id", "`time_cob_id` ",
                    hex(*master.time_cob_id & 0x7FF, 3),
                    " is reserved by CiA 301; 0x100 is its default");
    }
    bus.cycle.sync_window = std::chrono::microseconds{*master.sync_window_us};
    if (*master.sync_cob_id != 0x80 && is_restricted(*master.sync_cob_id)) {
      report_.error(master.sync_cob_id.pos, "cob-id", "`sync_cob_id` ", hex(*master.sync_cob_id, 3),
                    " is reserved by CiA 301");
    }
  }

  /// Sets the time of the ordered stop: the value of the network file, else a value derived from
  /// the ramps of the drives.
  void stop() {
    BusPlan& bus = plan();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      bus.nodes[i].axes = compile_axes(bus.nodes[i], out_.devices[i], nodes_[i].node, report_);
    }
    const auto& written = spec_.master.stop_timeout_ms;
    const Time derived = std::max(waits::stop_timeout_for(longest_stopping_time(bus)),
                                  stop_cycles * bus.cycle.period);
    bus.stop_timeout = written.given ? milliseconds(*written)
                                     : Time{std::chrono::ceil<std::chrono::milliseconds>(derived)};
    judge_stop(bus, spec_, report_);
  }

  /// Collects the nodes in ascending node-ID and checks that node-IDs and names are used only once.
  /// A node without a valid node-ID becomes a stray.
  void collect_nodes() {
    std::map<unsigned, const NodeSpec*> by_id;
    std::map<std::string, const NodeSpec*> by_name;
    for (std::size_t i = 0; i < spec_.nodes.size(); ++i) {
      const NodeSpec& node = spec_.nodes[i];
      check_name(node, by_name);
      const bool has_id = node.id.given && check_id(node, by_id);
      if (i >= dictionaries_.size() || dictionaries_[i] == nullptr) continue;
      const auto id = NodeId::from(has_id ? *node.id : stand_in_id);
      (has_id ? nodes_ : strays_).push_back({source_of(node, *dictionaries_[i], *id), {}});
    }
    std::ranges::sort(nodes_, {}, [](const NodePdos& n) { return n.node.id; });
  }

  NodeSource source_of(const NodeSpec& node, const ObjectDictionary& dictionary, NodeId id) {
    NodeSource source{&node, &dictionary, id};
    source.data = find_device_data(device_data_, node, dictionary, report_);
    source.firmware = firmware_of(source.data, node, dictionary);
    if (source.data != nullptr && !source.data->objects.empty()) {
      source.dictionary =
          &edited_.emplace_back(with_object_edits(dictionary, *source.data, source.firmware));
    }
    return source;
  }

  bool check_id(const NodeSpec& node, std::map<unsigned, const NodeSpec*>& by_id) {
    const auto [first, is_new] = by_id.emplace(*node.id, &node);
    const auto refuse = [&](const auto&... why) {
      report_.error(node.id.pos, "node-id-clash", "node id ", *node.id, " of `", node.name, "` ",
                    why...);
      return false;
    };
    if (!is_new) {
      return refuse("belongs to `", first->second->name, "` (line ", first->second->id.pos.line,
                    ") already");
    }
    const Sourced<std::uint8_t>& master = spec_.master.node_id;
    if (*node.id != *master) return true;
    return refuse("is the master's", master.given ? concat(" (line ", master.pos.line, ")")
                                                  : " by default: write `master: {node_id: ...}`");
  }

  void check_name(const NodeSpec& node, std::map<std::string, const NodeSpec*>& by_name) {
    const auto [first, is_new] = by_name.emplace(channel_form(node.name), &node);
    if (is_new) return;
    report_.error(node.pos, "name", "`", node.name, "` and `", first->second->name, "` (line ",
                  first->second->pos.line,
                  ") would share their LCM channels: names have to differ by more than case");
  }

  Time longest_reboot_delay(const NodeSpec& spec, Time first) {
    const Time longest =
        milliseconds(spec.reboot_delay_max_ms.value_or(default_reboot_delay_max_ms));
    if (spec.reboot_delay_max_ms.given && longest < first) {
      report_.error(spec.reboot_delay_max_ms.pos, "range", "`reboot_delay_max_ms` of node `",
                    spec.name, "` is shorter than its `reboot_delay_ms`, which is the first pause");
    }
    return std::max(first, longest);
  }

  void add_node(const NodePdos& source) {
    const NodeSpec& spec = *source.node.spec;
    const ObjectDictionary& dictionary = *source.node.dictionary;
    NodePlan node{
        .name = spec.name,
        .id = source.node.id,
        .description_file = *spec.dcf,
        .product_name = dictionary.device.product_name,
        .boot = *spec.boot,
        .mandatory = *spec.mandatory,
        .cia402 = is_cia402(source.node),
        .boot_plan = {},
        .sdo_timeout = sdo_timeout(spec),
        .reboot_delay = milliseconds(spec.reboot_delay_ms.value_or(default_reboot_delay_ms))};
    node.longest_reboot_delay = longest_reboot_delay(spec, node.reboot_delay);
    node.heartbeat_timeout = error_control_.heartbeat_timeout(source.node);
    node.consumes_master = *spec.heartbeat_consumer;
    node.heartbeat_period = milliseconds(*spec.boot ? error_control_.producer_ms(source.node) : 0);
    node.guard = error_control_.guard(source.node);
    node.emcy_cob_id = emcy_cob_id(source.node);
    node.start_later = plan().start_up.start_all && *spec.boot;
    node.on_loss = *spec.on_loss;
    node.group = group(*spec.group);
    check_keep_alive(spec, node, report_);
    node.lss = compile_lss(spec, dictionary, plan().nodes, report_);
    add_device_data(source, node);
    node.sdo = sdo_access(source.node);
    if (!spec.profile.given && is_drive_by_objects(dictionary)) {
      report_.note(spec.pos, "profile", "node `", spec.name, "`: ", dictionary.file,
                   " has no value for 1000:00; because of 6040:00 and 6041:00 takt treats the "
                   "device as a drive (write `profile: none` if it is not a drive)");
    }
    check_fallback(source.node, node.cia402, report_);
    check_sdo_channel(source.node, report_);
    check_node_values(source, report_);
    check_bit_rate(source.node);
    plan().nodes.push_back(std::move(node));
  }

  static void add_device_data(const NodePdos& source, NodePlan& node) {
    if (source.node.data == nullptr) return;
    const DeviceData& data = *source.node.data;
    node.device_data = data.name;
    node.device_data_file = data.id + ".yaml";
    node.device_notes = device_notes(source);
    node.on_sync_loss = data.on_sync_loss;
    node.firmware = firmware_plan(data, source.node.firmware);
    node.emcy_texts = data.emcy;
  }

  std::uint8_t group(const std::string& name) {
    if (name.empty()) return 0;
    std::vector<std::string>& groups = plan().groups;
    auto found = std::ranges::find(groups, name);
    if (found == groups.end()) found = groups.insert(groups.end(), name);
    return static_cast<std::uint8_t>(found - groups.begin() + 1);
  }

  /// Returns the timeouts of the network file, then those of the device data. The latter are never
  /// shorter than the general SDO timeout of the node.
  static std::vector<SdoObjectTimeout> stated_timeouts(const NodeSource& node) {
    std::vector<SdoObjectTimeout> list = node.spec->sdo_timeouts;
    if (node.data == nullptr) return list;
    for (const TimeoutEdit& edit : node.data->timeouts) {
      list.push_back(edit.timeout);
      list.back().timeout = std::max(sdo_timeout(*node.spec), edit.timeout.timeout);
    }
    return list;
  }

  /// Objects that store or restore parameters get a longer timeout, unless another timeout is
  /// stated.
  static SdoAccess sdo_access(const NodeSource& node) {
    const NodeSpec& spec = *node.spec;
    SdoAccess access{.block = spec.sdo_block.value_or(SdoBlockUse::automatic),
                     .timeouts = stated_timeouts(node)};
    if (spec.sdo_channel.given) access.channel = *spec.sdo_channel;
    const Time storing = std::max(storing_timeout, sdo_timeout(spec));
    access.timeouts.push_back({.index = 0x1010, .timeout = storing});
    access.timeouts.push_back({.index = 0x1011, .timeout = storing});
    return access;
  }

  void check_bit_rate(const NodeSource& node) {
    const auto& rates = node.dictionary->device.baud_rates_kbit;
    const std::uint32_t kbit = *spec_.master.baudrate_kbit;
    if (rates.empty() || std::ranges::find(rates, kbit) != rates.end()) return;
    std::string list;
    for (const std::uint16_t rate : rates) append_item(list, rate);
    report_.warning(node.spec->pos, "bit-rate", "node `", node.spec->name, "` supports ", list,
                    " kbit/s according to ", node.dictionary->file, ", but the bus runs at ", kbit);
  }

  void add_boot(std::size_t index) {
    const NodePdos& source = nodes_[index];
    NodePlan& node = plan().nodes[index];
    if (node.boot) compile_boot_of(source, node, static_cast<std::uint8_t>(index));
    set_device_watch(*source.node.dictionary, node);
  }

  /// Compiles a node without a valid node-ID, only so that one run also reports its other errors.
  void judge_stray(NodePdos& source) {
    source.pdos = compile_pdos(source.node, report_);
    judge_by_device_data(source, spec_.master, report_);
    check_node_values(source, report_);
    NodePlan node{.name = source.node.spec->name, .id = source.node.id};
    if (*source.node.spec->boot) compile_boot_of(source, node, stray_index);
  }

  void compile_boot_of(const NodePdos& source, NodePlan& node, std::uint8_t node_index) {
    const BootContext context{.master = spec_.master,
                              .plan = out_.plan,
                              .node = node,
                              .master_consumer_ms = error_control_.master_consumer_ms(source.node),
                              .producer_ms = error_control_.producer_ms(source.node),
                              .node_index = node_index};
    node.boot_plan = compile_boot(source, context, report_);
    const SdoAccess stated{.timeouts = stated_timeouts(source.node)};
    for (BootStep& step : node.boot_plan.steps) {
      const bool waits_only = step.object == ObjectKey{} || step.action == BootAction::probe;
      if (!waits_only) step.timeout = stated.timeout_of(step.object, step.timeout);
    }
  }

  const NetworkSpec& spec_;
  std::span<const ObjectDictionary* const> dictionaries_;
  std::span<const DeviceData> device_data_;
  std::deque<ObjectDictionary> edited_;  ///< a deque, because its elements keep their addresses
  NetworkReport report_;
  ErrorControl error_control_;
  std::vector<NodePdos> nodes_;
  std::vector<NodePdos> strays_;
  CompiledNetwork out_;
};

}  // namespace

CompiledNetwork compile_network(const NetworkSpec& spec,
                                std::span<const ObjectDictionary* const> dictionaries,
                                Findings& findings, std::span<const DeviceData> device_data) {
  return NetworkCompiler{spec, dictionaries, device_data, findings}.run();
}

}  // namespace takt
