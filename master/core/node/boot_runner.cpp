#include "master/core/node/boot_runner.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

bool begins_with_reset(const BootStep& step) noexcept {
  return step.action == BootAction::await_alive || step.action == BootAction::await_bootup ||
         (step.action == BootAction::nmt && is_reset(step.command));
}

/// The step checks whether the right device is there.
bool is_identity(const BootStep& step) noexcept {
  return step.action == BootAction::probe ||
         (step.action == BootAction::expect &&
          (step.object.index == 0x1000 || step.object.index == 0x1018));
}

}  // namespace

BootRunner::BootRunner(const BootPlan& plan) noexcept
    : plan_{&plan},
      after_reset_{static_cast<std::size_t>(
          std::ranges::find_if_not(plan.steps, begins_with_reset) - plan.steps.begin())},
      limits_(static_cast<std::size_t>(
          std::ranges::count(plan.steps, BootAction::read_limit, &BootStep::action))) {}

void BootRunner::start(From from, Time now) noexcept {
  state_ = State::running;
  began_ = now;
  restarts_ = 0;
  differs_ = false;
  cob_id_object_.reset();
  reset_sent_ = started_ = false;
  guards_ = running_ = wrote_ = false;
  asks_ = from == From::silent;
  identifies_ = from == From::identity;
  preoperational_ = took_out_ = false;
  left_alone_ = 0;
  serial_number_.reset();
  firmware_.reset();
  limits_read_ = 0;
  bootup_seen_ = from == From::bootup;
  heartbeat_seen_ = false;
  heard_ = from == From::bootup ? NmtState::bootup : NmtState::unknown;
  go_to(from == From::beginning ? 0 : after_reset_);
}

void BootRunner::go_to(std::size_t step) noexcept {
  step_ = static_cast<std::uint16_t>(std::min(step, plan_->steps.size()));
  phase_ = Phase::enter;
}

void BootRunner::on_bootup(Time now, SdoClient& client) noexcept {
  bootup_seen_ = true;
  preoperational_ = took_out_ = false;
  heard_ = NmtState::bootup;
  if (state_ != State::running || phase_ == Phase::nmt || phase_ == Phase::enter) return;
  if (current().action == BootAction::await_bootup) {
    bootup_in_step_ = true;
    return;
  }
  client.drop();
  if (++restarts_ > max_restarts) return fail({.fault = SdoFault::cancelled}, now, client);
  if (current().may_restart) {
    if (polls()) {
      phase_ = Phase::upload_next;
    } else {
      next();
    }
    return;
  }
  cob_id_object_.reset();
  differs_ = guards_ = running_ = asks_ = identifies_ = started_ = false;
  go_to(current().action == BootAction::probe ? step_ : after_reset_);
}

void BootRunner::on_heartbeat(NmtState state) noexcept {
  heard_ = state;
  preoperational_ = state == NmtState::preoperational;
  heartbeat_seen_ = true;
  heartbeat_in_step_ = true;
}

std::optional<NmtCommand> BootRunner::nmt_to_send() const noexcept {
  if (state_ != State::running) return std::nullopt;
  if (phase_ == Phase::preop) return NmtCommand::enter_preoperational;
  if (phase_ != Phase::nmt) return std::nullopt;
  return current().command;
}

void BootRunner::nmt_sent(Time /*now*/, SdoClient& client) noexcept {
  if (phase_ == Phase::preop) {
    took_out_ = took_out_ || heard_ == NmtState::operational;
    preoperational_ = true;
    phase_ = after_preop_;
    return;
  }
  started_ = current().command == NmtCommand::start;
  if (is_reset(current().command)) {
    client.drop();
    reset_sent_ = true;
    guards_ = bootup_seen_ = preoperational_ = took_out_ = false;
    heard_ = NmtState::unknown;
    cob_id_object_.reset();
  }
  next();
}

Time BootRunner::deadline() const noexcept {
  if (state_ != State::running) return never;
  if (phase_ == Phase::wait) return wait_until_;
  const bool at_work = phase_ == Phase::enter || phase_ == Phase::nmt || phase_ == Phase::preop;
  return at_work ? at_once : never;
}

void BootRunner::excuse(Time away) noexcept {
  entered_ += away;
  for (Time* const limit : {&deadline_, &wait_until_}) {
    if (*limit != never) *limit += away;
  }
}

void BootRunner::on_time(Time now, SdoClient& client) noexcept {
  while (state_ == State::running && proceed(now, client)) {
  }
}

