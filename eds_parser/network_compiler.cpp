#include "eds_parser/network_compiler.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <map>

#include "eds_parser/boot_compiler.hpp"
#include "eds_parser/cycle_compiler.hpp"
#include "eds_parser/device_compiler.hpp"
#include "eds_parser/device_rules.hpp"
#include "eds_parser/frame_time.hpp"
#include "eds_parser/layout_compiler.hpp"
#include "eds_parser/node_values.hpp"
#include "eds_parser/pdo_compiler.hpp"
#include "eds_parser/signal_rules.hpp"

namespace takt {
namespace {

constexpr std::uint16_t default_producer_ms = 100;
constexpr std::uint32_t default_sdo_timeout_ms = 500;
constexpr std::uint32_t default_boot_timeout_ms = 3000;
constexpr std::uint32_t default_reboot_delay_ms = 1000;

Time milliseconds(std::uint32_t value) { return std::chrono::milliseconds{value}; }

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Names end up in LCM channels, in capitals.
std::string channel_form(const std::string& name) {
  std::string out = lower(name);
  std::ranges::replace(out, '-', '_');
  return out;
}

std::int64_t value_of(const ObjectDictionary& dictionary, ObjectKey key) {
  const SubObject* sub = dictionary.find(key);
  return sub != nullptr && sub->value() ? as_integer(*sub->value()).value_or(0) : 0;
}

bool is_cia402(const NodeSource& node) {
  if (node.spec->profile.given) return *node.spec->profile == "cia402";
  return (value_of(*node.dictionary, {0x1000, 0}) & 0xFFFF) == 402 &&
         node.dictionary->find(ObjectKey{0x6040, 0}) != nullptr &&
         node.dictionary->find(ObjectKey{0x6041, 0}) != nullptr;
}

class NetworkCompiler {
 public:
  NetworkCompiler(const NetworkSpec& spec, std::span<const ObjectDictionary* const> dictionaries,
                  std::span<const DeviceData> device_data, Findings& findings)
      : spec_{spec},
        dictionaries_{dictionaries},
        device_data_{device_data},
        report_{spec.file, findings} {}

  CompiledNetwork run() {
    bus();
    collect_nodes();
    for (NodePdos& node : nodes_) {
      node.pdos = compile_pdos(node.node, report_);
      judge_by_device_data(node, report_);
    }
    assign_cob_ids(nodes_, *spec_.master.sync_cob_id, report_);
    for (const NodePdos& node : nodes_) add_node(node);
    compile_layout(nodes_, plan(), report_);
    compile_cycle(spec_, nodes_, plan(), report_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) add_boot(i);
    for (const NodePdos& node : nodes_) out_.devices.push_back(compile_device(node.node));
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
    bus.stop_timeout = milliseconds(*master.stop_timeout_ms);
    bus.cycle.sync = *master.sync_period_us != 0;
    bus.cycle.period =
        std::chrono::microseconds{bus.cycle.sync ? *master.sync_period_us : *master.cycle_us};
    bus.cycle.sync_cob_id = CobId::base(*master.sync_cob_id);
    bus.cycle.sync_overflow = *master.sync_overflow;
    bus.cycle.sync_window = std::chrono::microseconds{*master.sync_window_us};
    if (*master.sync_cob_id != 0x80 && is_restricted(*master.sync_cob_id)) {
      report_.error(master.sync_cob_id.pos, "cob-id",
                    "`sync_cob_id` " + hex(*master.sync_cob_id, 3) + " is reserved by CiA 301");
    }
  }

  /// Nodes in ascending id; ids and names used once.
  void collect_nodes() {
    std::map<unsigned, const NodeSpec*> by_id;
    std::map<std::string, const NodeSpec*> by_name;
    for (std::size_t i = 0; i < spec_.nodes.size(); ++i) {
      const NodeSpec& node = spec_.nodes[i];
      check_name(node, by_name);
      if (!node.id.given) continue;
      if (!check_id(node, by_id)) continue;
      if (i >= dictionaries_.size() || dictionaries_[i] == nullptr) continue;
      nodes_.push_back({source_of(node, *dictionaries_[i]), {}});
    }
    std::ranges::sort(nodes_, {}, [](const NodePdos& n) { return n.node.id; });
  }

