#include "master/core/boot_runner.hpp"

#include <algorithm>

#include "master/core/boot_value.hpp"

namespace takt {
namespace {

constexpr std::uint32_t pdo_invalid = 0x8000'0000;  // CiA 301, 7.5.2.35, bit 31
constexpr std::uint32_t no_rtr = 0x4000'0000;       // bit 30

bool begins_with_reset(const BootStep& step) noexcept {
  return step.action == BootAction::await_bootup ||
         (step.action == BootAction::nmt && is_reset(step.command));
}

bool is_pdo_cob_id(ObjectKey object) noexcept {
  return object.sub == 1 && ((object.index >= 0x1400 && object.index <= 0x15FF) ||
                             (object.index >= 0x1800 && object.index <= 0x19FF));
}

}  // namespace

BootRunner::BootRunner(const BootPlan& plan) noexcept
    : plan_{&plan},
      after_reset_{static_cast<std::size_t>(
          std::ranges::find_if_not(plan.steps, begins_with_reset) - plan.steps.begin())} {}

void BootRunner::start(From from, Time now) noexcept {
  state_ = State::running;
  began_ = now;
  restarts_ = 0;
  differs_ = false;
  cob_id_object_.reset();
  reset_sent_ = false;
  bootup_seen_ = from == From::bootup;
  heartbeat_seen_ = false;
  heard_ = from == From::bootup ? NmtState::bootup : NmtState::unknown;
  go_to(from == From::bootup ? after_reset_ : 0);
}

void BootRunner::go_to(std::size_t step) noexcept {
  step_ = static_cast<std::uint16_t>(std::min(step, plan_->steps.size()));
  phase_ = Phase::enter;
}

void BootRunner::on_bootup(Time now, SdoClient& client) noexcept {
  bootup_seen_ = true;
  heard_ = NmtState::bootup;
  if (state_ != State::running || phase_ == Phase::nmt || phase_ == Phase::enter) return;
  if (current().action == BootAction::await_bootup) {
    bootup_in_step_ = true;
    return;
  }
  client.drop();
  if (++restarts_ > max_restarts) return fail({.fault = SdoFault::cancelled}, now, client);
  cob_id_object_.reset();
  differs_ = false;
  go_to(current().action == BootAction::probe ? step_ : after_reset_);
}

void BootRunner::on_heartbeat(NmtState state) noexcept {
  heard_ = state;
  heartbeat_seen_ = true;
  heartbeat_in_step_ = true;
}

std::optional<NmtCommand> BootRunner::nmt_to_send() const noexcept {
  if (state_ != State::running || phase_ != Phase::nmt) return std::nullopt;
  return current().command;
}

void BootRunner::nmt_sent(Time /*now*/, SdoClient& client) noexcept {
  if (is_reset(current().command)) {
    client.drop();
    reset_sent_ = true;
    cob_id_object_.reset();
  }
  next();
}

Time BootRunner::deadline() const noexcept {
  if (state_ != State::running) return never;
  if (phase_ == Phase::wait) return wait_until_;
  return phase_ == Phase::enter || phase_ == Phase::nmt ? at_once : never;
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
    state_ = State::done;
    return;
  }
  const BootStep& step = current();
  attempts_ = 0;
  received_ = 0;
  bootup_in_step_ = heartbeat_in_step_ = false;
  deadline_ = wait_until_ = now + step.timeout;
  switch (step.action) {
    case BootAction::nmt:
      phase_ = Phase::nmt;
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
      to_write_ = step.value;
      phase_ = Phase::download_next;
      return;
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_object_ == step.object) return write_cob_id();
      [[fallthrough]];
    case BootAction::probe:
    case BootAction::expect:
    case BootAction::compare:
    case BootAction::verify:
    case BootAction::write_if_differs:
      phase_ = Phase::upload_next;
      return;
  }
}

bool BootRunner::begin_transfer(Time now, SdoClient& client) noexcept {
  if (!client.idle()) return false;
  const BootStep& step = current();
  Time timeout = step.timeout > Time{} ? step.timeout : default_timeout;
  if (step.action == BootAction::probe) {
    timeout = std::max(Time{1}, std::min(probe_attempt, deadline_ - now));
  }
  if (phase_ == Phase::download_next) {
    client.download(step.object, to_write_, timeout);
    phase_ = Phase::download;
    return true;
  }
  if (attempts_ < 255) ++attempts_;
  client.upload(step.object, buffer_, timeout);
  phase_ = phase_ == Phase::upload_next ? Phase::upload : Phase::confirm;
  return true;
}

bool BootRunner::end_wait(Time now, const SdoClient& client) noexcept {
  const bool over = now >= wait_until_;
  switch (current().action) {
    case BootAction::await_bootup:
      if (!over && !bootup_in_step_) return false;
      break;
    case BootAction::await_heartbeat:
      if (heartbeat_in_step_) break;
      if (over) fail({.fault = SdoFault::timeout}, now, client);
      return over;
    case BootAction::await_operational:
      if (heartbeat_in_step_ && heard_ == NmtState::operational) break;
      if (!over) return false;
      // Whoever has no heartbeat can't tell; whoever has one should have said it.
      if (heartbeat_seen_) return fail({.fault = SdoFault::timeout}, now, client), true;
      break;
    case BootAction::probe:
      if (over) phase_ = Phase::upload_next;
      return over;
    default:
      if (!over) return false;
  }
  next();
  return true;
}

