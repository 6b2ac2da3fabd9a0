#include <algorithm>

#include "eds_parser/network_file/keys/sections.hpp"
#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::string_view automatic[] = {"auto"};
constexpr std::string_view late_words[] = {"use", "drop"};
constexpr std::string_view mpdo_words[] = {"dam", "sam"};
constexpr IntegerRange numbers{1, 512};

/// Reads `0x6064` or `0x6064:0`, with index and sub-index in hex.
std::optional<ObjectKey> read_short_key(const YamlNode& node, std::string_view key,
                                        NetworkReport& report) {
  const std::size_t colon = node.text.find(':');
  YamlNode index = node;
  index.text = node.text.substr(0, colon);
  const auto value = read_integer(index, "index", {1, 0xFFFF}, report);
  if (!value) return {};
  ObjectKey object{static_cast<std::uint16_t>(*value), 0};
  if (colon == std::string::npos) return object;
  std::string_view sub = std::string_view{node.text}.substr(colon + 1);
  if (sub.starts_with("0x") || sub.starts_with("0X")) sub.remove_prefix(2);
  if (const auto number = number_in<std::uint8_t>(sub, 16); number && sub.size() <= 2) {
    object.sub = *number;
    return object;
  }
  report.error(node.pos, "not-a-number", "`", key, "`: `", node.text.substr(0, 40),
               "` is not an object: write 0x6064, or 0x6064:0 with the sub-index in hex");
  return {};
}

constexpr Key<MappingSpec> mapping_keys[] = {
    index_key<MappingSpec>(),
    sub_index_key<MappingSpec>(),
    key<&MappingSpec::bits>("bits", whole(1, 64), "the width of the object",
                            "Needed only if the object has no fixed width."),
};

void read_mapping(const KeyInput& in, PdoSpec& pdo) {
  if (in.node.kind != YamlNode::Kind::sequence) {
    return in.error(
        "wrong-type", in.what(),
        " has to be a list of `0x6041:0` or `{index: 0x6041, sub_index: 0}`, but this is ",
        name(in.node.kind));
  }
  pdo.mapping.pos = in.node.pos;
  pdo.mapping.given = true;
  if (in.node.items.size() > 64)
    return in.error("too-many", in.what(), " has more than 64 entries");
  for (const YamlNode* item : in.node.items) {
    const std::size_t errors = in.report().errors();
    MappingSpec entry{.object = {}, .bits = {}, .pos = item->pos};
    if (item->kind == YamlNode::Kind::scalar) {
      entry.object = read_short_key(*item, in.key.name, in.report()).value_or(ObjectKey{});
    } else {
      read_map(*item, "a mapping entry of " + in.map.what(), mapping_keys, entry, in.report());
    }
    if (in.report().errors() == errors) {
      pdo.mapping.value.push_back(entry);
    } else {
      pdo.enabled.value = false;  // This avoids findings that only follow from an incomplete PDO.
    }
  }
}

void read_mpdo(const KeyInput& in, PdoSpec& pdo) {
  const auto choice = read_choice(in.node, in.key.name, mpdo_words, in.report());
  if (choice) pdo.mpdo = {*choice == 0 ? Mpdo::dam : Mpdo::sam, in.node.pos, true};
}

