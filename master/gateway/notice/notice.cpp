#include "master/gateway/notice/notice.hpp"

#include "master/explain/boot_report.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

Weight weight_of(EventKind kind) noexcept {
  switch (kind) {
    case EventKind::boot_started:
    case EventKind::boot_done:
    case EventKind::node_state:
    case EventKind::heartbeat_back:
    case EventKind::pdo_back:
    case EventKind::sync_back:
    case EventKind::fallback_ended:
    case EventKind::bus_error_active:
    case EventKind::bus_recovered:
    case EventKind::program_progress:
    case EventKind::no_sdo_block:
    case EventKind::limit_read:
    case EventKind::network_ready:
    case EventKind::lss_assigned:
    case EventKind::interface_up:
    case EventKind::stopping:
    case EventKind::stopped:
      return Weight::note;
    case EventKind::bootup_again:
    case EventKind::guarding_toggle:
    case EventKind::lss_not_assigned:
    case EventKind::node_replaced:
    case EventKind::firmware_differs:
    case EventKind::unlisted_node:
    case EventKind::pdo_missing:
    case EventKind::pdo_late:
    case EventKind::pdo_length:
    case EventKind::cycles_missed:
    case EventKind::sync_jump:
    case EventKind::sync_early:
    case EventKind::sync_period:
    case EventKind::fallback_begun:
    case EventKind::outputs_held:
    case EventKind::limit_exceeded:
    case EventKind::bus_error_passive:
    case EventKind::send_buffer_full:
    case EventKind::still_armed:
    case EventKind::drive_coasts:
      return Weight::warning;
    case EventKind::boot_failed:
    case EventKind::heartbeat_lost:
    case EventKind::guarding_lost:
    case EventKind::network_late:
    case EventKind::duplicate_node:
    case EventKind::loss_reaction:
    case EventKind::mandatory_lost:
    case EventKind::axis_not_stopped:
    case EventKind::emcy:
    case EventKind::receive_overrun:
    case EventKind::sync_lost:
    case EventKind::bus_off:
    case EventKind::interface_down:
    case EventKind::foreign_sync:
    case EventKind::foreign_nmt:
    case EventKind::duplicate_cob_id:
      return Weight::error;
  }
  return Weight::error;
}

Notice to_notice(const BusPlan& plan, const Event& event) {
  // CiA 301, 7.2.7.1: error code 0 reports that an error has gone.
  const bool all_clear =
      event.kind == EventKind::emcy && event.bytes[0] == 0 && event.bytes[1] == 0;
  return {.when = event.when,
          .cycle = event.cycle,
          .node = event.node,
          .kind = std::string{name(event.kind)},
          .weight = all_clear ? Weight::note : weight_of(event.kind),
          .text = describe(plan, event),
          .asks_on = event.kind == EventKind::boot_failed &&
                     event.failure.action == BootAction::await_alive};
}

std::string_view node_name(const BusPlan& plan, std::uint8_t node) noexcept {
  const NodePlan* const planned = plan.find(node);
  return planned == nullptr ? std::string_view{} : std::string_view{planned->name};
}

event_t to_message(const BusPlan& plan, const Notice& notice) {
  constexpr std::size_t longest_text = message_bytes - 200;
  event_t message{};
  message.schema = message_schema;
  message.cycle = static_cast<std::int64_t>(notice.cycle);
  message.node_id = notice.node;
  message.node = std::string{node_name(plan, notice.node)}.substr(0, 64);
  message.kind = notice.kind.substr(0, 64);
  message.severity = static_cast<std::int16_t>(notice.weight);
  message.text = notice.text;
  if (message.text.size() > longest_text) {
    message.text.resize(longest_text);
    message.text += " ...";
  }
  return message;
}

}  // namespace takt