void BootRunner::on_result(const SdoResult& result, Time now, SdoClient& client) noexcept {
  if (phase_ == Phase::download) return on_downloaded(result, now, client);
  received_ = result.fault == SdoFault::none ? result.size : 0;
  if (phase_ == Phase::confirm) return on_confirmed(result, now, client);
  if (current().action == BootAction::probe) return on_probed(result, now, client);
  on_uploaded(result, now, client);
}

void BootRunner::on_probed(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const bool answered =
      result.fault == SdoFault::none || result.fault == SdoFault::too_long ||
      (result.fault == SdoFault::aborted_by_device && !means_busy(result.abort_code));
  if (answered) return next();
  if (now >= deadline_) return fail(result, now, client);
  phase_ = Phase::wait;
  wait_until_ = result.fault == SdoFault::timeout ? now : std::min(now + probe_pause, deadline_);
}

void BootRunner::on_uploaded(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const BootStep& step = current();
  const bool silent = result.fault == SdoFault::timeout ||
                      result.fault == SdoFault::aborted_by_master ||
                      result.fault == SdoFault::cancelled;
  if (silent && attempts_ < upload_attempts) {
    phase_ = Phase::upload_next;
    return;
  }
  if (silent) return fail(result, now, client);
  if (result.fault == SdoFault::none) remember_cob_id();
  const bool same = result.fault == SdoFault::none ? same_value(received(), step.value, step.mask)
                                                   : may_be_missing(step, result.abort_code);
  switch (step.action) {
    case BootAction::compare:
      differs_ = differs_ || !same;
      return next();
    case BootAction::write_if_differs:
      if (same) return next();
      to_write_ = step.value;
      phase_ = Phase::download_next;
      return;
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_object_ == step.object) return write_cob_id();
      return fail(result, now, client);
    default:
      return same ? next() : fail(result, now, client);
  }
}

void BootRunner::remember_cob_id() noexcept {
  if (!is_pdo_cob_id(current().object)) return;
  cob_id_object_ = current().object;
  cob_id_ = load_le<std::uint32_t>(received());
}

void BootRunner::write_cob_id() noexcept {
  const std::uint32_t wanted =
      current().action == BootAction::disable_pdo
          ? cob_id_ | pdo_invalid
          : (load_le<std::uint32_t>(std::span{current().value}) & ~no_rtr) | (cob_id_ & no_rtr);
  if (wanted == cob_id_) return next();
  store_le(std::span{cob_id_bytes_}, wanted);
  to_write_ = cob_id_bytes_;
  phase_ = Phase::download_next;
}

void BootRunner::on_written() noexcept {
  if (is_pdo_cob_id(current().object) && to_write_.size() == 4) {
    cob_id_object_ = current().object;
    cob_id_ = load_le<std::uint32_t>(to_write_);
  }
  next();
}

void BootRunner::on_downloaded(const SdoResult& result, Time now,
                               const SdoClient& client) noexcept {
  const BootStep& step = current();
  if (result.fault == SdoFault::none) return on_written();
  // A write is never repeated. Where its answer stays away, or the device calls it redundant, a
  // look at the object tells whether it has worked.
  const bool refused = result.fault == SdoFault::aborted_by_device;
  if (refused && may_be_missing(step, result.abort_code)) return next();
  if (refused && !may_be_redundant(step, result.abort_code)) return fail(result, now, client);
  refused_ = result;
  refused_sent_ = client.last_sent();
  refused_received_ = client.last_received();
  phase_ = Phase::confirm_next;
}

void BootRunner::on_confirmed(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  if (result.fault == SdoFault::none && same_value(received(), to_write_, 0xFFFF'FFFF)) {
    return on_written();
  }
  fail(refused_, now, client);
}

void BootRunner::fail(const SdoResult& result, Time now, const SdoClient& client) noexcept {
  const bool confirming = phase_ == Phase::confirm;
  const Frame& sent = confirming ? refused_sent_ : client.last_sent();
  const Frame& got = confirming ? refused_received_ : client.last_received();
  const bool transfer = phase_ != Phase::wait && result.fault != SdoFault::cancelled;
  const std::span value = received();
  state_ = State::failed;
  failure_ = {.step = step_,
              .action = current().action,
              .letter = current().letter,
              .fault = result.fault,
              .downloading = phase_ == Phase::download || confirming,
              .abort_code = result.abort_code,
              .object = current().object,
              .received_size = transfer ? got.length : std::uint8_t{0},
              .received = got.data,
              .sent_size = transfer ? sent.length : std::uint8_t{0},
              .sent = sent.data,
              .value_size = static_cast<std::uint16_t>(transfer ? value.size() : 0),
              .node_state = heard_,
              .bootup_seen = bootup_seen_,
              .attempts = attempts_,
              .restarts = restarts_,
              .elapsed = now - began_};
  for (std::size_t i = 0; i < failure_.value.size() && i < failure_.value_size; ++i) {
    failure_.value[i] = static_cast<std::uint8_t>(value[i]);
  }
}

}  // namespace takt
