#include <algorithm>
#include <array>
#include <cctype>

#include "eds_parser/network_file/sections.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/sim_names.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 32> keys_of_others{"driver",
                                                          "package",
                                                          "namespace",
                                                          "polling",
                                                          "period",
                                                          "non_transmit_timeout",
                                                          "diagnostics",
                                                          "switching_state",
                                                          "homing_timeout_seconds",
                                                          "channels",
                                                          "channel_names",
                                                          "num_channels",
                                                          "position_mode",
                                                          "velocity_mode",
                                                          "effort_mode",
                                                          "torque_mode",
                                                          "homing_mode",
                                                          "interpolated_position_mode",
                                                          "cyclic_position_mode",
                                                          "cyclic_velocity_mode",
                                                          "cyclic_torque_mode",
                                                          "enable_lazy_load",
                                                          "remappings",
                                                          "parameters",
                                                          "boot_timeout",
                                                          "joint_name",
                                                          "plugin",
                                                          "type",
                                                          "executor",
                                                          "container_name",
                                                          "description",
                                                          "comment"};
constexpr std::array<std::string_view, 4> position_scales{
    "scale_pos_to_dev", "scale_pos_from_dev", "offset_pos_to_dev", "offset_pos_from_dev"};
constexpr std::array<std::string_view, 4> velocity_scales{
    "scale_vel_to_dev", "scale_vel_from_dev", "offset_vel_to_dev", "offset_vel_from_dev"};
constexpr std::array<std::string_view, 4> torque_scales{"scale_eff_to_dev", "scale_eff_from_dev",
                                                        "offset_eff_to_dev", "offset_eff_from_dev"};
constexpr std::array<std::string_view, 2> acceleration_scales{"scale_acc_to_dev",
                                                              "scale_acc_from_dev"};
constexpr std::array<std::string_view, 1> not_supported{"time_cobid"};

/// Ignores the scales of ros2_canopen.
void ignore_scales(MapReader& reader) {
  const auto ignore = [&reader](std::span<const std::string_view> keys, const std::string& unit) {
    reader.ignore(keys,
                  "has no effect: takt scales with `units: {" + unit + "}}`, from counts to SI");
  };
  ignore(position_scales, "position: {scale: ..., offset: ..., unit: rad");
  ignore(velocity_scales, "velocity: {scale: ..., unit: rad/s");
  ignore(torque_scales, "torque: {scale: ..., unit: Nm");
  ignore(acceleration_scales, "acceleration: {scale: ..., unit: rad/s^2");
}

void read_firmware(MapReader& reader, Sourced<std::string>& out) {
  reader.text("firmware", out);
  if (!out.given || Firmware::parse(*out)) return;
  reader.report().error(
      out.pos, "not-a-version",
      "`firmware` of " + reader.what() + " has to be a version like \"16.00.00\"");
  out.given = false;
}

void read_identity(MapReader& reader, NodeSpec& node) {
  reader.integer("device_type", node.device_type);
  reader.integer("vendor_id", node.vendor_id);
  reader.integer("product_code", node.product_code);
  reader.integer("revision_number", node.revision_number);
  reader.integer("serial_number", node.serial_number);
  reader.text("device", node.device);
  read_firmware(reader, node.firmware);
}

/// Reads `lss:`, which is `true` or a map such as `{store: false}`.
void read_lss(MapReader& outer, NodeSpec& node) {
  const YamlNode* value = outer.take("lss");
  if (value == nullptr) return;
  node.lss = {true, value->pos, true};
  if (value->kind == YamlNode::Kind::map) {
    MapReader reader{*value, "`lss` of " + outer.what(), outer.report()};
    reader.boolean("store", node.lss_store);
    reader.finish();
  } else if (const auto wanted = read_bool(*value, "lss", outer.report())) {
    node.lss.value = *wanted;
  }
}

