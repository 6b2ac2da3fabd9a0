#include <algorithm>
#include <cctype>

#include "eds_parser/lcm/lcm_url.hpp"
#include "eds_parser/network_file/keys/sections.hpp"

// This file reads all sections of a network file except `master` and the nodes.

namespace takt {
namespace {

void read_name(const KeyInput& in, NetworkSpec& spec) {
  Sourced<std::string>& name = spec.bus.name;
  set(in, name);
  const auto bad = [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; };
  if (!std::ranges::any_of(*name, bad) && name->size() <= 32) return;
  in.error("name",
           "the bus name becomes part of LCM channel names: use at most 32 letters, digits, `_` "
           "and `-`");
}

/// Reads `interface`. Linux allows 15 bytes for the name of an interface and 107 bytes for the path
/// of a socket.
void read_interface(const KeyInput& in, NetworkSpec& spec) {
  constexpr std::string_view unix_bus = "unix:";
  set(in, spec.bus.interface);
  if (!spec.bus.interface.given) return;
  const std::string_view name = *spec.bus.interface;
  const bool is_path = name.starts_with(unix_bus);
  const std::size_t path = is_path ? name.size() - unix_bus.size() : 0;
  const bool good = is_path ? path > 0 && path <= 107
                            : name.size() <= 15 && name.find_first_of("/: ") == name.npos;
  if (good) return;
  in.error("interface",
           "`interface` has to be the name of a CAN interface (can0, at most 15 characters) or "
           "unix:PATH (at most 107)");
}

void read_bus_rate(const KeyInput& in, NetworkSpec& spec) {
  read_bit_rate(in, spec.master.baudrate_kbit);
}

constexpr Key<NetworkSpec> bus_keys[] = {
    key<read_name>("name", {.type = KeyType::text}, "the interface, otherwise `sim`",
                   "Part of the names of the LCM channels."),
    key<read_interface>("interface", {.type = KeyType::text}, "none",
                        "The CAN interface, such as `can0`, or `unix:PATH`. Without it, `taktd` "
                        "needs `--bus`."),
    key<read_bus_rate>("bitrate_kbit", whole(1, 100'000'000, "kbit/s"), "1000",
                       "The bit rate. `master: baudrate` is the same."),
};

void read_url(const KeyInput& in, LcmOptions& lcm) {
  set(in, lcm.url);
  if (lcm.url.empty()) return;
  const auto parsed = parse_lcm_url(lcm.url);
  if (!parsed) in.error("lcm-url", "`url` of `lcm`: ", parsed.error());
}

void read_authenticate(const KeyInput& in, LcmOptions& lcm) {
  set(in, lcm.signs);
  if (in.map.has("keys")) return;
  in.error("lcm", "`authenticate` of `lcm` needs `keys: FILE` beside it");
}

constexpr std::string_view signed_words[] = {"commands", "images"};
constexpr Key<LcmOptions> lcm_keys[] = {
    key<read_url>("url", {.type = KeyType::text}, "`LCM_DEFAULT_URL`, otherwise LCM's default",
                  "The LCM URL."),
    key<&LcmOptions::broker>("broker", "false", "`taktd` serves `tcpq://` itself."),
    key<&LcmOptions::keys>("keys", "none",
                           "Key file: `taktd` then accepts commands, requests and files in "
                           "envelopes only."),
    key<read_authenticate>("authenticate", word_of(signed_words), "`commands`",
                           "`images`: `taktd` also signs the messages that it publishes. Needs "
                           "`keys`."),
    key<&LcmOptions::typed>("typed", "true",
                            "`BUS_NODE_STATE` and `BUS_NODE_COMMAND` of each node, in the types "
                            "of `takt export lcm`."),
};

void read_size(const KeyInput& in, RecordingOptions& recording) {
  std::size_t mib = recording.bytes >> 20U;
  set(in, mib);
  recording.bytes = mib << 20U;
}

constexpr Key<RecordingOptions> black_box_keys[] = {
    key<&RecordingOptions::folder>("folder", "none",
                                   "The daemon records, and writes faults to this folder."),
    key<read_size>("size_mb", whole(1, 1024, "MiB"), "16",
                   "The memory of the recorder. `taktd` allocates it twice."),
    key<&RecordingOptions::keep>("keep", whole(1, 10'000, "recordings"), "20",
                                 "The number of recordings of this bus that are kept."),
};

// A reader of YAML 1.1 takes `off` without quotes as false. In this list it is a word.
constexpr std::string_view mode_words[] = {"enforce", "try", "off"};
constexpr Key<RealtimeOptions> realtime_option_keys[] = {
    key<&RealtimeOptions::mode>("mode", word_of(mode_words), "`try`",
                                "What `taktd` does if the machine does not grant real-time "
                                "scheduling."),
    key<&RealtimeOptions::priority>("priority", whole(1, 99), "80", "The SCHED_FIFO priority."),
    key<&RealtimeOptions::cpu>("cpu", whole(0, 1023), "any", "The CPU of the bus thread."),
    key<&RealtimeOptions::spin>("spin_us", whole(0, 10'000, "us"), "100",
                                "For this time, the bus thread waits actively before SYNC."),
    key<&RealtimeOptions::late_limit>(
        "late_limit_us", whole(0, 1'000'000, "us"), "none",
        "With `mode: enforce`, a SYNC that is later than this ends the run."),
};
constexpr Key<NetworkSpec> realtime_keys[] = {
    group<&NetworkSpec::realtime, realtime_option_keys>(),
    key<&NetworkSpec::receive_window_us>("receive_window_us", whole(1, 60'000'000, "us"),
                                         "the middle of the application's time",
                                         "A synchronous TPDO that comes later than this after "
                                         "SYNC counts as missing."),
};

constexpr Key<NetworkSpec> options_keys[] = {
    key<&NetworkSpec::dcf_path>(
        "dcf_path", "none",
        "A folder in which takt looks for device files that are not beside this "
        "file. `@...@` placeholders are ignored with a note.",
        bus_yml),
    key<with<read_multiplier, &NetworkSpec::heartbeat_multiplier>>(
        "heartbeat_multiplier", multiplier_value, "3.0",
        "The accepted silence, in heartbeat periods; at least 1.5.", bus_yml),
    key<&NetworkSpec::retry_factor>("retry_factor", "3",
                                    "The accepted silence, in guard times. 0: the master does not "
                                    "guard.",
                                    bus_yml),
};

/// Makes the row of a section. Its values go to `Member` of the network, or to the network itself
/// if there is no `Member`.
template <const auto& Keys, auto... Member>
constexpr Key<NetworkSpec> section(std::string_view name, std::string_view meaning,
                                   KeyOrigin origin = KeyOrigin::takt) {
  Key<NetworkSpec> row{{name, {.type = KeyType::map, .parts = rows_of<Keys>}, {}, meaning, origin}};
  row.read = [](const KeyInput& in, NetworkSpec& spec) {
    auto what = "`" + std::string{in.key.name} + "`";
    if constexpr (sizeof...(Member) == 0) {
      read_map(in.node, std::move(what), Keys, spec, in.report());
    } else {
      read_map(in.node, std::move(what), Keys, member_of<Member...>(spec), in.report());
    }
  };
  return row;
}

/// The sections are read in the order of these rows. Rows without a function (`defaults`, `nodes`)
/// are read last.
constexpr Key<NetworkSpec> sections[] = {
    section<bus_keys>("bus", "The bus."),
    section<lcm_keys, &NetworkSpec::lcm>("lcm", "The messages on LCM."),
    section<black_box_keys, &NetworkSpec::recording>("black_box", "The recordings."),
    section<realtime_keys>("realtime", "The scheduling of the bus thread."),
    section<options_keys>("options", "Values for all nodes.", bus_yml),
    key<read_master>("master", {.type = KeyType::map, .parts = master_rows}, "", "The master.",
                     bus_yml),
    {{"defaults",
      {.type = KeyType::map, .parts = node_rows},
      {},
      "Keys that every node gets that does not set them itself.",
      bus_yml}},
    {{"nodes", {.type = KeyType::map, .parts = node_rows}, {}, "The nodes, by name.", bus_yml}},
};

}  // namespace

std::span<const Key<NetworkSpec>> network_keys() noexcept { return sections; }

}  // namespace takt
