#include "apps/takt/import/key_table.hpp"

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
    {"node_id", "node id of the device"},
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
    {"heartbeat_consumer", "whether heartbeats are watched: 1016"},
    {"heartbeat_producer", "heartbeat, ms: 1017"},
    {"error_behavior", "reaction of the device to its errors: 1029 by sub-index"},
    {"nmt_inhibit_time", "shortest time between NMT commands, 100 us"},
    {"start", "the master becomes operational by itself"},
    {"start_nodes", "NMT start after each boot"},
    {"start_all_nodes", "NMT start by one broadcast"},
    {"reset_all_nodes", "reaction to the loss of a mandatory node"},
    {"stop_all_nodes", "reaction to the loss of a mandatory node"},
    {"boot_time", "limit for all mandatory nodes, ms"},
    {"dcf", "EDS or DCF, read when taktd starts: there is no build step"},
    {"guard_time", "node guarding, ms: 100C"},
    {"life_time_factor", "100D"},
    {"boot", "false: takt only watches the node"},
    {"mandatory", "taktd ends if the node fails to boot at the start"},
    {"reset_communication", "false: takt resets only nodes that are not OPERATIONAL"},
    {"software_file", "program, 1F50:01, loaded if the version differs"},
    {"software_version", "expected in 1F56:01"},
    {"restore_configuration", "sub-index of 1011, loaded before the configuration"},
    {"configuration_file",
     "concise DCF (1F22), written before `sdo` (dcfgen takes it for a folder)"},
    {"boot_timeout_ms", "limit of the first answer, ms"},
    {"sdo_timeout_ms", "limit of each SDO transfer, ms"},
    {"enabled", "false: the PDO is switched off in the device, even if the EDS has it off"},
    {"cob_id", "compared with the device; bits 30 and 31 as `takt plan` shows"},
    {"transmission", "compared with the device, not with its EDS"},
    {"inhibit_time", "100 us; compared with the device"},
    {"event_timer", "timer of the sender, ms"},
    {"event_deadline",
     "deadline of the receiver, ms (dcfgen fails here, or writes the event timer)"},
    {"sync_start", "SYNC counter of the first transmission"},
    {"mapping", "compared with the device, written and read back"},
    {"sdo", "compared with the device, written at boot in this order"},
    {"name", "part of the LCM channels"},
    {"interface", "CAN interface"},
    {"bitrate_kbit", "bit rate, kbit/s"},
    {"device_type", "expected identity, 1000"},
    {"profile", "features that the node gets"},
    {"safe_values", "sent before the first command, and by `fallback: safe`"},
    {"emcy_cob_id", "1014"},
    {"sync_cob_id", "1005"},
    {"cycle", "period of the image without SYNC, us"},
    {"time_period", "TIME, ms"},
    {"store_configuration", "sub-index of 1010, saved after the configuration"},
    {"reset", "how the master resets the node before the boot"},
    {"scale", "device counts to SI"},
    {"unit", "unit of the SI value"},
    {"fallback", "reaction of the outputs when their command is too old"},
    {"model", "model of the simulated device"},
}};

constexpr std::array<KeyText, 28> reasons{{
    {"driver",
     "C++ class of a ROS 2 driver; takt needs no driver, profiles follow from the device"},
    {"package", "ROS 2 package of that driver"},
    {"namespace", "ROS 2 names; LCM channels are named after the bus and the node"},
    {"polling", "ROS 2 publishing; the image is published every cycle"},
    {"period", "rate of a ROS 2 timer; the cycle is `sync_period`, or `cycle` of `master`"},
    {"non_transmit_timeout",
     "for the ROS 2 driver; in takt `realtime: receive_window_us` judges PDOs"},
    {"diagnostics", "ROS 2 diagnostics; in takt `takt status` and BUS_STATUS show them"},
    {"switching_state", "for the ROS 2 drive driver; in takt applications switch modes"},
    {"homing_timeout_seconds",
     "for the ROS 2 drive driver; in takt an application does the homing"},
    {"channels", "ROS 2 drive channels; every mapped object is in the image here"},
    {"channel_names", "ROS 2 drive channels; every mapped object is in the image here"},
    {"num_channels", "ROS 2 drive channels; every mapped object is in the image here"},
    {"position_mode", "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"velocity_mode", "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"effort_mode", "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"torque_mode", "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"homing_mode", "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"interpolated_position_mode",
     "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"cyclic_position_mode",
     "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"cyclic_velocity_mode",
     "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"cyclic_torque_mode",
     "for the ROS 2 drive driver; in takt map 6060, and the application chooses"},
    {"enable_lazy_load", "ROS 2 component loading"},
    {"remappings", "ROS 2 names"},
    {"boot_timeout", "for the ROS 2 driver; the key of takt is `boot_timeout_ms`"},
    {"time_cobid", "a variable of dcfgen, which does not read this key; the key is `time_cob_id`"},
    {"emcy_inhibit_time", "takt as master sends no EMCY, so no inhibit time applies"},
    {"error_behavior",
     "takt as master has no 1029: `on_loss`, `on_sync_loss` and `on_timeout` set the reactions"},
    {"dcf_path",
     "filled in by a build that takt does not need: takt looks for files beside this file"},
}};

}  // namespace

std::string_view key_meaning(std::string_view key) noexcept { return find(meanings, key); }

std::string_view why_ignored(std::string_view key) noexcept { return find(reasons, key); }

}  // namespace takt