constexpr Key<PdoSpec> pdo_keys[] = {
    key<&PdoSpec::enabled>("enabled", "true", "false: switched off in the device.", bus_yml),
    key<&PdoSpec::cob_id>("cob_id", whole_or(automatic, {0, 0xFFFF'FFFF}), "from the EDS",
                          "The COB-ID.", bus_yml),
    key<&PdoSpec::transmission>("transmission", "from the EDS",
                                "0: with SYNC, on change. 1..240: each n-th SYNC. 252, 253 (TPDO "
                                "only): on remote request. 254, 255: by event.",
                                bus_yml),
    key<&PdoSpec::inhibit_time>("inhibit_time", whole(0, 65535, "x 100 us"), "from the EDS",
                                "The inhibit time of the sender.", bus_yml),
    key<&PdoSpec::event_timer>("event_timer", whole(0, 65535, "ms"), "from the EDS",
                               "The event timer of the sender: the device for a TPDO, the master "
                               "for an RPDO.",
                               bus_yml),
    key<&PdoSpec::event_deadline>("event_deadline", whole(0, 65535, "ms"), "from the EDS",
                                  "The deadline that the receiver watches: the master for a TPDO, "
                                  "the device for an RPDO.",
                                  bus_yml),
    key<&PdoSpec::sync_start>("sync_start", whole(0, 240), "from the EDS",
                              "TPDO: the SYNC counter of the first transmission.", bus_yml),
    key<&PdoSpec::poll_ms>("poll_ms", whole(0, 3'600'000, "ms"), "none",
                           "TPDO: the master sends a remote request with this period."),
    key<&PdoSpec::poll_syncs>("poll_syncs", whole(0, 60'000), "none",
                              "TPDO: the master sends a remote request at every n-th SYNC."),
    key<&PdoSpec::on_request>("request", "false; true for a parameter channel of the device data",
                              "The PDO is not part of the image: requests alone use it."),
    key<&PdoSpec::drop_late>("late", word_of(late_words), "`use`",
                             "TPDO: whether a synchronous frame that comes too late is used."),
    key<read_mpdo>("mpdo", word_of(mpdo_words), "from the EDS",
                   "Multiplexed PDO, by source address (`sam`) or by destination (`dam`)."),
    key<read_mapping>("mapping", {.type = KeyType::mapping, .parts = rows_of<mapping_keys>},
                      "from the EDS",
                      "The objects, short `[0x6041, 0x6064:0]` with index and sub-index in "
                      "hexadecimal.",
                      bus_yml),
};

void check_types(const PdoSpec& pdo, bool is_tpdo, const std::string& what, NetworkReport& report) {
  const unsigned type = *pdo.transmission;
  const bool reserved = type >= 241 && type <= 251;
  const bool remote = (type == 252 || type == 253) && !is_tpdo;
  if (!reserved && !remote) return;
  report.error(pdo.transmission.pos, "transmission-type", "`transmission` ", type, " of ", what,
               " is reserved ", reserved ? "by CiA 301" : "for RPDOs",
               ": write 0..240 with SYNC, 254 or 255 by event");
}

/// Reports keys that only PDOs received by the master may have.
void check_direction(const PdoSpec& pdo, bool is_tpdo, const std::string& what,
                     NetworkReport& report) {
  if (pdo.poll_ms.given && pdo.poll_syncs.given) {
    report.error(pdo.poll_syncs.pos, "written-twice", "`poll_ms` and `poll_syncs` of ", what,
                 " exclude each other: keep one");
  }
  const auto refuse = [&](const auto& value, std::string_view name) {
    if (!value.given || is_tpdo) return;
    report.error(value.pos, "wrong-direction", "`", name, "` of ", what,
                 ": the master receives only TPDOs");
  };
  refuse(pdo.poll_ms, "poll_ms");
  refuse(pdo.poll_syncs, "poll_syncs");
  refuse(pdo.drop_late, "late");
}

}  // namespace

void read_pdos(const KeyInput& in, std::vector<PdoSpec>& pdos) {
  if (in.node.kind == YamlNode::Kind::null) return;
  if (in.node.kind != YamlNode::Kind::map) {
    return in.error("wrong-type", in.what(),
                    " has to be a map of PDO numbers, `1: {mapping: [...]}`, but this is ",
                    name(in.node.kind));
  }
  const std::string key{in.key.name};
  const bool is_tpdo = key == "tpdo";
  for (const YamlPair& pair : in.node.pairs) {
    const auto number = read_number_key(pair, key + " number", numbers, in.report());
    if (!number) continue;
    if (std::ranges::find(pdos, *number, &PdoSpec::number) != pdos.end()) {
      in.report().error(pair.key_pos, "duplicate-key", "`", key, "` ", *number, " of ",
                        in.map.what(), " is written twice");
      continue;
    }
    const std::string what = concat(is_tpdo ? "TPDO" : "RPDO", *number, " of ", in.map.what());
    PdoSpec& pdo = pdos.emplace_back();
    read_map(*pair.value, what, pdo_keys, pdo, in.report());
    pdo.number = static_cast<std::uint16_t>(*number);
    pdo.pos = pair.key_pos;
    check_types(pdo, is_tpdo, what, in.report());
    check_direction(pdo, is_tpdo, what, in.report());
  }
}

KeyRows pdo_rows() { return rows_of<pdo_keys>(); }

}  // namespace takt
