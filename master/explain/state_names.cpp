#include "eds_parser/values/name_of.hpp"
#include "master/explain/boot_report.hpp"

namespace takt {

std::string_view name(EventKind kind) noexcept {
  static constexpr std::string_view names[] = {
      // nodes
      "boot_started", "boot_done", "boot_failed", "node_state", "heartbeat_lost", "heartbeat_back",
      "guarding_lost", "guarding_toggle", "bootup_again", "node_replaced", "firmware_differs",
      "no_sdo_block", "limit_read", "program_progress", "lss_assigned", "lss_not_assigned",
      "unlisted_node", "network_ready", "network_late", "duplicate_node", "loss_reaction",
      "mandatory_lost", "emcy",
      // the cycle
      "pdo_missing", "pdo_back", "pdo_late", "pdo_length", "cycles_missed", "receive_overrun",
      // SYNC of another device
      "sync_lost", "sync_back", "sync_jump", "sync_early", "sync_period",
      // outputs
      "fallback_begun", "fallback_ended", "outputs_held", "limit_exceeded",
      // CAN controller and interface
      "bus_error_passive", "bus_error_active", "bus_off", "bus_recovered", "send_buffer_full",
      "interface_down", "interface_up", "foreign_sync", "foreign_nmt", "duplicate_cob_id",
      // the ordered stop
      "axis_not_stopped", "still_armed", "drive_coasts",
      // the master
      "stopping", "stopped"};
  return name_of(kind, names, "unknown");
}

std::string_view name(NmtState state) noexcept {
  switch (state) {
    case NmtState::bootup:
      return "boot-up";
    case NmtState::stopped:
      return "STOPPED";
    case NmtState::operational:
      return "OPERATIONAL";
    case NmtState::preoperational:
      return "PRE-OPERATIONAL";
    case NmtState::unknown:
      break;
  }
  return "unknown";
}

std::string_view name(BootState state) noexcept {
  static constexpr std::string_view names[] = {"idle", "booting", "ready", "failed", "lost"};
  return name_of(state, names, "unknown");
}

std::string_view name(SdoFault fault) noexcept {
  static constexpr std::string_view names[] = {
      // transfers
      "none", "aborted by the device", "aborted by the master", "timeout", "answer too long",
      "cancelled", "no such node", "refused",
      // requests
      "no such PDO", "node not operational", "LSS service failed", "LSS service refused",
      "wrong length", "axes not stopped"};
  return name_of(fault, names, "unknown");
}

}  // namespace takt
