#include <algorithm>

#include "master/core/network/network.hpp"
#include "master/wire/nmt.hpp"

// NMT of the whole network: its start, and the reactions to the loss of a node.

namespace takt {
namespace {

bool ends_exchange(NmtCommand command) noexcept {
  return command == NmtCommand::stop || command == NmtCommand::enter_preoperational;
}

}  // namespace

/// Calls `change` for each session. `change` may change the deadline of the session, but not its
/// status.
template <class Change>
void Network::change_all(Change change) noexcept {
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    change(sessions_[i]);
    deadlines_[i] = sessions_[i].deadline();
  }
}

void Network::follow_start(Time now) noexcept {
  if (observe_ || stopping_ || boots_given_up_) return;
  if (start_.late(now)) {
    const auto missing = static_cast<std::uint32_t>(start_.missing(statuses_));
    events_.push({.when = now, .kind = EventKind::network_late, .detail = missing});
  }
  if (!start_.update(statuses_)) return;
  const bool bootup_waits = own_state_ == NmtState::bootup && heartbeat_at_ != never;
  if (plan_.start_up.start_master && !bootup_waits) command_master(NmtCommand::start);
  if (plan_.start_up.start_all && plan_.start_nodes) broadcasts_.push({NmtCommand::start, 0});
  for (NodeSession& session : sessions_) session.on_network_start();
  if (start_.matters()) events_.push({.when = now, .kind = EventKind::network_ready});
}

/// Reacts to the loss of a node. CiA 302-2, error handling of a running node.
void Network::on_loss(std::size_t index, Time now) noexcept {
  if (boots_given_up_) return;  // The ordered stop is the reaction.
  const NodePlan& node = plan_.nodes[index];
  if (node.mandatory && plan_.start_up.on_loss != MandatoryLoss::only_it) {
    return on_mandatory_loss(now);
  }
  if (node.on_loss == LossReaction::report) return;
  if (node.on_loss == LossReaction::stop_node) sessions_[index].halt();
  if (node.on_loss == LossReaction::stop_group) halt_group(index);
  events_.push({.when = now,
                .kind = EventKind::loss_reaction,
                .node = node.id.value(),
                .value = static_cast<std::int64_t>(node.on_loss)});
}

void Network::halt_group(std::size_t index) noexcept {
  const std::uint8_t group = plan_.nodes[index].group;
  change_all([&](NodeSession& session) {
    const bool in_group = group != 0 && session.plan().group == group;
    if (in_group || &session == &sessions_[index]) session.halt();
  });
}

void Network::on_mandatory_loss(Time now) noexcept {
  const bool stops = plan_.start_up.on_loss == MandatoryLoss::stop_all;
  broadcasts_.push({stops ? NmtCommand::stop : NmtCommand::reset_node, 0});
  if (stops) {
    for (NodeSession& session : sessions_) session.await_command();
  }
  events_.push({.when = now, .kind = EventKind::mandatory_lost, .value = stops ? 1 : 0});
}

bool Network::demands_quick_stop(std::size_t node_index) const noexcept {
  for (std::size_t i = 0; i < statuses_.size(); ++i) {
    const NodePlan& lost = plan_.nodes[i];
    if (lost.on_loss != LossReaction::quick_stop || statuses_[i].boot == BootState::ready ||
        statuses_[i].boot_count == 0) {
      continue;
    }
    if (lost.group == 0 || lost.group == plan_.nodes[node_index].group) return true;
  }
  return false;
}

void Network::on_sync_loss() noexcept {
  change_all([this](NodeSession& session) {
    if (session.plan().id != plan_.cycle.sync_producer) session.pause();
  });
}

void Network::on_absence(Time away) noexcept {
  change_all([away](NodeSession& session) { session.extend_deadlines(away); });
}

void Network::on_sync_back() noexcept {
  change_all([](NodeSession& session) { session.resume(); });
}

