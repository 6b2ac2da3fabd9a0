#include "master/explain/boot_report.hpp"

namespace takt {

std::string_view name(EventKind kind) noexcept {
  switch (kind) {
    case EventKind::boot_started:
      return "boot_started";
    case EventKind::boot_done:
      return "boot_done";
    case EventKind::boot_failed:
      return "boot_failed";
    case EventKind::node_state:
      return "node_state";
    case EventKind::heartbeat_lost:
      return "heartbeat_lost";
    case EventKind::heartbeat_back:
      return "heartbeat_back";
    case EventKind::guarding_lost:
      return "guarding_lost";
    case EventKind::guarding_toggle:
      return "guarding_toggle";
    case EventKind::bootup_again:
      return "bootup_again";
    case EventKind::lss_assigned:
      return "lss_assigned";
    case EventKind::lss_not_assigned:
      return "lss_not_assigned";
    case EventKind::firmware_differs:
      return "firmware_differs";
    case EventKind::node_replaced:
      return "node_replaced";
    case EventKind::no_sdo_block:
      return "no_sdo_block";
    case EventKind::program_progress:
      return "program_progress";
    case EventKind::unlisted_node:
      return "unlisted_node";
    case EventKind::network_ready:
      return "network_ready";
    case EventKind::network_late:
      return "network_late";
    case EventKind::duplicate_node:
      return "duplicate_node";
    case EventKind::loss_reaction:
      return "loss_reaction";
    case EventKind::mandatory_lost:
      return "mandatory_lost";
    case EventKind::emcy:
      return "emcy";
    case EventKind::pdo_missing:
      return "pdo_missing";
    case EventKind::pdo_back:
      return "pdo_back";
    case EventKind::pdo_late:
      return "pdo_late";
    case EventKind::pdo_length:
      return "pdo_length";
    case EventKind::cycles_missed:
      return "cycles_missed";
    case EventKind::receive_overrun:
      return "receive_overrun";
    case EventKind::sync_lost:
      return "sync_lost";
    case EventKind::sync_back:
      return "sync_back";
    case EventKind::sync_jump:
      return "sync_jump";
    case EventKind::sync_early:
      return "sync_early";
    case EventKind::sync_period:
      return "sync_period";
    case EventKind::command_refused:
      return "command_refused";
    case EventKind::fallback_begun:
      return "fallback_begun";
    case EventKind::fallback_ended:
      return "fallback_ended";
    case EventKind::outputs_held:
      return "outputs_held";
    case EventKind::limit_read:
      return "limit_read";
    case EventKind::limit_exceeded:
      return "limit_exceeded";
    case EventKind::bus_error_passive:
      return "bus_error_passive";
    case EventKind::bus_error_active:
      return "bus_error_active";
    case EventKind::bus_off:
      return "bus_off";
    case EventKind::bus_recovered:
      return "bus_recovered";
    case EventKind::send_buffer_full:
      return "send_buffer_full";
    case EventKind::interface_down:
      return "interface_down";
    case EventKind::interface_up:
      return "interface_up";
    case EventKind::foreign_sync:
      return "foreign_sync";
    case EventKind::foreign_nmt:
      return "foreign_nmt";
    case EventKind::duplicate_cob_id:
      return "duplicate_cob_id";
    case EventKind::axis_not_stopped:
      return "axis_not_stopped";
    case EventKind::still_armed:
      return "still_armed";
    case EventKind::drive_coasts:
      return "drive_coasts";
    case EventKind::stopping:
      return "stopping";
    case EventKind::stopped:
      return "stopped";
  }
  return "unknown";
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
      return "unknown";
  }
  return "unknown";
}

std::string_view name(BootState state) noexcept {
  switch (state) {
    case BootState::idle:
      return "idle";
    case BootState::booting:
      return "booting";
    case BootState::ready:
      return "ready";
    case BootState::failed:
      return "failed";
    case BootState::lost:
      return "lost";
  }
  return "unknown";
}

std::string_view name(SdoFault fault) noexcept {
  switch (fault) {
    case SdoFault::none:
      return "none";
    case SdoFault::aborted_by_device:
      return "aborted by the device";
    case SdoFault::aborted_by_master:
      return "aborted by the master";
    case SdoFault::timeout:
      return "timeout";
    case SdoFault::too_long:
      return "answer too long";
    case SdoFault::cancelled:
      return "cancelled";
    case SdoFault::no_such_node:
      return "no such node";
    case SdoFault::axes_not_stopped:
      return "axes not stopped";
    case SdoFault::refused:
      return "refused";
    case SdoFault::no_such_pdo:
      return "no such PDO";
    case SdoFault::not_exchanging:
      return "node not operational";
    case SdoFault::lss_failed:
      return "LSS service failed";
    case SdoFault::lss_refused:
      return "LSS service refused";
    case SdoFault::wrong_length:
      return "wrong length";
  }
  return "unknown";
}

}  // namespace takt
