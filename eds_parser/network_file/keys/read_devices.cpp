#include "eds_parser/network_file/keys/read_devices.hpp"

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/network_file/keys/sections.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"

namespace takt {

/// Reads a number, or a range `[low, high]`.
static bool read_value(const KeyInput& in, NumberRange& out) {
  const IntegerRange limits = in.key.value.range;
  const bool is_list = in.node.kind == YamlNode::Kind::sequence;
  if (is_list && in.node.items.size() != 2) {
    in.error("wrong-type", "`", in.key.name, "` takes a number or `[lowest, highest]`");
    return false;
  }
  const auto bound = [&](const YamlNode& node) {
    return read_integer(node, in.key.name, limits, in.report());
  };
  const auto low = bound(is_list ? *in.node.items[0] : in.node);
  const auto high = is_list ? bound(*in.node.items[1]) : low;
  if (!low || !high) return false;
  if (*low > *high) {
    in.error("out-of-range", "`", in.key.name, "`: write the lower number first");
    return false;
  }
  out = {static_cast<std::uint32_t>(*low), static_cast<std::uint32_t>(*high)};
  return true;
}

namespace {

constexpr std::string_view timer_words[] = {"restarts", "additional", "alone"};
constexpr std::string_view function_words[] = {"process_data", "parameter_channel"};
constexpr std::string_view access_words[] = {"ro", "wo", "rw", "rwr", "rww", "const"};
constexpr std::string_view no_match[] = {"none"};
constexpr std::string_view boot_reset_words[] = {"communication", "node", "none"};
constexpr KeyValue object_index = whole(0x1000, 0xFFFF);

/// Makes the row `reason` of a section or of an entry.
template <class T>
constexpr Key<T> reason_key() {
  return key<&T::fact, &DeviceFact::reason>(
      "reason", "none", "takt prints this text when it refuses a configuration.");
}

constexpr KeyValue range_of(std::int64_t low, std::int64_t high) {
  return {.type = KeyType::range, .range = {low, high}};
}

constexpr Key<DeviceMatch> match_keys[] = {
    required(key<&DeviceMatch::vendor>("vendor_id", whole(1, 0xFFFF'FFFF), "", "0x1018:01.")),
    key<&DeviceMatch::product>("product_code", range_of(0, 0xFFFF'FFFF), "any", "0x1018:02."),
    key<&DeviceMatch::revision>("revision", range_of(0, 0xFFFF'FFFF), "any", "0x1018:03."),
};

/// Reads one identity, a list of identities, or `none`.
void read_match(const KeyInput& in, DeviceData& data) {
  if (in.node.kind == YamlNode::Kind::scalar && in.node.text == no_match[0]) return;
  if (in.node.kind == YamlNode::Kind::sequence && !in.node.items.empty()) {
    return read_list<match_keys>(in, data.matches);
  }
  read_map(in.node, "`match`", match_keys, data.matches.emplace_back(), in.report());
}

constexpr Key<NodeIdRule> node_id_keys[] = {
    required(key<&NodeIdRule::ids>("range", range_of(1, 127), "",
                                   "The node ids that the switches of the device can set. takt "
                                   "refuses others.")),
    reason_key<NodeIdRule>(),
};

constexpr Key<HeartbeatRule> heartbeat_keys[] = {
    required(key<&HeartbeatRule::multiple_of_ms>("multiple_of_ms", whole(1, 1000, "ms"), "",
                                                 "The device rounds 0x1016 and 0x1017 down to a "
                                                 "multiple of this.")),
    reason_key<HeartbeatRule>(),
};

void check_value(const KeyInput& in, const std::vector<ValueEdit>&, const ValueEdit& edit) {
  if (!is_pdo_parameter(edit.object.index)) return;
  in.error("wrong-object",
           "`sdo` is not for PDO parameters (0x1400..0x1BFF); write rules of `tpdo` and `rpdo`");
}

constexpr Key<ValueEdit> value_keys[] = {
    required(key<&ValueEdit::object, &ObjectKey::index>("index", object_index, "", "The index.")),
    key<&ValueEdit::object, &ObjectKey::sub>("sub_index", "0", "The sub-index."),
    required(key<&ValueEdit::value>("value", whole(-0x8000'0000LL, 0xFFFF'FFFFLL), "",
                                    "Written in the boot before the `sdo` of the network file, "
                                    "unless that file or a DCF sets the object.")),
    reason_key<ValueEdit>(),
};

constexpr Key<TimeoutEdit> timeout_edit_keys[] = {
    required(key<&TimeoutEdit::timeout, &SdoObjectTimeout::index>("index", object_index, "",
                                                                  "The index.")),
    key<&TimeoutEdit::timeout, &SdoObjectTimeout::sub>("sub_index", "all", "The sub-index."),
    required(key<&TimeoutEdit::timeout, &SdoObjectTimeout::timeout>(
        "timeout_ms", whole(1, 600'000, "ms"), "",
        "The time for an answer, in the boot and by request. That of the network file takes "
        "precedence.")),
    reason_key<TimeoutEdit>(),
};

template <auto Member>
void read_types(const KeyInput& in, PdoRule& rule) {
  if (in.node.kind != YamlNode::Kind::sequence || in.node.items.empty()) {
    return in.error("wrong-type", in.what(),
                    " has to be a list of numbers and ranges: [[1, 240], 254, 255]");
  }
  for (const YamlNode* item : in.node.items) {
    NumberRange types;
    if (read_value(KeyInput{in.map, in.key, *item}, types)) (rule.*Member).push_back(types);
  }
}

constexpr KeyValue types{.type = KeyType::list, .range = {0, 255}};
constexpr Key<PdoRule> pdo_rule_keys[] = {
    key<&PdoRule::numbers>("numbers", range_of(1, 512), "all", "The PDOs of the rule."),
    key<read_types<&PdoRule::types>>("transmission", types, "all",
                                     "The permitted types: `[[1, 240], 254, 255]`."),
    key<read_types<&PdoRule::answers>>("answers_rpdo", types, "none",
                                       "With these types a TPDO is sent only as the answer to the "
                                       "RPDO of its number."),
    key<&PdoRule::without_timer>("without_timer", "false", "There is no event timer."),
    key<&PdoRule::without_rtr>("without_rtr", "false", "There are no remote requests."),
    key<&PdoRule::no_more_entries>("no_more_entries", "false",
                                   "A mapping may be reduced, but not extended beyond its "
                                   "default."),
    key<&PdoRule::no_gaps>("no_gaps", "false",
                           "A PDO can be used only together with the PDO of the previous number."),
    key<&PdoRule::function>("function", word_of(function_words), "`process_data`",
                            "`parameter_channel`: the RPDO, and the TPDO that answers it, are "
                            "used by requests only (`takt param`)."),
    reason_key<PdoRule>(),
};

/// Reads the rules of one direction.
void read_pdo_rules(const KeyInput& in, DeviceData& data) {
  const std::size_t before = data.pdos.size();
  read_list<pdo_rule_keys>(in, data.pdos);
  for (auto& rule : std::span{data.pdos}.subspan(before)) rule.is_tpdo = in.key.name == "tpdo";
}

constexpr Key<InhibitRule> inhibit_keys[] = {
    key<&InhibitRule::unit_us>("unit_us", whole(1, 1'000'000, "us"), "100",
                               "The unit of 0x1800:03 in the device. The network file stays in "
                               "100 us."),
    key<&InhibitRule::least>("least", whole(0, 65535), "0",
                             "The shortest time, in units of `unit_us`."),
    key<&InhibitRule::factory>("default", whole(0, 65535), "unknown",
                               "The default, in units of `unit_us`."),
    reason_key<InhibitRule>(),
};

constexpr Key<TimerRule> timer_keys[] = {
    key<&TimerRule::meaning>(
        "meaning", word_of(timer_words), "`restarts`",
        "`restarts`: every transmission restarts the timer (CiA 301). `additional`: the timer "
        "sends in addition to changes. `alone`: while the timer is set, changes send nothing."),
    reason_key<TimerRule>(),
};

constexpr Key<SyncRule> sync_keys[] = {
    key<&SyncRule::own_tpdos_from>("own_tpdos_from", "none",
                                   "The first firmware in which the SYNC that the device itself "
                                   "sends triggers its TPDOs."),
    key<&SyncRule::tx_identifier>("tx_identifier", object_index, "none",
                                  "The object with the COB-ID on which the device sends SYNC; the "
                                  "rule holds only while its value is equal to 0x1005."),
    reason_key<SyncRule>(),
};

void read_sub_index(const KeyInput& in, ObjectEdit& edit) {
  set(in, edit.object.sub);
  edit.whole = false;
}

void check_edit(const KeyInput& in, const std::vector<ObjectEdit>&, const ObjectEdit& edit) {
  if (edit.missing != edit.access.has_value()) return;
  in.error("missing-key",
           "an entry of `objects` needs an `index`, and either `missing: true` or `access`");
}

constexpr Key<ObjectEdit> object_edit_keys[] = {
    required(key<&ObjectEdit::object, &ObjectKey::index>("index", object_index, "", "The index.")),
    key<read_sub_index>("sub_index", whole(0, 255), "all", "The sub-index."),
    key<&ObjectEdit::missing>("missing", "false", "The device does not have the object."),
    key<&ObjectEdit::access>("access", word_of(access_words), "from the EDS", "Its access."),
    key<&ObjectEdit::from>("firmware_from", "all", "The first firmware with this difference."),
    key<&ObjectEdit::below>("firmware_below", "none", "The first firmware without it again."),
    reason_key<ObjectEdit>(),
};

constexpr Key<SdoServerFact> server_keys[] = {
    required(key<&SdoServerFact::index>("index", whole(0x1201, 0x127F), "", "The index.")),
    required(key<&SdoServerFact::request>("request", whole(0x180, 0x77F), "",
                                          "The identifier of requests, without the node id.")),
    required(key<&SdoServerFact::answer>("answer", whole(0x180, 0x77F), "",
                                         "The identifier of answers, without the node id.")),
    reason_key<SdoServerFact>(),
};

constexpr Key<BootTweaks> boot_keys[] = {
    key<&BootTweaks::reset>("reset", word_of(boot_reset_words), "by the network file",
                            "A network file that resets in another way gets a warning."),
    key<&BootTweaks::values_after_pdos>("values_after_pdos", "false",
                                        "The values are written after the PDOs."),
    key<&BootTweaks::pause_after_bootup_ms>("pause_after_bootup_ms", whole(0, 60'000, "ms"), "0",
                                            "A pause after the boot-up message."),
    key<&BootTweaks::pause_before_start_ms>("pause_before_start_ms", whole(0, 60'000, "ms"), "0",
                                            "A pause before NMT start."),
    reason_key<BootTweaks>(),
};

constexpr IntegerRange emcy_codes{1, 0xFFFF};

void read_emcy(const KeyInput& in, DeviceData& data) {
  if (in.node.kind != YamlNode::Kind::map || in.node.pairs.size() > 1024) {
    return in.error("wrong-type", "`emcy` has to be a map of error codes to texts");
  }
  for (const YamlPair& pair : in.node.pairs) {
    const auto code = read_number_key(pair, in.key.name, emcy_codes, in.report());
    auto meaning = read_text(*pair.value, in.key.name, in.report());
    if (code && meaning) {
      data.emcy.push_back({static_cast<std::uint16_t>(*code), std::move(*meaning)});
    }
  }
}

/// Reads `speed_axis`, which has to be complete in the device data. Only a node of a network file
/// may state a part of it.
void read_speed_words(const KeyInput& in, DeviceData& data) {
  const std::size_t errors = in.report().errors();
  read_speed_axis(in, data.speed_axis);
  const std::string lack = missing_part(data.speed_axis);
  if (in.report().errors() != errors || lack.empty()) return;
  in.error("missing-key", in.what(), " lacks ", lack);
}

constexpr KeyValue pdo_rules{.type = KeyType::list, .parts = rows_of<pdo_rule_keys>};
constexpr Key<DeviceData> device_keys[] = {
    required(key<&DeviceData::name>("name", "", "The family.")),
    key<&DeviceData::manual>("manual", "none", "The source of the facts."),
    key<&DeviceData::revision_is_firmware>("revision_is_firmware", "false",
                                           "0x1018:03 is the firmware version: the main version "
                                           "in the upper half, the sub-version in the lower "
                                           "half."),
    required(key<read_match>(
        "match", {.type = KeyType::list, .words = no_match, .parts = rows_of<match_keys>}, "",
        "One identity or a list of them, or `none`: only `device:` of a node "
        "selects the entry.")),
    map_key<&DeviceData::node_ids, node_id_keys>("node_ids", "1..127",
                                                 "The node ids of the device."),
    map_key<&DeviceData::heartbeat, heartbeat_keys>("heartbeat", "1 ms",
                                                    "The resolution of heartbeat times."),
    list_key<&DeviceData::values, value_keys, check_value>("sdo", "none", "Values to write."),
    list_key<&DeviceData::timeouts, timeout_edit_keys>("sdo_timeouts", "none",
                                                       "Objects that take longer."),
    key<read_pdo_rules>("tpdo", pdo_rules, "CiA 301", "What the TPDOs can do."),
    key<read_pdo_rules>("rpdo", pdo_rules, "CiA 301", "What the RPDOs can do."),
    map_key<&DeviceData::inhibit, inhibit_keys>("inhibit_time", "CiA 301", "Inhibit times."),
    map_key<&DeviceData::timer, timer_keys>("event_timer", "CiA 301", "Event timers."),
    map_key<&DeviceData::sync, sync_keys>("sync_producer", "CiA 301",
                                          "The device as producer of SYNC."),
    list_key<&DeviceData::objects, object_edit_keys, check_edit>("objects", "none",
                                                                 "Differences from the EDS."),
    list_key<&DeviceData::sdo_servers, server_keys>(
        "sdo_servers", "none",
        "SDO servers that may be on from the factory, although the EDS has them off or does not "
        "have them. If one of them uses a COB-ID of another node, the plan warns."),
    key<read_speed_words>("speed_axis", {.type = KeyType::map, .parts = speed_axis_rows}, "none",
                          "An inverter: its control word and its status word."),
    map_key<&DeviceData::boot, boot_keys>("boot", "CiA 302-2", "How to boot the device."),
    key<&DeviceData::on_sync_loss>("on_sync_loss", "unknown",
                                   "A sentence on what the outputs do when SYNC is missing for "
                                   "longer than 0x1006 allows. `takt audit` then relies on it."),
    key<read_emcy>("emcy", {.type = KeyType::numbered, .range = emcy_codes}, "none",
                   "Error codes in words: `{0x2310: \"overcurrent\"}`."),
};

}  // namespace

KeyRows device_data_rows() { return rows_of<device_keys>(); }

std::optional<DeviceData> read_device_data(std::string_view text, const std::string& file,
                                           Findings& findings) {
  Findings own;
  const YamlTree tree = YamlTree::parse(text, file, own);
  DeviceData data;
  data.file = file;
  data.id = std::filesystem::path{file}.stem().string();
  NetworkReport report{file, own};
  if (tree.root() != nullptr) read_map(*tree.root(), "the device data", device_keys, data, report);
  const bool usable = tree.root() != nullptr && !has_error(own);
  findings.insert(findings.end(), own.begin(), own.end());
  if (!usable) return {};
  return data;
}

}  // namespace takt
