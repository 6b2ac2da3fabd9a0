#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "eds_parser/lcm/lcm_url.hpp"
#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

constexpr std::string_view other_reader = "has no meaning for takt and is ignored";
constexpr std::string_view of_nodes =
    "has no effect: write it under the nodes, or under `defaults`";

constexpr std::array<std::uint32_t, 9> standard_rates{10, 20, 50, 100, 125, 250, 500, 800, 1000};

bool is_standard_rate(std::uint32_t kbit) {
  return std::ranges::find(standard_rates, kbit) != standard_rates.end();
}

/// Reads a bit rate in kbit/s. `baudrate` does not name its unit, so a value that can only be in
/// bit/s counts as that.
void read_bit_rate(MapReader& reader, std::string_view key, Sourced<std::uint32_t>& out) {
  Sourced<std::uint32_t> rate;
  reader.integer(key, rate, {1, 100'000'000, " kbit/s"});
  if (!rate.given) return;
  NetworkReport& report = reader.report();
  const std::string written = "`" + std::string{key} + "` is in kbit/s";
  const std::uint32_t kbit = *rate / 1000;
  const bool is_bits = *rate > 1000 && *rate % 1000 == 0 && is_standard_rate(kbit);
  if (is_bits && key == "baudrate") {
    report.warning(rate.pos, "unit",
                   written + ": " + std::to_string(*rate) +
                       " is read as bit/s, CAN allows at most " + "1000 kbit/s; write " +
                       std::to_string(kbit));
    rate.value = kbit;
  } else if (*rate > 1000) {
    report.error(rate.pos, "unit",
                 written + ": " + std::to_string(*rate) + " would be " + std::to_string(kbit) +
                     " Mbit/s; CAN allows at most 1000 kbit/s" +
                     (is_bits ? ", write " + std::to_string(kbit) : ""));
    return;
  } else if (!is_standard_rate(*rate)) {
    report.warning(rate.pos, "bit-rate",
                   written + " and " + std::to_string(*rate) +
                       " is not a CANopen bit rate (10, 20, 50, 100, 125, 250, 500, 800, 1000)");
  }
  out = rate;
}

/// Reads the keys of a SYNC that another device sends.
void read_sync_source(MapReader& reader, MasterSpec& master) {
  NetworkReport& report = reader.report();
  reader.text("sync_source", master.sync_source);
  reader.integer("sync_timeout", master.sync_timeout_us, {1, 60'000'000, " us"});
  if (const YamlNode* reaction = reader.take("on_sync_loss")) {
    constexpr std::array<std::string_view, 3> names{"hold", "fallback", "stop"};
    if (const auto choice = read_choice(*reaction, "on_sync_loss", names, report)) {
      master.on_sync_loss = {static_cast<SyncLoss>(*choice), reaction->pos, true};
    }
  }
  const bool followed = master.sync_source.given && *master.sync_source != "master";
  const auto needs_source = [&](const SourcePos& pos, const std::string& key) {
    report.error(pos, "sync-source",
                 "`" + key +
                     "` is for a SYNC that another device makes: name this device with "
                     "`sync_source` (a node, or `external`)");
  };
  if (!followed && master.sync_timeout_us.given) {
    needs_source(master.sync_timeout_us.pos, "sync_timeout");
  }
  if (!followed && master.on_sync_loss.given) needs_source(master.on_sync_loss.pos, "on_sync_loss");
  const std::uint32_t period = *master.sync_period_us;
  if (followed && period == 0) {
    report.error(master.sync_source.pos, "sync-source",
                 "`sync_source` needs `sync_period`: the SYNC period of the producer in us");
  } else if (followed && master.sync_timeout_us.given && *master.sync_timeout_us < period) {
    report.error(master.sync_timeout_us.pos, "out-of-range",
                 "`sync_timeout` of " + std::to_string(*master.sync_timeout_us) +
                     " us is shorter than `sync_period` of " + std::to_string(period) +
                     " us: every SYNC would count as lost");
  }
}

void read_stop_disarm(MapReader& reader, MasterSpec& master) {
  const YamlNode* way = reader.take("stop_disarm");
  if (way == nullptr) return;
  constexpr std::array<std::string_view, 2> names{"sdo", "reset_communication"};
  if (const auto choice = read_choice(*way, "stop_disarm", names, reader.report())) {
    master.stop_disarm = {static_cast<StopDisarm>(*choice), way->pos, true};
  }
}

