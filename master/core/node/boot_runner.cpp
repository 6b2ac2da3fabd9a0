#include "master/core/node/boot_runner.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/table/waits.hpp"

// This file runs the boot from step to step: the waits, the NMT commands, and the begin of each
// transfer.

namespace takt {
namespace {

bool begins_with_reset(const BootStep& step) noexcept {
  return step.action == BootAction::await_alive || step.action == BootAction::await_bootup ||
         (step.action == BootAction::nmt && is_reset(step.command));
}

BootCourse course_of(BootRunner::From from) noexcept {
  switch (from) {
    case BootRunner::From::silent:
      return BootCourse::probing_silent_node;
    case BootRunner::From::identity:
      return BootCourse::identifying;
    case BootRunner::From::beginning:
    case BootRunner::From::bootup:
      break;
  }
  return BootCourse::configuring;
}

}  // namespace

BootRunner::BootRunner(const BootPlan& plan) noexcept
    : plan_{&plan},
      after_reset_{static_cast<std::size_t>(
          std::ranges::find_if_not(plan.steps, begins_with_reset) - plan.steps.begin())},
      limits_{static_cast<std::size_t>(
          std::ranges::count(plan.steps, BootAction::read_limit, &BootStep::action))} {}

void BootRunner::start(From from, Time now) noexcept {
  began_ = now;
  course_ = course_of(from);
  restarts_ = 0;
  compared_ = Compared::same;
  device_ = Device::untouched;
  guarding_ = Guarding::not_yet;
  nmt_ = {};
  if (from == From::bootup) nmt_.on_bootup();
  cob_id_.forget();
  left_alone_ = 0;
  serial_number_.reset();
  firmware_.reset();
  limits_.clear();
  go_to(from == From::beginning ? 0 : after_reset_);
}

void BootRunner::go_to(std::size_t step) noexcept {
  step_ = static_cast<std::uint16_t>(std::min(step, plan_->steps.size()));
  state_ = State::entering;
}

void BootRunner::on_bootup(Time now, SdoClient& client) noexcept {
  nmt_.on_bootup();
  if (!runs() || state_ == State::commanding || state_ == State::entering) return;
  if (current().action == BootAction::await_bootup) {
    progress_.sign_came = true;
    return;
  }
  client.drop();
  if (++restarts_ > max_restarts) return fail({.fault = SdoFault::cancelled}, now, client);
  if (current().may_restart) return polls() ? go_to_transfer(Transfer::upload) : next();
  cob_id_.forget();
  compared_ = Compared::same;
  guarding_ = Guarding::not_yet;
  course_ = BootCourse::configuring;
  go_to(current().action == BootAction::probe ? step_ : after_reset_);
}

void BootRunner::on_heartbeat(NmtState state) noexcept {
  nmt_.on_heartbeat(state);
  const bool awaited = state_ == State::waiting && current().action != BootAction::await_bootup;
  progress_.sign_came = progress_.sign_came || awaited;
}

std::optional<NmtCommand> BootRunner::nmt_to_send() const noexcept {
  if (state_ == State::before_preop) return NmtCommand::enter_preoperational;
  if (state_ == State::commanding) return current().command;
  return std::nullopt;
}

void BootRunner::nmt_sent(SdoClient& client) noexcept {
  if (state_ == State::before_preop) {
    nmt_.commanded_preoperational();
    state_ = State::before_transfer;
    return;
  }
  nmt_.commanded(current().command);
  if (is_reset(current().command)) {
    client.drop();
    guarding_ = Guarding::not_yet;
    cob_id_.forget();
  }
  next();
}

Time BootRunner::deadline() const noexcept {
  switch (state_) {
    case State::entering:
    case State::commanding:
    case State::before_preop:
      return at_once;
    case State::waiting:
      return progress_.wait_until;
    case State::before_transfer:
    case State::in_transfer:  // the client has its own deadline
    case State::idle:
    case State::done:
    case State::failed:
      break;
  }
  return never;
}

void BootRunner::extend_deadlines(Time away) noexcept {
  progress_.entered += away;
  for (Time* const limit : {&progress_.deadline, &progress_.wait_until}) {
    if (*limit != never) *limit += away;
  }
}

void BootRunner::on_time(Time now, SdoClient& client) noexcept {
  while (proceed(now, client)) {
  }
}

bool BootRunner::proceed(Time now, SdoClient& client) noexcept {
  switch (state_) {
    case State::entering:
      enter(now);
      return true;
    case State::waiting:
      return end_wait(now, client);
    case State::before_transfer:
      return begin_transfer(now, client);
    case State::in_transfer: {
      const auto result = client.take_result();
      if (result) on_result(*result, now, client);
      return result.has_value();
    }
    case State::commanding:
    case State::before_preop:
    case State::idle:
    case State::done:
    case State::failed:
      break;
  }
  return false;
}

void BootRunner::enter(Time now) noexcept {
  if (step_ == plan_->steps.size()) {
    if (course_ != BootCourse::probing_silent_node) {
      state_ = State::done;
      return;
    }
    course_ = BootCourse::configuring;
    return go_to(after_reset_);
  }
  const BootStep& step = current();
  if (course_ == BootCourse::identifying && !identifies_device(step)) {
    course_ = BootCourse::configuring;
    return go_to(0);
  }
  if (skips(course_, step, device_ == Device::written)) return next();
  const Time end = now + step.timeout;
  progress_ = {.entered = now, .deadline = end, .wait_until = end};
  begin(step);
}

void BootRunner::begin(const BootStep& step) noexcept {
  switch (step.action) {
    case BootAction::nmt:
      state_ = State::commanding;
      return;
    case BootAction::await_guarding:
    case BootAction::await_alive:
      if (step.action == BootAction::await_guarding || step.guarded) guarding_ = Guarding::begun;
      [[fallthrough]];
    case BootAction::await_bootup:
    case BootAction::await_heartbeat:
    case BootAction::await_operational:
    case BootAction::pause:
      state_ = State::waiting;
      return;
    case BootAction::skip_if_same: {
      const Compared compared = std::exchange(compared_, Compared::same);
      return go_to(compared == Compared::same ? std::max<std::size_t>(step.target, step_ + 1U)
                                              : step_ + 1U);
    }
    case BootAction::write:
    case BootAction::write_if_changed:
    case BootAction::download_program:
      return write(step.value);
    case BootAction::disable_pdo:
    case BootAction::enable_pdo:
      if (cob_id_.knows(step.object)) return write_cob_id();
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
      return go_to_transfer(Transfer::upload);
  }
}

bool BootRunner::begin_transfer(Time now, SdoClient& client) noexcept {
  if (!client.idle()) return false;
  if (needs_preop()) {
    state_ = State::before_preop;
    return false;
  }
  const BootStep& step = current();
  Time timeout = step.timeout > Time{} ? step.timeout : default_timeout;
  if (polls()) {
    timeout = std::max(Time{1}, std::min(waits::probe_try, progress_.deadline - now));
  }
  state_ = State::in_transfer;
  if (transfer_ == Transfer::download) {
    client.download(step.object, to_write_, timeout);
    return true;
  }
  if (progress_.uploads < 255) ++progress_.uploads;
  client.upload(step.object, buffer_, timeout);
  return true;
}

/// Returns true if the command PRE-OPERATIONAL must come before the transfer. Parameters are
/// written in this state, but a device that starts by itself leaves it without a command. A device
/// in STOPPED answers no SDO at all. The boot does not write to a node that is or may be
/// OPERATIONAL.
bool BootRunner::needs_preop() const noexcept {
  const bool leaves_state =
      course_ == BootCourse::keeping_operational || course_ == BootCourse::probing_silent_node;
  if (nmt_.preoperational() || leaves_state) return false;
  return transfer_ == Transfer::download || nmt_.reported() == NmtState::stopped;
}

bool BootRunner::end_wait(Time now, const SdoClient& client) noexcept {
  const bool over = now >= progress_.wait_until;
  switch (current().action) {
    case BootAction::await_bootup:
      if (!over && !progress_.sign_came) return false;
      break;
    case BootAction::await_heartbeat:
    case BootAction::await_guarding:
    case BootAction::await_alive:
      return end_sign_of_life(over, now, client);
    case BootAction::await_operational:
      if (progress_.sign_came && nmt_.reported() == NmtState::operational) break;
      if (!over) return false;
      // A node without heartbeat cannot report the state; a node with heartbeat should have
      // reported it.
      if (nmt_.heartbeat_seen()) {
        fail({.fault = SdoFault::timeout}, now, client);
        return true;
      }
      break;
    case BootAction::probe:
    case BootAction::await_value:
      if (over) go_to_transfer(Transfer::upload);
      return over;
    default:
      if (!over) return false;
  }
  next();
  return true;
}

bool BootRunner::end_sign_of_life(bool over, Time now, const SdoClient& client) noexcept {
  if (!progress_.sign_came) {
    if (over) fail({.fault = SdoFault::timeout}, now, client);
    return over;
  }
  if (course_ == BootCourse::probing_silent_node) {
    course_ = BootCourse::configuring;
    go_to(0);
    return true;
  }
  if (current().action == BootAction::await_alive) {
    const bool operational = nmt_.reported() == NmtState::operational;
    course_ = operational ? BootCourse::keeping_operational : BootCourse::configuring;
    go_to(operational ? current().target : step_ + 1U);
  } else {
    next();
  }
  return true;
}

}  // namespace takt
