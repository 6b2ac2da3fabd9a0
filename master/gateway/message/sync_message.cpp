#include <algorithm>
#include <fmt/format.h>
#include <string>

#include "master/gateway/message/status_messages.hpp"
#include "master/lcm/messages.hpp"

namespace takt {
namespace {

std::string ms_text(std::int64_t ns) {
  const std::int64_t us = (ns + 500) / 1000;
  return fmt::format("{}.{:03} ms", us / 1000, us % 1000);
}

std::string sync_producer_text(const BusPlan& plan) {
  if (!plan.cycle.sync_followed) return "master";
  if (!plan.cycle.sync_producer) return "external";
  const auto found = std::ranges::find(plan.nodes, *plan.cycle.sync_producer, &NodePlan::id);
  return found == plan.nodes.end() ? "external" : found->name;
}

std::string words(const sync_status_t& message, SyncState state) {
  const std::string of = message.node_id == 0
                             ? "a device that is not in the network file"
                             : fmt::format("{} (node {})", message.source, message.node_id);
  switch (state) {
    case SyncState::none:
      return "no SYNC";
    case SyncState::made:
      return "produced by the master, " + ms_text(message.declared_ns);
    case SyncState::awaited:
      return "waits for the first SYNC of " + of;
    case SyncState::locked:
      return "locked to the SYNC of " + of + ", " + ms_text(message.period_ns);
    case SyncState::lost:
      return "SYNC of " + of + " LOST";
  }
  return {};
}

}  // namespace

sync_status_t sync_message(const BusPlan& plan, const BusStatus& bus) {
  sync_status_t message{};
  message.schema = message_schema;
  message.state = static_cast<std::int16_t>(bus.sync);
  if (bus.sync != SyncState::none) message.source = sync_producer_text(plan);
  const bool followed = plan.cycle.sync_followed;
  if (followed && plan.cycle.sync_producer) message.node_id = plan.cycle.sync_producer->value();
  if (!followed && bus.sync == SyncState::made) message.node_id = plan.master_id.value();
  message.declared_ns = plan.cycle.sync ? plan.cycle.period.count() : 0;
  message.period_ns = followed ? bus.sync_period.count() : message.declared_ns;
  message.timeout_ns = followed ? plan.cycle.sync_timeout.count() : 0;
  message.syncs = plan.cycle.sync ? static_cast<std::int64_t>(bus.beats) : 0;
  message.losses = bus.sync_losses;
  message.text = words(message, bus.sync);
  return message;
}

}  // namespace takt