void read_sync(MapReader& reader, MasterSpec& master) {
  NetworkReport& report = reader.report();
  reader.integer("sync_period", master.sync_period_us, {0, 60'000'000, " us"});
  reader.integer("sync_window", master.sync_window_us, {0, 60'000'000, " us"});
  reader.integer("sync_overflow", master.sync_overflow, {0, 240});
  reader.integer("sync_cob_id", master.sync_cob_id, {0x001, 0x7FF});
  reader.integer("cycle", master.cycle_us, {200, 60'000'000, " us"});
  if (master.sync_overflow.given && *master.sync_overflow == 1) {
    report.error(master.sync_overflow.pos, "out-of-range",
                 "`sync_overflow` has to be 0 (no counter) or 2..240; CiA 301 reserves 1");
  }
  const std::uint32_t period = *master.sync_period_us;
  if (period > 0 && period < 200) {
    report.error(master.sync_period_us.pos, "unit",
                 "`sync_period` is in us: " + std::to_string(period) +
                     " us leaves no room for frames; for " + std::to_string(period) + " ms write " +
                     std::to_string(period * 1000));
  }
  if (master.sync_window_us.given && period > 0 && *master.sync_window_us > period) {
    report.error(master.sync_window_us.pos, "out-of-range",
                 "`sync_window` of " + std::to_string(*master.sync_window_us) +
                     " us is longer than `sync_period` of " + std::to_string(period) + " us");
  }
  read_sync_source(reader, master);
}

/// Reads the keys of the master's TIME. `time_cob_id` of other programs has the flags of 0x1012:
/// bit 30 means producer.
void read_time(MapReader& reader, MasterSpec& master) {
  constexpr std::uint32_t produces = 0x4000'0000;
  constexpr std::uint32_t flags = 0xC000'0000;
  reader.integer("time_period", master.time_period_ms, {0, 86'400'000, " ms"});
  reader.integer("time_cob_id", master.time_cob_id);
  const std::uint32_t id = *master.time_cob_id & ~flags;
  if (id == 0 || id > 0x7FF) {
    reader.report().error(
        master.time_cob_id.pos, "out-of-range",
        "`time_cob_id` has to be an identifier of 0x001..0x7FF; bits 30 (produce) and "
        "31 (consume) may be set as in 0x1012");
    return;
  }
  if ((*master.time_cob_id & produces) != 0 && !master.time_period_ms.given) {
    master.time_period_ms = {1000, master.time_cob_id.pos, true};
  }
  if (master.time_period_ms.given && *master.time_period_ms > 0 && *master.time_period_ms < 100) {
    reader.report().error(
        master.time_period_ms.pos, "out-of-range",
        "`time_period` is in ms and has to be at least 100: TIME has priority over every PDO");
  }
}

/// Linux allows 15 bytes for the name of an interface and 107 bytes for the path of a socket.
void check_interface(const Sourced<std::string>& interface, NetworkReport& report) {
  constexpr std::string_view unix_bus = "unix:";
  if (!interface.given) return;
  const std::string_view name = *interface;
  const bool is_path = name.starts_with(unix_bus);
  const std::size_t path = is_path ? name.size() - unix_bus.size() : 0;
  const bool good = is_path ? path > 0 && path <= 107
                            : name.size() <= 15 && name.find_first_of("/: ") == name.npos;
  if (good) return;
  report.error(interface.pos, "interface",
               "`interface` has to be the name of a CAN interface (can0, at most 15 characters) or "
               "unix:PATH (at most 107)");
}

}  // namespace

void read_bus(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`bus`", report};
  reader.text("name", spec.bus.name);
  reader.text("interface", spec.bus.interface);
  read_bit_rate(reader, "bitrate_kbit", spec.master.baudrate_kbit);
  reader.finish();
  check_interface(spec.bus.interface, report);
  const auto bad = [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; };
  if (spec.bus.name.given &&
      (std::ranges::any_of(*spec.bus.name, bad) || spec.bus.name->size() > 32)) {
    report.error(spec.bus.name.pos, "name",
                 "the bus name becomes part of LCM channel names: use at most 32 letters, digits, "
                 "`_` and `-`");
  }
}

void read_options(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`options`", report};
  reader.text("dcf_path", spec.dcf_path);
  reader.number("heartbeat_multiplier", spec.heartbeat_multiplier);
  reader.integer("retry_factor", spec.retry_factor, {0, 255});
  reader.finish();
  if (spec.heartbeat_multiplier.given && *spec.heartbeat_multiplier < 1.5) {
    report.error(
        spec.heartbeat_multiplier.pos, "out-of-range",
        "`heartbeat_multiplier` has to be at least 1.5, or one late heartbeat stops the node");
  }
}

