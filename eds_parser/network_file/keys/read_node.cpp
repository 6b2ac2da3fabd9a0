#include <algorithm>
#include <cctype>

#include "eds_parser/network_file/keys/sections.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/sim_names.hpp"

namespace takt {
namespace {

// Each list has its words in the order of the enumerators of its type.
constexpr std::string_view reset_words[] = {"communication", "node", "none", "keep_alive"};
constexpr std::string_view loss_words[] = {"report", "stop_node", "stop_group", "quick_stop"};
constexpr std::string_view fallback_words[] = {"quick_stop", "hold", "zero", "safe", "disable"};
constexpr std::string_view block_words[] = {"auto", "never"};
constexpr std::string_view profile_words[] = {"none", "cia401", "cia402", "cia406"};
constexpr std::string_view date_words[] = {"auto"};

/// Reads the name of a file. An empty name counts as not given, as in the generators of other
/// masters.
void read_file_name(const KeyInput& in, Sourced<std::string>& out) {
  const bool empty = in.node.kind == YamlNode::Kind::scalar && in.node.text.empty();
  if (!empty) set(in, out);
}

constexpr Key<NodeSpec> lss_keys[] = {
    key<&NodeSpec::lss_store>("store", "true", "The device stores the node id."),
};

/// Reads `lss:`, which is `true` or a map such as `{store: false}`.
void read_lss(const KeyInput& in, NodeSpec& node) {
  node.lss = {true, in.node.pos, true};
  if (in.node.kind != YamlNode::Kind::map) return set(in, node.lss);
  MapReader map{in.node, in.what(), in.report()};
  read_keys(map, lss_keys, node, in.node.pos);
  map.finish();
}

void read_reset_communication(const KeyInput& in, NodeSpec& node) {
  Sourced<bool> communication;
  set(in, communication);
  if (!communication.given) return;
  node.reset = {*communication ? ResetPolicy::communication : ResetPolicy::keep_alive,
                communication.pos, true};
}

void read_reset(const KeyInput& in, NodeSpec& node) {
  if (node.reset.given) {
    in.error("duplicate-key", "`reset` and `reset_communication` set the same option: keep one");
  }
  set(in, node.reset);
}

constexpr IntegerRange error_classes{1, 254};
constexpr IntegerRange error_reactions{0, 255};

void read_error_behavior(const KeyInput& in, NodeSpec& node) {
  if (in.node.kind == YamlNode::Kind::null) return;
  if (in.node.kind != YamlNode::Kind::map) {
    return in.error(
        "wrong-type",
        "`error_behavior` has to be a map of sub-indices of 0x1029, for example `{1: 0}`");
  }
  for (const YamlPair& pair : in.node.pairs) {
    const auto sub = read_number_key(pair, in.key.name, error_classes, in.report());
    const auto value = read_integer(*pair.value, in.key.name, error_reactions, in.report());
    if (!sub || !value) continue;
    node.error_behavior.push_back({.object = {0x1029, static_cast<std::uint8_t>(*sub)},
                                   .value = *value,
                                   .pos = pair.key_pos,
                                   .value_pos = pair.value->pos});
  }
}

constexpr Key<SdoObjectTimeout> sdo_timeout_keys[] = {
    required(key<&SdoObjectTimeout::index>("index", whole(1, 0xFFFF), "", "The index.")),
    key<&SdoObjectTimeout::sub>("sub_index", "all", "The sub-index."),
    required(key<&SdoObjectTimeout::timeout>("timeout_ms", whole(1, 600'000, "ms"), "",
                                             "The time for each SDO answer.")),
};

struct WrittenChannel {
  std::uint32_t request = 0;
  std::uint32_t answer = 0;
};

constexpr Key<WrittenChannel> channel_keys[] = {
    required(
        key<&WrittenChannel::request>("request", whole(0x581, 0x7FF), "",
                                      "The COB-ID of the requests of the master (0x1201:01).")),
    required(key<&WrittenChannel::answer>("answer", whole(0x581, 0x7FF), "",
                                          "The COB-ID of the answers of the device (0x1201:02).")),
};

void read_channel(const KeyInput& in, NodeSpec& node) {
  const std::size_t errors = in.report().errors();
  WrittenChannel channel;
  read_map(in.node, in.what(), channel_keys, channel, in.report());
  if (in.report().errors() != errors) return;
  if (channel.request == channel.answer) {
    return in.error("missing-key", in.what(), " needs two different COB-IDs");
  }
  node.sdo_channel = {
      {CobId::base(channel.request), CobId::base(channel.answer)}, in.node.pos, true};
}

constexpr Key<TimeoutSpec> timeout_keys[] = {
    key<&TimeoutSpec::fallback>("fallback", word_of(fallback_words),
                                "drives `quick_stop`, inverters stop, others `hold`",
                                "The reaction of the outputs. `quick_stop` and `disable` are for "
                                "drives and inverters; `safe` needs `safe_values`."),
    key<&TimeoutSpec::after>("after", whole(0, 3'600'000, "ms"), "50; inverters 500",
                             "The time to live of a command, never below 3 cycles. 0 means no "
                             "limit and causes a warning."),
    key<&TimeoutSpec::after_cycles>("after_cycles", whole(0, 1'000'000), "none",
                                    "The same in cycles; 1 and 2 become 3 with a warning."),
};

void check_timeout(const KeyInput& in, const TimeoutSpec& timeout) {
  const auto& [fallback, after, cycles] = timeout;
  NetworkReport& report = in.report();
  if (after.given && cycles.given) {
    report.error(cycles.pos, "duplicate-key",
                 "`after` (ms) and `after_cycles` set the same time: keep one of them");
  }
  for (const Sourced<std::uint32_t>* limit : {&after, &cycles}) {
    if (!limit->given || limit->value != 0) continue;
    report.warning(limit->pos, "no-time-to-live",
                   "0 means no limit: outputs keep their last command when the application dies; "
                   "use this for latched outputs of I/O nodes only");
  }
  if (!cycles.given || *cycles == 0 || *cycles >= fewest_fallback_cycles) return;
  const std::string fewest = std::to_string(fewest_fallback_cycles);
  report.warning(cycles.pos, "short-time-to-live", "commands last for ", fewest,
                 " cycles at least: ", fewest, " is used instead of ", *cycles);
}

/// Reads one word, or a list of words.
void read_quirks(const KeyInput& in, SimSpec& sim) {
  if (in.node.kind == YamlNode::Kind::null) return;
  const auto add = [&](const YamlNode& word) {
    const auto choice = read_choice(word, in.key.name, sim_quirks, in.report());
    if (choice) sim.quirks.emplace_back(sim_quirks[*choice]);
  };
  if (in.node.kind != YamlNode::Kind::sequence) return add(in.node);
  for (const YamlNode* item : in.node.items) add(*item);
}

constexpr Key<SimSpec> sim_keys[] = {
    key<&SimSpec::model>("model", word_of(sim_models), "by 0x1000", "The simulated device."),
    key<&SimSpec::firmware>("firmware", "unknown", "The firmware of the simulated device."),
    key<read_quirks>("quirks", {.type = KeyType::list, .words = sim_quirks}, "none",
                     "Faults and special features, which [faults.md](faults.md) describes."),
    key<read_mechanics>("mechanics", {.type = KeyType::map, .parts = mechanics_rows}, "none",
                        "The mechanics of each axis of a `drive402`; `{}`: a servo motor of 400 W "
                        "with a load. See [simulation.md](simulation.md)."),
};

void check_sim(const KeyInput& in, const SimSpec& sim) {
  if (!sim.mechanics || sim.model.empty() || sim.model == "drive402") return;
  in.error("wrong-type", in.what(), ": `mechanics` belongs to the model `drive402`, not to `",
           sim.model, "`");
}

void read_rpdos(const KeyInput& in, NodeSpec& node) {
  const std::size_t errors = in.report().errors();
  read_pdos(in, node.rpdos);
  node.has_rpdo_errors = in.report().errors() != errors;
}

constexpr KeyValue pdos{.type = KeyType::numbered, .range = {1, 512}, .parts = pdo_rows};
constexpr KeyValue object_list{.type = KeyType::list, .parts = object_rows};
constexpr KeyValue file_name{.type = KeyType::text};

constexpr std::string_view ros_modes =
    "it is for the ROS 2 drive driver; in takt map 0x6060, and the application chooses the mode";
constexpr std::string_view ros_channels =
    "ROS 2 drive channels; in takt every mapped object is in the image";

constexpr Key<NodeSpec> node_keys[] = {
    required(key<&NodeSpec::id>("node_id", whole(1, 127), "", "The node id.", bus_yml)),
    key<&NodeSpec::dcf>("dcf", "required",
                        "EDS or DCF, relative to this file, then to `dcf_path`. It is read when "
                        "taktd starts: there is no build step.",
                        bus_yml),
    key<&NodeSpec::dcf_path>(
        "dcf_path", "from `options`",
        "A folder in which takt looks for device files that are not beside this file.", bus_yml),
    key<&NodeSpec::device_type>("device_type", "from the EDS",
                                "The expected value of 0x1000. 0: not checked."),
    key<&NodeSpec::vendor_id>("vendor_id", "from the EDS",
                              "The expected value of 0x1018:01. 0: not checked.", bus_yml),
    key<&NodeSpec::product_code>("product_code", "from the EDS",
                                 "The expected value of 0x1018:02. 0: not checked.", bus_yml),
    key<&NodeSpec::revision_number>("revision_number", "0",
                                    "The expected value of 0x1018:03. 0: not checked.", bus_yml),
    key<&NodeSpec::serial_number>("serial_number", "0",
                                  "The expected value of 0x1018:04. 0: not checked.", bus_yml),
    key<read_lss>("lss", {.type = KeyType::boolean, .parts = rows_of<lss_keys>}, "false",
                  "A device without node id that has the expected identity gets this node id by "
                  "LSS (CiA 305)."),
    key<&NodeSpec::device>("device", "by identity",
                           "Entry of the [device data](device_data.md), for example `lenze8400`; "
                           "`none`: no entry."),
    key<&NodeSpec::firmware>("firmware", "unknown, or from the revision number",
                             "Some rules of the device data begin or end with a version."),
    key<&NodeSpec::boot>("boot", "true",
                         "false: the node is only watched; it gets no NMT command and no SDO.",
                         bus_yml),
    key<&NodeSpec::mandatory>("mandatory", "false",
                              "If the node fails to boot at the start, `taktd` ends with exit "
                              "code 4. If it is lost later, the master waits for it as for other "
                              "nodes.",
                              bus_yml),
    key<read_reset_communication>("reset_communication", {.type = KeyType::boolean}, "true",
                                  "false is `reset: keep_alive`, true is `reset: communication`.",
                                  bus_yml),
    key<read_reset>("reset", word_of(reset_words), "`communication`",
                    "The reset that the master sends before it boots the node."),
    key<&NodeSpec::restore>("restore_configuration", whole(0, 127), "0",
                            "Sub-index of 0x1011 that is loaded before the configuration.",
                            bus_yml),
    key<&NodeSpec::store>("store_configuration", whole(0, 127), "0",
                          "Sub-index of 0x1010 that is saved after the configuration, if anything "
                          "was written."),
    key<&NodeSpec::software_version>("software_version", "0",
                                     "The version that is expected in 0x1F56:01. 0: not checked.",
                                     bus_yml),
    key<with<read_file_name, &NodeSpec::software_file>>(
        "software_file", file_name, "none",
        "Program that is loaded (0x1F50:01) if the version differs.", bus_yml),
    key<with<read_file_name, &NodeSpec::configuration_file>>(
        "configuration_file", file_name, "none",
        "Concise DCF (0x1F22), written in its order before `sdo`. dcfgen expects a folder here.",
        bus_yml),
    key<&NodeSpec::configuration_date>(
        "configuration_date", whole_or(date_words, {1, 0xFFFF'FFFF, "days since 1984-01-01"}),
        "from a DCF (0x1020)",
        "The date in 0x1020:01. `auto` derives date and time from what is configured."),
    key<&NodeSpec::configuration_time>("configuration_time", whole(0, 86'399'999, "ms"),
                                       "from a DCF (0x1020)",
                                       "The time in 0x1020:02, since midnight."),
    key<&NodeSpec::boot_timeout_ms>("boot_timeout_ms", whole(1, 600'000, "ms"), "3000",
                                    "Time for the first answer of the node in its boot.", bus_yml),
    key<&NodeSpec::sdo_timeout_ms>("sdo_timeout_ms", whole(1, 60'000, "ms"), "500",
                                   "Time for each SDO answer.", bus_yml),
    key<&NodeSpec::reboot_delay_ms>("reboot_delay_ms", whole(1, 600'000, "ms"), "1000",
                                    "The pause before a failed boot is tried again. It doubles "
                                    "with each boot that fails."),
    key<&NodeSpec::reboot_delay_max_ms>("reboot_delay_max_ms", whole(1, 600'000, "ms"), "30000",
                                        "The longest pause between two boots."),
    key<&NodeSpec::sdo_block>("sdo_block", word_of(block_words), "`auto`",
                              "Whether values of 128 bytes and more, and files, use block "
                              "transfer."),
    key<read_channel>("sdo_channel", {.type = KeyType::map, .parts = rows_of<channel_keys>},
                      "0x600 and 0x580 + node id",
                      "Another SDO server of the device, so that a tool can have the first one."),
    list_key<&NodeSpec::sdo_timeouts, sdo_timeout_keys>("sdo_timeouts", "0x1010 and 0x1011: 5 s",
                                                        "Objects that take longer."),
    key<with<read_consumer, &NodeSpec::heartbeat_consumer>>(
        "heartbeat_consumer", {.type = KeyType::boolean}, "true",
        "The device watches the master (0x1016).", bus_yml),
    key<with<read_producer, &NodeSpec::heartbeat_producer>>(
        "heartbeat_producer", whole(0, 65535, "ms"), "from the EDS, otherwise 100",
        "The period of the node's heartbeat (0x1017). 0: it sends none.", bus_yml),
    key<with<read_multiplier, &NodeSpec::heartbeat_multiplier>>(
        "heartbeat_multiplier", multiplier_value, "from `options`",
        "The accepted silence of this node, in heartbeat periods.", bus_yml),
    key<&NodeSpec::guard_time>("guard_time", whole(0, 65535, "ms"), "from the EDS",
                               "The guard time (0x100C). The master guards the node by remote "
                               "frames; this is for a device without heartbeat.",
                               bus_yml),
    key<&NodeSpec::life_time_factor>("life_time_factor", whole(0, 255), "unchanged",
                                     "0x100D: the device reports loss of the master after this "
                                     "number of guard times. 0: it does not watch.",
                                     bus_yml),
    key<&NodeSpec::retry_factor>(
        "retry_factor", whole(0, 255), "from `options`, otherwise 0x100D",
        "The master reports the loss of the device after this number of guard times. "
        "0: it does not guard.",
        bus_yml),
    key<&NodeSpec::emcy_cob_id>("emcy_cob_id", whole(0x001, 0x7FF), "from the EDS",
                                "The COB-ID of EMCY (0x1014)."),
    key<&NodeSpec::emcy_inhibit_time>("emcy_inhibit_time", whole(0, 65535, "x 100 us"), "unchanged",
                                      "The inhibit time of EMCY (0x1015).", bus_yml),
    key<&NodeSpec::time_cob_id>("time_cob_id", "unchanged",
                                "0x1012: `0x80000100` makes the device consume TIME.", bus_yml),
    key<read_error_behavior>(
        "error_behavior",
        {.type = KeyType::numbered, .range = error_classes, .entries = error_reactions},
        "unchanged", "The error behaviour (0x1029) by sub-index, 0..255: `{1: 0}`.", bus_yml),
    key<&NodeSpec::group>("group", "none", "A name that several nodes share."),
    key<&NodeSpec::on_loss>("on_loss", word_of(loss_words), "`report`",
                            "What happens when the node falls silent."),
    key<&NodeSpec::profile>("profile", word_of(profile_words), "from 0x1000",
                            "The features that the node gets. `cia402`: axis features."),
    key<with<read_pdos, &NodeSpec::tpdos>>("tpdo", pdos, "from the EDS", "The TPDOs by number.",
                                           bus_yml),
    key<read_rpdos>("rpdo", pdos, "from the EDS", "The RPDOs by number.", bus_yml),
    key<with<read_objects, &NodeSpec::sdo>>(
        "sdo", object_list, "none",
        "Values that are written in the boot, in this order, where the value differs.", bus_yml),
    key<with<read_objects, &NodeSpec::safe_values>>(
        "safe_values", object_list, "none",
        "Values that are sent before the first command, and by `fallback: safe`."),
    key<read_units>("units", {.type = KeyType::map, .parts = units_rows}, "counts",
                    "The units of values: SI = sign * counts * scale + offset."),
    key<read_limits>("limits", {.type = KeyType::map, .parts = limits_rows}, "none",
                     "What may be commanded, in the units of `units`."),
    key<read_homing>("homing",
                     {.type = KeyType::integer, .range = {-128, 127}, .parts = homing_rows}, "none",
                     "The homing of the axes of a drive; a number is the method."),
    key<read_feed_forward>("feed_forward", {.type = KeyType::map, .parts = feed_forward_rows},
                           "none", "The torque offset (0x60B2) of the motions that `taktd` runs."),
    key<with<read_speed_axis, &NodeSpec::speed_axis>>(
        "speed_axis", {.type = KeyType::map, .parts = speed_axis_rows}, "from the device data",
        "The words of an inverter, see [speed.md](speed.md). Keys that are left out come from the "
        "device data."),
    map_key<&NodeSpec::on_timeout, timeout_keys, check_timeout>(
        "on_timeout", "drives `quick_stop` after 50 ms, inverters stop after 500 ms, others `hold`",
        "What outputs do when their command has become too old."),
    map_key<&NodeSpec::sim, sim_keys, check_sim>("sim", "by 0x1000", "For the simulation."),
    also<NodeSpec, ros_keys<NodeSpec>>(),
    foreign<NodeSpec>("switching_state homing_timeout_seconds",
                      "it is for the ROS 2 drive driver; in takt applications switch modes and do "
                      "the homing"),
    foreign<NodeSpec>("channels channel_names num_channels", ros_channels),
    foreign<NodeSpec>("position_mode velocity_mode effort_mode torque_mode homing_mode "
                      "interpolated_position_mode cyclic_position_mode cyclic_velocity_mode "
                      "cyclic_torque_mode",
                      ros_modes),
    foreign<NodeSpec>("enable_lazy_load parameters joint_name plugin type executor container_name "
                      "description comment",
                      other_reader),
    foreign<NodeSpec>("scale_pos_to_dev scale_pos_from_dev offset_pos_to_dev offset_pos_from_dev",
                      "takt scales with `units: {position: {scale: ..., offset: ..., unit: rad}}`, "
                      "from counts to SI"),
    foreign<NodeSpec>("scale_vel_to_dev scale_vel_from_dev offset_vel_to_dev offset_vel_from_dev",
                      "takt scales with `units: {velocity: {scale: ..., unit: rad/s}}`, from "
                      "counts to SI"),
    foreign<NodeSpec>("scale_eff_to_dev scale_eff_from_dev offset_eff_to_dev offset_eff_from_dev",
                      "takt scales with `units: {torque: {scale: ..., unit: Nm}}`, from counts to "
                      "SI"),
    foreign<NodeSpec>("scale_acc_to_dev scale_acc_from_dev",
                      "takt scales with `units: {acceleration: {scale: ..., unit: rad/s^2}}`, "
                      "from counts to SI"),
    foreign<NodeSpec>("time_cobid", "dcfgen does not read it either; the key is `time_cob_id`"),
};

void check_name(const std::string& name, SourcePos pos, NetworkReport& report) {
  const auto bad = [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; };
  if (name == "all" || (!name.empty() && std::ranges::all_of(name, [](unsigned char c) {
        return std::isdigit(c) != 0;
      }))) {
    report.error(pos, "name", "`", name,
                 "` can't be the name of a node: in commands like `takt nmt start` numbers are "
                 "node ids and `all` means all nodes");
  }
  if (name.empty() || name.size() > 48 || std::ranges::any_of(name, bad)) {
    report.error(
        pos, "name", "the node name `", name.substr(0, 60),
        "` becomes part of LCM channel names: use at most 48 letters, digits, `_` and `-`");
  }
}

/// Reports a node that names no device file.
void check_device_file(MapReader& map, SourcePos pos) {
  if (!map.is_readable() || map.has("dcf") || map.has_slip_of("dcf")) return;
  const bool misnamed = map.take("eds") != nullptr;
  map.report().error(misnamed ? map.key_pos("eds") : pos, "missing-key", map.what(),
                     misnamed ? " names its device file under `eds`, which no program reads; the "
                                "key is `dcf`, for an EDS as well"
                              : " lacks `dcf`, the name of its EDS or DCF file");
}

}  // namespace

NodeSpec read_node(const YamlNode& node, const std::string& name, SourcePos pos,
                   NetworkReport& report) {
  NodeSpec spec;
  spec.name = name;
  spec.pos = pos;
  check_name(name, pos, report);
  MapReader map{node, "node `" + name + "`", report};
  read_keys(map, node_keys, spec, pos);
  if (*spec.on_loss == LossReaction::stop_group && !spec.group.given) {
    report.error(spec.on_loss.pos, "group",
                 "`on_loss: stop_group` needs `group:`, the name that its nodes share");
  }
  check_device_file(map, pos);
  if (map.has_slip_of("rpdo")) spec.has_rpdo_errors = true;
  if (map.has_slip_of("units")) spec.units.has_errors = true;
  map.finish_shared(map.has("driver") ? driver_key : std::string_view{});
  return spec;
}

KeyRows node_rows() { return rows_of<node_keys>(); }

}  // namespace takt
