#include "apps/import/key_table.hpp"

#include <algorithm>
#include <array>

namespace takt {
namespace {

struct KeyText {
  std::string_view key;
  std::string_view text;
};

template <std::size_t N>
std::string_view find(const std::array<KeyText, N>& table, std::string_view key) noexcept {
  const auto found = std::ranges::find(table, key, &KeyText::key);
  return found == table.end() ? std::string_view{} : found->text;
}

constexpr std::array<KeyText, 61> meanings{{
    {"dcf_path", "second folder for device files"},
    {"heartbeat_multiplier", "silence that is accepted, in heartbeats"},
    {"retry_factor", "silence that is accepted, in guard times"},
    {"node_id", "its address"},
    {"baudrate", "bit rate, kbit/s"},
    {"vendor_id", "expected identity, 1018:01"},
    {"product_code", "expected identity, 1018:02"},
    {"revision_number", "expected identity, 1018:03; 0 is not checked"},
    {"serial_number", "expected identity, 1018:04; 0 is not checked"},
    {"sync_period", "SYNC period, us"},
    {"sync_window", "1007 of the devices, us"},
    {"sync_overflow", "SYNC counter, 1019 of every device that has it"},
    {"time_cob_id", "TIME, 1012"},
    {"emcy_inhibit_time", "1015, 100 us"},
    {"heartbeat_consumer", "who watches whom: 1016"},
    {"heartbeat_producer", "heartbeat, ms: 1017"},
    {"error_behavior", "what the device does at its errors: 1029 by sub-index"},
    {"nmt_inhibit_time", "least time between NMT commands, 100 us"},
    {"start", "the master becomes operational by itself"},
    {"start_nodes", "NMT start after each boot"},
    {"start_all_nodes", "NMT start by one broadcast"},
    {"reset_all_nodes", "what the loss of a mandatory node means"},
    {"stop_all_nodes", "what the loss of a mandatory node means"},
    {"boot_time", "limit for all mandatory nodes, ms"},
    {"dcf", "EDS or DCF, read when taktd starts: there is no build step"},
    {"guard_time", "node guarding, ms: 100C"},
    {"life_time_factor", "100D"},
    {"boot", "false: it is only watched"},
    {"mandatory", "taktd ends where it fails to boot at the start"},
    {"reset_communication",
     "false: a node that is OPERATIONAL is left as it is, only others are reset"},
    {"software_file", "program, 1F50:01, loaded where the version differs"},
    {"software_version", "expected in 1F56:01"},
    {"restore_configuration", "sub-index of 1011, loaded before the configuration"},
    {"configuration_file",
     "concise DCF (1F22), written before `sdo` (dcfgen takes it for a folder)"},
    {"boot_timeout_ms", "limit of the first answer, ms"},
    {"sdo_timeout_ms", "limit of each SDO transfer, ms"},
    {"enabled", "what is false is switched off in the device, also where its EDS has it off"},
    {"cob_id", "compared with the device; bits 30 and 31 as `takt plan` says"},
    {"transmission", "compared with the device, not with its EDS"},
    {"inhibit_time", "100 us; compared with the device"},
    {"event_timer", "ms, of the sender"},
    {"event_deadline", "ms, of the receiver (dcfgen fails here, or writes the event timer)"},
    {"sync_start", "SYNC counter of the first transmission"},
    {"mapping", "compared with the device, written and read back"},
    {"sdo", "compared with the device, written at boot in this order"},
    {"name", "part of the LCM channels"},
    {"interface", "CAN interface"},
    {"bitrate_kbit", "bit rate, kbit/s"},
    {"device_type", "expected identity, 1000"},
    {"profile", "which features it gets"},
    {"safe_values", "sent before the first command, and by `fallback: safe`"},
    {"emcy_cob_id", "1014"},
    {"sync_cob_id", "1005"},
    {"cycle", "period of the image without SYNC, us"},
    {"time_period", "TIME, ms"},
    {"store_configuration", "sub-index of 1010, saved after the configuration"},
    {"reset", "what the master does to it first"},
    {"scale", "device counts to SI"},
    {"unit", "of the SI value"},
    {"fallback", "what outputs do when their command has grown old"},
    {"model", "of the simulated device"},
}};

constexpr std::array<KeyText, 28> reasons{{
    {"driver", "C++ class of a ROS 2 driver: takt needs none, profiles follow from the device"},
    {"package", "ROS 2 package of that driver"},
    {"namespace", "ROS 2 names; LCM channels are named after the bus and the node"},
    {"polling", "ROS 2 publishing; the image is published every cycle"},
    {"period", "rate of a ROS 2 timer; the cycle is `sync_period`, or `cycle` of `master`"},
    {"non_transmit_timeout", "of the ROS 2 driver; `realtime: receive_window_us` judges PDOs here"},
    {"diagnostics", "ROS 2 diagnostics; `takt status` and BUS_STATUS show them here"},
    {"switching_state", "of the ROS 2 drive driver; applications switch modes here"},
    {"homing_timeout_seconds", "of the ROS 2 drive driver; homing is an application's here"},
    {"channels", "ROS 2 drive channels; every mapped object is in the image here"},
    {"channel_names", "ROS 2 drive channels; every mapped object is in the image here"},
    {"num_channels", "ROS 2 drive channels; every mapped object is in the image here"},
    {"position_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"velocity_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"effort_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"torque_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"homing_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"interpolated_position_mode",
     "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"cyclic_position_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"cyclic_velocity_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"cyclic_torque_mode", "of the ROS 2 drive driver; map 6060 and the application chooses"},
    {"enable_lazy_load", "ROS 2 component loading"},
    {"remappings", "ROS 2 names"},
    {"boot_timeout", "of the ROS 2 driver; here it is `boot_timeout_ms`"},
    {"time_cobid", "a variable of dcfgen, which reads no such key; the key is `time_cob_id`"},
    {"emcy_inhibit_time", "takt as master sends no EMCY: there is nothing to hold back"},
    {"error_behavior",
     "takt as master has no 1029: `on_loss`, `on_sync_loss` and `on_timeout` say what faults do"},
    {"dcf_path",
     "filled in by a build that takt does not need: files are looked for beside this one"},
}};

}  // namespace

std::string_view key_meaning(std::string_view key) noexcept { return find(meanings, key); }

std::string_view why_ignored(std::string_view key) noexcept { return find(reasons, key); }

}  // namespace takt