void read_master(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`master`", report};
  MasterSpec& master = spec.master;
  master.pos = node.pos;
  const Sourced<std::uint32_t> of_bus = master.baudrate_kbit;
  reader.integer("node_id", master.node_id, {1, 127});
  read_bit_rate(reader, "baudrate", master.baudrate_kbit);
  if (of_bus.given && master.baudrate_kbit.value != of_bus.value) {
    report.error(master.baudrate_kbit.pos, "bit-rate",
                 "`baudrate` of `master` and `bitrate_kbit` of `bus` differ: keep one");
  }
  read_sync(reader, master);
  read_time(reader, master);
  read_heartbeat_ends(reader, master.heartbeat_consumer, master.heartbeat_producer);
  reader.number("heartbeat_multiplier", master.heartbeat_multiplier);
  reader.boolean("start_nodes", master.start_nodes);
  reader.boolean("start", master.start);
  reader.boolean("start_all_nodes", master.start_all_nodes);
  reader.boolean("reset_all_nodes", master.reset_all_nodes);
  reader.boolean("stop_all_nodes", master.stop_all_nodes);
  reader.integer("boot_time", master.boot_time_ms, {0, 3'600'000, " ms"});
  reader.integer("nmt_inhibit_time", master.nmt_inhibit_time, {0, 65535, " x 100 us"});
  reader.integer("stop_timeout", master.stop_timeout_ms, {100, 60'000, " ms"});
  read_stop_disarm(reader, master);
  reader.integer("service_frames", master.service_frames, {1, 250, " frames"});
  reader.ignore(
      std::array<std::string_view, 13>{"driver", "package", "namespace", "polling", "period",
                                       "diagnostics", "vendor_id", "product_code",
                                       "revision_number", "serial_number", "remappings",
                                       "boot_timeout", "non_transmit_timeout"},
      other_reader);
  reader.ignore(std::array<std::string_view, 2>{"boot_timeout_ms", "sdo_timeout_ms"}, of_nodes);
  reader.ignore(std::array<std::string_view, 1>{"emcy_inhibit_time"},
                "has no effect: the master sends no EMCY");
  reader.ignore(std::array<std::string_view, 1>{"error_behavior"},
                "has no effect: the master has no 0x1029; `on_loss` of a node, `on_sync_loss`, "
                "`on_timeout` and `stop_all_nodes` set the reactions to faults");
  reader.finish_shared(node.find("driver") != nullptr ? driver_key : std::string_view{});
}

void read_realtime(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`realtime`", report};
  RealtimeOptions& options = spec.realtime;
  if (const YamlNode* mode = reader.take("mode")) {
    constexpr std::array<std::string_view, 3> names{"enforce", "try", "off"};
    // YAML 1.1 readers take a bare `off` as false; here it is a word.
    if (const auto choice = read_choice(*mode, "mode", names, report)) {
      options.mode = static_cast<RtMode>(*choice);
    }
  }
  Sourced<std::uint32_t> priority, cpu, spin_us, late_us;
  reader.integer("priority", priority, {1, 99});
  reader.integer("cpu", cpu, {0, 1023});
  reader.integer("spin_us", spin_us, {0, 10'000, " us"});
  reader.integer("late_limit_us", late_us, {0, 1'000'000, " us"});
  reader.integer("receive_window_us", spec.receive_window_us, {1, 60'000'000, " us"});
  reader.finish();
  if (priority.given) options.priority = static_cast<int>(*priority);
  if (cpu.given) options.cpu = static_cast<int>(*cpu);
  if (spin_us.given) options.spin = std::chrono::microseconds{*spin_us};
  if (late_us.given) options.late_limit = std::chrono::microseconds{*late_us};
}

void read_black_box(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`black_box`", report};
  Sourced<std::string> folder;
  Sourced<std::uint32_t> size_mb, keep;
  reader.text("folder", folder);
  reader.integer("size_mb", size_mb, {1, 1024, " MiB"});
  reader.integer("keep", keep, {1, 10'000, " recordings"});
  reader.finish();
  spec.recording.folder = *folder;
  if (size_mb.given) spec.recording.bytes = std::size_t{*size_mb} << 20U;
  if (keep.given) spec.recording.keep = *keep;
}

void read_lcm(const YamlNode& node, NetworkSpec& spec, NetworkReport& report) {
  MapReader reader{node, "`lcm`", report};
  Sourced<std::string> url;
  Sourced<bool> broker;
  Sourced<bool> typed{.value = true, .pos = {}};
  Sourced<std::string> keys;
  Sourced<std::string> authenticate{.value = "commands", .pos = {}};
  reader.text("keys", keys);
  reader.text("authenticate", authenticate);
  reader.text("url", url);
  reader.boolean("broker", broker);
  reader.boolean("typed", typed);
  reader.finish();
  const bool signs = *authenticate == "images";
  spec.lcm = {.url = *url, .broker = *broker, .typed = *typed, .keys = *keys, .signs = signs};
  if (!signs && *authenticate != "commands") {
    report.error(
        authenticate.pos, "lcm",
        "`authenticate` of `lcm` has to be `commands` or `images`, not `" + *authenticate + "`");
  } else if (authenticate.given && keys->empty()) {
    report.error(authenticate.pos, "lcm", "`authenticate` of `lcm` needs `keys: FILE` beside it");
  }
  if (!url.given) return;
  const auto parsed = parse_lcm_url(*url);
  if (!parsed) report.error(url.pos, "lcm-url", "`url` of `lcm`: " + parsed.error());
}

}  // namespace takt