  NodeSource source_of(const NodeSpec& node, const ObjectDictionary& dictionary) {
    NodeSource source{&node, &dictionary, *NodeId::from(*node.id)};
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
    if (!is_new) {
      report_.error(node.id.pos, "node-id-clash",
                    "node id " + std::to_string(*node.id) + " of `" + node.name + "` belongs to `" +
                        first->second->name + "` (line " +
                        std::to_string(first->second->id.pos.line) + ") already");
      return false;
    }
    if (*node.id == *spec_.master.node_id) {
      report_.error(node.id.pos, "node-id-clash",
                    "node id " + std::to_string(*node.id) + " of `" + node.name +
                        "` is the master's" +
                        (spec_.master.node_id.given
                             ? " (line " + std::to_string(spec_.master.node_id.pos.line) + ")"
                             : " by default: write `master: {node_id: ...}`"));
      return false;
    }
    return true;
  }

  void check_name(const NodeSpec& node, std::map<std::string, const NodeSpec*>& by_name) {
    const auto [first, is_new] = by_name.emplace(channel_form(node.name), &node);
    if (is_new) return;
    report_.error(node.pos, "name",
                  "`" + node.name + "` and `" + first->second->name + "` (line " +
                      std::to_string(first->second->pos.line) +
                      ") would share their LCM channels: names differ by more than case");
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
        .sdo_timeout = milliseconds(spec.sdo_timeout_ms.value_or(default_sdo_timeout_ms)),
        .reboot_delay = milliseconds(spec.reboot_delay_ms.value_or(default_reboot_delay_ms))};
    node.heartbeat_timeout = heartbeat_timeout(source.node);
    node.heartbeat_period = milliseconds(*spec.boot ? producer_ms(source.node) : 0);
    node.guard = guard(source.node);
    node.emcy_cob_id = emcy_cob_id(source.node);
    node.start_later = plan().start_up.start_all && *spec.boot;
    node.on_loss = *spec.on_loss;
    node.group = group(*spec.group);
    check_keep_alive(spec, node);
    add_device_data(source, node);
    check_fallback(source.node, node.cia402, report_);
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
    for (const EmcyMeaning& emcy : data.emcy) node.emcy_texts.push_back({emcy.code, emcy.text});
  }