bool BootRunner::proceed(Time now, SdoClient& client) noexcept {
  switch (phase_) {
    case Phase::enter:
      enter(now);
      return true;
    case Phase::nmt:
    case Phase::preop:
      return false;
    case Phase::wait:
      return end_wait(now, client);
    case Phase::upload_next:
    case Phase::download_next:
    case Phase::confirm_next:
      return begin_transfer(now, client);
    case Phase::upload:
    case Phase::download:
    case Phase::confirm:
      break;
  }
  const auto result = client.take_result();
  if (result) on_result(*result, now, client);
  return result.has_value();
}

void BootRunner::enter(Time now) noexcept {
  if (step_ == plan_->steps.size()) {
    if (std::exchange(asks_, false)) return go_to(after_reset_);
    state_ = State::done;
    return;
  }
  const BootStep& step = current();
  if (identifies_ && !is_identity(step)) {
    identifies_ = false;
    return go_to(0);
  }
  if (skips(step)) return next();
  attempts_ = 0;
  received_ = 0;
  bootup_in_step_ = heartbeat_in_step_ = preop_again_ = false;
  entered_ = now;
  deadline_ = wait_until_ = now + step.timeout;
  begin(step);
}

/// The step makes a node report its state, and does not disturb a node that is OPERATIONAL.
bool BootRunner::asks(const BootStep& step) noexcept {
  const std::uint16_t index = step.object.index;
  switch (step.action) {
    case BootAction::probe:
    case BootAction::await_heartbeat:
    case BootAction::await_guarding:
      return true;
    case BootAction::expect:
      return index == 0x1000 || index == 0x1018;
    case BootAction::write:
    case BootAction::write_if_differs:
      return index == 0x1017 || index == 0x100C || index == 0x100D;
    default:
      return false;
  }
}

/// The step would change a node that stays OPERATIONAL, or is not needed.
bool BootRunner::skips(const BootStep& step) const noexcept {
  if (asks_) return !asks(step);
  switch (step.action) {
    case BootAction::write_if_changed:
      return running_ || !wrote_;
    case BootAction::nmt:
    case BootAction::await_bootup:
    case BootAction::pause:
    case BootAction::write:
    case BootAction::download_program:
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
    case BootAction::verify:
      return running_;
    default:
      return false;
  }
}

void BootRunner::begin(const BootStep& step) noexcept {
  switch (step.action) {
    case BootAction::nmt:
      phase_ = Phase::nmt;
      return;
    case BootAction::await_guarding:
    case BootAction::await_alive:
      guards_ = guards_ || step.action == BootAction::await_guarding || step.guarded;
      phase_ = Phase::wait;
      return;
    case BootAction::await_bootup:
    case BootAction::await_heartbeat:
    case BootAction::await_operational:
    case BootAction::pause:
      phase_ = Phase::wait;
      return;
    case BootAction::skip_if_same:
      go_to(differs_ ? step_ + 1U : std::max<std::size_t>(step.target, step_ + 1U));
      differs_ = false;
      return;
    case BootAction::write:
    case BootAction::write_if_changed:
    case BootAction::download_program:
      to_write_ = step.value;
      phase_ = Phase::download_next;
      return;
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_object_ == step.object) return write_cob_id();
      [[fallthrough]];
    case BootAction::probe:
    case BootAction::await_value:
    case BootAction::expect:
    case BootAction::compare:
    case BootAction::verify:
    case BootAction::read_serial:
    case BootAction::read_firmware:
    case BootAction::read_limit:
    case BootAction::write_if_differs:
      phase_ = Phase::upload_next;
      return;
  }
}

bool BootRunner::end_wait(Time now, const SdoClient& client) noexcept {
  const bool over = now >= wait_until_;
  switch (current().action) {
    case BootAction::await_bootup:
      if (!over && !bootup_in_step_) return false;
      break;
    case BootAction::await_heartbeat:
    case BootAction::await_guarding:
    case BootAction::await_alive:
      return end_sign_of_life(over, now, client);
    case BootAction::await_operational:
      if (heartbeat_in_step_ && heard_ == NmtState::operational) break;
      if (!over) return false;
      // A node without heartbeat cannot report the state; a node with heartbeat should have
      // reported it.
      if (heartbeat_seen_) return fail({.fault = SdoFault::timeout}, now, client), true;
      break;
    case BootAction::probe:
    case BootAction::await_value:
      if (over) phase_ = Phase::upload_next;
      return over;
    default:
      if (!over) return false;
  }
  next();
  return true;
}

bool BootRunner::end_sign_of_life(bool over, Time now, const SdoClient& client) noexcept {
  if (!heartbeat_in_step_) {
    if (over) fail({.fault = SdoFault::timeout}, now, client);
    return over;
  }
  if (std::exchange(asks_, false)) {
    go_to(0);
    return true;
  }
  running_ =
      current().action == BootAction::await_alive ? heard_ == NmtState::operational : running_;
  go_to(current().action == BootAction::await_alive && running_ ? current().target : step_ + 1U);
  return true;
}

}  // namespace takt