/// Changes the NMT state of the master itself. The master does not receive its own broadcasts, so
/// this function applies them to its state. CiA 302-2.
void Network::command_master(NmtCommand command) noexcept {
  const bool starts_anew = own_state_ == NmtState::stopped && command != NmtCommand::stop;
  sync_restarts_ = sync_restarts_ || starts_anew || is_reset(command);
  switch (command) {
    case NmtCommand::start:
      own_state_ = NmtState::operational;
      return;
    case NmtCommand::stop:
      own_state_ = NmtState::stopped;
      return;
    case NmtCommand::enter_preoperational:
      own_state_ = NmtState::preoperational;
      return;
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      own_state_ = NmtState::bootup;
      return;
  }
}

/// Returns the node whose axes lose their PDOs or the SYNC by this command. 0 means all nodes, and
/// std::nullopt means that no axis is affected. A reset does not wait for axes, because it must
/// also work for a device that does not stop.
std::optional<std::uint8_t> Network::axes_reached(const NmtMessage& message) const noexcept {
  if (nmt_stop_ == NmtStop::immediate || !ends_exchange(message.command)) return std::nullopt;
  const bool own = message.node == plan_.master_id.value();
  if (own && message.command != NmtCommand::stop) return std::nullopt;
  const std::uint8_t reached = own ? std::uint8_t{0} : message.node;
  const bool any = std::ranges::any_of(plan_.nodes, [&](const NodePlan& node) {
    return node.cia402 && (reached == 0 || reached == node.id.value());
  });
  return any ? std::optional{reached} : std::nullopt;
}

/// Returns true if the command has to wait until its axes are stopped, because they may be enabled.
bool Network::waits_for_axes(const NmtMessage& message) const noexcept {
  const auto reached = axes_reached(message);
  return reached && axes_at_rest_ != 0 && axes_at_rest_ != *reached;
}

void Network::drop_awaiting() noexcept {
  while (command_ != nullptr || (command_ = requests_.next(0)) != nullptr) {
    requests_.answer(*command_, SdoFault::cancelled);
    command_ = nullptr;
  }
  NmtMessage dropped;
  while (broadcasts_.pop(dropped)) {
  }
  awaits_axes_.reset();
  axes_at_rest_.reset();
}

void Network::give_up_boots(Time now) noexcept {
  boots_given_up_ = true;
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    sessions_[i].give_up_boot();
    touched(i, now);
  }
}

/// Sends an NMT command. Returns false if there is no room, the inhibit time is not over, or axes
/// have to be stopped first.
bool Network::send_command(const NmtMessage& message, Time now, Outbox& out) noexcept {
  const auto reached = axes_reached(message);
  if (waits_for_axes(message)) {
    if (!awaits_axes_) awaits_axes_ = reached;
    return false;
  }
  const bool own = message.node == plan_.master_id.value();
  if (!own && (!nmt_gate_.open(now) || !out.push(encode(message)))) return false;
  if (reached && awaits_axes_ == reached) {
    awaits_axes_.reset();
    axes_at_rest_.reset();
  }
  if (own) {
    command_master(message.command);
    return true;
  }
  nmt_gate_.sent(now);
  if (message.node == 0) command_master(message.command);
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    if (message.node != 0 && index_[message.node] != i) continue;
    sessions_[i].on_commanded(message.command, now);
    touched(i, now);
  }
  return true;
}

void Network::begin_anew(Time now) noexcept {
  start_.begin(now);
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    sessions_[i].on_network_reset();
    touched(i, now);
  }
}

void Network::send_own_commands(Time now, Outbox& out) noexcept {
  while (!broadcasts_.empty()) {
    if (!send_command(broadcasts_.front(), now, out)) return;
    NmtMessage sent;
    broadcasts_.pop(sent);
    if (sent.command == NmtCommand::stop) {
      for (NodeSession& session : sessions_) session.await_command();
    }
    if (is_reset(sent.command)) begin_anew(now);
  }
}

void Network::send_commands(Time now, Outbox& out) noexcept {
  while (command_ != nullptr || (command_ = requests_.next(0)) != nullptr) {
    const NmtMessage message{command_->request.command, command_->request.node};
    const bool stopped_axes = axes_reached(message).has_value() && axes_at_rest_.has_value();
    if (!send_command(message, now, out)) return;
    const bool doubtful = stopped_axes && rest_ == AxesAtRest::unconfirmed;
    requests_.answer(*command_, doubtful ? SdoFault::axes_not_stopped : SdoFault::none);
    command_ = nullptr;
  }
}

}  // namespace takt
