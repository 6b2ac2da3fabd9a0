#include <algorithm>
#include <utility>

#include "master/core/node/node_session.hpp"

// This file handles the NMT commands to the node, and decides who may start it.

namespace takt {

void NodeSession::await_command() noexcept {
  if (!stopping()) command_ = Command::application;
  if (!booting()) return;
  runner_.stop();
  client_.cancel();
  client_.take_result();
  status_.boot = BootState::lost;
}

void NodeSession::give_up_boot() noexcept {
  if (managed_ == Managed::no) return;
  const bool first = booting() && status_.boot_count == 0;
  await_command();
  if (first) status_.boot = BootState::failed;
}

void NodeSession::halt() noexcept {
  await_command();
  if (managed_ == Managed::yes && !stopping()) own_command_ = NmtCommand::stop;
}

void NodeSession::pause() noexcept {
  const bool runs = status_.boot == BootState::ready && wanted_ == NmtState::operational;
  const bool halted = command_ == Command::application;
  if (managed_ == Managed::no || stopping() || halted || !runs) return;
  command_ = Command::paused;
  own_command_ = NmtCommand::stop;
}

void NodeSession::resume() noexcept {
  if (command_ != Command::paused) return;
  command_ = Command::network;
  if (own_command_ == NmtCommand::stop) {
    own_command_.reset();  // NMT stop was not sent yet
  } else if (wanted_ == NmtState::stopped) {
    own_command_ = NmtCommand::start;  // if no other command was sent since
  }
}

void NodeSession::on_commanded(NmtCommand command, Time now) noexcept {
  if (command_ == Command::application && (command == NmtCommand::start || is_reset(command))) {
    command_ = Command::network;
    if (status_.boot == BootState::lost) retries_.without_pause(now);
  }
  follow_command(command, now);
}

/// Applies an NMT command that was sent to the node to the state of the session.
void NodeSession::follow_command(NmtCommand command, Time now) noexcept {
  switch (command) {
    case NmtCommand::start:
      return want(NmtState::operational, now);
    case NmtCommand::stop:
      return want(NmtState::stopped, now);
    case NmtCommand::enter_preoperational:
      return want(NmtState::preoperational, now);
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      break;
  }
  retries_.shorten_pause();
  on_node_reset();
  assume(NmtState::unknown, now);
  if (managed_ == Managed::no || stopping() || status_.boot == BootState::idle) return;
  if (booting()) return boot(BootRunner::From::beginning, now);
  // The boot waits for the boot-up message, or for the pause.
  boot_later(BootState::lost, BootRunner::From::beginning, now);
}

void NodeSession::want(NmtState state, Time now) noexcept {
  wanted_ = state;
  heartbeats_against_ = 0;
  assume(state, now);
}

bool NodeSession::exchanges_pdos() const noexcept {
  const bool booted = status_.boot == BootState::ready || status_.boot == BootState::idle;
  if (!booted || status_.nmt != NmtState::operational) return false;
  return !ends_exchange() || heartbeats_against_ >= 2;
}

NodeStatus NodeSession::status() const noexcept {
  NodeStatus status = status_;
  status.exchanging = exchanges_pdos();
  return status;
}

void NodeSession::assume(NmtState state, Time now) noexcept {
  if (status_.nmt == state) return;
  status_.nmt = state;
  announce(EventKind::node_state, now, static_cast<std::int64_t>(state));
}

void NodeSession::disarm() noexcept {
  watch_.disarm();
  guard_.node_was_reset();
  duplicates_.restart();
}

void NodeSession::on_node_reset() noexcept {
  disarm();
  client_.drop();
  requests_.cancel();
}

bool NodeSession::push_nmt(NmtCommand command, Time now, Outbox& out) noexcept {
  const NmtMessage message{command, plan_->id.value()};
  if (!shared_.nmt_gate.open(now) || !out.push(encode(message))) return false;
  shared_.nmt_gate.sent(now);
  return true;
}

void NodeSession::send_own_command(Time now, Outbox& out) noexcept {
  if (!own_command_ || !push_nmt(*own_command_, now, out)) return;
  const NmtCommand command = *std::exchange(own_command_, std::nullopt);
  if (!stopping()) return follow_command(command, now);
  status_.nmt = is_reset(command) ? NmtState::unknown : NmtState::preoperational;
}

void NodeSession::send_boot_command(Time now, Outbox& out) noexcept {
  const auto command = runner_.nmt_to_send();
  if (!command || !push_nmt(*command, now, out)) return;
  runner_.nmt_sent(client_);
  if (is_reset(*command)) {
    disarm();
    status_.nmt = NmtState::unknown;
  } else {
    follow_command(*command, now);
  }
  advance(now);
}

void NodeSession::begin_stop(NmtCommand last) noexcept {
  if (stopping()) return;
  command_ = Command::stopping;
  own_command_.reset();
  const bool keeps_alive = std::ranges::any_of(plan_->boot_plan.steps, [](const BootStep& step) {
    return step.action == BootAction::await_alive;
  });
  if (managed_ == Managed::yes) {
    own_command_ = keeps_alive ? NmtCommand::enter_preoperational : last;
  }
  runner_.stop();
  guard_.stop();
  client_.cancel();
  client_.take_result();
  requests_.forget();  // the network answers all requests
  status_.boot = BootState::idle;
  retries_.cancel();
}

}  // namespace takt