void read_reset(MapReader& reader, NodeSpec& node) {
  Sourced<bool> communication;
  reader.boolean("reset_communication", communication);
  if (communication.given) {
    node.reset = {*communication ? ResetPolicy::communication : ResetPolicy::keep_alive,
                  communication.pos, true};
  }
  const YamlNode* value = reader.take("reset");
  if (value == nullptr) return;
  constexpr std::array<std::string_view, 4> names{"communication", "node", "none", "keep_alive"};
  if (const auto choice = read_choice(*value, "reset", names, reader.report())) {
    if (communication.given) {
      reader.report().error(value->pos, "duplicate-key",
                            "`reset` and `reset_communication` set the same option: keep one");
    }
    node.reset = {static_cast<ResetPolicy>(*choice), value->pos, true};
  }
}

/// Reads the configuration date. `auto` derives it from the configured values.
void read_configuration_date(MapReader& reader, NodeSpec& node) {
  reader.integer("configuration_time", node.configuration_time, {0, 86'399'999, " ms"});
  const YamlNode* date = reader.take("configuration_date");
  if (date == nullptr) return;
  if (date->text == "auto") {
    node.configuration_date = {std::nullopt, date->pos, true};
    return;
  }
  constexpr IntegerRange days{1, 0xFFFF'FFFF, " days since 1984-01-01"};
  if (const auto value = read_integer(*date, "configuration_date", days, reader.report())) {
    node.configuration_date = {static_cast<std::uint32_t>(*value), date->pos, true};
  }
}

void read_loss(MapReader& reader, NodeSpec& node) {
  reader.text("group", node.group);
  const YamlNode* value = reader.take("on_loss");
  if (value == nullptr) return;
  constexpr std::array<std::string_view, 4> names{"report", "stop_node", "stop_group",
                                                  "quick_stop"};
  if (const auto choice = read_choice(*value, "on_loss", names, reader.report())) {
    node.on_loss = {static_cast<LossReaction>(*choice), value->pos, true};
  }
  if (*node.on_loss == LossReaction::stop_group && !node.group.given) {
    reader.report().error(value->pos, "group",
                          "`on_loss: stop_group` needs `group:`, the name that its nodes share");
  }
}

void read_boot(MapReader& reader, NodeSpec& node) {
  reader.boolean("boot", node.boot);
  reader.boolean("mandatory", node.mandatory);
  read_reset(reader, node);
  reader.integer("restore_configuration", node.restore, {0, 127});
  reader.integer("store_configuration", node.store, {0, 127});
  reader.integer("software_version", node.software_version);
  reader.file("software_file", node.software_file);
  reader.file("configuration_file", node.configuration_file);
  read_configuration_date(reader, node);
  reader.integer("boot_timeout_ms", node.boot_timeout_ms, {1, 600'000, " ms"});
  reader.integer("sdo_timeout_ms", node.sdo_timeout_ms, {1, 60'000, " ms"});
  reader.integer("reboot_delay_ms", node.reboot_delay_ms, {1, 600'000, " ms"});
  reader.integer("reboot_delay_max_ms", node.reboot_delay_max_ms, {1, 600'000, " ms"});
}

void read_heartbeat(MapReader& reader, NodeSpec& node) {
  read_heartbeat_ends(reader, node.heartbeat_consumer, node.heartbeat_producer);
  reader.number("heartbeat_multiplier", node.heartbeat_multiplier);
  if (node.heartbeat_multiplier.given && *node.heartbeat_multiplier < 1.5) {
    reader.report().error(
        node.heartbeat_multiplier.pos, "out-of-range",
        "`heartbeat_multiplier` has to be at least 1.5, or one late heartbeat stops the node");
  }
  reader.integer("guard_time", node.guard_time, {0, 65535, " ms"});
  reader.integer("life_time_factor", node.life_time_factor, {0, 255});
  reader.integer("emcy_cob_id", node.emcy_cob_id, {0x001, 0x7FF});
  reader.integer("emcy_inhibit_time", node.emcy_inhibit_time, {0, 65535, " x 100 us"});
  reader.integer("time_cob_id", node.time_cob_id);
  reader.integer("retry_factor", node.retry_factor, {0, 255});
  const YamlNode* behavior = reader.take("error_behavior");
  if (behavior == nullptr || behavior->kind == YamlNode::Kind::null) return;
  if (behavior->kind != YamlNode::Kind::map) {
    reader.report().error(
        behavior->pos, "wrong-type",
        "`error_behavior` has to be a map of sub-indices of 0x1029, for example `{1: 0}`");
    return;
  }
  for (const YamlPair& pair : behavior->pairs) {
    YamlNode sub;
    sub.kind = YamlNode::Kind::scalar;
    sub.text = pair.key;
    sub.pos = pair.key_pos;
    const auto key = read_integer(sub, "error_behavior", {1, 254}, reader.report());
    const auto value = read_integer(*pair.value, "error_behavior", {0, 255}, reader.report());
    if (!key || !value) continue;
    SdoSpec& sdo = node.error_behavior.emplace_back();
    sdo.object = {0x1029, static_cast<std::uint8_t>(*key)};
    sdo.value = *value;
    sdo.pos = pair.key_pos;
    sdo.value_pos = pair.value->pos;
  }
}

void warn_of_no_limit(const TimeoutSpec& timeout, NetworkReport& report) {
  for (const Sourced<std::uint32_t>* after : {&timeout.after, &timeout.after_cycles}) {
    if (!after->given || after->value != 0) continue;
    report.warning(after->pos, "no-time-to-live",
                   "0 means no limit: outputs keep their last command when the application dies; "
                   "use this for latched outputs of I/O nodes only");
  }
}

void warn_of_short_limit(const TimeoutSpec& timeout, NetworkReport& report) {
  const Sourced<std::uint32_t>& after = timeout.after_cycles;
  if (!after.given || after.value == 0 || after.value >= fewest_fallback_cycles) return;
  report.warning(after.pos, "short-time-to-live",
                 "commands last for " + std::to_string(fewest_fallback_cycles) +
                     " cycles at least: " + std::to_string(fewest_fallback_cycles) +
                     " is used instead of " + std::to_string(after.value));
}

void read_timeout(MapReader& outer, NodeSpec& node) {
  const YamlNode* map = outer.take("on_timeout");
  if (map == nullptr) return;
  MapReader reader{*map, "`on_timeout` of " + outer.what(), outer.report()};
  if (const YamlNode* fallback = reader.take("fallback")) {
    constexpr std::array<std::string_view, 5> names{"quick_stop", "hold", "zero", "safe",
                                                    "disable"};
    if (const auto choice = read_choice(*fallback, "fallback", names, outer.report())) {
      node.on_timeout.fallback = {static_cast<FallbackPolicy>(*choice), fallback->pos, true};
    }
  }
  reader.integer("after", node.on_timeout.after, {0, 3'600'000, " ms"});
  reader.integer("after_cycles", node.on_timeout.after_cycles, {0, 1'000'000});
  if (node.on_timeout.after.given && node.on_timeout.after_cycles.given) {
    outer.report().error(node.on_timeout.after_cycles.pos, "duplicate-key",
                         "`after` (ms) and `after_cycles` set the same time: keep one of them");
  }
  warn_of_no_limit(node.on_timeout, outer.report());
  warn_of_short_limit(node.on_timeout, outer.report());
  reader.finish();
}

/// Reads one word, or a list of words.
void read_quirks(const YamlNode& quirks, NodeSpec& node, NetworkReport& report) {
  if (quirks.kind == YamlNode::Kind::null) return;
  const auto add = [&](const YamlNode& word) {
    if (const auto choice = read_choice(word, "quirks", sim_quirks, report)) {
      node.sim.quirks.emplace_back(sim_quirks[*choice]);
    }
  };
  if (quirks.kind != YamlNode::Kind::sequence) return add(quirks);
  for (const YamlNode* item : quirks.items) add(*item);
}

void read_sim(MapReader& outer, NodeSpec& node) {
  const YamlNode* map = outer.take("sim");
  if (map == nullptr) return;
  MapReader reader{*map, "`sim` of " + outer.what(), outer.report()};
  if (const YamlNode* model = reader.take("model")) {
    if (const auto choice = read_choice(*model, "model", sim_models, outer.report())) {
      node.sim.model = sim_models[*choice];
    }
  }
  read_firmware(reader, node.sim.firmware);
  if (const YamlNode* quirks = reader.take("quirks")) read_quirks(*quirks, node, outer.report());
  reader.finish();
}

void read_lists(MapReader& reader, NodeSpec& node) {
  NetworkReport& report = reader.report();
  const std::string& owner = reader.what();
  if (const YamlNode* list = reader.take("tpdo")) {
    node.tpdos = read_pdos(*list, "tpdo", owner, report);
  }
  if (const YamlNode* list = reader.take("rpdo")) {
    const std::size_t errors = report.errors();
    node.rpdos = read_pdos(*list, "rpdo", owner, report);
    node.has_rpdo_errors = report.errors() != errors;
  }
  if (const YamlNode* list = reader.take("sdo")) {
    node.sdo = read_objects(*list, "sdo", owner, report);
  }
  if (const YamlNode* list = reader.take("safe_values")) {
    node.safe_values = read_objects(*list, "safe_values", owner, report);
  }
  if (const YamlNode* map = reader.take("units")) node.units = read_units(*map, owner, report);
  if (const YamlNode* map = reader.take("limits")) node.limits = read_limits(*map, owner, report);
}

void check_name(const std::string& name, SourcePos pos, NetworkReport& report) {
  const auto bad = [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; };
  if (name == "all" || (!name.empty() && std::ranges::all_of(name, [](unsigned char c) {
        return std::isdigit(c) != 0;
      }))) {
    report.error(pos, "name",
                 "`" + name +
                     "` can't be the name of a node: in commands like `takt nmt start` numbers are "
                     "node ids and `all` means all nodes");
  }
  if (name.empty() || name.size() > 48 || std::ranges::any_of(name, bad)) {
    report.error(
        pos, "name",
        "the node name `" + name.substr(0, 60) +
            "` becomes part of LCM channel names: use at most 48 letters, digits, `_` and `-`");
  }
}

}  // namespace

NodeSpec read_node(const YamlNode& node, const std::string& name, SourcePos pos,
                   NetworkReport& report) {
  NodeSpec spec;
  spec.name = name;
  spec.pos = pos;
  check_name(name, pos, report);
  MapReader reader{node, "node `" + name + "`", report};
  const bool has_id = reader.take("node_id") != nullptr;
  reader.integer("node_id", spec.id, {1, 127});
  reader.text("dcf", spec.dcf);
  reader.text("dcf_path", spec.dcf_path);
  read_identity(reader, spec);
  read_lss(reader, spec);
  read_boot(reader, spec);
  read_sdo_access(reader, spec);
  read_heartbeat(reader, spec);
  read_loss(reader, spec);
  if (const YamlNode* profile = reader.take("profile")) {
    constexpr std::array<std::string_view, 4> names{"none", "cia401", "cia402", "cia406"};
    if (const auto choice = read_choice(*profile, "profile", names, report)) {
      spec.profile = {std::string{names[*choice]}, profile->pos, true};
    }
  }
  read_lists(reader, spec);
  read_timeout(reader, spec);
  read_sim(reader, spec);
  reader.ignore(keys_of_others, "has no meaning for takt and is ignored");
  ignore_scales(reader);
  reader.ignore(not_supported, "has no effect in this version of takt");
  const YamlNode* misnamed = node.find("dcf") == nullptr ? reader.take("eds") : nullptr;
  if (reader.has_slip_of("rpdo")) spec.has_rpdo_errors = true;
  if (reader.has_slip_of("units")) spec.units.has_errors = true;
  reader.finish_shared(node.find("driver") != nullptr ? driver_key : std::string_view{});
  if (node.kind != YamlNode::Kind::map && node.kind != YamlNode::Kind::null) return spec;
  if (!has_id && !reader.has_slip_of("node_id"))
    report.error(pos, "missing-key", "node `" + name + "` lacks `node_id` (1..127)");
  if (misnamed != nullptr) {
    report.error(reader.key_pos("eds"), "missing-key",
                 "node `" + name +
                     "` names its device file under `eds`, which no program reads; the key is "
                     "`dcf`, for an EDS as well");
  } else if (!spec.dcf.given && node.find("dcf") == nullptr && !reader.has_slip_of("dcf")) {
    report.error(pos, "missing-key",
                 "node `" + name + "` lacks `dcf`, the name of its EDS or DCF file");
  }
  return spec;
}

}  // namespace takt
