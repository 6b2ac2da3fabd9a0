#include "master/gateway/notice/notice.hpp"

#include <algorithm>

#include "master/explain/boot_report.hpp"
#include "master/lcm/messages.hpp"

namespace takt {

/// Returns the severity of a kind of event. A kind that is in neither list is an error.
Weight weight_of(EventKind kind) noexcept {
  using enum EventKind;
  static constexpr EventKind notes[] = {
      boot_started,   boot_done,        node_state,    heartbeat_back,   pdo_back,     sync_back,
      fallback_ended, bus_error_active, bus_recovered, program_progress, no_sdo_block, limit_read,
      network_ready,  lss_assigned,     interface_up,  stopping,         stopped};
  static constexpr EventKind warnings[] = {
      bootup_again,   guarding_toggle,   lss_not_assigned, node_replaced,  firmware_differs,
      unlisted_node,  pdo_missing,       pdo_late,         pdo_length,     cycles_missed,
      sync_jump,      sync_early,        sync_period,      fallback_begun, outputs_held,
      limit_exceeded, bus_error_passive, send_buffer_full, still_armed,    drive_coasts};
  if (std::ranges::find(notes, kind) != std::end(notes)) return Weight::note;
  if (std::ranges::find(warnings, kind) != std::end(warnings)) return Weight::warning;
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
