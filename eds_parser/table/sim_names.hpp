#pragma once
#include <array>
#include <string_view>

namespace takt {

/// `sim: {model: ...}` of a node: the behaviour of a simulated device besides its communication.
inline constexpr std::array<std::string_view, 8> sim_models{
    "plain",     "drive402", "io401",    "encoder406",
    "lenze8400", "beckhoff", "plain301", "astraada_drv28"};

/// `sim: {quirks: [...]}` of a node: permanent faults and special features of a simulated device.
/// The last four are features (of inputs and outputs, plain301, any device), the others are faults.
inline constexpr std::array<std::string_view, 18> sim_quirks{
    "late_bootup",        "no_bootup",     "bootup_storm", "self_start",   "no_start",
    "preop_only",         "no_heartbeat",  "no_guarding",  "stuck_toggle", "mute_sdo",
    "mute_pdo",           "fixed_mapping", "lss_silent",   "lss_no_store", "loopback",
    "event_timer_raster", "lss",           "no_node_id"};

}  // namespace takt