  /// Of the network file, else of the device file; none: the predefined 0x080 + id.
  static std::optional<CobId> emcy_cob_id(const NodeSource& node) {
    const std::int64_t own = value_of(*node.dictionary, {0x1014, 0});
    const std::int64_t id = node.spec->emcy_cob_id.given ? *node.spec->emcy_cob_id : own;
    const bool off = (id & 0x8000'0000) != 0;
    if (id <= 0 || off || id == 0x80 + node.id.value()) return std::nullopt;
    const auto raw = static_cast<std::uint32_t>(id);
    return (raw & 0x2000'0000) != 0 ? CobId::extended(raw) : CobId::base(raw);
  }

  std::uint8_t group(const std::string& name) {
    if (name.empty()) return 0;
    std::vector<std::string>& groups = plan().groups;
    auto found = std::ranges::find(groups, name);
    if (found == groups.end()) found = groups.insert(groups.end(), name);
    return static_cast<std::uint8_t>(found - groups.begin() + 1);
  }

  void check_keep_alive(const NodeSpec& spec, const NodePlan& node) {
    const bool shows_life = node.heartbeat_timeout != Time{} || node.guard.period != Time{};
    if (*spec.reset != ResetPolicy::keep_alive || !node.boot || shows_life) return;
    report_.error(spec.reset.pos, "keep-alive",
                  "node `" + spec.name +
                      "` is to be kept running, but shows its state neither by "
                      "heartbeat nor by guarding: give it `heartbeat_producer` or `guard_time`, or "
                      "write `reset: none`");
  }

  double multiplier(const NodeSpec& node) const {
    if (node.heartbeat_multiplier.given) return *node.heartbeat_multiplier;
    return spec_.master.heartbeat_multiplier.value_or(*spec_.heartbeat_multiplier);
  }

  /// 0x1017 of a node: of the network file; else of the device file; else, where the device can,
  /// 100 ms or as much as keeps all heartbeats below 2 % of the bus.
  std::uint16_t producer_ms(const NodeSource& node) const {
    if (node.spec->heartbeat_producer.given) return *node.spec->heartbeat_producer;
    const std::int64_t own = value_of(*node.dictionary, {0x1017, 0});
    if (own > 0 && own <= 0xFFFF) return static_cast<std::uint16_t>(own);
    if (!has_heartbeat_producer(*node.dictionary) || !*node.spec->boot) return 0;
    const Time all = wire_time(worst_frame_bits(1) * spec_.nodes.size(), out_.plan.bitrate);
    const auto floor = static_cast<std::uint32_t>(all * 50 / std::chrono::milliseconds{1}) + 1;
    return static_cast<std::uint16_t>(
        std::clamp<std::uint32_t>((floor + 49) / 50 * 50, default_producer_ms, 60'000));
  }

  Time heartbeat_timeout(const NodeSource& node) const {
    if (!*spec_.master.heartbeat_consumer) return Time{};
    const double ms = producer_ms(node) * std::max(1.5, multiplier(*node.spec));
    return Time{static_cast<Time::rep>(std::llround(ms * 1e6))};
  }

  /// Guarding where the device file or the network file has a guard time and there is no heartbeat.
  GuardPlan guard(const NodeSource& node) {
    const NodeSpec& spec = *node.spec;
    const std::int64_t own = value_of(*node.dictionary, {0x100C, 0});
    const std::int64_t ms = spec.guard_time.given ? *spec.guard_time : own;
    if (ms <= 0 || ms > 0xFFFF || !*spec.boot || !*spec_.master.heartbeat_consumer) return {};
    if (producer_ms(node) != 0) {
      if (spec.guard_time.given) {
        report_.note(spec.guard_time.pos, "guarding",
                     "node `" + spec.name +
                         "` has a heartbeat, and with it it does not answer "
                         "guarding (CiA 301): `guard_time` is left alone; `heartbeat_producer: 0` "
                         "would switch to guarding");
      }
      return {};
    }
    const std::int64_t factor = value_of(*node.dictionary, {0x100D, 0});
    const auto of_device = static_cast<std::uint8_t>(
        factor > 0 && factor <= 255 ? factor : std::int64_t{*spec_.retry_factor});
    return {.period = milliseconds(static_cast<std::uint32_t>(ms)),
            .retries = spec.retry_factor.value_or(spec_.retry_factor.given ? *spec_.retry_factor
                                                                           : of_device)};
  }

  void check_bit_rate(const NodeSource& node) {
    const auto& rates = node.dictionary->device.baud_rates_kbit;
    const std::uint32_t kbit = *spec_.master.baudrate_kbit;
    if (rates.empty() || std::ranges::find(rates, kbit) != rates.end()) return;
    std::string list;
    for (const std::uint16_t rate : rates)
      list += (list.empty() ? "" : ", ") + std::to_string(rate);
    report_.warning(node.spec->pos, "bit-rate",
                    "node `" + node.spec->name + "` knows " + list + " kbit/s by " +
                        node.dictionary->file + "; the bus runs at " + std::to_string(kbit));
  }

  void add_boot(std::size_t index) {
    const NodePdos& source = nodes_[index];
    NodePlan& node = plan().nodes[index];
    if (!node.boot) return;
    const MasterSpec& master = spec_.master;
    const std::uint16_t master_ms = *master.heartbeat_producer;
    const double accepted = master_ms * std::max(1.5, multiplier(*source.node.spec));
    const BootContext context{
        .master_id = out_.plan.master_id,
        .master_heartbeat_ms = master_ms,
        .master_consumer_ms = static_cast<std::uint16_t>(std::min(65535.0, std::ceil(accepted))),
        .producer_ms = producer_ms(source.node),
        .heartbeat_timeout = node.heartbeat_timeout,
        .guard = node.guard,
        .sync = out_.plan.cycle.sync,
        .sync_cob_id = *master.sync_cob_id,
        .sync_period_us = *master.sync_period_us,
        .sync_overflow = *master.sync_overflow,
        .sync_window_us = master.sync_window_us,
        .start_nodes = *master.start_nodes,
        .start_all = *master.start_all_nodes,
        .cia402 = node.cia402,
        .sdo_timeout = node.sdo_timeout,
        .boot_timeout =
            milliseconds(source.node.spec->boot_timeout_ms.value_or(default_boot_timeout_ms))};
    node.boot_plan = compile_boot(source, context, report_);
  }

  const NetworkSpec& spec_;
  std::span<const ObjectDictionary* const> dictionaries_;
  std::span<const DeviceData> device_data_;
  std::deque<ObjectDictionary> edited_;  ///< stable addresses
  NetworkReport report_;
  std::vector<NodePdos> nodes_;
  CompiledNetwork out_;
};

}  // namespace

CompiledNetwork compile_network(const NetworkSpec& spec,
                                std::span<const ObjectDictionary* const> dictionaries,
                                Findings& findings, std::span<const DeviceData> device_data) {
  return NetworkCompiler{spec, dictionaries, device_data, findings}.run();
}

}  // namespace takt
