#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr std::string_view sync_loss_words[] = {"hold", "fallback", "stop"};
constexpr std::string_view disarm_words[] = {"sdo", "reset_communication"};

constexpr Key<MasterSpec> master_keys[] = {
    key<&MasterSpec::node_id>("node_id", whole(1, 127), "127", "The node id of the master.",
                              bus_yml),
    key<with<read_bit_rate, &MasterSpec::baudrate_kbit>>(
        "baudrate", whole(1, 100'000'000, "kbit/s"), "1000", "The bit rate.", bus_yml),
    key<&MasterSpec::sync_period_us>("sync_period", whole(0, 60'000'000, "us"), "0",
                                     "The period of SYNC. 0: the bus has no SYNC.", bus_yml),
    key<&MasterSpec::cycle_us>("cycle", whole(200, 60'000'000, "us"), "10000",
                               "The period of the image on a bus without SYNC."),
    key<&MasterSpec::sync_overflow>("sync_overflow", whole(0, 240), "0",
                                    "The largest value of the SYNC counter (0x1019): 0 (no "
                                    "counter) or 2..240.",
                                    bus_yml),
    key<&MasterSpec::sync_window_us>("sync_window", whole(0, 60'000'000, "us"), "unchanged",
                                     "The synchronous window of the devices (0x1007).", bus_yml),
    key<&MasterSpec::sync_cob_id>("sync_cob_id", whole(0x001, 0x7FF), "0x80",
                                  "The COB-ID of SYNC."),
    key<&MasterSpec::sync_source>("sync_source", "`master`",
                                  "Who produces SYNC: `master`, the name of a node, or `external` "
                                  "for a device outside of this file."),
    key<&MasterSpec::sync_timeout_us>("sync_timeout", whole(1, 60'000'000, "us"), "1.5 periods",
                                      "After this time without SYNC from another source, SYNC "
                                      "counts as lost."),
    key<&MasterSpec::on_sync_loss>("on_sync_loss", word_of(sync_loss_words), "`fallback`",
                                   "What happens until that SYNC is back."),
    key<&MasterSpec::time_period_ms>("time_period", whole(0, 86'400'000, "ms"), "0",
                                     "The time between two TIME frames, at least 100 ms. 0: the "
                                     "master sends none."),
    key<&MasterSpec::time_cob_id>("time_cob_id", "0x100",
                                  "The COB-ID of TIME. Bit 30 without `time_period` means "
                                  "`time_period: 1000`.",
                                  bus_yml),
    key<with<read_producer, &MasterSpec::heartbeat_producer>>(
        "heartbeat_producer", whole(0, 65535, "ms"), "100",
        "The period of the master's heartbeat. 0: it sends none. Devices with 0x1016 watch it.",
        bus_yml),
    key<with<read_consumer, &MasterSpec::heartbeat_consumer>>(
        "heartbeat_consumer", {.type = KeyType::boolean}, "true", "The master watches the nodes.",
        bus_yml),
    key<&MasterSpec::heartbeat_multiplier>(
        "heartbeat_multiplier", "from `options`",
        "The silence after which a device reports the loss of the master, "
        "in heartbeat periods.",
        bus_yml),
    key<&MasterSpec::start_nodes>("start_nodes", "true",
                                  "The master sends NMT start after each boot.", bus_yml),
    key<&MasterSpec::start_all_nodes>("start_all_nodes", "false",
                                      "One broadcast starts the nodes, when every mandatory node "
                                      "has booted and every other node was tried.",
                                      bus_yml),
    key<&MasterSpec::start>("start", "true",
                            "The master becomes OPERATIONAL when every mandatory node has booted. "
                            "false: it waits for a command.",
                            bus_yml),
    key<&MasterSpec::reset_all_nodes>("reset_all_nodes", "false",
                                      "The loss of a mandatory node resets all nodes.", bus_yml),
    key<&MasterSpec::stop_all_nodes>("stop_all_nodes", "false",
                                     "The loss of a mandatory node stops all nodes, until they are "
                                     "reset or started. Takes precedence over `reset_all_nodes`.",
                                     bus_yml),
    key<&MasterSpec::boot_time_ms>("boot_time", whole(0, 3'600'000, "ms"), "0",
                                   "The time in which all mandatory nodes have to boot. 0: there "
                                   "is no limit.",
                                   bus_yml),
    key<&MasterSpec::nmt_inhibit_time>("nmt_inhibit_time", whole(0, 65535, "x 100 us"), "0",
                                       "The shortest time between two NMT commands.", bus_yml),
    key<&MasterSpec::stop_timeout_ms>("stop_timeout", whole(100, 60'000, "ms"),
                                      "from the drives: 5000 to 30000, at least 10 cycles",
                                      "The limit of the whole [ordered stop](ordered_stop.md)."),
    key<&MasterSpec::stop_disarm>(
        "stop_disarm", word_of(disarm_words), "`sdo`",
        "How the master ends the supervision in the devices when the stop of every axis is "
        "confirmed, before SYNC and heartbeat end."),
    key<&MasterSpec::service_frames>("service_frames", whole(1, 250, "frames"),
                                     "what fits, at most 16 in each 10 ms",
                                     "The largest number of SDO and NMT frames that the master "
                                     "sends in one cycle."),
    also<MasterSpec, ros_keys<MasterSpec>>(),
    foreign<MasterSpec>("vendor_id product_code revision_number serial_number", other_reader),
    foreign<MasterSpec>("boot_timeout_ms sdo_timeout_ms",
                        "write it under the nodes, or under `defaults`"),
    foreign<MasterSpec>("emcy_inhibit_time", "the master sends no EMCY"),
    foreign<MasterSpec>("error_behavior",
                        "the master has no 0x1029; `on_loss` of a node, `on_sync_loss`, "
                        "`on_timeout` and `stop_all_nodes` set the reactions to faults"),
};

/// Checks the keys of a SYNC that another device sends.
void check_sync_source(const MasterSpec& master, NetworkReport& report) {
  const bool followed = master.sync_source.given && *master.sync_source != "master";
  const auto needs_source = [&](const auto& value, const std::string& key) {
    if (followed || !value.given) return;
    report.error(
        value.pos, "sync-source", "`", key,
        "` is for a SYNC that another device produces: name this device with `sync_source` "
        "(a node, or `external`)");
  };
  needs_source(master.sync_timeout_us, "sync_timeout");
  needs_source(master.on_sync_loss, "on_sync_loss");
  const std::uint32_t period = *master.sync_period_us;
  if (followed && period == 0) {
    report.error(master.sync_source.pos, "sync-source",
                 "`sync_source` needs `sync_period`: the SYNC period of the producer in us");
  } else if (followed && master.sync_timeout_us.given && *master.sync_timeout_us < period) {
    report.error(master.sync_timeout_us.pos, "out-of-range", "`sync_timeout` of ",
                 *master.sync_timeout_us, " us is shorter than `sync_period` of ", period,
                 " us: every SYNC would count as lost");
  }
}

void check_sync(const MasterSpec& master, NetworkReport& report) {
  if (*master.sync_overflow == 1) {
    report.error(master.sync_overflow.pos, "out-of-range",
                 "`sync_overflow` has to be 0 (no counter) or 2..240; CiA 301 reserves 1");
  }
  const std::uint32_t period = *master.sync_period_us;
  if (period > 0 && period < 200) {
    report.error(master.sync_period_us.pos, "unit", "`sync_period` is in us: ", period,
                 " us leaves no room for frames; for ", period, " ms write ", period * 1000);
  }
  if (master.sync_window_us.given && period > 0 && *master.sync_window_us > period) {
    report.error(master.sync_window_us.pos, "out-of-range", "`sync_window` of ",
                 *master.sync_window_us, " us is longer than `sync_period` of ", period, " us");
  }
}

/// Checks the keys of the master's TIME. `time_cob_id` of other programs has the flags of 0x1012:
/// bit 30 means producer.
void check_time(MasterSpec& master, NetworkReport& report) {
  constexpr std::uint32_t produces = 0x4000'0000;
  constexpr std::uint32_t flags = 0xC000'0000;
  const std::uint32_t id = *master.time_cob_id & ~flags;
  if (id == 0 || id > 0x7FF) {
    report.error(master.time_cob_id.pos, "out-of-range",
                 "`time_cob_id` has to be an identifier of 0x001..0x7FF; bits 30 (produce) and "
                 "31 (consume) may be set as in 0x1012");
    return;
  }
  if ((*master.time_cob_id & produces) != 0 && !master.time_period_ms.given) {
    master.time_period_ms = {1000, master.time_cob_id.pos, true};
  }
  if (*master.time_period_ms > 0 && *master.time_period_ms < 100) {
    report.error(
        master.time_period_ms.pos, "out-of-range",
        "`time_period` is in ms and has to be at least 100: TIME has priority over every PDO");
  }
}

}  // namespace

void read_master(const KeyInput& in, NetworkSpec& spec) {
  MapReader map{in.node, "`master`", in.report()};
  MasterSpec& master = spec.master;
  master.pos = in.node.pos;
  read_keys(map, master_keys, master, in.node.pos);
  map.finish_shared(map.has("driver") ? driver_key : std::string_view{});
  check_sync(master, in.report());
  check_sync_source(master, in.report());
  check_time(master, in.report());
}

KeyRows master_rows() { return rows_of<master_keys>(); }

}  // namespace takt
